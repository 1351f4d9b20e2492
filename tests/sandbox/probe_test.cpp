// Probes in the sandbox: drawing, dragging, resetting, saving.
#include "app/sandbox/draw/probe_draw.h"
#include "app/sandbox/sandbox.h"
#include "engine/scene/scene_file.h"
#include "tests/temporary_folder.h"

#include <csignal>
#include <filesystem>
#include <fstream>

#include <sys/resource.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

// A ray along x at a ball, seen from +z; the ball is at the centre of an 800 x 600 viewport.
SceneDesc ray_at_ball() {
    SceneDesc scene;
    scene.name = "ray_at_ball";
    ProbeDesc probe;
    probe.name = "ray";
    probe.question = ProbeQuestion::raycast;
    probe.ray = ProbeRayDesc{{-2, 0, 0}, {1, 0, 0}, {}, {}};
    ProbeShapeDesc ball;
    ball.shape = SphereDesc{1};
    probe.shapes.push_back(ball);
    probe.expects = {{"t", 1}};
    probe.source = "-2 + t = -1";
    scene.probes.push_back(probe);
    scene.camera.target = glm::dvec3(0);
    scene.camera.yaw = 0;
    scene.camera.pitch = 0;
    return scene;
}

class ProbeTest : public testing::Test {
  protected:
    ProbeTest() : sandbox(Session()) { sandbox.open(ray_at_ball()); }
    void send(PointerEvent::Kind kind, glm::vec2 at) {
        PointerEvent event;
        event.kind = kind;
        event.position = at;
        sandbox.handle(event, viewport);
    }
    double t() const { return sandbox.session().answers().front().value("t"); }

    static constexpr glm::vec2 viewport{800, 600};
    static constexpr glm::vec2 ball{400, 300};
    Sandbox sandbox;
};

TEST_F(ProbeTest, AnswersAreThereFromTheStartAndNothingSteps) {
    EXPECT_EQ(t(), 1);
    EXPECT_FALSE(sandbox.session().step());
    sandbox.advance(1'000'000'000);
    sandbox.perform(Action::step);
    EXPECT_EQ(sandbox.session().simulation()->step_count(), 0U);
    EXPECT_EQ(sandbox.title(), "ray_at_ball - probes - Plumb");
}

TEST_F(ProbeTest, ADragOnADiscMovesTheProbeAndNotTheCamera) {
    const float yaw = sandbox.view().camera.yaw;
    send(PointerEvent::Kind::move, ball);
    ASSERT_TRUE(sandbox.view().hovered_handle.has_value());
    EXPECT_EQ(*sandbox.view().hovered_handle, (ProbeHandle{0, 0}));
    send(PointerEvent::Kind::press, ball);
    // To the right by as much as half a metre at the ball.
    const glm::vec2 there(sandbox.view().camera.project({0.5f, 0, 0}, viewport));
    send(PointerEvent::Kind::move, there);
    EXPECT_NEAR(t(), 1.5, 1e-4); // the answer is updated immediately
    send(PointerEvent::Kind::release, there);
    EXPECT_EQ(sandbox.view().camera.yaw, yaw);
    EXPECT_EQ(sandbox.tools().drag(), Tools::Drag::none);

    EXPECT_TRUE(sandbox.session().probes().front().expects.empty());

    sandbox.perform(Action::restart);
    EXPECT_EQ(t(), 1);
    EXPECT_EQ(sandbox.session().probes().front().expects.size(), 1U);
}

TEST_F(ProbeTest, BesideTheDiscsTheCameraTurns) {
    const float yaw = sandbox.view().camera.yaw;
    send(PointerEvent::Kind::press, {100, 500});
    send(PointerEvent::Kind::move, {200, 500});
    send(PointerEvent::Kind::release, {200, 500});
    EXPECT_NE(sandbox.view().camera.yaw, yaw);
    EXPECT_EQ(t(), 1);
}

// The expectations hold only where the scene placed the probe.
TEST_F(ProbeTest, ASavedSceneHasTheMovedProbeAndExpectsNothingOfIt) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "moved.toml";
    sandbox.session().move_probe(0, 0, {0.25, 0, 0});
    ASSERT_TRUE(sandbox.session().save_scene(file));
    const SceneFileResult again = load_scene(file);
    ASSERT_TRUE(again.ok());
    EXPECT_EQ(again.scene.probes.front().shapes.front().position, glm::dvec3(0.25, 0, 0));
    EXPECT_TRUE(again.scene.probes.front().expects.empty());
}

TEST_F(ProbeTest, ASavedSceneTakesTheFilesOfItsMeshesAlong) {
    const TemporaryFolder temporary;
    const std::filesystem::path folder = temporary.path() / "new";
    const std::filesystem::path gears = PLUMB_SOURCE_DIR "/scenes/geometry/mesh_file.toml";
    ASSERT_TRUE(sandbox.session().open(gears));
    ASSERT_TRUE(sandbox.session().save_scene(folder / "saved.toml"));
    ASSERT_TRUE(sandbox.session().save_scene(folder / "again.toml"));
    EXPECT_TRUE(load_scene(folder / "again.toml").ok());
    // A different mesh of that name is neither overwritten nor used.
    std::ofstream(folder / "gear.obj") << "v 0 0 0\nf 1 1 1\n";
    EXPECT_FALSE(sandbox.session().save_scene(folder / "third.toml"));
    EXPECT_FALSE(std::filesystem::exists(folder / "third.toml"));
}

// Simulates a disk that is full after so many bytes.
class FullDisk {
  public:
    explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &before_);
        const struct rlimit small { bytes, before_.rlim_max };
        setrlimit(RLIMIT_FSIZE, &small);
    }
    ~FullDisk() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    FullDisk(const FullDisk &) = delete;
    FullDisk &operator=(const FullDisk &) = delete;

  private:
    struct rlimit before_ {};
    void (*handler_)(int);
};

TEST_F(ProbeTest, OnAFullDiskNoPartOfASavedSceneIsLeft) {
    const TemporaryFolder temporary;
    const std::filesystem::path folder = temporary.path() / "new";
    const auto fails = [&] {
        const FullDisk full(100);
        EXPECT_FALSE(sandbox.session().save_scene(folder / "saved.toml"));
        const std::string said = sandbox.session().messages().all().back().text;
        EXPECT_NE(said.find("File too large"), std::string::npos) << said;
        EXPECT_TRUE(std::filesystem::is_empty(folder));
    };
    fails(); // the scene itself
    ASSERT_TRUE(sandbox.session().open(PLUMB_SOURCE_DIR "/scenes/geometry/mesh_file.toml"));
    fails(); // its mesh
    EXPECT_TRUE(sandbox.session().save_scene(folder / "saved.toml"));
    EXPECT_TRUE(load_scene(folder / "saved.toml").ok());
}

TEST_F(ProbeTest, ProbesAreDrawnOverALevelFloorUnlessTheyAreFlat) {
    const DrawList list = sandbox.draw_list();
    ASSERT_EQ(list.shapes.size(), 1U);
    EXPECT_EQ(list.shapes.front().kind, DrawKind::sphere);
    EXPECT_TRUE(list.shapes.front().glass);
    EXPECT_FALSE(list.lines.empty());
    ASSERT_EQ(list.planes.size(), 1U);
    EXPECT_LE(list.planes.front().position.y, -1.0f); // under the ball

    SceneDesc flat = ray_at_ball();
    flat.probes.front().shapes.front().shape = CircleDesc{1};
    ASSERT_TRUE(sandbox.open(flat));
    EXPECT_TRUE(sandbox.draw_list().planes.empty());
    EXPECT_EQ(sandbox.draw_list().meshes.size(), 1U);
}

TEST_F(ProbeTest, WhereAPickingProbeIsThePointerPicksToo) {
    SceneDesc scene = ray_at_ball();
    ProbeDesc &probe = scene.probes.front();
    probe.question = ProbeQuestion::pick;
    probe.ray.reset();
    probe.camera = ProbeCameraDesc{};
    probe.camera->pixel = glm::dvec2(80, 50);
    ASSERT_TRUE(sandbox.open(scene));
    send(PointerEvent::Kind::move, ball);
    ASSERT_TRUE(sandbox.view().pointed_at.has_value());
    EXPECT_LT(glm::distance(sandbox.view().pointed_at->position, glm::dvec3(0, 0, 1)), 1e-4);
    send(PointerEvent::Kind::move, {5, 5});
    EXPECT_FALSE(sandbox.view().pointed_at.has_value());
}

TEST_F(ProbeTest, AllIsFramed) {
    const Around all = around(sandbox.session().answers());
    EXPECT_GT(all.radius, 1);
    EXPECT_LT(glm::length(all.centre), 3);
    sandbox.perform(Action::frame);
    EXPECT_GT(sandbox.view().camera.distance, all.radius);
}

} // namespace
} // namespace plumb

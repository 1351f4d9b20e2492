#include "app/sandbox/sandbox.h"

#include "app/render/palette.h"
#include "app/sandbox/draw/world_draw.h"
#include "tests/sandbox/fake_simulation.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <unistd.h>

#include <gtest/gtest.h>

namespace plumb {
namespace {

using namespace special_key;

Sandbox fake_sandbox() {
    Sandbox sandbox(Session({}, nullptr, make_fake()));
    sandbox.open(two_balls());
    return sandbox;
}

void press(Sandbox &sandbox, char32_t key, bool ctrl = false, bool shift = false) {
    sandbox.handle(KeyEvent{{key, ctrl, shift}, false});
}

std::uint64_t steps(const Sandbox &sandbox) {
    return sandbox.session().simulation()->step_count();
}

bool same(const Camera &a, const Camera &b) {
    return a.target == b.target && a.distance == b.distance && a.yaw == b.yaw &&
           a.pitch == b.pitch && a.fov == b.fov;
}

TEST(Sandbox, PauseStepAndStepBackByKeys) {
    Sandbox sandbox = fake_sandbox();
    EXPECT_FALSE(sandbox.clock().paused());
    sandbox.advance(50'000'000); // three steps of 1/60 s
    EXPECT_EQ(steps(sandbox), 3u);
    press(sandbox, ' ');
    sandbox.advance(1'000'000'000);
    EXPECT_EQ(steps(sandbox), 3u);
    press(sandbox, '.');
    press(sandbox, right, false, true);
    EXPECT_EQ(steps(sandbox), 9u);
    press(sandbox, left, false, true);
    press(sandbox, ',');
    EXPECT_EQ(steps(sandbox), 3u);
    press(sandbox, 'r');
    EXPECT_EQ(steps(sandbox), 0u);
    EXPECT_TRUE(sandbox.clock().paused()); // restarting keeps the pause
}

TEST(Sandbox, StepPausesARunningWorld) {
    Sandbox sandbox = fake_sandbox();
    press(sandbox, '.');
    EXPECT_TRUE(sandbox.clock().paused());
    EXPECT_EQ(steps(sandbox), 1u);
}

TEST(Sandbox, TheTitleSaysSceneStateAndStep) {
    Sandbox sandbox = fake_sandbox();
    EXPECT_EQ(sandbox.title(), "two_balls - running - step 0 - Plumb");
    press(sandbox, '.');
    EXPECT_EQ(sandbox.title(), "two_balls - paused - step 1 - Plumb");
}

TEST(Sandbox, DrawTogglesNeverMoveTheCamera) {
    Sandbox sandbox = fake_sandbox();
    sandbox.view().camera.yaw = 1.25f;
    sandbox.view().camera.distance = 17;
    const Camera before = sandbox.view().camera;
    for (const char32_t key : {U'c', U'j', U'w', U'b', U'v', U'm', tab, f1, U'p', U'.', U'r'}) {
        press(sandbox, key);
        EXPECT_TRUE(same(sandbox.view().camera, before)) << "key " << static_cast<unsigned>(key);
        EXPECT_TRUE(same(sandbox.draw_list().camera, before));
    }
    EXPECT_TRUE(sandbox.draw_list().view.wireframe);
}

TEST(Sandbox, HomeAndFrameMoveTheCamera) {
    Sandbox sandbox = fake_sandbox();
    const Camera at_home = sandbox.view().camera;
    sandbox.view().selected = 1;
    press(sandbox, 'f');
    EXPECT_EQ(sandbox.view().camera.target, glm::vec3(5, 0, 0));
    EXPECT_EQ(sandbox.view().camera.yaw, at_home.yaw);
    // The ball of radius 1 has about its own width of space on either side.
    const float high = 1 / std::tan(std::asin(1 / sandbox.view().camera.distance));
    EXPECT_NEAR(high * std::tan(at_home.fov / 2), 3, 0.3);
    press(sandbox, special_key::home);
    EXPECT_TRUE(same(sandbox.view().camera, at_home));
}

// The free part of the window stays in place: only the panels change it.
TEST(Sandbox, HomeAndFrameLookThroughWhatThePanelsLeaveFree) {
    Sandbox sandbox = fake_sandbox();
    sandbox.view().camera.look_through({1000, 800}, {200, 0}, {500, 600}, 1);
    const glm::vec2 centre = sandbox.view().camera.centre;
    const float share = sandbox.view().camera.share;
    EXPECT_NEAR(centre.x, -0.1f, 1e-6f);
    EXPECT_EQ(centre.y, 0.25f);
    EXPECT_EQ(share, 0.625f);
    sandbox.view().selected = 1;
    for (const char32_t key : {U'f', special_key::home}) {
        press(sandbox, key);
        EXPECT_EQ(sandbox.view().camera.centre, centre);
        EXPECT_EQ(sandbox.view().camera.share, share);
    }
    // The ball at the origin is seen at the centre of the free part.
    const glm::vec3 seen = sandbox.view().camera.project({0, 0, 0}, {1000, 800});
    EXPECT_NEAR(seen.x, 450, 0.01f);
    EXPECT_NEAR(seen.y, 300, 0.01f);
}

TEST(Sandbox, PanelsGrowAndShrinkBackToWhatTheyWere) {
    Sandbox sandbox = fake_sandbox();
    for (int i = 0; i < 3; ++i)
        press(sandbox, '=', true);
    EXPECT_NEAR(sandbox.view().ui_scale, 1.331f, 1e-4f);
    for (int i = 0; i < 3; ++i)
        press(sandbox, '-', true);
    EXPECT_EQ(sandbox.view().ui_scale, 1);
    EXPECT_EQ(sandbox.clock().speed(), 1); // the same keys change it without Ctrl
}

TEST(Sandbox, EscapePeelsBackAndNeverQuits) {
    Sandbox sandbox = fake_sandbox();
    sandbox.view().selected = 0;
    sandbox.view().search = "stack";
    sandbox.session().messages().error("something");
    press(sandbox, '?');
    press(sandbox, escape);
    EXPECT_FALSE(sandbox.view().help);
    EXPECT_EQ(sandbox.view().search, "stack");
    press(sandbox, escape);
    EXPECT_EQ(sandbox.view().search, "");
    EXPECT_FALSE(sandbox.session().messages().empty());
    press(sandbox, escape);
    EXPECT_TRUE(sandbox.session().messages().empty());
    EXPECT_TRUE(sandbox.view().selected.has_value());
    press(sandbox, escape);
    EXPECT_FALSE(sandbox.view().selected.has_value());
    for (int i = 0; i < 5; ++i)
        press(sandbox, escape);
    EXPECT_FALSE(sandbox.quit_requested());
    press(sandbox, 'q', true);
    EXPECT_TRUE(sandbox.quit_requested());
}

TEST(Sandbox, TypedTextIsNoShortcut) {
    Sandbox sandbox = fake_sandbox();
    press(sandbox, 'o', true);
    // From now on the search box has the keyboard, even before it is drawn.
    press(sandbox, 'p');
    press(sandbox, 'r');
    EXPECT_FALSE(sandbox.clock().paused());
    sandbox.view().focus_search = false;
    sandbox.handle(KeyEvent{{'p', false, false}, false}, true);
    EXPECT_FALSE(sandbox.clock().paused());
    sandbox.view().search = "pyr";
    sandbox.handle(KeyEvent{{escape, false, false}, false}, true);
    EXPECT_EQ(sandbox.view().search, "");
    EXPECT_TRUE(sandbox.take_keyboard_release());
    EXPECT_FALSE(sandbox.take_keyboard_release());
}

TEST(Sandbox, HeldDownOnlySomeKeysRepeat) {
    Sandbox sandbox = fake_sandbox();
    sandbox.handle(KeyEvent{{'.', false, false}, true});
    EXPECT_EQ(steps(sandbox), 1u);
    sandbox.handle(KeyEvent{{'p', false, false}, true});
    EXPECT_TRUE(sandbox.clock().paused());
    sandbox.handle(KeyEvent{{'c', false, false}, true});
    EXPECT_FALSE(sandbox.view().contacts);
}

TEST(Sandbox, AnExplosionPausesInsteadOfSteppingOn) {
    Sandbox sandbox = fake_sandbox();
    dynamic_cast<FakeSimulation &>(*sandbox.session().simulation()).diverges_at = 1;
    sandbox.advance(100'000'000);
    EXPECT_EQ(steps(sandbox), 2u);
    EXPECT_EQ(sandbox.title(), "two_balls - stopped - step 2 - Plumb");
    sandbox.advance(1'000'000'000);
    EXPECT_EQ(steps(sandbox), 2u);
}

TEST(Sandbox, ASelectionThatIsGoneIsLetGo) {
    Sandbox sandbox = fake_sandbox();
    press(sandbox, '.');
    sandbox.session().shoot({0, 0, 9}, {}, 0.5);
    sandbox.view().selected = 2;
    press(sandbox, '.');
    EXPECT_EQ(sandbox.view().selected, 2u);
    press(sandbox, ','); // back to after the shot
    press(sandbox, ','); // back to before it
    EXPECT_FALSE(sandbox.view().selected.has_value());
}

// With files: the scenes of the source tree.
class SandboxWithScenes : public testing::Test {
  protected:
    SandboxWithScenes() {
        const std::filesystem::path folder = std::filesystem::path(PLUMB_SOURCE_DIR) / "scenes";
        for (const char *name : {"free/free_fall", "joints/pendulum", "stacking/ten_box_stack"}) {
            SceneEntry entry;
            entry.path = folder / (std::string(name) + ".toml");
            entry.subject = entry.path.parent_path().filename().string();
            entry.name = entry.path.stem().string();
            scenes.push_back(entry);
        }
    }
    std::vector<SceneEntry> scenes;
};

TEST_F(SandboxWithScenes, BracketsGoThroughTheListAndAround) {
    Sandbox sandbox(Session(), scenes);
    press(sandbox, ']');
    EXPECT_EQ(sandbox.session().path(), scenes[0].path);
    press(sandbox, ']');
    press(sandbox, ']');
    EXPECT_EQ(sandbox.session().path(), scenes[2].path);
    press(sandbox, ']');
    EXPECT_EQ(sandbox.session().path(), scenes[0].path);
    press(sandbox, '[');
    EXPECT_EQ(sandbox.session().path(), scenes[2].path);
}

TEST_F(SandboxWithScenes, ReloadKeepsCameraPauseAndSelection) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(scenes[2].path));
    press(sandbox, '.');
    sandbox.view().camera.yaw = 2;
    sandbox.view().selected = 1;
    press(sandbox, 'l', true);
    EXPECT_EQ(steps(sandbox), 0u);
    EXPECT_TRUE(sandbox.clock().paused());
    EXPECT_EQ(sandbox.view().camera.yaw, 2);
    EXPECT_EQ(sandbox.view().selected, 1u);
}

TEST_F(SandboxWithScenes, AnotherSceneBringsItsCamera) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(scenes[1].path));
    sandbox.view().camera.yaw = 2;
    sandbox.view().selected = 0;
    ASSERT_TRUE(sandbox.open(scenes[2].path));
    EXPECT_TRUE(same(sandbox.view().camera, camera_of(sandbox.session().scene().camera)));
    EXPECT_FALSE(sandbox.view().selected.has_value());
}

TEST_F(SandboxWithScenes, JointsThatNothingElseShowsAreShownWhereMostBodiesHangOnThem) {
    const std::filesystem::path folder = std::filesystem::path(PLUMB_SOURCE_DIR) / "scenes";
    Sandbox sandbox{Session()};
    for (const char *name : {"joints/slider_fall", "joints/hinge_motor", "joints/welded"}) {
        ASSERT_TRUE(sandbox.open(folder / (std::string(name) + ".toml")));
        EXPECT_TRUE(sandbox.view().joints) << name;
    }
    // Rods are drawn anyway, a few joints among many bodies are not the point of the scene, and
    // probes have no joints.
    for (const char *name :
         {"joints/newtons_cradle", "showcase/wrecking_ball", "geometry/raycasts"}) {
        ASSERT_TRUE(sandbox.open(folder / (std::string(name) + ".toml")));
        EXPECT_FALSE(sandbox.view().joints) << name;
    }
    // Once hidden, they stay hidden until the next scene.
    ASSERT_TRUE(sandbox.open(folder / "joints/door.toml"));
    press(sandbox, 'j');
    press(sandbox, 'r');
    EXPECT_FALSE(sandbox.view().joints);
}

TEST(Search, FindsNamesBeforeTitlesAndTitlesBeforeFolders) {
    const std::vector<SceneEntry> scenes{{"a", "stacking", "domino_run", "Dominoes"},
                                         {"b", "stacking", "wall", "A stack of bricks"},
                                         {"c", "stacking", "ten_box_stack", "Ten boxes"},
                                         {"d", "towers", "stack_of_two", "Two boxes"}};
    EXPECT_EQ(matching(scenes, "stack"), (std::vector<std::size_t>{2, 3, 1, 0}));
    EXPECT_EQ(matching(scenes, "Stack box"), (std::vector<std::size_t>{2, 3}));
    EXPECT_EQ(matching(scenes, ""), (std::vector<std::size_t>{0, 1, 2, 3}));
}

TEST_F(SandboxWithScenes, ABadFileIsAMessageAndTheOldSceneGoesOn) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(scenes[1].path));
    EXPECT_FALSE(sandbox.open(std::filesystem::path("/no/such/file.toml")));
    EXPECT_FALSE(sandbox.session().messages().empty());
    EXPECT_EQ(sandbox.session().path(), scenes[1].path);
}

TEST_F(SandboxWithScenes, AnglesGoThroughTheMethodsThatCanRunTheScene) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(scenes[2].path));
    const std::string first(sandbox.session().simulation()->method().name);
    std::vector<std::string> seen{first};
    for (;;) {
        press(sandbox, '>');
        const std::string now(sandbox.session().simulation()->method().name);
        if (now == first)
            break;
        seen.push_back(now);
        ASSERT_LE(seen.size(), method_infos().size());
    }
    std::size_t able = 0;
    for (const MethodInfo &method : method_infos())
        able += why_not(method, sandbox.session().scene()).empty() ? 1 : 0;
    EXPECT_EQ(seen.size(), able);
    press(sandbox, '<');
    EXPECT_EQ(sandbox.session().simulation()->method().name, seen.back());
    EXPECT_TRUE(sandbox.session().messages().empty());
}

TEST_F(SandboxWithScenes, SearchFindsByEveryWordInNameFolderOrTitle) {
    scenes[0].title = "A ball falls";
    EXPECT_EQ(matching(scenes, "").size(), 3u);
    EXPECT_EQ(matching(scenes, "PEND"), std::vector<std::size_t>{1});
    EXPECT_EQ(matching(scenes, "stacking box"), std::vector<std::size_t>{2});
    EXPECT_EQ(matching(scenes, "falls"), std::vector<std::size_t>{0});
    EXPECT_TRUE(matching(scenes, "falls box").empty());
}

TEST_F(SandboxWithScenes, NewFilesOverwriteNothing) {
    const std::filesystem::path out =
        std::filesystem::temp_directory_path() / ("plumb-out-" + std::to_string(::getpid()));
    Sandbox sandbox(Session(), scenes, out);
    ASSERT_TRUE(sandbox.open(scenes[0].path));
    press(sandbox, 's', true);
    press(sandbox, 's', true);
    EXPECT_TRUE(std::filesystem::exists(out / "free_fall-0.toml"));
    EXPECT_TRUE(std::filesystem::exists(out / "free_fall-0-2.toml"));
    std::filesystem::remove_all(out);
}

// Drawn as if the pointer held it, from the first frame on.
TEST(Sandbox, ShowsWhatASavedSceneHoldsUntilEscape) {
    SceneDesc scene = two_balls();
    GrabStateDesc &grab = scene.grab.emplace();
    grab.body = "left";
    grab.target = {0, 3, 0};
    grab.max_force = 100;
    grab.frequency = 5;
    Sandbox sandbox{Session()};
    ASSERT_TRUE(sandbox.open(scene));
    sandbox.session().messages().clear();
    sandbox.view().selected = 0;
    const auto drawn = [&] {
        return std::ranges::any_of(sandbox.draw_list().lines, [](const DrawLine &line) {
            return line.colour == colours::grab && line.b == glm::vec3(0, 3, 0);
        });
    };
    EXPECT_TRUE(drawn());
    sandbox.advance(50'000'000);
    EXPECT_TRUE(drawn());
    press(sandbox, escape);
    EXPECT_FALSE(drawn());
    EXPECT_FALSE(sandbox.session().held());
    EXPECT_EQ(sandbox.view().selected, 0u);
    press(sandbox, escape);
    EXPECT_FALSE(sandbox.view().selected);
}

} // namespace
} // namespace plumb

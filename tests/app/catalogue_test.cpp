// Every scene in the catalogue with every method that can run it.
#include "tests/app/program.h"
#include "tests/trials.h"

#include "app/lab/run/check.h"
#include "engine/core/task_pool.h"
#include "engine/dynamics/method_info.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/simulation.h"

#include <algorithm>
#include <limits>
#include <map>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> scene_files() {
    std::vector<fs::path> files;
    for (const fs::directory_entry &file :
         fs::recursive_directory_iterator(fs::path(PLUMB_SOURCE_DIR) / "scenes"))
        if (file.path().extension() == ".toml")
            files.push_back(file.path());
    std::ranges::sort(files);
    return files;
}

SceneDesc loaded(const fs::path &path) {
    const SceneFileResult result = load_scene(path);
    EXPECT_TRUE(result.ok()) << path;
    return result.scene;
}

class Scene : public testing::TestWithParam<fs::path> {};

// Known failings: what a method cannot do by its nature, or only at a cost that no scene would pay.
// TGS Soft falls by semi-implicit Euler and bounces once a step, one contact at a time. Methods
// that do not look ahead use the contact planes from the start of the step for all of it. Explicit
// Euler speeds up spins, and steps short enough to avoid that are lost in float; it makes orbits
// and swings grow, and backward Euler makes orbits shrink. XPBD damps swings and spins, its
// friction is off by a few per cent, and it does not propagate impulses. AVBD damps swings most of
// all, bounces like TGS Soft, and its passes add energy to fast-moving cloth. Naive impulses never
// come to rest, and naive spin never tumbles.
//
// The number bounds the error of the expectation missed by most, in units of its tolerance: a
// quarter above the measured one. Null if the method must meet the scene.
const double *known_failing(std::string_view method, const std::string &scene) {
    static const std::map<std::string_view, std::map<std::string, double>> failing{
        {"tgs_soft",
         {{"free_fall", 52},
          {"bounce_elastic", 440},
          {"bounce_half", 5.2},
          {"bouncing", 700},
          {"elastic_666", 21},
          {"newtons_cradle", 30},
          {"passing", 3.5e6},
          {"struck_before_wall", 2},
          {"oblique_impact", 10}}},
        {"sequential_impulses",
         {{"long_chain", 210},
          {"passing", 3.5e6},
          {"struck_before_wall", 1.8},
          {"oblique_impact", 10}}},
        {"nncg", {{"passing", 3.5e6}, {"oblique_impact", 10}}},
        {"xpbd",
         {{"bouncing", 18},
          {"grasping", 2.5e4},
          {"rolling", 12},
          {"passing", 3.5e6},
          {"slope_holds", 1.7e4},
          {"slope_slides", 83},
          {"spinning_book", 120},
          {"hinge_pendulum", 44},
          {"newtons_cradle", 44},
          {"top", 210},
          {"twenty_box_stack", 440},
          {"oblique_impact", 10}}},
        {"avbd",
         {{"bounce_elastic", 490},
          {"bounce_half", 15},
          {"bouncing", 750},
          {"elastic_666", 23},
          {"passing", 3.5e6},
          {"newtons_cradle", 27},
          {"closed_loop", 11},
          {"long_chain", 18},
          {"kapla", 1100},
          {"static_stability", 3.5},
          {"door", 2.9},
          {"hinge_pendulum", 170},
          {"slider_fall", 110},
          {"flag", 200},
          {"hanging_cloth", 17},
          {"trampoline", 4.1},
          {"oblique_impact", 10}}},
        {"naive_impulses",
         {{"free_fall", 210},
          {"bounce_elastic", 410},
          {"bounce_half", 18},
          {"bouncing", 670},
          {"666", 2.3},
          {"elastic_666", 5.2},
          {"rolling", 140},
          {"kapla", 9.6e5},
          {"static_stability", 120},
          {"seams", 17},
          {"slope_holds", 1400},
          {"struck_before_wall", 450},
          {"barrel_run", 2.9},
          {"compounds", 170},
          {"dice", 9000},
          {"terrain", 2.9},
          {"mesh_terrain", std::numeric_limits<double>::infinity()}, // it does not swing at all
          {"tumbling", 4.8},
          {"pyramid", 130},
          {"ten_box_stack", 250},
          {"twenty_box_stack", 500},
          {"oblique_impact", 17},
          {"breaking", 17},
          {"door", 590},
          {"double_pendulum", 48},
          {"heavy_chain", 560},
          {"hinge_motor", 6.1},
          {"hinge_pendulum", 92},
          {"newtons_cradle", 5.2},
          {"pendulum", 66},
          {"rope", 41},
          {"slider_fall", 82},
          {"slider_motor", 1.1},
          {"soft_ball", std::numeric_limits<double>::infinity()}, // it has no second swing
          {"soft_joints", 13},
          {"spring", 48},
          {"top", 24},
          {"welded", 480},
          {"closed_loop", 59},
          {"grasping", 1400},
          {"long_chain", 110},
          {"wrecking_ball", 17}}},
        {"explicit_euler",
         {{"spinning_book", 220},
          {"kepler_orbit", 50},
          {"catenary", 2.5},
          {"spring_limit", 3e18}}}, // no spring stays bounded, at any step
        {"backward_euler", {{"kepler_orbit", 50}}},
        {"naive_spin", {{"spinning_book", 150}}}};
    const auto found = failing.find(method);
    if (found == failing.end() || !found->second.contains(scene))
        return nullptr;
    return &found->second.at(scene);
}

double worst_error(const CheckOutcome &outcome) {
    double worst = 0;
    for (const ExpectOutcome &one : outcome.run.outcomes)
        worst = std::max(worst, one.scaled_error);
    return worst;
}

// The methods that can run it. Where time is short, the largest scenes run with their own only.
std::vector<std::string_view> methods_for(const SceneDesc &scene) {
    const auto own = Simulation::create(scene, {}, nullptr);
    const Frame read = own->read();
    constexpr std::size_t large = 150;
    const bool with_own_alone =
        trials(100) < 100 && read.bodies.size() + read.particles.size() > large;
    std::vector<std::string_view> names;
    for (const MethodInfo &method : method_infos())
        if (why_not(method, scene).empty() &&
            (!with_own_alone || method.name == own->method().name))
            names.push_back(method.name);
    return names;
}

TEST_P(Scene, IsWithinItsTolerancesWithEveryMethodThatCanRunIt) {
    const SceneDesc scene = loaded(GetParam());
    const std::vector<std::string_view> methods = methods_for(scene);
    EXPECT_FALSE(methods.empty());
    for (const std::string_view method : methods) {
        RunOptions options;
        options.method = method;
        const CheckOutcome outcome = check_scene(scene, options, nullptr);
        std::ostringstream text;
        print(text, outcome);
        const double *most = known_failing(method, GetParam().stem().string());
        EXPECT_EQ(exit_code(outcome), most ? ExitCode::outside_tolerance : ExitCode::fine)
            << text.str();
        EXPECT_LE(worst_error(outcome), most ? *most : 1) << text.str();
    }
}

TEST_P(Scene, HasSomethingToHoldItTo) {
    const SceneDesc scene = loaded(GetParam());
    EXPECT_TRUE(!scene.expects.empty() ||
                std::ranges::any_of(scene.probes,
                                    [](const ProbeDesc &probe) { return !probe.expects.empty(); }));
}

// Grabs the first dynamic body or free particle, if there is one.
std::optional<Command> grab_of_first(const SceneDesc &scene) {
    for (const BodyDesc &body : scene.bodies)
        if (body.kind == BodyKind::dynamic)
            return GrabBody{
                body.name, {0.01, 0.02, 0}, body.position + glm::dvec3{0.1, 0.2, 0}, 100};
    for (const ParticleDesc &particle : scene.particles)
        if (!particle.pinned)
            return GrabParticle{particle.name, particle.position + glm::dvec3{0, 0.2, 0}, 100};
    return std::nullopt;
}

// The state, saved as a scene and loaded again, has the same hash and continues the same way,
// including the grabbed body and the time at which dt was changed.
TEST_P(Scene, GoesOnTheSameFromASavedFile) {
    const auto together = static_cast<std::uint64_t>(std::max(40, trials(100))); // steps
    const SceneDesc scene = loaded(GetParam());
    for (const std::string_view method : methods_for(scene)) {
        RunOptions options;
        options.method = method;
        const auto original = Simulation::create(scene, options, nullptr);
        struct Copy {
            std::uint64_t saved_at;
            std::unique_ptr<Simulation> simulation;
        };
        std::vector<Copy> copies;
        const std::optional<Command> grab = grab_of_first(scene);
        const auto for_all = [&](auto act) {
            act(*original);
            for (const Copy &copy : copies)
                act(*copy.simulation);
        };
        for (std::uint64_t step = 0; step <= 100 + together; ++step) {
            if (step == 20 && grab)
                for_all([&](Simulation &simulation) { simulation.apply(*grab); });
            if (step == 60) {
                GivenSettings shorter;
                shorter.give(&StepSettings::dt, original->settings().dt / 2);
                for_all([&](Simulation &simulation) { simulation.apply(SetSettings{shorter}); });
            }
            if (step == 0 || step == 1 || step == 30 || step == 100) {
                const std::string text = write_scene(original->describe());
                const SceneFileResult again = parse_scene(text, GetParam().string());
                ASSERT_TRUE(again.ok()) << format_message("saved", again.messages.front());
                copies.push_back({step, Simulation::create(again.scene, {}, nullptr)});
            }
            for (const Copy &copy : copies)
                if (step == copy.saved_at || step == copy.saved_at + together) {
                    ASSERT_EQ(copy.simulation->hash(), original->hash())
                        << method << ", saved at step " << copy.saved_at << ", at step " << step;
                    ASSERT_EQ(copy.simulation->time(), original->time());
                }
            std::erase_if(copies,
                          [&](const Copy &copy) { return step == copy.saved_at + together; });
            original->step();
            for (const Copy &copy : copies)
                copy.simulation->step();
        }
    }
}

TEST_P(Scene, IsTheSameWithTwoThreads) {
    const SceneDesc scene = loaded(GetParam());
    TaskPool two(2);
    const int steps = std::max(40, trials(100));
    for (const MethodInfo &method : method_infos()) {
        if (!why_not(method, scene).empty())
            continue;
        RunOptions options;
        options.method = method.name;
        const auto alone = Simulation::create(scene, options, nullptr);
        const auto shared = Simulation::create(scene, options, &two);
        for (int s = 0; s < steps; ++s) {
            alone->step();
            shared->step();
        }
        EXPECT_EQ(shared->hash(), alone->hash()) << method.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Scene, testing::ValuesIn(scene_files()),
                         [](const auto &each) { return each.param.stem().string(); });

} // namespace
} // namespace plumb

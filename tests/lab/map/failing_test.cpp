#include "app/lab/map/failing.h"
#include "app/lab/map/passage.h"

#include "tests/lab/run/fake_simulation.h"

#include <set>

#include <gtest/gtest.h>

namespace plumb {
namespace {

SceneDesc scene_of_a_ball() {
    SceneDesc scene;
    BodyDesc &ball = scene.bodies.emplace_back();
    ball.name = "ball";
    ball.colliders.emplace_back().shape = SphereDesc{0.5};
    return scene;
}

ExpectOutcome missed(const char *name, const char *quantity, ExpectDesc::Relation relation,
                     double value, double measured) {
    ExpectOutcome outcome;
    outcome.desc.name = name;
    outcome.desc.quantity = quantity;
    outcome.desc.relation = relation;
    outcome.desc.value = value;
    outcome.measured = measured;
    outcome.verdict = Verdict::missed;
    outcome.scaled_error = 2;
    return outcome;
}

using Is = ExpectDesc::Relation;

RunFailing with_outcome(const ExpectOutcome &outcome) {
    SceneDesc scene = scene_of_a_ball();
    scene.expects.push_back(outcome.desc);
    JudgedRun run;
    run.outcomes.push_back(outcome);
    return why_failed(scene, run, "");
}

TEST(Failing, HasARowALetterAndAColourOfItsOwn) {
    std::set<char> letters;
    std::set<unsigned> colours;
    for (const FailingInfo &info : failings()) {
        letters.insert(info.letter);
        colours.insert(info.colour);
        EXPECT_EQ(&info_of(info.failing), &info);
        EXPECT_EQ(find_failing(info.name), info.failing);
    }
    EXPECT_EQ(failings().size(), static_cast<std::size_t>(Failing::undecided) + 1);
    EXPECT_EQ(letters.size(), failings().size());
    EXPECT_EQ(colours.size(), failings().size());
    EXPECT_FALSE(find_failing("nonsense"));
}

TEST(Failing, IsTheFirstOfThose) {
    const SceneDesc scene = scene_of_a_ball();
    JudgedRun run;
    EXPECT_EQ(why_failed(scene, run, "").failing, Failing::none);
    run.end_joint_drift = 0.3;
    EXPECT_EQ(why_failed(scene, run, "").failing, Failing::drift);
    run.end_penetration = 0.3;
    EXPECT_EQ(why_failed(scene, run, "").failing, Failing::penetration);
    run.max_energy_gain = 0.2;
    EXPECT_EQ(why_failed(scene, run, "").failing, Failing::energy_grew);
    EXPECT_EQ(why_failed(scene, run, "ball through wall"),
              (RunFailing{Failing::passed_through, "ball through wall"}));
    run.divergence = Divergence{};
    run.divergence->body = "ball";
    EXPECT_EQ(why_failed(scene, run, "ball through wall"),
              (RunFailing{Failing::not_finite, "ball"}));
}

// A quarter of the ball's 1 m, a tenth of the energy.
TEST(Failing, BeginsBeyondWhatIsTolerated) {
    const SceneDesc scene = scene_of_a_ball();
    JudgedRun run;
    run.end_joint_drift = run.end_penetration = 0.249;
    run.max_penetration = run.max_joint_drift = 5; // on the way
    run.max_energy_gain = 0.099;
    EXPECT_EQ(why_failed(scene, run, "").failing, Failing::none);
}

TEST(Failing, GoesByTheQuantityThatWasMissed) {
    EXPECT_EQ(with_outcome(missed("e", "energy_error", Is::equals, 0, 1)),
              (RunFailing{Failing::energy_grew, "e"}));
    EXPECT_EQ(with_outcome(missed("e", "energy_error", Is::equals, 0, -1)),
              (RunFailing{Failing::missed, "e"}));
    EXPECT_EQ(with_outcome(missed("p", "penetration", Is::at_most, 0.1, 1)).failing,
              Failing::penetration);
    EXPECT_EQ(with_outcome(missed("d", "joint_drift", Is::at_most, 0.1, 1)).failing,
              Failing::drift);
    EXPECT_EQ(with_outcome(missed("f", "position.y", Is::at_least, 2, 1)).failing, Failing::fell);
    EXPECT_EQ(with_outcome(missed("f", "tilt", Is::at_most, 0.1, 1)).failing, Failing::fell);
    EXPECT_EQ(with_outcome(missed("h", "position.y", Is::equals, 2, 1)).failing, Failing::missed);
    EXPECT_EQ(with_outcome(missed("r", "speed", Is::at_most, 0.1, 1)).failing,
              Failing::never_rests);
    EXPECT_EQ(with_outcome(missed("r", "kinetic_energy", Is::at_most, 0.1, 1)).failing,
              Failing::never_rests);
}

// A body that should have stayed where it was, and went downwards instead.
TEST(Failing, TellsAFallFromSlidingAway) {
    const ExpectOutcome outcome = missed("stands", "displacement", Is::at_most, 0.05, 2);
    SceneDesc scene = scene_of_a_ball();
    scene.expects.push_back(outcome.desc);
    JudgedRun run;
    run.outcomes.push_back(outcome);
    for (const double drop : {-1.0, 0.0, 0.04, 0.9}) {
        run.drops = {drop};
        EXPECT_EQ(why_failed(scene, run, ""), (RunFailing{Failing::missed, "stands"})) << drop;
    }
    run.drops = {1.5};
    EXPECT_EQ(why_failed(scene, run, ""), (RunFailing{Failing::fell, "stands"}));
}

// A fall of g t^2 / 2, and one that only moves along x.
TEST(Failing, KnowsFromTheRunHowFarABodyDropped) {
    SceneDesc scene = scene_of_a_ball();
    ExpectDesc &stays = scene.expects.emplace_back();
    stays.name = "stays";
    stays.quantity = "displacement";
    stays.body = "ball";
    stays.reduce = "max";
    stays.relation = Is::at_most;
    stays.value = 0.1;
    stays.to = 1;
    for (const bool falls : {true, false}) {
        FakeSimulation simulation(1.0 / 64);
        simulation.state_at = [&](double t) {
            return BodyState{.position =
                                 falls ? glm::dvec3(0, 3 - 4.905 * t * t, 0) : glm::dvec3(t, 3, 0)};
        };
        JudgeOptions options;
        options.follow_errors = true;
        const JudgedRun run = judge_run(simulation, scene, options);
        ASSERT_EQ(run.drops.size(), 1U);
        EXPECT_NEAR(run.drops[0], falls ? 4.905 : 0, 1e-12);
        EXPECT_EQ(why_failed(scene, run, "").failing, falls ? Failing::fell : Failing::missed);
    }
}

// "drift" and "max_abs" measure how far the energy went, not which way.
TEST(Failing, TellsEnergyLostFromEnergyGained) {
    for (const char *reduce : {"drift", "max_abs"}) {
        ExpectOutcome outcome = missed("e", "energy_error", Is::at_most, 0.01, 0.2);
        outcome.desc.reduce = reduce;
        SceneDesc scene = scene_of_a_ball();
        scene.expects.push_back(outcome.desc);
        JudgedRun run;
        run.outcomes.push_back(outcome);
        run.max_energy_error = 0.2;
        run.max_energy_gain = 0.03;
        EXPECT_EQ(why_failed(scene, run, ""), (RunFailing{Failing::missed, "e"})) << reduce;
        run.max_energy_gain = 0.2;
        EXPECT_EQ(why_failed(scene, run, ""), (RunFailing{Failing::energy_grew, "e"})) << reduce;
    }
}

TEST(Failing, AsksNothingOfItsOwnWhereTheSceneDoes) {
    SceneDesc scene = scene_of_a_ball();
    scene.expects.push_back(missed("p", "penetration", Is::at_most, 2, 1).desc);
    scene.expects.push_back(missed("e", "energy", Is::at_most, 2, 1).desc);
    JudgedRun run;
    run.end_penetration = 1;
    run.max_energy_gain = 1;
    EXPECT_EQ(why_failed(scene, run, "").failing, Failing::none);
    scene.expects.clear();
    EXPECT_EQ(why_failed(scene, run, "").failing, Failing::energy_grew);
    // A spring adds its own energy, and its drift is its motion.
    scene.joints.emplace_back().frequency = 2;
    run.end_joint_drift = 1;
    EXPECT_EQ(why_failed(scene, run, "").failing, Failing::penetration);
    run.end_penetration = 0;
    EXPECT_EQ(why_failed(scene, run, "").failing, Failing::none);
}

// A ball along x, with a wall of 0.2 m about x = 0 and a floor at y = -5.
std::string passage(const std::vector<glm::dvec3> &path, const char *obstacle_shape = "wall") {
    SceneDesc scene = scene_of_a_ball();
    BodyDesc &wall = scene.bodies.emplace_back();
    wall.name = obstacle_shape;
    wall.kind = BodyKind::static_body;
    if (wall.name == "pillar")
        wall.colliders.emplace_back().shape = SphereDesc{1};
    else
        wall.colliders.emplace_back().shape = BoxDesc{{0.1, 3, 3}};
    BodyDesc &floor = scene.bodies.emplace_back();
    floor.name = "floor";
    floor.kind = BodyKind::static_body;
    floor.position = {0, -5, 0};
    floor.colliders.emplace_back().shape = PlaneDesc{};
    FakeSimulation simulation(1);
    simulation.state_at = [&](double time) {
        return BodyState{.position = path[static_cast<std::size_t>(time + 0.5)]};
    };
    PassageWatch watch(scene, simulation);
    for (std::size_t i = 1; i < path.size(); ++i) {
        simulation.step();
        watch.sample(simulation);
    }
    return watch.first();
}

TEST(PassageWatch, SeesABodyPassThroughAWallInOneStepOrInMany) {
    EXPECT_EQ(passage({{-1, 0, 0}, {1, 0, 0}}), "ball through wall");
    EXPECT_EQ(passage({{-1, 0, 0}, {-0.05, 0, 0}, {0.05, 0.3, 0}, {0.3, 0.3, 0}}),
              "ball through wall");
}

TEST(PassageWatch, LetsABodyGoBackOrAround) {
    EXPECT_EQ(passage({{-1, 0, 0}, {-0.05, 0, 0}, {-0.3, 0, 0}}), "");
    EXPECT_EQ(passage({{-1, 0, 0}, {-1, 4, 0}, {1, 4, 0}, {1, 0, 0}}), "");
    EXPECT_EQ(passage({{-1, 2.9, 0}, {0, 2.9, 0}, {0, 3.5, 0}}), ""); // pushed out over the top
    EXPECT_EQ(passage({{0, 0, 0}, {1, 0, 0}}), "");                   // starts inside
    EXPECT_EQ(passage({{-2, 0.95, 0}, {2, 0.95, 0}}, "pillar"), "");  // a graze
    EXPECT_EQ(passage({{-2, 0.2, 0}, {2, 0.2, 0}}, "pillar"), "ball through pillar");
}

TEST(PassageWatch, HoldsAPlaneForPassedOnceTheCentreIsBelow) {
    EXPECT_EQ(passage({{-9, 0, 0}, {-9, -4.9, 0}}), "");
    EXPECT_EQ(passage({{-9, 0, 0}, {-9, -5.1, 0}}), "ball through floor");
}

} // namespace
} // namespace plumb

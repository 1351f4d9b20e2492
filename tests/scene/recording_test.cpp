// A recorded run replays the same, also through a file; errors in a recording are reported.
#include "engine/scene/recording.h"

#include "engine/scene/scene_file.h"

#include <algorithm>
#include <functional>
#include <sstream>

#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr const char *scene_text = R"(title = "heap"
[world]
precision = "PRECISION"
[[material]]
name = "ice"
friction = 0.05
[[body]]
name = "ground"
shape = "plane"
[[body]]
name = "crate"
shape = "box"
half_extents = [0.5, 0.4, 0.3]
position = [0.1, 0.5, 0]
rotation_deg = [0, 20, 0]
repeat = { kind = "stack", count = 4 }
[[body]]
name = "club"
shapes = [
    { shape = "sphere", radius = 0.3, position = [0, 1, 0] },
    { shape = "box", half_extents = [0.1, 1, 0.1] },
]
position = [2, 3, 0]
[[body]]
name = "bob"
shape = "sphere"
radius = 0.2
position = [3, 3, 0]
[[particle]]
name = "mote"
position = [6, 2, 0]
[[joint]]
name = "string"
type = "ball"
body_b = "bob"
anchor = [3, 4, 0]
)";

SceneDesc scene(const std::string &precision = "float") {
    std::string text = scene_text;
    text.replace(text.find("PRECISION"), 9, precision);
    const SceneFileResult result = parse_scene(text, "heap.toml");
    EXPECT_TRUE(result.ok()) << format_message("heap.toml", result.messages.front());
    return result.scene;
}

JointDesc rod(const char *name) {
    JointDesc joint;
    joint.name = name;
    joint.type = JointType::distance;
    joint.body_a = "crate_3";
    joint.body_b = "ball";
    joint.anchor_a_local = {0, 0.4, 1.0 / 3};
    joint.min_length = 0.5;
    joint.max_length = 6;
    return joint;
}

BodyDesc shot(const char *name) {
    BodyDesc body;
    body.name = name;
    body.colliders.emplace_back().shape = SphereDesc{0.17};
    body.material = "ice";
    body.position = {-3, 1.1, 0.05};
    body.velocity = {11, 0.3, 0};
    body.colour = glm::vec3(0.2f, 0.4f, 0.6f);
    return body;
}

// Every kind of command, with the step it precedes.
std::vector<std::pair<std::uint64_t, Command>> commands() {
    GivenSettings settings;
    settings.give(&StepSettings::substeps, 3);
    settings.give(&StepSettings::gravity, glm::dvec3(0.1, -3, 1.0 / 3));
    const glm::dquat turned = glm::normalize(glm::dquat(1, 0.3, -0.2, 0.1));
    return {
        {0, ApplyImpulse{"crate_3", {30, 0.1, 1.0 / 3}, {0, 3, 0}}},
        {5, AddBody{shot("ball")}},
        {9, GrabBody{"club", {0, 1, 0.1}, {2, 4, 1}, 5e5, {1.0 / 3, 0.25}}},
        {12, MoveGrab{{2.5, 4, 1.0 / 7}}},
        {15, RemoveBody{"crate_0"}},
        {15, AddBody{shot("crate_0")}}, // into the hole, with the name that is now free
        {20, ReleaseGrab{}},
        {22, SetMotion{"bob", {3, 3, 0.2}, turned, {0, 0, 1}, {0.1, 0.2, 0.3}}},
        {25, SetMethod{"sequential_impulses"}},
        {25, SetSettings{settings}},
        {30, RemoveBody{"bob"}},    // and its joint
        {31, AddJoint{rod("rod")}}, // into its hole
        {32, GrabParticle{"mote", {6, 3, 1.0 / 3}, 50, {7, 0.5}}},
        {36, RemoveJoint{"rod"}},
        {40, ApplyImpulse{"ball", {0, 0.5, 0}, {0, 0, 0}}},
    };
}

Recording recorded(const SceneDesc &of, std::uint64_t steps = 40) {
    const auto simulation = Simulation::create(of, {}, nullptr);
    Recorder recorder(*simulation);
    const auto all = commands();
    for (std::uint64_t step = 0;; ++step) {
        for (const auto &[at, command] : all)
            if (at == step) {
                simulation->apply(command);
                recorder.add(*simulation, command);
            }
        if (step == steps)
            return recorder.recording(*simulation);
        recorder.before_step(*simulation);
        simulation->step();
    }
}

// The first step that differs, if any.
std::optional<std::uint64_t> first_difference(const Recording &recording) {
    const auto simulation = Simulation::create(recording.scene, {}, nullptr);
    Replay replay(recording);
    for (;; simulation->step()) {
        if (!replay.obey(*simulation))
            return simulation->step_count();
        if (replay.is_at_end(*simulation))
            return std::nullopt;
    }
}

Recording parsed(const std::string &text) {
    const RecordingResult result = parse_recording(text, "heap.toml");
    for (const SceneMessage &message : result.messages)
        ADD_FAILURE() << format_message("heap.toml", message);
    return result.recording;
}

TEST(Recording, EveryKindOfCommandIsTried) {
    std::vector<bool> tried(std::variant_size_v<Command>);
    for (const auto &[step, command] : commands())
        tried[command.index()] = true;
    EXPECT_EQ(std::ranges::count(tried, false), 0);
}

TEST(Recording, ComesOutTheSameThroughAFile) {
    for (const char *precision : {"float", "double"}) {
        const Recording first = recorded(scene(precision));
        ASSERT_EQ(first.hashes.size(), 41U);
        EXPECT_EQ(first.commands.size(), commands().size());
        EXPECT_EQ(first_difference(first), std::nullopt);
        const std::string text = write_recording(first);
        const Recording read = parsed(text);
        EXPECT_EQ(read.hashes, first.hashes);
        EXPECT_EQ(first_difference(read), std::nullopt) << precision;
        EXPECT_EQ(write_recording(read), text);
    }
}

// Leaving out any one command changes the run from that command's step on.
TEST(Recording, ALeftOutCommandIsFoundAtItsStep) {
    const Recording whole = recorded(scene());
    for (std::size_t i = 0; i < whole.commands.size(); ++i) {
        if (i == 5 || i == 6) // it removes or lets go of what the next one needs, or nothing
            continue;
        Recording less = whole;
        const std::uint64_t step = less.commands[i].step;
        less.commands.erase(less.commands.begin() + static_cast<std::ptrdiff_t>(i));
        try {
            EXPECT_EQ(first_difference(less), step) << i;
        } catch (const CommandFailure &) { // a body is missing, or exists already
        }
    }
}

TEST(Recording, AChangedHashIsFoundAtItsStep) {
    Recording recording = recorded(scene());
    recording.hashes[17] ^= 1;
    EXPECT_EQ(first_difference(recording), 17U);
}

TEST(Recording, WhatIsSteppedBackOverIsForgotten) {
    const auto simulation = Simulation::create(scene(), {}, nullptr);
    Recorder recorder(*simulation);
    const auto obey = [&](const Command &command) {
        simulation->apply(command);
        recorder.add(*simulation, command);
    };
    std::unique_ptr<Simulation::Saved> saved;
    for (int step = 0; step < 20; ++step) {
        if (step == 3)
            obey(ApplyImpulse{"crate_3", {30, 0, 0}, {0, 3, 0}});
        if (step == 7)
            obey(AddBody{shot("ball")});
        if (step == 7)
            saved = simulation->save();
        if (step == 12)
            obey(RemoveBody{"ball"});
        recorder.before_step(*simulation);
        simulation->step();
    }
    simulation->restore(*saved);
    recorder.went_back(*simulation);
    obey(SetMotion{"bob", {3, 3, 0.2}, {1, 0, 0, 0}, {0, 0, 1}, {}});
    recorder.before_step(*simulation);
    simulation->step();
    const Recording recording = recorder.recording(*simulation);
    EXPECT_EQ(recording.last_step(), 8U);
    EXPECT_EQ(recording.commands.size(), 3U);
    EXPECT_EQ(recording.hashes.back(), simulation->hash());
    EXPECT_EQ(first_difference(recording), std::nullopt);
}

// A recording can start where a saved scene continues.
TEST(Recording, CountsItsStepsFromItsScene) {
    const auto simulation = Simulation::create(scene(), {}, nullptr);
    for (int i = 0; i < 10; ++i)
        simulation->step();
    const Recording recording = recorded(simulation->describe(), 0);
    EXPECT_EQ(recording.first_step(), 10U);
    EXPECT_EQ(recording.last_step(), 10U);
    EXPECT_EQ(first_difference(parsed(write_recording(recording))), std::nullopt);
}

// A recording that starts in mid-run knows the holes that removed bodies left: new bodies fill them
// and get the same place in the solver's order.
TEST(Recording, StartsAfterBodiesWereRemoved) {
    for (const char *precision : {"float", "double"}) {
        SceneDesc heap = scene(precision);
        heap.bodies.push_back(shot("removed_2")); // a name the recording would like to use
        heap.bodies.back().position.y = 9;
        const auto simulation = Simulation::create(heap, {}, nullptr);
        const auto step = [&](int count) {
            for (int i = 0; i < count; ++i)
                simulation->step();
        };
        step(20);
        simulation->apply(RemoveBody{"crate_3"});
        simulation->apply(RemoveBody{"crate_1"});
        step(5);
        simulation->apply(RemoveBody{"bob"});
        simulation->apply(AddBody{shot("bob")});
        step(5);
        simulation->apply(RemoveBody{"club"});
        Recorder recorder(*simulation);
        const auto obey = [&](const Command &command) {
            simulation->apply(command);
            recorder.add(*simulation, command);
        };
        for (int i = 0; i < 30; ++i) {
            if (i % 5 == 2) {
                BodyDesc ball = shot(("ball_" + std::to_string(i)).c_str());
                ball.position = {0.1 * i - 1, 0.6, 0.1};
                ball.velocity = {0, 0, 0};
                obey(AddBody{ball});
            }
            if (i == 14) {
                obey(RemoveBody{"ball_7"});
                obey(RemoveBody{"ball_2"});
            }
            recorder.before_step(*simulation);
            simulation->step();
        }
        const Recording recording = recorder.recording(*simulation);
        EXPECT_EQ(recording.first_step(), 30U);
        EXPECT_EQ(first_difference(recording), std::nullopt) << precision;
        const Recording read = parsed(write_recording(recording));
        EXPECT_EQ(first_difference(read), std::nullopt) << precision;
        EXPECT_EQ(read.hashes.back(), simulation->hash());
    }
}

// The same of joints, also where all bodies are still there, some of them asleep.
TEST(Recording, StartsAfterJointsWereRemoved) {
    SceneDesc heap = scene();
    const auto hung = [&](const char *name, double x) {
        JointDesc joint;
        joint.name = name;
        joint.body_b = "club";
        joint.anchor_a_local = heap.bodies[5].position + glm::dvec3(x, 2, 0);
        joint.anchor_b_local = {x, 2, 0};
        return joint;
    };
    ASSERT_EQ(heap.bodies[5].name, "club");
    for (const auto &[name, x] : {std::pair("left", -0.1), {"middle", 0.0}, {"right", 0.1}})
        heap.joints.push_back(hung(name, x));
    const auto simulation = Simulation::create(heap, {}, nullptr);
    const auto step = [&](int count) {
        for (int i = 0; i < count; ++i)
            simulation->step();
    };
    step(60);
    for (const char *name : {"right", "left", "string"})
        simulation->apply(RemoveJoint{name});
    EXPECT_THROW(simulation->apply(RemoveJoint{"left"}), std::invalid_argument);
    EXPECT_THROW(simulation->apply(AddJoint{hung("middle", 0)}), std::invalid_argument);
    step(60);
    Recorder recorder(*simulation);
    const auto obey = [&](const Command &command) {
        simulation->apply(command);
        recorder.add(*simulation, command);
    };
    obey(AddBody{shot("ball")});
    for (int i = 0; i < 20; ++i) {
        if (i == 5)
            for (const auto &[name, x] : {std::pair("third", 0.3), {"left", -0.1}})
                obey(AddJoint{hung(name, x)});
        recorder.before_step(*simulation);
        simulation->step();
    }
    EXPECT_TRUE(simulation->find_joint("left"));
    EXPECT_EQ(simulation->find_joint("third"), 0U); // in the hole of "string"
    const Recording recording = recorder.recording(*simulation);
    EXPECT_EQ(first_difference(recording), std::nullopt);
    EXPECT_EQ(first_difference(parsed(write_recording(recording))), std::nullopt);
}

// What its type does not read makes no difference, and is not in a file.
TEST(Recording, HasOfAJointOnlyWhatItsTypeReads) {
    JointDesc joint;
    joint.name = "added";
    joint.body_b = "club";
    JointDesc more = joint;
    more.max_length = 2;
    more.limits = {-1, 1};
    more.motor_speed = 3;
    more.frame_b_local = {0, 1, 0, 0};
    const auto plain = Simulation::create(scene(), {}, nullptr);
    const auto with_more = Simulation::create(scene(), {}, nullptr);
    Recorder recorder(*with_more);
    plain->apply(AddJoint{joint});
    with_more->apply(AddJoint{more});
    recorder.add(*with_more, AddJoint{more});
    EXPECT_EQ(plain->hash(), with_more->hash());
    EXPECT_EQ(first_difference(parsed(write_recording(recorder.recording(*with_more)))),
              std::nullopt);
}

// Also while a method without contacts steps the remaining bodies.
TEST(Recording, StartsAfterBodiesWereRemovedWhereNothingCollides) {
    SceneDesc heap = scene();
    heap.particles.clear();
    const auto simulation = Simulation::create(heap, {}, nullptr);
    for (int i = 0; i < 10; ++i)
        simulation->step();
    for (const BodyDesc &body : heap.bodies)
        if (body.name != "bob" && body.name != "club")
            simulation->apply(RemoveBody{body.name});
    simulation->apply(RemoveBody{"bob"});
    simulation->apply(SetMethod{"rk4"});
    simulation->step();
    Recorder recorder(*simulation);
    const auto obey = [&](const Command &command) {
        simulation->apply(command);
        recorder.add(*simulation, command);
    };
    for (int i = 0; i < 20; ++i) {
        if (i == 5) {
            obey(SetMethod{"soft_step"});
            BodyDesc ball = shot("ball");
            ball.position = {1, 3, 0};
            obey(AddBody{ball});
        }
        recorder.before_step(*simulation);
        simulation->step();
    }
    const Recording recording = recorder.recording(*simulation);
    EXPECT_EQ(first_difference(recording), std::nullopt);
    EXPECT_EQ(first_difference(parsed(write_recording(recording))), std::nullopt);
}

TEST(Recording, MistakesAreNamedAtTheirPlace) {
    const std::string text = write_recording(recorded(scene()));
    struct Mistake {
        const char *from, *to, *said;
    };
    for (const Mistake &mistake : std::initializer_list<Mistake>{
             {"do = \"grab\"", "do = \"grib\"", "did you mean \"grab\"?"},
             {"max_force = ", "max_farce = ", "max_farce"},
             {"body = \"club\"\npoint", "body = 3\npoint", "body is a number"},
             {"point = [0, 1, 0.1]", "point = [0, 1]", "point has 2 elements"},
             {"step = 9\n", "step = 90\n", "there is no step 90"},
             {"step = 9\n", "step = 4\n", "there is no step 4"},
             {"do = \"release\"", "do = \"release\"\nbody = \"club\"", "body"},
             {"substeps = 3", "substeps = 0", "substeps"},
             {"radius = 0.17", "radius = -1", "radius"},
             {"material = \"ice\"", "material = \"rice\"", "did you mean \"ice\"?"},
             {"[recording]\n", "[recording]\nspeed = 1\n", "speed"},
             {"hashes = [\n", "hashes = [\n\"12345\",\n", "16 hexadecimal digits"},
             {"hashes = [\n", "hashes = [\n\"12345678901234xy\",\n", "16 hexadecimal digits"},
             {"hashes = [\n", "hashes = [\n17,\n", "16 hexadecimal digits"},
             {"\nbody = \"ball\"\n", "\n", "body"},
             {"max_length = 6", "max_length = -6", "max_length"},
             {"max_length = 6", "damping_ratio = 1", "needs a length"},
             {"anchor_a_local = [0, 0.4", "anchor_a = [0, 0.4", "takes no anchor_a"},
             {"joint = \"rod\"", "joint = 3", "joint is a number"},
         }) {
        std::string wrong = text;
        const std::size_t at = wrong.find(mistake.from);
        ASSERT_NE(at, std::string::npos) << mistake.from;
        wrong.replace(at, std::string_view(mistake.from).size(), mistake.to);
        const RecordingResult result = parse_recording(wrong, "heap.toml");
        EXPECT_FALSE(result.ok()) << mistake.to;
        const auto line_of = [&](std::size_t place) {
            return std::ranges::count(wrong.substr(0, place), '\n') + 1;
        };
        bool found = false;
        for (const SceneMessage &message : result.messages) {
            found = found ||
                    (message.what + message.suggestion).find(mistake.said) != std::string::npos;
            // At the change, or at its table.
            EXPECT_LE(std::abs(static_cast<double>(message.line) - double(line_of(at))), 6)
                << format_message("heap.toml", message);
            EXPECT_GE(message.column, 1U);
        }
        EXPECT_TRUE(found) << mistake.to << ": "
                           << format_message("heap.toml", result.messages.front());
    }
}

TEST(Recording, ASceneIsNone) {
    const RecordingResult result = parse_recording(write_scene(scene()), "heap.toml");
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.messages.front().what.find("no [recording]"), std::string::npos);
    EXPECT_FALSE(load_recording("no such file").ok());
    EXPECT_FALSE(parse_recording("]", "heap.toml").ok());
}

// The values that a file gives for a grab's spring are kept; the others get their defaults.
TEST(Recording, AGrabHasTheSpringThatIsGiven) {
    const std::string text = write_recording(recorded(scene()));
    const RecordingResult read = parse_recording(text, "heap.toml");
    ASSERT_TRUE(read.ok()) << format_message("heap.toml", read.messages.front());
    int grabs = 0;
    for (const RecordedCommand &command : read.recording.commands) {
        if (const auto *body = std::get_if<GrabBody>(&command.command)) {
            EXPECT_EQ(body->spring.frequency, 1.0 / 3);
            EXPECT_EQ(body->spring.damping_ratio, 0.25);
            ++grabs;
        }
        if (const auto *particle = std::get_if<GrabParticle>(&command.command)) {
            EXPECT_EQ(particle->spring.frequency, 7);
            EXPECT_EQ(particle->spring.damping_ratio, 0.5);
            ++grabs;
        }
    }
    EXPECT_EQ(grabs, 2);

    std::string silent;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (line != "damping_ratio = 0.25" && line != "frequency = 7")
            silent += line + '\n';
    const RecordingResult rest = parse_recording(silent, "heap.toml");
    ASSERT_TRUE(rest.ok()) << format_message("heap.toml", rest.messages.front());
    for (const RecordedCommand &command : rest.recording.commands) {
        if (const auto *body = std::get_if<GrabBody>(&command.command)) {
            EXPECT_EQ(body->spring.damping_ratio, 1);
        }
        if (const auto *particle = std::get_if<GrabParticle>(&command.command)) {
            EXPECT_EQ(particle->spring.frequency, 5);
        }
    }
}

// A command that cannot be obeyed, or that no file could give back, changes nothing and reports
// why.
TEST(Commands, ThatCannotBeObeyedChangeNothing) {
    const auto simulation = Simulation::create(scene(), {}, nullptr);
    for (int i = 0; i < 3; ++i)
        simulation->step();
    const std::uint64_t before = simulation->hash();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    GivenSettings settings;
    settings.give(&StepSettings::dt, -1);
    const auto but = [](auto &&change) {
        BodyDesc body = shot("bad");
        change(body);
        return AddBody{body};
    };
    JointDesc nameless = rod("");
    nameless.body_b = "bob";
    for (const Command &command : std::initializer_list<Command>{
             but([&](BodyDesc &body) { body.velocity.x = nan; }),
             but([](BodyDesc &body) { body.velocity.x = 1e30; }),
             but([](BodyDesc &body) { body.position.y = 1e12; }),
             but([](BodyDesc &body) {
                 body.orientation = {2, 0, 0, 0};
             }),
             but([](BodyDesc &body) {
                 body.orientation = {0, 0, 0, 0};
             }),
             but([](BodyDesc &body) { body.material = "snow"; }),
             but([](BodyDesc &body) { body.colliders.front().material = "snow"; }),
             but([](BodyDesc &body) { body.colliders.front().shape = HullDesc{}; }),
             but([](BodyDesc &body) { body.colliders.front().shape = MeshDesc{}; }),
             but([](BodyDesc &body) { body.colliders.front().shape = HeightFieldDesc{}; }),
             but([](BodyDesc &body) { body.name = ""; }),
             but([](BodyDesc &body) { body.name = "world"; }),
             but([](BodyDesc &body) { body.mass = body.density = 1; }),
             but([](BodyDesc &body) { body.mass = 1e20; }),
             but([](BodyDesc &body) { body.kind = BodyKind::static_body; }), // it moves
             AddJoint{nameless},
             SetMotion{"bob", {1e12, 0, 0}, {1, 0, 0, 0}, {}, {}},
             SetMotion{"bob", {}, {2, 0, 0, 0}, {}, {}},
             AddBody{shot("bob")},
             RemoveBody{"bell"},
             SetMotion{"bob", {nan, 0, 0}, {1, 0, 0, 0}, {}, {}},
             SetMotion{"bell", {}, {1, 0, 0, 0}, {}, {}},
             ApplyImpulse{"bob", {nan, 0, 0}, {}},
             GrabBody{"bob", {}, {}, -1},
             GrabBody{"bob", {}, {}, 1, {0, 1}},
             GrabBody{"bob", {}, {}, 1, {5, nan}},
             GrabBody{"bob", {nan, 0, 0}, {}, 1},
             MoveGrab{{0, nan, 0}},
             SetMethod{"rk4"},
             SetMethod{"soft_stop"},
             SetSettings{settings}}) {
        EXPECT_THROW(simulation->apply(command), std::invalid_argument) << command.index();
        EXPECT_EQ(simulation->hash(), before) << command.index();
    }
}

} // namespace
} // namespace plumb

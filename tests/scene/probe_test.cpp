// Probes: the file format, the handles, and the answers of trees and frustums against brute force.
// The geometric functions have their own tests; that probes call them correctly is checked by the
// expects of scenes/geometry, in the catalogue tests.
#include "engine/scene/probe.h"

#include "engine/scene/scene_file.h"
#include "engine/scene/simulation.h"
#include "tests/temporary_folder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

namespace fs = std::filesystem;

std::vector<SceneDesc> geometry_scenes() {
    std::vector<fs::path> files;
    for (const fs::directory_entry &file :
         fs::directory_iterator(fs::path(PLUMB_SOURCE_DIR) / "scenes/geometry"))
        if (file.path().extension() == ".toml")
            files.push_back(file.path());
    std::ranges::sort(files);
    std::vector<SceneDesc> scenes;
    for (const fs::path &file : files) {
        const SceneFileResult result = load_scene(file);
        for (const SceneMessage &message : result.messages)
            ADD_FAILURE() << format_message(file.string(), message);
        scenes.push_back(result.scene);
    }
    return scenes;
}

const std::string beside_the_scenes = PLUMB_SOURCE_DIR "/scenes/geometry/probes.toml";

SceneDesc parsed(const std::string &text) {
    const SceneFileResult result = parse_scene(text, beside_the_scenes);
    for (const SceneMessage &message : result.messages)
        ADD_FAILURE() << format_message("probes.toml", message);
    return result.scene;
}

// All messages, one per line.
std::string said(const std::string &text) {
    std::string all;
    for (const SceneMessage &message : parse_scene(text, "p.toml").messages)
        all += format_message("p.toml", message) + "\n";
    return all;
}

bool has(const std::string &text, const std::string &part) {
    return text.find(part) != std::string::npos;
}

constexpr const char *ray_and_sphere = R"([[probe]]
name = "ray"
ask = "raycast"
ray = { origin = [-3, 0, 0], direction = [2, 0, 0] }
shapes = [{ shape = "sphere", position = [0, 0, 0], radius = 1 }]
)";

// ---- answers ----

TEST(Probe, ARayThroughASphereIsAnsweredInBothPrecisions) {
    const SceneDesc scene = parsed(ray_and_sphere);
    for (const Precision precision : {Precision::f32, Precision::f64}) {
        const ProbeAnswer found = answer(scene.probes.front(), precision);
        EXPECT_TRUE(found.refusal.empty());
        EXPECT_EQ(found.value("hit"), 1);
        EXPECT_EQ(found.value("t"), 1); // (3 - 1) / 2
        EXPECT_EQ(found.value("t_exit"), 2);
        EXPECT_EQ(found.value("normal_x"), -1);
        EXPECT_TRUE(std::isnan(found.value("nothing of that name")));
    }
}

TEST(Probe, WhatIsAnsweredIsListed) {
    std::set<ProbeQuestion> asked;
    for (const SceneDesc &scene : geometry_scenes())
        for (const ProbeDesc &probe : scene.probes) {
            const ProbeQuestionInfo &info = probe_question(probe.question);
            EXPECT_EQ(info.question, probe.question);
            asked.insert(probe.question);
            const ProbeAnswer found = answer(probe, Precision::f32);
            EXPECT_EQ(found.refusal, "") << scene.name << ": " << probe.name;
            std::set<std::string_view> names;
            for (const ProbeValue &value : found.values) {
                EXPECT_TRUE(names.insert(value.name).second) << probe.name << " " << value.name;
                EXPECT_NE(std::ranges::find(info.values, value.name), info.values.end())
                    << info.name << " has no value " << value.name;
            }
        }
    EXPECT_EQ(asked.size(), probe_questions().size()) << "a question that no scene shows";
}

TEST(Probe, TheSameQuestionGivesTheSameBits) {
    for (const SceneDesc &scene : geometry_scenes())
        for (const Precision precision : {Precision::f32, Precision::f64})
            EXPECT_EQ(hash_of_answers(scene.probes, precision),
                      hash_of_answers(scene.probes, precision))
                << scene.name;
}

// A tree's items as drawn, each with its verdict, checked without a tree.
TEST(Probe, AnOctreeFindsWhatLookingAtEachFinds) {
    const SceneDesc scene = parsed(R"([[probe]]
name = "tree"
ask = "tree"
tree = "octree"
scatter = { count = 300, half_extents = [4, 3, 2], size = 0.3, seed = 9 }
shapes = [{ shape = "sphere", position = [0.5, 0.25, 0], radius = 1.5 }]
)");
    const ProbeAnswer found = answer(scene.probes.front(), Precision::f64);
    const glm::dvec3 center(0.5, 0.25, 0);
    std::size_t items = 0;
    std::size_t touched = 0;
    for (const ProbeSolid &solid : found.solids) {
        if (solid.tone == ProbeTone::query)
            continue; // the ball itself
        ++items;
        const glm::dvec3 half = std::get<BoxDesc>(solid.shape).half_extents;
        const glm::dvec3 near = glm::clamp(center, solid.position - half, solid.position + half);
        const bool touches = glm::distance(near, center) <= 1.5;
        touched += touches ? 1 : 0;
        EXPECT_EQ(solid.tone == ProbeTone::yes, touches);
    }
    EXPECT_EQ(items, 300U);
    EXPECT_EQ(found.value("found"), static_cast<double>(touched));
    EXPECT_GT(touched, 5U);
}

// Checked without a matrix, by the angles at which the eye sees a box's corners.
TEST(Probe, CullingKeepsEachBoxWithACornerInTheView) {
    const SceneDesc scene = parsed(R"([[probe]]
name = "culling"
ask = "cull"
camera = { eye = [0, 0, 8], target = [0, 0, 0], fov_deg = 60, aspect = 1, near = 1, far = 11 }
scatter = { count = 500, half_extents = [6, 6, 6], size = 0.3, seed = 4 }
)");
    const ProbeAnswer found = answer(scene.probes.front(), Precision::f64);
    const double slope = std::tan(0.5 * 60 * 3.14159265358979323846 / 180);
    std::size_t inside = 0;
    for (const ProbeSolid &solid : found.solids) {
        int corners_in = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 half = std::get<BoxDesc>(solid.shape).half_extents;
            glm::dvec3 at = solid.position;
            for (int axis = 0; axis < 3; ++axis)
                at[axis] += ((corner >> axis & 1) != 0 ? 1 : -1) * half[axis];
            const double depth = 8 - at.z;
            if (depth > 1 && depth < 11 && std::abs(at.x) < slope * depth &&
                std::abs(at.y) < slope * depth)
                ++corners_in;
        }
        if (corners_in > 0) {
            EXPECT_NE(solid.tone, ProbeTone::no);
        }
        EXPECT_EQ(solid.tone == ProbeTone::yes, corners_in == 8);
        inside += corners_in > 0 ? 1 : 0;
    }
    EXPECT_GE(found.value("seen"), static_cast<double>(inside));
    EXPECT_EQ(found.value("seen") + found.value("culled"), 500);
    EXPECT_GT(inside, 50U);
}

// A matrix for which all formulas give integers.
TEST(Probe, AMatrixIsTakenApart) {
    const SceneDesc scene = parsed(R"([[probe]]
name = "matrix"
ask = "matrix"
points = [[1, 1, 1], [2, 1, 6], [3, 2, 7], [4, 5, 1]]
)"); // rows 1 2 3, 0 1 4, 5 6 0
    const std::vector<double> minors{-24, -20, -5, -18, -15, -4, 5, 4, 1};
    const std::vector<double> inverse{-24, 18, 5, 20, -15, -4, -5, 4, 1}; // as the determinant is 1
    for (const Precision precision : {Precision::f32, Precision::f64}) {
        const ProbeAnswer found = answer(scene.probes.front(), precision);
        EXPECT_EQ(found.value("determinant"), 1);
        EXPECT_EQ(found.value("invertible"), 1);
        for (std::size_t i = 0; i < 9; ++i) {
            const std::string at =
                "_" + std::to_string(i / 3 + 1) + std::to_string(i % 3 + 1); // row, column
            const std::string turned = "_" + std::to_string(i % 3 + 1) + std::to_string(i / 3 + 1);
            const double sign = i % 2 == 0 ? 1 : -1;
            EXPECT_EQ(found.value("minor" + at), minors[i]);
            EXPECT_EQ(found.value("cofactor" + at), sign * minors[i]);
            EXPECT_EQ(found.value("adjugate" + turned), sign * minors[i]);
            EXPECT_NEAR(found.value("inverse" + at), inverse[i], 2e-3); // the documented bound
        }
    }
}

TEST(Probe, ASingularMatrixIsSaidToBeOne) {
    const SceneDesc scene = parsed(R"([[probe]]
name = "matrix"
ask = "matrix"
points = [[0, 0, 0], [1, 2, 3], [4, 5, 6], [5, 7, 9]]
)");
    const ProbeAnswer found = answer(scene.probes.front(), Precision::f32);
    EXPECT_EQ(found.refusal, "");
    EXPECT_EQ(found.value("invertible"), 0);
    EXPECT_EQ(found.value("minor_11"), 3); // 5 x 9 - 7 x 6 with rows 1 4 5, 2 5 7, 3 6 9
    EXPECT_TRUE(std::isnan(found.value("inverse_11")));
    EXPECT_TRUE(std::ranges::any_of(found.labels, [](const ProbeLabel &label) {
        return label.text == "singular: no inverse";
    }));
}

// The numbers of a file are scaled, turned, and moved.
TEST(Probe, AMeshFromAFileStandsWhereItIsPut) {
    const SceneDesc scene = parsed(R"([[probe]]
name = "ray"
ask = "raycast"
ray = { origin = [20, 0, 0.5], direction = [-1, 0, 0] }
shapes = [{ shape = "mesh", file = "gear.obj", position = [3, 0, 0], scale = 4, axis = [0, 1, 0], angle_deg = 90 }]
)");
    const ProbeDesc &probe = scene.probes.front();
    EXPECT_EQ(std::get<MeshDesc>(probe.shapes.front().shape).data->vertices.size(), 96U);
    const ProbeAnswer found = answer(probe, Precision::f64);
    EXPECT_NEAR(found.value("x"), 4, 1e-9); // 0.25 thick on either side
    EXPECT_NEAR(found.value("normal_x"), 1, 1e-9);
}

// A compound gives the same answer as its parts one by one.
TEST(Probe, ACompoundHoldsWhatItsPartsHold) {
    const std::string parts = R"({ shape = "circle", position = [1, 0], radius = 0.5 },
{ shape = "rectangle", position = [-1, 0.25], half_extents = [0.75, 0.5] },
{ shape = "oriented_rectangle", position = [0, -1], half_extents = [0.75, 0.25], angle_deg = 45 })";
    std::string points;
    for (int x = -16; x <= 16; ++x)
        for (int y = -16; y <= 16; ++y)
            points += "[" + std::to_string(x / 8.0) + ", " + std::to_string(y / 8.0) + "], ";
    const auto inside = [&](const std::string &shapes) {
        return answer(parsed("[[probe]]\nname = \"a\"\nask = \"contains\"\nshapes = [" + shapes +
                             "]\npoints = [" + points + "]\n")
                          .probes.front(),
                      Precision::f64)
            .value("inside");
    };
    const double apart = inside(parts);
    EXPECT_GT(apart, 100);
    EXPECT_EQ(inside(R"({ shape = "compound", position = [0, 0], parts = [)" + parts + "] }"),
              apart);
}

TEST(Probe, WhatTheGeometryRefusesIsSaidAndNotThrown) {
    SceneDesc scene = parsed(ray_and_sphere);
    scene.probes.front().ray->direction = glm::dvec3(0);
    const ProbeAnswer found = answer(scene.probes.front(), Precision::f32);
    EXPECT_NE(found.refusal, "");
    EXPECT_EQ(found.refusal.find(".cpp"), std::string::npos) << found.refusal;
    EXPECT_TRUE(found.values.empty());
}

// ---- files ----

TEST(ProbeFile, WritesWhatReadsTheSame) {
    for (const SceneDesc &scene : geometry_scenes()) {
        const std::string text = write_scene(scene);
        const SceneDesc again = parsed(text);
        ASSERT_EQ(again.probes.size(), scene.probes.size()) << text;
        EXPECT_EQ(write_scene(again), text) << scene.name;
        for (const Precision precision : {Precision::f32, Precision::f64})
            EXPECT_EQ(hash_of_answers(again.probes, precision),
                      hash_of_answers(scene.probes, precision))
                << scene.name;
    }
}

TEST(ProbeFile, SaysAllThatIsWrongAtOnce) {
    const std::string all = said(R"([[probe]]
name = "a"
ask = "raycst"

[[probe]]
name = "b"
ask = "raycast"
shapes = [{ shape = "spere", radius = 1 }]

[[probe]]
name = "b"
ask = "contains"
shapes = [{ shape = "sphere", radius = -1 }]
ray = { origin = [0, 0, 0], direction = [1, 0, 0] }
points = []

[[probe]]
name = "c"
ask = "overlap"
shapes = [{ shape = "circle", radius = 1, position = [1, 2, 3] }]
expect = { overlaps = true }

[[probe]]
name = "d"
ask = "pick"
shapes = [{ shape = "box", radius = 1 }]
camera = { eye = [1, 1, 1], target = [1, 1, 1], near = 2, far = 1 }
)");
    EXPECT_TRUE(has(all, R"(p.toml:3:7: error: unknown ask "raycst"; did you mean "raycast"?)"));
    EXPECT_TRUE(has(all, R"(p.toml:8:21: error: unknown shape "spere"; did you mean "sphere"?)"));
    EXPECT_TRUE(has(all, "has none of ray and segment") || has(all, "ray = {")) << all;
    EXPECT_TRUE(has(all, R"(another probe is already named "b", at line 6)"));
    EXPECT_TRUE(has(all, "radius is -1; it must be a positive number"));
    EXPECT_TRUE(has(all, R"(ask = "contains" has no ray)"));
    EXPECT_TRUE(has(all, "has 0 valid points"));
    EXPECT_TRUE(has(all, R"([[probe]] "c" has 1 shape; ask = "overlap" takes 2 to)"));
    EXPECT_TRUE(has(all, R"(ask = "overlap" has no value "overlaps"; did you mean "overlap"?)"));
    EXPECT_TRUE(has(all, "has no source"));
    EXPECT_TRUE(has(all, "a box has no radius; its size is half_extents"));
    EXPECT_TRUE(has(all, "the camera looks at its own eye"));
    EXPECT_TRUE(has(all, "far must lie beyond near"));
    EXPECT_TRUE(has(all, "has no pixel"));
}

TEST(ProbeFile, AQuestionWithoutAnAnswerIsAnError) {
    const std::string all = said(R"([[probe]]
name = "flat and solid"
ask = "distance"
shapes = [{ shape = "plane", position = [0, 0, 0] }, { shape = "sphere", radius = 1 }]
)");
    EXPECT_TRUE(has(all, "has no answer: ")) << all;
    EXPECT_TRUE(has(all, "both shapes must be convex")) << all;
}

TEST(ProbeFile, AMeshFileThatCannotBeUsedIsAnErrorInTheSceneAndInTheFile) {
    const TemporaryFolder temporary;
    const fs::path &folder = temporary.path();
    std::ofstream(folder / "bad.obj") << "v 0 0 0\nv 1 0 0\nf 1 2 9\n";
    const auto said_of = [&](const std::string &mesh) {
        const std::string text = "[[probe]]\nname = \"a\"\nask = \"closest\"\npoint = [0, 0, 0]\n"
                                 "shapes = [{ shape = \"mesh\", " +
                                 mesh + " }]\n";
        std::string all;
        for (const SceneMessage &message :
             parse_scene(text, (folder / "scene.toml").string()).messages)
            all += format_message("scene.toml", message) + "\n";
        return all;
    };
    const std::string bad = said_of(R"(file = "bad.obj")");
    EXPECT_TRUE(has(bad, "scene.toml:5:36: error: bad.obj:3: ")) << bad;
    EXPECT_TRUE(
        has(said_of(R"(file = "none.obj")"), R"(cannot read "none.obj"; it must be a file)"));
    for (const char *name : {"/etc/passwd", "../gear.obj", "folder/gear.obj", "..", ".", ""}) {
        const std::string all = said_of("file = \"" + std::string(name) + "\"");
        EXPECT_TRUE(has(all, "is not the name of a file beside the scene")) << all;
    }
    EXPECT_TRUE(has(said_of("file = 3"), "file is a number"));
    EXPECT_TRUE(has(said_of(R"(model = "ball", file = "bad.obj")"), "has both model and file"));
    EXPECT_TRUE(has(said_of("scale = 2"), "has none of model, file"));
    EXPECT_TRUE(has(said_of(R"(model = "ball", half_extents = [1, 1, 1], scale = 2)"),
                    "a mesh with model has no scale"));
    EXPECT_TRUE(has(said_of(R"(file = "bad.obj", detail = 4)"), "a mesh with file has no detail"));
    fs::remove_all(folder);
}

TEST(ProbeFile, ACompoundIsMadeOfFlatSolids) {
    const auto said_of = [](const std::string &keys) {
        return said("[[probe]]\nname = \"a\"\nask = \"contains\"\npoint = [0, 0]\n"
                    "shapes = [{ shape = \"compound\"" +
                    keys + " }]\n");
    };
    EXPECT_TRUE(has(said_of(""), "has no parts"));
    EXPECT_TRUE(has(said_of(", parts = []"), "has 0 parts; it takes an array of 1 to"));
    EXPECT_TRUE(has(said_of(", parts = [3]"), "parts holds a number"));
    EXPECT_TRUE(has(said_of(R"(, parts = [{ shape = "sphere", radius = 1 }])"),
                    R"(unknown shape "sphere")"));
    EXPECT_TRUE(has(said_of(R"(, parts = [{ shape = "compound", parts = [] }])"),
                    R"(unknown shape "compound")"));
    EXPECT_TRUE(has(said_of(R"(, parts = [{ shape = "circle", radius = -1 }])"), "radius is -1"));
}

// ---- handles ----

TEST(ProbeHandles, EachMovesToItsPlaceAndFlatOnesStayFlat) {
    for (const SceneDesc &scene : geometry_scenes())
        for (const ProbeDesc &probe : scene.probes) {
            const std::vector<glm::dvec3> before = probe_handles(probe);
            EXPECT_FALSE(before.empty() && probe.question != ProbeQuestion::enclose)
                << scene.name << ": " << probe.name;
            for (std::size_t h = 0; h < before.size(); ++h) {
                ProbeDesc moved = probe;
                const glm::dvec3 place = before[h] + glm::dvec3(0.25, -0.5, 0.75);
                move_probe_handle(moved, h, place);
                const glm::dvec3 wanted = is_flat(probe) ? glm::dvec3(place.x, place.y, 0) : place;
                EXPECT_LT(glm::distance(probe_handles(moved)[h], wanted), 1e-12)
                    << scene.name << ": " << probe.name << ", " << h;
            }
        }
}

TEST(ProbeHandles, ARayKeepsADirection) {
    SceneDesc scene = parsed(ray_and_sphere);
    ProbeDesc &probe = scene.probes.front();
    const std::vector<glm::dvec3> handles = probe_handles(probe); // sphere, origin, tip
    ASSERT_EQ(handles.size(), 3U);
    move_probe_handle(probe, 2, handles[1]);
    EXPECT_EQ(probe.ray->direction, glm::dvec3(2, 0, 0));
    move_probe_handle(probe, 1, {0, 5, 0}); // the whole ray moves
    EXPECT_EQ(probe.ray->direction, glm::dvec3(2, 0, 0));
    EXPECT_EQ(probe_handles(probe)[2], glm::dvec3(2, 5, 0));
}

// ---- a scene without a world ----

TEST(ProbeSimulation, HasNoWorldAndCostsNoStep) {
    const SceneDesc scene = parsed(ray_and_sphere);
    EXPECT_FALSE(has_world(scene));
    const auto simulation = Simulation::create(scene, {}, nullptr);
    EXPECT_FALSE(simulation->has_world());
    const std::uint64_t before = simulation->hash();
    simulation->step();
    EXPECT_EQ(simulation->step_count(), 0U);
    EXPECT_EQ(simulation->time(), 0);
    EXPECT_EQ(simulation->energy(), 0);
    EXPECT_EQ(simulation->hash(), before);
    EXPECT_EQ(simulation->body_count(), 0U);
    EXPECT_FALSE(simulation->pick({0, 0, 5}, {0, 0, -1}).has_value());
    EXPECT_THROW(simulation->add_body({}), std::invalid_argument);
    const auto again = Simulation::create(simulation->describe(), {}, nullptr);
    EXPECT_EQ(again->hash(), before);
}

TEST(ProbeSimulation, AnotherAnswerIsAnotherHash) {
    SceneDesc scene = parsed(ray_and_sphere);
    const std::uint64_t before = Simulation::create(scene, {}, nullptr)->hash();
    scene.probes.front().shapes.front().shape = SphereDesc{1.25};
    EXPECT_NE(Simulation::create(scene, {}, nullptr)->hash(), before);
}

TEST(ProbeSimulation, AWorldWithProbesIsStillAWorld) {
    const SceneDesc scene = parsed(std::string(ray_and_sphere) +
                                   "[[body]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 1\n");
    EXPECT_TRUE(has_world(scene));
    const auto simulation = Simulation::create(scene, {}, nullptr);
    simulation->step();
    EXPECT_EQ(simulation->step_count(), 1U);
    EXPECT_EQ(simulation->describe().probes.size(), 1U);
}

} // namespace
} // namespace plumb

// Shapes in scene files: each kind survives the round trip, and each error is reported at its
// place.
#include "engine/scene/scene_file.h"

#include "engine/scene/shape_kinds.h"
#include "tests/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

const std::string tetrahedron = "points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]";
const std::string pyramid_mesh = "vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]\n"
                                 "triangles = [[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]]";
const std::string heights = "heights = [[0, 0.5, 0], [1, 0, 0.25]]\nspacing = 0.5";

// One body with the given shape lines.
std::string body(const std::string &lines) {
    return "[[body]]\nname = \"a\"\n" + lines + "\n";
}

SceneDesc parsed(const std::string &text) {
    const SceneFileResult read = parse_scene(text, "s.toml");
    for (const SceneMessage &message : read.messages)
        EXPECT_EQ(message.severity, SceneMessage::Severity::warning)
            << format_message("s.toml", message) << "\n"
            << text;
    return read.scene;
}

std::string said(const std::string &text) {
    std::string all;
    for (const SceneMessage &message : parse_scene(text, "s.toml").messages)
        all += format_message("s.toml", message) + "\n";
    return all;
}

bool has(const std::string &all, const std::string &part) {
    return all.find(part) != std::string::npos;
}

// A valid body of each kind.
std::vector<std::string> every_kind() {
    return {"shape = \"sphere\"\nradius = 2",
            "shape = \"box\"\nhalf_extents = [1, 2, 3]",
            "shape = \"capsule\"\nhalf_height = 1\nradius = 0.5",
            "shape = \"cylinder\"\nhalf_height = 1\nradius = 0.5",
            "shape = \"hull\"\n" + tetrahedron,
            "shape = \"plane\"",
            "shape = \"mesh\"\n" + pyramid_mesh,
            "shape = \"mesh\"\nmodel = \"torus\"\nhalf_extents = [2, 1, 2]\nsides = \"both\"",
            "shape = \"height_field\"\n" + heights,
            "shape = \"mesh\"\nsides = \"solid\"\n" + pyramid_mesh,
            "shape = \"height_field\"\nhalf_extents = [4, 1, 3]\ndetail = 6\nsides = \"solid\""};
}

// As an inline table for `shapes`.
std::string inline_table(std::string lines) {
    std::ranges::replace(lines, '\n', ',');
    return "{ " + lines + " }";
}

TEST(SceneFileShapes, EachKindOfBodyIsThere) {
    std::vector<bool> seen(std::variant_size_v<ShapeDesc>);
    for (const std::string &lines : every_kind())
        seen[parsed(body(lines)).bodies.at(0).colliders.at(0).shape.index()] = true;
    EXPECT_EQ(std::ranges::count(seen, true), std::ssize(seen));
}

TEST(SceneFileShapes, EachKindComesBackAsItWasWritten) {
    for (const std::string &lines : every_kind()) {
        const SceneDesc scene = parsed(body(lines + "\nlayer = 3\nignores = [0, 31]"));
        const std::string text = write_scene(scene);
        for (std::size_t start = 0; start < lines.size();) {
            const std::size_t end = std::min(lines.find('\n', start), lines.size());
            EXPECT_TRUE(has(text, lines.substr(start, end - start) + "\n")) << text;
            start = end + 1;
        }
        EXPECT_TRUE(has(text, "layer = 3\nignores = [0, 31]\n")) << text;
        EXPECT_EQ(write_scene(parsed(text)), text);
    }
}

TEST(SceneFileShapes, SeveralComeBackEachWithItsOwn) {
    for (const std::string &lines : every_kind()) {
        const std::string several =
            "[[material]]\nname = \"ice\"\n" +
            body("kind = \"static\"\nshapes = [" + inline_table(lines) +
                 ", { shape = \"box\", half_extents = [1, 1, 1], position = [1, 2, 3], "
                 "rotation_deg = [0, 90, 0], material = \"ice\", density = 3, layer = 2, "
                 "ignores = [5], sensor = true }]");
        const SceneDesc scene = parsed(several);
        ASSERT_EQ(scene.bodies.at(0).colliders.size(), 2U);
        const ColliderDesc &box = scene.bodies[0].colliders[1];
        EXPECT_EQ(box.position, glm::dvec3(1, 2, 3));
        EXPECT_LT(glm::distance(box.orientation * glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1)),
                  1e-15);
        EXPECT_EQ(box.material, "ice");
        EXPECT_EQ(box.density, 3);
        EXPECT_EQ(box.filter.layer, 2);
        EXPECT_EQ(box.filter.ignores, 32U);
        EXPECT_TRUE(box.sensor);
        const std::string text = write_scene(scene);
        EXPECT_EQ(write_scene(parsed(text)), text);
    }
}

TEST(SceneFileShapes, MassAndFreedomComeBack) {
    const std::string lines = "mass = 3\ncenter_of_mass = [0, 0.5, 0]\ninertia = [1, 2, 2.5]\n";
    const std::string freedom = "locked = [\"z\", \"rotation_x\"]\ngravity_scale = -0.5\n"
                                "force = [1, 2, 3]\ntorque = [0, -4, 0]\n"
                                "linear_damping = 0.25\nangular_damping = 2\n";
    const std::string pose = "mass_pose = { position = [0, 0.5, 0], orientation = [0, 1, 0, 0] }\n";
    const SceneDesc scene =
        parsed(body("shape = \"sphere\"\nradius = 1\n" + lines + pose + freedom));
    const BodyDesc &read = scene.bodies.at(0);
    EXPECT_EQ(read.inertia, glm::dvec3(1, 2, 2.5));
    EXPECT_EQ(read.locked, (std::array{false, false, true, true, false, false}));
    EXPECT_EQ(read.gravity_scale, -0.5);
    EXPECT_EQ(read.force, glm::dvec3(1, 2, 3));
    EXPECT_EQ(read.torque, glm::dvec3(0, -4, 0));
    ASSERT_TRUE(read.mass_pose);
    EXPECT_EQ(read.mass_pose->orientation.x, 1);
    const std::string text = write_scene(scene);
    EXPECT_TRUE(has(text, lines + pose)) << text;
    EXPECT_TRUE(has(text, freedom)) << text;
    EXPECT_EQ(write_scene(parsed(text)), text);
}

// In order: its own, its material's, the body's, the body's material's.
TEST(SceneFileShapes, DensitiesGoByTheNearest) {
    const std::string materials = "[[material]]\nname = \"a\"\ndensity = 10\n"
                                  "[[material]]\nname = \"b\"\ndensity = 20\n";
    const auto mass = [&](const std::string &of_shape, const std::string &of_body) {
        const SceneDesc scene =
            parsed(materials + body("shapes = [{ shape = \"box\", half_extents = [0.5, 0.5, 0.5]" +
                                    of_shape + " }]\n" + of_body));
        return mass_of(scene, scene.bodies.at(0));
    };
    EXPECT_EQ(mass("", ""), 1000);
    EXPECT_EQ(mass("", "material = \"a\""), 10);
    EXPECT_EQ(mass("", "material = \"a\"\ndensity = 5"), 5);
    EXPECT_EQ(mass(", material = \"b\"", "material = \"a\"\ndensity = 5"), 20);
    EXPECT_EQ(mass(", material = \"b\", density = 7", "density = 5"), 7);
    EXPECT_EQ(mass(", density = 7", "mass = 2"), 2);
}

TEST(SceneFileShapes, MistakesAreToldWhereTheyAre) {
    const auto expect = [](const std::string &lines, const std::string &message) {
        const std::string all = said(body(lines));
        EXPECT_TRUE(has(all, message)) << lines << "\nsaid: " << all;
        EXPECT_EQ(std::ranges::count(all, '\n'), 1) << all;
    };
    expect("shape = \"sphere\"\nradius = 1\nhalf_extents = [1, 1, 1]",
           "s.toml:5:1: error: a sphere has no half_extents; its size is its radius");
    expect("shape = \"cylinder\"\nradius = 1",
           "s.toml:1:1: error: [[body]] \"a\" has no half_height; half_height = metres");
    expect("shape = \"hull\"", "[[body]] \"a\" has none of points, file");
    expect("shape = \"hull\"\npoints = [[0, 0, 0]]",
           "s.toml:4:10: error: [[body]] \"a\" has 1 valid points; it takes 4 to");
    expect("shape = \"hull\"\npoints = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]",
           "s.toml:4:10: error: these 4 points have no solid hull; it takes four that are not "
           "coplanar");
    expect("shape = \"hull\"\n" + tetrahedron + "\nscale = 2",
           "s.toml:5:1: error: a hull with points has no scale");
    expect("shape = \"mesh\"\nkind = \"dynamic\"\n" + pyramid_mesh,
           "s.toml:4:8: error: a mesh cannot be dynamic; kind = \"static\", which is a mesh's "
           "default");
    expect("shape = \"mesh\"\nmass = 2\n" + pyramid_mesh,
           "s.toml:4:1: error: a mesh has no mass; it never moves");
    expect("shape = \"mesh\"\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n"
           "triangles = [[0, 1, 3]]",
           "s.toml:5:21: error: triangles[0][2] is 3; it must be a whole number from 0 to 2");
    expect("shape = \"mesh\"\nmodel = \"ball\"\nhalf_extents = [1, 1, 1]\nsides = \"none\"",
           "s.toml:6:9: error: unknown sides \"none\"; did you mean \"one\"?");
    const std::string no_space = " encloses no space, so it cannot be solid; close it, with its "
                                 "triangles counter-clockwise seen from outside; or sides = "
                                 "\"both\"";
    expect("shape = \"mesh\"\nmodel = \"bowl\"\nhalf_extents = [1, 1, 1]\nsides = \"solid\"",
           "s.toml:6:9: error: [[body]] \"a\"" + no_space);
    expect("shape = \"mesh\"\nsides = \"solid\"\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], "
           "[0, 0, 1]]\ntriangles = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]", // inside out
           no_space);
    expect("shape = \"mesh\"\nfile = \"../x.obj\"", "is not the name of a file beside the scene");
    expect("shape = \"height_field\"\nheights = [[1, 2], [3]]\nspacing = 1",
           "s.toml:4:20: error: heights[1] has 1 heights");
    expect("shape = \"height_field\"\nhalf_extents = [1e-9, 1, 1e9]", "heights; at most 1000000");
    expect("shapes = []", "s.toml:3:10: error: [[body]] \"a\" has 0 shapes");
    expect("shapes = [{ shape = \"bx\" }]",
           "s.toml:3:21: error: unknown shape \"bx\"; did you mean \"box\"?");
    expect("shapes = [{ shape = \"sphere\", radius = 1 }]\nradius = 2",
           "s.toml:4:1: error: a body with several shapes has no radius; each of them has its own");
    expect("shapes = [{ shape = \"sphere\", radius = 1, materiel = \"x\" }]",
           "unknown key \"materiel\" in the sphere of [[body]] \"a\"; did you mean \"material\"?");
    expect("shapes = [{ shape = \"sphere\", radius = 1, material = \"x\" }]",
           "there is no material \"x\"");
    expect("shape = \"sphere\"\nradius = 1\ninertia = [1, 1, 3]",
           "s.toml:5:11: error: impossible moments of inertia");
    expect("shape = \"sphere\"\nradius = 1\nlocked = [\"w\"]", "unknown axis \"w\"");
    expect("shape = \"sphere\"\nradius = 1\nlayer = 32",
           "layer is 32; it must be a whole number from 0 to 31");
    expect("shape = \"sphere\"\nradius = 1\nsensor = true",
           "density times volume gives a mass of 0 kg");
}

TEST(SceneFileShapes, APointsFileIsScaledAndNamedAgain) {
    const TemporaryFolder temporary;
    const std::filesystem::path &folder = temporary.path();
    std::ofstream(folder / "t.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n"
                                       "f 1 4 3\nf 2 3 4\n";
    const std::string text = body("shape = \"hull\"\nfile = \"t.obj\"\nscale = 2") +
                             "[[body]]\nname = \"b\"\nshape = \"mesh\"\nfile = \"t.obj\"\n";
    const SceneFileResult read = parse_scene(text, (folder / "s.toml").string());
    ASSERT_TRUE(read.ok());
    const ShapeDesc &hull = read.scene.bodies.at(0).colliders.at(0).shape;
    EXPECT_EQ(std::get<HullDesc>(hull).points->at(1), glm::dvec3(2, 0, 0));
    EXPECT_NEAR(volume(hull), 8.0 / 6, 1e-12);
    const ShapeDesc &mesh = read.scene.bodies.at(1).colliders.at(0).shape;
    EXPECT_EQ(std::get<MeshDesc>(mesh).data->triangles.size(), 4U);
    const std::string written = write_scene(read.scene);
    EXPECT_TRUE(has(written, "shape = \"hull\"\nfile = \"t.obj\"\nscale = 2\n")) << written;
    EXPECT_FALSE(has(written, "points")) << written;
}

} // namespace
} // namespace plumb

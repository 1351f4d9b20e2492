// Particles, springs and cloth in scene files: reading, errors, and the round trip through a file.
#include "engine/scene/cloth.h"
#include "engine/scene/particle_keys.h"
#include "engine/scene/scene_limits.h"
#include "engine/scene/soft_parts.h"
#include "tests/scene/scene_file_errors.h"
#include "tests/temporary_folder.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

namespace plumb {
namespace {

using namespace scene_file_errors;

const std::string bob = "[[particle]]\nname = \"bob\"\nmass = 2\n";
const std::string nail = "[[particle]]\nname = \"nail\"\nposition = [0, 3, 0]\npinned = true\n";
const std::string sheet = "[[cloth]]\nname = \"sheet\"\ncells = [3, 2]\nsize = [3, 2]\n";
const std::string spring = "[[spring]]\nname = \"s\"\nstiffness = 50\n";

SceneDesc parse(const std::string &text) {
    const SceneFileResult result = parse_scene(text, "s.toml");
    for (const SceneMessage &message : result.messages)
        ADD_FAILURE() << format_message("s.toml", message) << "\n" << text;
    return result.scene;
}

TEST(ParticleFile, ReferencesAreInTheReadme) {
    std::ifstream file(PLUMB_SOURCE_DIR "/scenes/README.md");
    std::ostringstream text;
    text << file.rdbuf();
    for (const std::string &reference :
         {attractor_reference(), particle_reference(), spring_reference(), cloth_reference()})
        EXPECT_NE(text.str().find(reference), std::string::npos)
            << "put this into scenes/README.md:\n\n"
            << reference;
}

TEST(ParticleFile, AttractorsAreReadAndWritten) {
    const SceneDesc scene = parse(bob + R"([[attractor]]
name = "sun"
position = [1, 2, 3]
gravitational_parameter = 4.5
[[attractor]]
name = "moon"
radius = 0.5
)");
    const SceneDesc again = parse(write_scene(scene));
    for (const SceneDesc *read : {&scene, &again}) {
        ASSERT_EQ(read->attractors.size(), 2U);
        EXPECT_EQ(read->attractors[0].name, "sun");
        EXPECT_EQ(read->attractors[0].position, glm::dvec3(1, 2, 3));
        EXPECT_EQ(read->attractors[0].gravitational_parameter, 4.5);
        EXPECT_EQ(read->attractors[1].gravitational_parameter, 1);
        EXPECT_EQ(read->attractors[1].radius, 0.5);
    }
}

TEST(ParticleFile, SpringTakesItsRestLengthFromTheStart) {
    const SceneDesc scene = parse(bob + nail + sheet + ball + R"(position = [0, 10, 0]
rotation_deg = [0, 0, 90]
[[spring]]
name = "between particles"
a = "nail"
b = "bob"
stiffness = 50
[[spring]]
name = "to the world"
a = "bob"
anchor_b = [0, 0, -7]
stiffness = 50
[[spring]]
name = "to a body"
a = "nail"
b = "ball"
anchor_b = [1, 10, 0]
stiffness = 50
[[spring]]
name = "to a cloth"
a = "sheet[3,1]"
b = "bob"
stiffness = 50
)");
    ASSERT_EQ(scene.springs.size(), 4U);
    EXPECT_EQ(scene.springs[0].rest_length, 3);
    EXPECT_EQ(scene.springs[1].rest_length, 7);
    EXPECT_NEAR(scene.springs[2].rest_length, std::sqrt(50.0), 1e-12);
    // A quarter turn about z: the world's x is the body's -y.
    EXPECT_NEAR(glm::distance(scene.springs[2].anchor_b_local, glm::dvec3(0, -1, 0)), 0, 1e-12);
    EXPECT_EQ(scene.springs[3].rest_length, 1.5);
    const SoftParts parts(scene);
    EXPECT_EQ(parts.springs[3].a.index, parts.find_particle("sheet[3,1]"));
    EXPECT_EQ(parts.springs[2].b.kind, SpringEndInfo::Kind::body);
}

// The reduced mass of 2 kg and 3 kg is 6/5 kg, and of 2 kg against a fixed end 2 kg.
TEST(ParticleFile, FrequencyAndDampingRatioAreOfTheReducedMass) {
    const SceneDesc scene = parse(bob + nail + R"([[particle]]
name = "other"
position = [1, 0, 0]
mass = 3
[[spring]]
name = "pair"
a = "bob"
b = "other"
frequency = 2
damping_ratio = 0.25
[[spring]]
name = "hung"
a = "nail"
b = "bob"
stiffness = 50
damping_ratio = 1
)");
    const double omega = 4 * std::numbers::pi;
    EXPECT_NEAR(scene.springs[0].stiffness, 1.2 * omega * omega, 1e-10);
    EXPECT_NEAR(scene.springs[0].damping, 2 * 0.25 * omega * 1.2, 1e-12);
    EXPECT_NEAR(scene.springs[1].damping, 2 * std::sqrt(50.0 * 2), 1e-12);
}

TEST(ParticleFile, PinsByWordAndByPlace) {
    const auto pins = [](const std::string &value) {
        return parse(sheet + "pins = " + value + "\n").cloths.at(0).pins;
    };
    using Pins = std::vector<std::uint32_t>; // four along x, three rows
    EXPECT_EQ(pins("\"corners\""), (Pins{0, 3, 8, 11}));
    EXPECT_EQ(pins("\"edge\""), (Pins{0, 1, 2, 3}));
    EXPECT_EQ(pins("\"border\""), (Pins{0, 1, 2, 3, 4, 7, 8, 9, 10, 11}));
    EXPECT_EQ(pins("[[3, 2], [0, 1], [3, 2]]"), (Pins{4, 11}));
}

class ParticleErrors : public testing::TestWithParam<SceneFileError> {};

TEST_P(ParticleErrors, AreSaid) {
    expect_messages(GetParam());
}

const std::vector<SceneFileError> &errors() {
    static const std::vector<SceneFileError> all{
        {"ParticleNoName",
         "@[[particle]]\nmass = 1\n",
         {"[[particle]] has no name; each particle needs a name of its own"}},
        {"ParticleUnknownKey",
         "[[particle]]\nname = \"p\"\n@mas = 1\n",
         {R"(unknown key "mas" in [[particle]] "p"; did you mean "mass"?)"}},
        {"ParticleTwice",
         bob + "[[particle]]\nname = @\"bob\"\n",
         {R"(another particle is already named "bob", at line 2; each particle needs a name of its own)"}},
        {"ParticleCalledAsABody",
         ball + "[[particle]]\nname = @\"ball\"\n",
         {R"(a body is already named "ball"; springs and expectations refer to bodies, particles and cloths by name alone)"}},
        {"ClothCalledAsAParticle",
         bob + "[[cloth]]\nname = @\"bob\"\n",
         {R"(a particle is already named "bob"; springs and expectations refer to bodies, particles and cloths by name alone)"}},
        {"ParticleWorld",
         "[[particle]]\nname = @\"world\"\n",
         {R"("world" cannot be the name of a particle; it stands for the world in joints and springs)"}},
        {"ParticleNan",
         "[[particle]]\nname = \"p\"\nposition = [0, @nan, 0]\n",
         {"position[1] is nan; it must be a number between -1e9 and 1e9"}},
        {"ParticleMass",
         "[[particle]]\nname = \"p\"\nmass = @0\n",
         {"mass is 0; it must be a positive number, from 1e-9 to 1e9"}},
        {"ParticleRadius",
         "[[particle]]\nname = \"p\"\nradius = @-1\n",
         {"radius is -1; it must be a positive number, from 1e-9 to 1e9"}},
        {"ParticlePinnedMoves",
         "[[particle]]\nname = \"p\"\npinned = true\n@velocity = [1, 0, 0]\n",
         {"a pinned particle has no velocity; it never moves"}},
        {"ParticleMaterial",
         "[[particle]]\nname = \"p\"\nmaterial = @\"silk\"\n",
         {R"(there is no material "silk")"}},
        {"SpringUnknownEnd",
         bob + spring + "a = \"bob\"\nb = @\"bib\"\n",
         {R"(there is no particle or body "bib"; did you mean "bob"?)"}},
        {"SpringUnknownBody",
         ball + spring + "a = \"ball\"\nb = @\"bal\"\n",
         {R"(there is no body "bal"; did you mean "ball"?)"}},
        {"SpringWorldToItself",
         "@" + spring + "anchor_a = [0, 0, 0]\n",
         {R"([[spring]] "s" joins the world to itself; give a or b the name of a particle or a body)"}},
        {"SpringToItself",
         bob + spring + "a = \"bob\"\nb = @\"bob\"\n",
         {R"([[spring]] "s" joins "bob" to itself; a and b must differ)"}},
        {"SpringWorldWithoutAnchor",
         bob + "@" + spring + "a = \"bob\"\n",
         {R"([[spring]] "s" has none of anchor_b, anchor_b_local; anchor_b = [x, y, z] is a point in world coordinates)"}},
        {"SpringAnchorOfAParticle",
         bob + nail + spring + "a = \"bob\"\nb = \"nail\"\nanchor_b = @[0, 0, 0]\n",
         {"a particle has no anchor_b; it is pulled at its centre"}},
        {"SpringNoStiffness",
         bob + nail + "@[[spring]]\nname = \"s\"\na = \"bob\"\nb = \"nail\"\n",
         {R"([[spring]] "s" has none of stiffness, frequency; how stiff is it, in N/m or Hz?)"}},
        {"SpringRestLength",
         bob + nail + spring + "a = \"bob\"\nb = \"nail\"\nrest_length = @0\n",
         {"rest_length is 0; it must be a positive number, from 1e-9 to 1e9"}},
        {"SpringEndsAtOnePlace",
         bob + "@" + spring + "a = \"bob\"\nanchor_b = [0, 0, 0]\n",
         {R"(the ends of [[spring]] "s" are 0 m apart, which cannot be its rest length; give it a rest_length: a positive number, from 1e-9 to 1e9)"}},
        {"SpringFrequencyOfWhatNeverMoves",
         nail + "[[spring]]\nname = \"s\"\na = \"nail\"\nanchor_b = [0, 0, 0]\nfrequency = @3\n",
         {R"(neither end of [[spring]] "s" moves, so it has no frequency; give its stiffness and damping)"}},
        {"SpringTwoWaysToSayIt",
         bob + nail + spring + "a = \"bob\"\nb = \"nail\"\n@frequency = 3\n",
         {"[[spring]] \"s\" has both stiffness and frequency; keep one of them"}},
        {"SpringWholeCloth",
         sheet + bob + spring + "a = @\"sheet\"\nb = \"bob\"\n",
         {R"(the cloth "sheet" has many particles; name one of "sheet[0,0]" to "sheet[3,2]")"}},
        {"SpringNoSuchParticle",
         sheet + bob + spring + "a = @\"sheet[4,0]\"\nb = \"bob\"\n",
         {R"(the cloth "sheet" has no particle [4,0]; name one of "sheet[0,0]" to "sheet[3,2]")"}},
        {"ClothTooManyCells",
         "[[cloth]]\nname = \"c\"\ncells = [10, @1001]\n",
         {"cells[1] is 1001; it must be a whole number from 1 to 1000"}},
        {"ClothNoCells",
         "[[cloth]]\nname = \"c\"\ncells = [@0, 1]\n",
         {"cells[0] is 0; it must be a whole number from 1 to 1000"}},
        {"ClothCells",
         "[[cloth]]\nname = \"c\"\ncells = @[1, 2, 3]\n",
         {"cells has 3 elements; it must be [nx, nz], the cells along x and z"}},
        {"ClothSize",
         "[[cloth]]\nname = \"c\"\nsize = [1, @-2]\n",
         {"size[1] is -2; it must be a positive number, from 1e-9 to 1e9"}},
        {"ClothPinNotThere",
         sheet + "pins = [[0, 0], [@4, 0]]\n",
         {"pins[1][0] is 4; it must be a whole number from 0 to 3"}},
        {"ClothPinWord",
         sheet + "pins = @\"corner\"\n",
         {R"(unknown pins "corner"; did you mean "corners"?)"}},
        {"ClothPinNoPair",
         sheet + "pins = [@3]\n",
         {"pins[0] is a number; it must be a pair [i, j], the i-th particle along x of the "
          "j-th row"}},
        {"ClothStateOfOthers",
         sheet + "positions = @[[0, 0, 0]]\nvelocities = @[[0, 0, 0]]\n",
         {"positions has 1 elements; it must be an array of 12 vectors, one for each particle",
          "velocities has 1 elements; it must be an array of 12 vectors, one for each particle"}},
        {"ClothHalfAState",
         sheet + "positions = @[]\n",
         {R"([[cloth]] "sheet" has only one of positions and velocities; give both, for all its particles)"}},
        {"ClothTornNotThere",
         sheet + "torn = [@99]\n",
         {"torn[0] is 99; it must be a whole number from 0 to 38"}},
        {"ClothFileNotThere",
         "[[cloth]]\nname = \"c\"\nfile = @\"no.obj\"\n",
         {R"(cannot read "no.obj"; it must be a file beside the scene)"}},
        {"ClothFileElsewhere",
         "[[cloth]]\nname = \"c\"\nfile = @\"../no.obj\"\n",
         {R"("../no.obj" is not the name of a file beside the scene; file = "name.obj", without folders)"}},
        {"ClothFileWithCells",
         "[[cloth]]\nname = \"c\"\nfile = @\"no.obj\"\n@cells = [1, 1]\n",
         {R"(cannot read "no.obj"; it must be a file beside the scene)",
          "a cloth from a file has no cells; its particles and springs are the file's vertices and "
          "edges"}},
        {"ExpectUnknownParticle",
         bob + "[[expect]]\nname = \"e\"\nquantity = \"position.y\"\nbody = @\"bub\"\nto = 1\n"
               "at_most = 1\nsource = \"s\"\n",
         {R"(there is no body "bub")"}},
        {"ExpectTiltOfAParticle",
         bob + "[[expect]]\nname = \"e\"\nquantity = \"tilt\"\nbody = @\"bob\"\nto = 1\n"
               "at_most = 1\nsource = \"s\"\n",
         {R"(there is no body "bob"; a particle has no tilt)"}},
        {"ExpectUnknownSpring",
         bob + nail + spring +
             "a = \"bob\"\nb = \"nail\"\n[[expect]]\nname = \"e\"\n"
             "quantity = \"strain\"\nspring = @\"t\"\nto = 1\nat_most = 1\n"
             "source = \"s\"\n",
         {R"(there is no spring "t"; the only one is s)"}},
        {"ExpectStrainOfABody",
         bob + "@[[expect]]\nname = \"e\"\nquantity = \"strain\"\n@body = \"bob\"\nto = 1\n"
               "at_most = 1\nsource = \"s\"\n",
         {R"([[expect]] "e" has no spring; strain is measured on one spring: which?)",
          R"(strain has no body; it is measured on a spring: spring = "...")"}},
    };
    return all;
}

INSTANTIATE_TEST_SUITE_P(All, ParticleErrors, testing::ValuesIn(errors()),
                         [](const auto &tested) { return tested.param.name; });

TEST(ParticleFile, TooManyParticles) {
    // 448 x 448 is more than 200 000; the first cloth alone fits.
    const std::string large = "cells = [446, 446]\n";
    EXPECT_EQ(parse("[[cloth]]\nname = \"a\"\n" + large).cloths.size(), 1U);
    expect_messages(
        {"",
         "[[cloth]]\nname = \"a\"\n" + large + "[[cloth]]\nname = \"b\"\ncells = @[20, 20]\n",
         {"too many particles: 199809 before this, and 441 here; a scene holds at most "
          "200000"}});
}

class ClothMesh : public testing::Test {
  protected:
    ClothMesh() {
        write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2 3 4\n");
        write("loose.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2 3\n");
        write("flat.obj", "v 0 0 0\nv 0 0 0\nv 1 0 1\nf 1 2 3\n");
    }
    void write(const char *name, const char *text) const { std::ofstream(folder / name) << text; }
    SceneFileResult read(const std::string &more) const {
        return parse_scene("[[cloth]]\nname = \"c\"\n" + more, (folder / "s.toml").string());
    }
    TemporaryFolder temporary;
    std::filesystem::path folder = temporary.path();
};

TEST_F(ClothMesh, IsMadeOfVerticesAndEdges) {
    const SceneFileResult result = read("file = \"square.obj\"\nscale = 2\npins = [3]\n");
    ASSERT_TRUE(result.ok()) << result.messages.front().what;
    const SoftParts parts(result.scene);
    EXPECT_EQ(parts.particles.size(), 4U);
    EXPECT_EQ(parts.springs.size(), 6U); // four sides, the diagonal, and the bend spring across it
    EXPECT_EQ(parts.springs.front().rest_length, 2);
    EXPECT_TRUE(parts.particles[3].pinned);
    EXPECT_EQ(parts.particles[0].mass, 0.25);
    const std::string text = write_scene(result.scene);
    EXPECT_EQ(write_scene(parse_scene(text, (folder / "s.toml").string()).scene), text);
}

TEST_F(ClothMesh, WhatMakesNoClothIsRefused) {
    for (const auto &[file, flaw] :
         {std::pair("loose.obj", "its vertex 3 is not a corner of any triangle"),
          std::pair("flat.obj", "its edge from vertex 0 to vertex 1 has no length")}) {
        const SceneFileResult result = read("file = \"" + std::string(file) + "\"\n");
        ASSERT_EQ(result.messages.size(), 1U);
        EXPECT_EQ(
            format_message("s", result.messages.front()),
            "s:3:8: error: \"" + std::string(file) + "\" cannot be a cloth: " + flaw +
                "; each vertex must be a corner of a triangle, and each edge must have a length");
    }
    const SceneFileResult pin = read("file = \"square.obj\"\npins = [4]\n");
    ASSERT_EQ(pin.messages.size(), 1U);
    EXPECT_EQ(pin.messages.front().what, "pins[0] is 4");
}

} // namespace
} // namespace plumb

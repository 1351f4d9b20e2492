#include "engine/scene/obj_file.h"

#include "engine/core/random.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

namespace plumb {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

ObjResult read(const std::string &text) {
    std::istringstream in(text);
    return read_obj(in, "model.obj");
}

ObjMesh mesh_of(const std::string &text) {
    ObjResult result = read(text);
    EXPECT_EQ(result.error, "");
    return std::move(result.mesh);
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(ObjFile, ReadsFacesOfAllSpellings) {
    const ObjMesh mesh = mesh_of("# a comment\nmtllib no_such_file.mtl\no thing\n" + square +
                                 "vt 0 0\nvn 0 0 1\nusemtl none\ns off\n"
                                 "f 1 2 3\nf 1/1 3/1 4/1\n\tf  1//1 2//1   3//1 \n"
                                 "f 1/1/1 2/1/1 3/1/1\nf -4 -3 -2\nl 1 2\np 1\nf 1 2 3 # why\n");
    ASSERT_EQ(mesh.vertices.size(), 4U);
    EXPECT_EQ(mesh.vertices[2], glm::dvec3(1, 1, 0));
    const Triangles expected{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2}};
    EXPECT_EQ(mesh.triangles, expected);
}

TEST(ObjFile, LineEndsOfAllSystems) {
    for (const char *end : {"\n", "\r\n", "\r"}) {
        std::string text;
        for (const char *line : {"v 0 0 0", "v 1 0 0", "", "v 0 1 0", "f 1 2 3"})
            text += std::string(line) + end;
        EXPECT_EQ(mesh_of(text).triangles, (Triangles{{0, 1, 2}}));
        text += "f 1 2 9";
        EXPECT_TRUE(read(text).error.starts_with("model.obj:6: ")) << read(text).error;
    }
    EXPECT_EQ(mesh_of("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3").triangles.size(), 1U); // no newline
}

TEST(ObjFile, RelativeIndicesCountFromTheirLine) {
    const ObjMesh mesh =
        mesh_of("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -3 -2 -1\nf 4 5 1\nv 6 6 6\n");
    const Triangles expected{{0, 1, 2}, {1, 2, 3}, {3, 4, 0}}; // 5 is defined after its use
    EXPECT_EQ(mesh.triangles, expected);
    EXPECT_NE(read("v 0 0 0\nv 1 0 0\nf -1 -2 -3\nv 0 1 0\n").error.find("before this line"),
              std::string::npos);
}

TEST(ObjFile, NumbersAreReadToTheLastBit) {
    Random random(1);
    const int rounds = trials(1'000'000); // numbers
    for (int round = 0; round < rounds; round += 300) {
        std::vector<double> expected;
        std::string text;
        for (int i = 0; i < 300; ++i) {
            const double value =
                random.next_in(-1.0, 1.0) * std::pow(10.0, random.next_in(-300.0, 8.0));
            expected.push_back(value);
            std::array<char, 40> digits{};
            std::snprintf(digits.data(), digits.size(), i % 2 == 0 ? "%+.17g" : "%.17E", value);
            text +=
                (i % 3 == 0 ? "v " : " ") + std::string(digits.data()) + (i % 3 == 2 ? "\n" : "");
        }
        const ObjMesh mesh = mesh_of(text + "f 1 2 3\n");
        for (std::size_t i = 0; i < 300; ++i)
            ASSERT_EQ(mesh.vertices[i / 3][int(i % 3)], expected[i]);
    }
    // Anything after three numbers is ignored: a weight or a colour.
    EXPECT_EQ(mesh_of("v .5 -.5 +5. 1\nv 1e2 0 0 1 0 0\nv 0 -0 1 junk\nf 1 2 3\n").vertices[0],
              glm::dvec3(0.5, -0.5, 5.0));
}

// --- Polygons.

glm::dvec3 area_of(const std::vector<glm::dvec3> &p) {
    glm::dvec3 sum{0};
    for (std::size_t i = 2; i < p.size(); ++i)
        sum += glm::cross(p[i - 1] - p[0], p[i] - p[0]);
    return 0.5 * sum;
}

TEST(ObjFile, ConvexPolygonsBecomeFans) {
    EXPECT_EQ(mesh_of(square + "f 1 2 3 4\n").triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(mesh_of(square + "f 4 3 2 1\n").triangles, (Triangles{{3, 2, 1}, {3, 1, 0}}));
}

TEST(ObjFile, AnArrowheadIsNotCutOutside) {
    // Whichever corner it starts with, and wherever it is.
    for (const double at : {0.0, -7.0, 1e6}) {
        const std::array<glm::dvec3, 4> corners{
            glm::dvec3{at, 5, at}, {at + 2, 5, at - 1}, {at + 0.5, 5, at}, {at + 2, 5, at + 1}};
        for (std::size_t first = 0; first < 4; ++first) {
            std::ostringstream text;
            text.precision(17);
            std::vector<glm::dvec3> outline;
            for (std::size_t i = 0; i < 4; ++i) {
                const glm::dvec3 &p = outline.emplace_back(corners[(first + i) % 4]);
                text << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
            }
            const ObjMesh mesh = mesh_of(text.str() + "f 1 2 3 4\n");
            ASSERT_EQ(mesh.triangles.size(), 2U);
            const glm::dvec3 whole = area_of(outline);
            double sum = 0;
            for (const auto &[a, b, c] : mesh.triangles) {
                const glm::dvec3 part =
                    area_of({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
                EXPECT_GT(glm::dot(part, whole), 0.0);
                sum += glm::length(part);
            }
            EXPECT_NEAR(sum, glm::length(whole), 1e-9);
        }
    }
}

void append(std::string &text, double value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text += ' ';
    text.append(digits.data(), end);
}

// A star with spikes inwards and outwards and some collinear corners, flat or tilted.
std::vector<glm::dvec3> any_simple_polygon(Random &random, std::uint32_t count) {
    const bool is_flat = random.next_index(2) == 0;
    const double angle = is_flat ? 0.0 : random.next_in(0.0, 6.0);
    const glm::dvec3 center{random.next_in(-9, 9), random.next_in(-9, 9), random.next_in(-9, 9)};
    std::vector<glm::dvec3> outline;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double turn = 6.283185307179586 * double(i) / count;
        double reach = random.next_index(3) == 0 ? 0.05 : random.next_in(0.2, 1.0);
        if (random.next_index(5) == 0 && i > 0) // in line with the last corners, or nearly
            reach = glm::length(outline.back() - center) * random.next_in(0.99, 1.01);
        const double x = reach * std::cos(turn), y = reach * std::sin(turn);
        outline.push_back(center + glm::dvec3{x * std::cos(angle), y, x * std::sin(angle)});
    }
    return outline;
}

// Each triangle must wind as the outline does, and their areas must add up to its area: then
// nothing is covered twice or left out. A million polygons, ten to a file.
TEST(ObjFile, AnySimplePolygonIsCutIntoItsArea) {
    Random random(2);
    const int rounds = trials(100'000);
    for (int round = 0; round < rounds; ++round) {
        std::vector<std::vector<glm::dvec3>> outlines;
        std::vector<bool> is_backward;
        std::string text;
        std::uint32_t first = 1;
        for (int k = 0; k < 10; ++k) {
            const std::uint32_t few = random.next_index(random.next_index(8) == 0 ? 20 : 5);
            const std::uint32_t count = k == 0 && round % 500 == 0 ? 255 : 4 + few;
            outlines.push_back(any_simple_polygon(random, count));
            for (const glm::dvec3 &p : outlines.back()) {
                text += 'v';
                for (int i = 0; i < 3; ++i)
                    append(text, p[i]);
                text += '\n';
            }
            is_backward.push_back(random.next_index(2) == 0);
            text += 'f';
            for (std::uint32_t i = 0; i < count; ++i)
                append(text, is_backward.back() ? first + count - 1 - i : first + i);
            text += '\n';
            first += count;
        }
        const ObjMesh mesh = mesh_of(text);
        ASSERT_EQ(mesh.vertices.size(), first - 1);
        std::size_t at = 0;
        first = 0;
        for (std::size_t k = 0; k < outlines.size(); ++k) {
            const std::vector<glm::dvec3> &outline = outlines[k];
            const glm::dvec3 whole = area_of(outline) * (is_backward[k] ? -1.0 : 1.0);
            double sum = 0;
            for (std::size_t i = 2; i < outline.size(); ++i, ++at) {
                ASSERT_LT(at, mesh.triangles.size());
                std::array<glm::dvec3, 3> corners{};
                for (std::size_t c = 0; c < 3; ++c)
                    corners[c] = outline.at(mesh.triangles[at][c] - first);
                const glm::dvec3 part =
                    0.5 * glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
                ASSERT_GT(glm::dot(part, whole), -1e-14) << "round " << round;
                sum += glm::length(part);
            }
            ASSERT_NEAR(sum, glm::length(whole), 1e-12 * double(outline.size()))
                << "round " << round;
            first += std::uint32_t(outline.size());
        }
        ASSERT_EQ(at, mesh.triangles.size());
    }
}

TEST(ObjFile, CornersInLineAndSlits) {
    // A corner in the middle of a side.
    EXPECT_EQ(mesh_of("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3 4\n").triangles.size(), 2U);
    // A square with a square hole, joined by a slit that uses two corners twice.
    const ObjMesh hole = mesh_of("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\n"
                                 "v 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\nf 1 2 3 4 1 5 6 7 8 5\n");
    double sum = 0;
    for (const auto &[a, b, c] : hole.triangles) {
        const double area = area_of({hole.vertices[a], hole.vertices[b], hole.vertices[c]}).z;
        EXPECT_GE(area, 0.0);
        sum += area;
    }
    EXPECT_EQ(sum, 12.0);
    // Zero area still gives the same number of triangles.
    EXPECT_EQ(mesh_of("v 0 0 0\nv 1 1 1\nv 2 2 2\nv 3 3 3\nf 1 2 3 4\n").triangles.size(), 2U);
    EXPECT_EQ(mesh_of("v 0 0 0\nv 1 1 1\nf 1 1 1\nf 1 2 2 1\n").triangles.size(), 3U);
    // Not planar.
    EXPECT_EQ(mesh_of("v 0 0 0\nv 1 0 1\nv 1 1 0\nv 0 1 1\nf 1 2 3 4\n").triangles.size(), 2U);
}

// --- What is refused.

TEST(ObjFile, OneMessageNamesTheLineTheFaultAndTheRemedy) {
    struct Case {
        std::string text;
        const char *message;
    };
    const std::string far = std::to_string(max_obj_polygon_corners);
    const std::vector<Case> cases{
        {"", "model.obj:0: the file has no faces; lines such as v 0 0 0 and f 1 2 3"},
        {square, "model.obj:4: the file has no faces; lines such as v 0 0 0 and f 1 2 3"},
        {square + "f 1 2 5\n", "model.obj:5: a face with vertex 5; the file has 4 vertices"},
        {square + "f 1 2 0\n",
         "model.obj:5: a face with vertex 0; the first vertex is 1, the last -1"},
        {square + "f 1 2 -5\n",
         "model.obj:5: a face with vertex -5; there are 4 vertices before this line"},
        {square + "\nf 1 2\n", "model.obj:6: a face with 2 corners; three or more"},
        {square + "f\n", "model.obj:5: a face with 0 corners; three or more"},
        {square + "f 1 2 x\n", "model.obj:5: not a corner of a face: 'x'; a vertex index, such "
                               "as 7, 7/1, 7//3, 7/1/3 or -1"},
        {square + "f 1 2 3/\n", "model.obj:5: not a corner of a face: '3/'; a vertex index, such "
                                "as 7, 7/1, 7//3, 7/1/3 or -1"},
        {square + "f 1 2 99999999999\n",
         "model.obj:5: not a corner of a face: '99999999999'; a vertex index, such as 7, 7/1, "
         "7//3, 7/1/3 or -1"},
        {"v 0 0\n", "model.obj:1: a vertex with fewer than three numbers; v x y z"},
        {"v 0 0 nan\n", "model.obj:1: a coordinate that is not finite or too large: 'nan'; "
                        "coordinates from -1e+08 to 1e+08"},
        {"v 0 -inf 0\n", "model.obj:1: a coordinate that is not finite or too large: '-inf'; "
                         "coordinates from -1e+08 to 1e+08"},
        {"v 0 1e9 0\n", "model.obj:1: a coordinate that is not finite or too large: '1e9'; "
                        "coordinates from -1e+08 to 1e+08"},
        {"v 0 1e999 0\n",
         "model.obj:1: a number out of the range of double: '1e999'; coordinates from "
         "-1e+08 to 1e+08"},
        {"v 0 one 0\n", "model.obj:1: not a number: 'one'; v x y z, such as v 0.5 -1 2e-3"},
        {"v 0 0,5 0\n", "model.obj:1: not a number: '0,5'; v x y z, such as v 0.5 -1 2e-3"},
        {"v 0 0x1 0\n", "model.obj:1: not a number: '0x1'; v x y z, such as v 0.5 -1 2e-3"},
        {square + "f 1 3 2 4\n",
         "model.obj:5: a face of 4 corners whose outline crosses or touches "
         "itself; split it into triangles"},
        {std::string("v 0 0 0\0", 8) + "\nf 1 2 3", "model.obj:1: a zero byte; a text file"},
        {"v 0 0 \x1b[31mred\n",
         "model.obj:1: not a number: '?[31mred'; v x y z, such as v 0.5 -1 2e-3"},
    };
    for (const Case &c : cases) {
        const ObjResult result = read(c.text);
        EXPECT_EQ(result.error, c.message);
        EXPECT_TRUE(result.mesh.vertices.empty());
        EXPECT_TRUE(result.mesh.triangles.empty());
    }
}

TEST(ObjFile, LimitsAreKept) {
    std::string face = "f";
    for (std::size_t i = 0; i <= max_obj_polygon_corners; ++i)
        face += " 1";
    EXPECT_NE(read(square + face).error.find("255 at most"), std::string::npos);
    EXPECT_NE(read("# " + std::string(max_obj_line_bytes, '-')).error.find("a line of"),
              std::string::npos);
    std::string many;
    for (std::size_t i = 0; i <= max_obj_vertices; ++i)
        many += "v 0 0 0\n";
    EXPECT_NE(read(many + "f 1 2 3").error.find("too many vertices"), std::string::npos);
    std::string large = "f 1 2 3\n";
    large += std::string(max_obj_bytes, '\n');
    EXPECT_NE(read(large).error.find("the file is too large"), std::string::npos);
    // An unreadable stream.
    std::istringstream broken("v 0 0 0");
    broken.setstate(std::ios::badbit);
    EXPECT_NE(read_obj(broken, "x").error.find("cannot be read"), std::string::npos);
}

// Valid files with bytes changed, cut and doubled: a mesh or one message, never a crash.
TEST(ObjFile, DamagedFiles) {
    Random random(3);
    const std::string good = "# cube\n" + square +
                             "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvn 0 0 1\nvt 0.5 0.5\ng side\n"
                             "f 1/1/1 2/1/1 3/1/1 4/1/1\nf 5//1 6//1 7//1 8//1\nf -8 -7 -3 -4\n"
                             "f 1 2 6 5\nf 3 4 8 7\nf 1 5 8 4 \n";
    const std::string bytes = "0123456789-+./eE vfn#\n\r\t\\\0x";
    int read_well = 0, refused = 0;
    for (int round = 0; round < trials(1'000'000); ++round) {
        std::string text = good;
        const std::uint32_t changes = 1 + random.next_index(4);
        for (std::uint32_t k = 0; k < changes; ++k) {
            const std::size_t at = random.next_index(std::uint32_t(text.size()));
            const std::size_t length = random.next_index(6);
            switch (random.next_index(4)) {
            case 0:
                text[at] = bytes[random.next_index(std::uint32_t(bytes.size()))];
                break;
            case 1:
                text.erase(at, length);
                break;
            case 2:
                text.insert(at, text.substr(random.next_index(std::uint32_t(text.size())), length));
                break;
            default:
                text[at] = char(random.next_index(256));
            }
        }
        const ObjResult result = read(text);
        (result.ok() ? read_well : refused)++;
        if (!result.ok()) {
            ASSERT_TRUE(result.error.starts_with("model.obj:")) << result.error;
            ASSERT_EQ(result.error.find('\n'), std::string::npos);
            ASSERT_NE(result.error.find("; "), std::string::npos);
            continue;
        }
        for (const auto &triangle : result.mesh.triangles)
            for (const std::uint32_t corner : triangle)
                ASSERT_LT(corner, result.mesh.vertices.size());
    }
    EXPECT_GT(read_well, trials(1'000'000) / 10);
    EXPECT_GT(refused, trials(1'000'000) / 10);
}

} // namespace
} // namespace plumb

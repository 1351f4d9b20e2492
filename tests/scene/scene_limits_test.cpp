// The limits of a scene, and the messages beyond them.
#include "tests/scene/scene_file_errors.h"
#include "tests/temporary_folder.h"

#include <filesystem>
#include <fstream>

namespace plumb {
namespace {

using namespace scene_file_errors;

std::string body(const std::string &name, const std::string &more) {
    return "[[body]]\nname = \"" + name + "\"\nshape = \"box\"\nhalf_extents = [0.5, 0.5, 0.5]\n" +
           more + "\n";
}

std::string line_of(int count, double step) {
    return "repeat = { kind = \"line\", count = " + std::to_string(count) + ", step = [" +
           std::to_string(step) + ", 0, 0] }";
}

std::string probe(int number, const std::string &asks) {
    return "[[probe]]\nname = @\"p" + std::to_string(number) + "\"\n" + asks + "\n";
}

std::string repeated(const std::string &text, const std::string &separator, int count) {
    std::string all;
    for (int i = 0; i < count; ++i)
        all += (i > 0 ? separator : "") + text;
    return all;
}

// The message points to the last mark; earlier marks are at probes that still fit.
void expect_only(std::string marked, const std::string &message) {
    while (marked.find('@') != marked.rfind('@'))
        marked.erase(marked.find('@'), 1);
    expect_messages({"", marked, {message}});
}

bool fine(const std::string &text) {
    const SceneFileResult result = parse_scene(text, "s.toml");
    for (const SceneMessage &message : result.messages)
        if (message.severity == SceneMessage::Severity::error)
            ADD_FAILURE() << format_message("s.toml", message);
    return result.ok();
}

// n bodies in one place are n (n - 1) / 2 pairs: 3 000 025 for 2450, and the 2450th is the first
// too many.
TEST(SceneLimits, BodiesInOnePlace) {
    EXPECT_TRUE(fine(body("heap", line_of(2449, 1e-4))));
    expect_messages(
        {"",
         body("first", "position = [1e6, 0, 0]") + "@" + body("heap", line_of(3000, 1e-4)),
         {"with \"heap_2449\" more than 3000000 pairs of bodies touch or overlap at the "
          "start; each pair takes memory: move the bodies apart (fast ones reach as far as "
          "they move in a step)"}});
    // Static ones too: they are checked once.
    EXPECT_FALSE(parse_scene(body("heap", "kind = \"static\"\n" + line_of(3000, 1e-4)), "s").ok());
}

TEST(SceneLimits, FastBodiesReachFar) {
    const std::string row = line_of(4000, 2);
    EXPECT_TRUE(fine(body("row", row)));
    EXPECT_FALSE(parse_scene(body("row", "velocity = [1e6, 0, 0]\n" + row), "s").ok());
    EXPECT_TRUE(fine("[world]\ndt = 1e-6\n" + body("row", "velocity = [1e6, 0, 0]\n" + row)));
}

TEST(SceneLimits, ASolidBlockOfBoxesAsLargeAsASceneMayBe) {
    EXPECT_TRUE(
        fine(body("block", "repeat = { kind = \"grid\", count = [58, 58, 59], spacing = [1, "
                           "1, 1] }")));
}

TEST(SceneLimits, Planes) {
    std::string planes;
    for (int i = 0; i < 100; ++i)
        planes += "[[body]]\nname = \"p" + std::to_string(i) + "\"\nshape = \"plane\"\n";
    EXPECT_TRUE(fine(planes + body("box", "position = [0, 0.5, 0]")));
    expect_messages({"",
                     planes + "@[[body]]\nname = \"p\"\nshape = \"plane\"\n",
                     {"too many planes; a scene holds at most 100"}});
    // Each pair of a plane and a body that reaches it counts.
    EXPECT_FALSE(parse_scene(planes + body("row", line_of(30'001, 2)), "s").ok());
    EXPECT_TRUE(fine(planes + body("row", "position = [0, 50, 0]\n" + line_of(30'001, 2))));
}

// A knot of detail 64 has 65 536 triangles; 61 knots have 3 997 696.
TEST(SceneLimits, TrianglesOfAllBodies) {
    const auto knots = [](const std::string &name, int count, int x) {
        return "[[body]]\nname = \"" + name +
               "\"\nshape = \"mesh\"\nmodel = \"knot\"\nhalf_extents = [1, 1, 1]\ndetail = 64\n"
               "position = [" +
               std::to_string(x) + ", 0, 0]\n" +
               (count > 1 ? "repeat = @{ kind = \"line\", count = " + std::to_string(count) +
                                ", step = [0, 3, 0] }\n"
                          : "");
    };
    std::string most = knots("knots", 61, 0);
    most.erase(most.find('@'), 1);
    EXPECT_TRUE(fine(most));
    const std::string suggestion = " here; a scene holds at most 4000000";
    expect_messages({"",
                     most + "@" + knots("knot", 1, 5),
                     {"too many surface triangles: 3997696 before this, and 65536" + suggestion}});
    expect_messages({"",
                     knots("knots", 2000, 0),
                     {"too many surface triangles: 0 before this, and 131072000" + suggestion}});
    // A field of 51 by 1001 heights has 50 000 squares.
    const std::string field = "shape = \"height_field\"\nhalf_extents = [1, 1, 20]\ndetail = 50\n";
    EXPECT_TRUE(fine("[[body]]\nname = \"hills\"\n" + field +
                     "repeat = { kind = \"line\", count = 40, step = [3, 0, 0] }\n"));
    EXPECT_FALSE(parse_scene("[[body]]\nname = \"hills\"\n" + field +
                                 "repeat = { kind = \"line\", count = 41, step = [3, 0, 0] }\n",
                             "s")
                     .ok());
}

TEST(SceneLimits, HeightsOfAHeightField) {
    const auto hills = [](const std::string &half_extents) {
        return "[[probe]]\nname = \"hills\"\nask = \"closest\"\npoints = [[0, 1, 0]]\n"
               "shapes = [{ shape = \"height_field\", half_extents = @" +
               half_extents + ", detail = 50 }]\n";
    };
    std::string most = hills("[1, 1, 20]");
    most.erase(most.find('@'), 1);
    EXPECT_TRUE(fine(most));
    const std::string suggestion = " heights; at most 1000000";
    const std::string title = "the height_field of [[probe]] \"hills\" would have ";
    expect_messages({"", hills("[1, 1, 400]"), {title + "1020051" + suggestion}});
    expect_messages({"", hills("[1, 1, 200000]"), {title + "510000051" + suggestion}});
    // More than an integer holds.
    expect_messages(
        {"", hills("[1e-9, 1, 1e9]"), {title + "2549999999999999475712.0" + suggestion}});
}

TEST(SceneLimits, ProbesTogether) {
    const std::string knot =
        "{ shape = \"mesh\", model = \"knot\", half_extents = [1, 1, 1], detail = 64 }";
    std::string meshes;
    for (int i = 0; i < 16; ++i)
        meshes += probe(i, "ask = \"closest\"\npoint = [0, 0, 0]\nshapes = [" + knot + "]");
    expect_only(meshes, "with [[probe]] \"p15\" the scene's probes have 1048576 triangles; all "
                        "probes of a scene have at most 1000000");

    std::string scatters;
    for (int i = 0; i < 11; ++i)
        scatters += probe(i, "ask = \"tree\"\ntree = \"bvh\"\nscatter = { count = 20000, "
                             "half_extents = [5, 5, 5] }");
    expect_only(scatters, "with [[probe]] \"p10\" the scene's probes have 220000 scattered items; "
                          "all probes of a scene have at most 200000");

    const std::string points = "points = [" + repeated("[9, 9, 9]", ", ", 2000) + "]\n";
    const std::string spheres =
        "shapes = [" + repeated("{ shape = \"sphere\", radius = 1 }", ", ", 300) + "]";
    expect_only(probe(0, "ask = \"contains\"\n" + points + spheres) +
                    probe(1, "ask = \"contains\"\n" + points + spheres),
                "with [[probe]] \"p1\" the scene's probes have 1200000 pairs to query (a shape "
                "and a point, or two shapes); all probes of a scene have at most 1000000");

    std::string circles;
    for (int i = 0; i < 51; ++i)
        circles += probe(i, "ask = \"contains\"\npoint = [0, 0]\nshapes = [" +
                                repeated("{ shape = \"circle\", radius = 1 }", ", ", 1000) + "]");
    expect_only(circles, "with [[probe]] \"p50\" the scene's probes have 51000 shapes; all probes "
                         "of a scene have at most 50000");
}

TEST(SceneLimits, OfManyMistakesTheFirstInTheFileAreListed) {
    std::string text = "[world]\n";
    for (int i = 0; i < 300; ++i)
        text += "mistake_" + std::to_string(i) + " = 1\n";
    // Read later, but first in the file.
    const SceneFileResult result = parse_scene("expect = 1\n" + text, "s.toml");
    ASSERT_EQ(result.messages.size(), max_listed_mistakes + 1);
    EXPECT_EQ(result.messages.front().line, 1U);
    for (std::size_t i = 1; i < max_listed_mistakes; ++i)
        EXPECT_EQ(result.messages[i].line, i + 2);
    EXPECT_EQ(format_message("s.toml", result.messages.back()), "s.toml: error: ... and 251 more");
}

TEST(SceneLimits, AFileHasALargestSize) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.write(
        "large.toml",
        "title = \"large\"\n[[body]]\nname = \"a\"\nshape = \"sphere\"\nradius = 1\n#");
    std::filesystem::resize_file(path, max_scene_file_bytes); // zeros are no TOML, but are read
    EXPECT_NE(load_scene(path).messages.at(0).line, 0U);
    std::filesystem::resize_file(path, max_scene_file_bytes + 1);
    const SceneFileResult result = load_scene(path);
    ASSERT_EQ(result.messages.size(), 1U);
    EXPECT_EQ(format_message("s.toml", result.messages[0]),
              "s.toml: error: the file is too large; a scene file has at most 64 MiB; `repeat` "
              "makes many bodies from a few lines");
}

} // namespace
} // namespace plumb

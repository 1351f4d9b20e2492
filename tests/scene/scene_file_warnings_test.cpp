// Which scene files give warnings, and which do not.
#include "engine/scene/scene_file.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

std::vector<std::string> warnings(const std::string &text) {
    const SceneFileResult result = parse_scene(text, "s.toml");
    std::vector<std::string> all;
    for (const SceneMessage &message : result.messages)
        all.push_back(format_message("s.toml", message));
    EXPECT_TRUE(result.ok());
    return all;
}

using None = std::vector<std::string>;

std::string body(const std::string &name, const std::string &rest) {
    return "[[body]]\nname = \"" + name + "\"\n" + rest + "\n";
}
const std::string sphere = "shape = \"sphere\"\nradius = 0.5\n";
const std::string box = "shape = \"box\"\nhalf_extents = [0.5, 0.5, 0.5]\n";
const std::string capsule = "shape = \"capsule\"\nhalf_height = 0.5\nradius = 0.5\n";
const std::string cylinder = "shape = \"cylinder\"\nhalf_height = 0.5\nradius = 0.5\n";
const std::string cube = "shape = \"hull\"\npoints = [[-0.5, -0.5, -0.5], [0.5, -0.5, -0.5], "
                         "[-0.5, 0.5, -0.5], [0.5, 0.5, -0.5], [-0.5, -0.5, 0.5], "
                         "[0.5, -0.5, 0.5], [-0.5, 0.5, 0.5], [0.5, 0.5, 0.5]]\n";

TEST(SceneWarnings, OverlapHasADepth) {
    // Spheres 1 m wide, 0.9 m apart; the second starts at line 6.
    const std::string text = body("a", sphere) + body("b", sphere + "position = [0.9, 0, 0]");
    EXPECT_EQ(warnings(text),
              (None{"s.toml:6:1: warning: \"a\" and \"b\" overlap by 0.1 m at the start; move them "
                    "apart, or they will be thrown apart"}));
}

TEST(SceneWarnings, OverlapOfEveryPairOfShapes) {
    const std::vector<std::string> shapes{sphere, box, capsule, cylinder, cube};
    const std::string ground = body("ground", "shape = \"plane\"");
    for (const std::string &first : shapes) {
        for (const std::string &second : shapes) {
            // All are 1 m wide in x: 0.98 m apart they overlap by 2 %, 0.995 m apart by 0.5 %.
            EXPECT_EQ(
                warnings(body("a", first) + body("b", second + "position = [0.98, 0, 0]")).size(),
                1U)
                << first << second;
            EXPECT_EQ(warnings(body("a", first) + body("b", second + "position = [0.995, 0, 0]")),
                      None{});
            EXPECT_EQ(warnings(body("a", first) + body("b", second + "position = [1.2, 0, 0]")),
                      None{});
        }
        EXPECT_EQ(warnings(ground + body("a", first + "position = [7, 0.3, 0]")).size(), 1U);
        EXPECT_EQ(warnings(body("a", first + "position = [7, 0.3, 0]") + ground).size(), 1U);
        EXPECT_EQ(warnings(ground + body("a", first + "position = [7, 1.01, 0]")), None{});
    }
}

// A dumbbell of two balls; the only shape between them is a sensor.
TEST(SceneWarnings, OverlapOfCompoundsIsThatOfTheirShapes) {
    const auto dumbbell = [](const std::string &ends) {
        return "shapes = [{ shape = \"sphere\", radius = 0.5, position = [-2, 0, 0]" + ends +
               " }, { shape = \"sphere\", radius = 0.5, position = [2, 0, 0]" + ends +
               " }, { shape = \"sphere\", radius = 0.5, sensor = true }]\n";
    };
    const std::string ball = body("ball", sphere);
    EXPECT_EQ(warnings(ball + body("a", dumbbell(""))), None{});
    EXPECT_EQ(warnings(ball + body("a", dumbbell("") + "position = [1.5, 0, 0]")).size(), 1U);
    EXPECT_EQ(warnings(ball + body("a", dumbbell(", ignores = [0]") + "position = [1.5, 0, 0]")),
              None{});
}

TEST(SceneWarnings, TouchingStacksAndTurnedBoxesAreFine) {
    const std::string ground = body("ground", "shape = \"plane\"");
    EXPECT_EQ(warnings(ground + body("a", box + "position = [0, 0.5, 0]\nrepeat = { kind = "
                                                "\"stack\", count = 20, turn_deg = 7 }")),
              None{});
    EXPECT_EQ(warnings(ground + body("a", box + "position = [0, 0.5, 0]\nrepeat = { kind = "
                                                "\"pyramid\", base = 12, spacing = [1.1, 1] }")),
              None{});
    // AABBs overlap but the boxes do not: corner to corner, turned by 45 degrees.
    EXPECT_EQ(warnings(body("a", box + "rotation_deg = [0, 45, 0]") +
                       body("b", box + "rotation_deg = [0, 45, 0]\nposition = [0.8, 0, 0.8]")),
              None{});
    // Far away, where float cannot resolve millimetres.
    EXPECT_EQ(warnings("[world]\nprecision = \"double\"\n" +
                       body("a", box + "position = [1e8, 0, 0]") +
                       body("b", box + "position = [100000001, 0, 0]")),
              None{});
}

TEST(SceneWarnings, FarAwayFloatIsTooCoarse) {
    const auto at = [](const std::string &x) {
        return body("near", sphere) + body("far", sphere + "position = [" + x + ", 0, 0]");
    };
    EXPECT_EQ(warnings(at("1e5")),
              (None{"s.toml:6:1: warning: \"far\" is 1e+05 m from the origin, where float "
                    "positions are 0.00781 m apart: too coarse to simulate its motion; "
                    "world.precision = \"double\", or move the scene closer to the origin"}));
    EXPECT_EQ(warnings(at("1000")), None{});
    EXPECT_EQ(warnings("[world]\nprecision = \"double\"\n" + at("1e5")), None{});
    // Small bodies suffer first, and one warning covers many.
    EXPECT_EQ(warnings(body("a", "shape = \"sphere\"\nradius = 0.005\nposition = [1000, 0, 0]\n"
                                 "repeat = { kind = \"line\", count = 30, step = [0.1, 0, 0] }"))
                  .size(),
              1U);
    EXPECT_EQ(warnings(body("a", sphere + "kind = \"static\"\nposition = [1e5, 0, 0]")), None{});
}

TEST(SceneWarnings, BodiesThatDoNotCollideMayOverlap) {
    const std::string a = body("a", sphere);
    const std::string b = body("b", sphere + "position = [0.5, 0, 0]");
    const std::string joint = "[[joint]]\nname = \"j\"\ntype = \"ball\"\nbody_a = \"a\"\n"
                              "body_b = \"b\"\nanchor = [0.25, 0, 0]\n";
    EXPECT_EQ(warnings(a + b + joint), None{});
    EXPECT_EQ(warnings(a + b + joint + "collide_connected = true\n").size(), 1U);
    EXPECT_EQ(warnings(a + b + joint + "broken = true\n").size(), 1U);
    // The ends of a row of rigid welds are one body, too.
    const auto row = [&](const std::string &key) {
        const auto weld = [](const std::string &from) {
            return "[[joint]]\nname = \"" + from + " to c\"\ntype = \"fixed\"\nbody_a = \"" + from +
                   "\"\nbody_b = \"c\"\nanchor = [0.25, 0, 0]\n";
        };
        const std::string c = body("c", sphere + "position = [0.25, 0, 0]");
        return warnings(a + b + c + weld("a") + weld("b") + key).size();
    };
    EXPECT_EQ(row(""), 0U);
    EXPECT_EQ(row("frequency = 5\n"), 1U);
    EXPECT_EQ(row("break_force = 10\n"), 1U);
    EXPECT_EQ(
        warnings(body("a", sphere + "kind = \"static\"") + body("b", sphere + "kind = \"static\"")),
        None{});
}

TEST(SceneWarnings, ManyOverlapsAreCountedTogether) {
    // 30 spheres overlap with their neighbours: 29 pairs, ten of them listed.
    const std::vector<std::string> all = warnings(
        body("a", sphere + "repeat = { kind = \"line\", count = 30, step = [0.9, 0, 0] }"));
    ASSERT_EQ(all.size(), 10U);
    int counted = 0;
    for (const std::string &message : all)
        counted += message.find("(and 19 more overlaps)") != std::string::npos;
    EXPECT_EQ(counted, 1);
}

TEST(SceneWarnings, MassRatio) {
    const auto pair = [](const std::string &mass, const std::string &x) {
        return body("a", sphere + "mass = 1") +
               body("b", sphere + "mass = " + mass + "\nposition = [" + x + ", 0, 0]");
    };
    EXPECT_EQ(
        warnings(pair("150", "1")),
        (None{"s.toml:6:1: warning: \"a\" and \"b\" touch, and their masses differ by a factor "
              "of 150; iterative solvers converge slowly above 100: make the masses more similar, "
              "or expect many iterations"}));
    EXPECT_EQ(warnings(pair("100", "1")), None{});
    EXPECT_EQ(warnings(pair("150", "2")), None{});
    const std::vector<std::string> joined =
        warnings(pair("150", "2") + "[[joint]]\nname = \"j\"\ntype = \"distance\"\n"
                                    "body_a = \"a\"\nbody_b = \"b\"\n");
    ASSERT_EQ(joined.size(), 1U);
    EXPECT_NE(joined[0].find("s.toml:12:1: warning: \"a\" and \"b\" are joined"), std::string::npos)
        << joined[0];
}

TEST(SceneWarnings, JointsThatMoveNothingOrJerk) {
    const std::string fixed = body("a", sphere + "kind = \"static\"");
    EXPECT_EQ(warnings(fixed + "[[joint]]\nname = \"j\"\ntype = \"ball\"\nbody_a = \"a\"\n"
                               "anchor = [0, 0, 0]\n"),
              (None{"s.toml:6:1: warning: joint \"j\" moves nothing: neither of its bodies is "
                    "dynamic"}));
    EXPECT_EQ(warnings(body("a", sphere) + "[[joint]]\nname = \"j\"\ntype = \"ball\"\n"
                                           "body_a = \"a\"\nanchor_a = [0, 0, 0]\n"
                                           "anchor_b = [0, 0.25, 0]\n"),
              (None{"s.toml:6:1: warning: the two anchors of ball joint \"j\" start 0.25 m apart; "
                    "they should coincide, or the first step will jerk them together"}));
}

TEST(SceneWarnings, AnchorsThatEachTypeKeepsTogether) {
    const auto joint = [&](const std::string &keys) {
        return warnings(body("a", sphere) +
                        "[[joint]]\nname = \"j\"\nbody_a = \"a\"\n"
                        "anchor_a = [0, 0, 0]\nanchor_b = [0, 0.25, 0]\n" +
                        keys);
    };
    EXPECT_EQ(joint("type = \"hinge\"\naxis = [0, 1, 0]\n").size(), 1U);
    EXPECT_EQ(joint("type = \"fixed\"\n").size(), 1U);
    EXPECT_EQ(joint("type = \"slider\"\naxis = [1, 0, 0]\n"),
              (None{"s.toml:6:1: warning: the two anchors of slider joint \"j\" start 0.25 m apart "
                    "across its axis; they should coincide, or the first step will jerk them "
                    "together"}));
    EXPECT_EQ(joint("type = \"slider\"\naxis = [0, 1, 0]\n"), None{}); // allowed along its axis
    EXPECT_EQ(joint("type = \"ball\"\nfrequency = 2\n"), None{});      // a stretched spring
    EXPECT_EQ(joint("type = \"distance\"\n"), None{});
}

TEST(SceneWarnings, StepTooLong) {
    // 0.5 m wide at 200 m/s: 1/400 s at most; here 2 m a step.
    EXPECT_EQ(
        warnings("[world]\ndt = 0.01\n" +
                 body("a", "shape = \"sphere\"\nradius = 0.25\nvelocity = [0, 0, 200]")),
        (None{"s.toml:3:1: warning: \"a\" moves 2 m in one step, more than its width of 0.5 m, "
              "and may pass through others (|v| dt > width); world.dt up to 0.0025"}));
    EXPECT_EQ(
        warnings("[world]\ndt = 0.01\n" + body("a", sphere + "angular_velocity = [0, 400, 0]")),
        (None{"s.toml:3:1: warning: \"a\" turns by 4 rad in one step, more than half a "
              "revolution (|w| dt > pi); world.dt up to 0.00785"}));
    // g dt^2 = 10 * 0.01 = 0.1 m, half the width 0.05 m: up to sqrt(0.05 / 10) = 0.0707 s.
    EXPECT_EQ(warnings("[world]\ngravity = [0, -10, 0]\ndt = 0.1\n" +
                       body("a", "shape = \"sphere\"\nradius = 0.05")),
              (None{"s.toml:3:6: warning: a body falls 0.1 m in its first step, more than half the "
                    "width of \"a\" (g dt^2 > width / 2); dt up to 0.0707"}));
    // omega = sqrt(10 / 0.001) = 100 rad/s: 2/100 s at most, and dt / 2 substeps = 0.025 s.
    const std::string rod = body("a", sphere) + "[[joint]]\nname = \"j\"\ntype = \"distance\"\n"
                                                "body_a = \"a\"\nanchor_b = [0, 0.001, 0]\n";
    EXPECT_EQ(
        warnings("[world]\ngravity = [0, -10, 0]\ndt = 0.05\nsubsteps = 2\n" + rod),
        (None{"s.toml:10:1: warning: a pendulum on \"j\" has omega = sqrt(g / length) = 100 rad/s, "
              "and omega h = 2.5 > 2 is unstable (h = dt / substeps); a step h up to 0.02"}));
    EXPECT_EQ(warnings("[world]\ngravity = [0, -10, 0]\ndt = 0.05\nsubsteps = 3\n" + rod), None{});
}

} // namespace
} // namespace plumb

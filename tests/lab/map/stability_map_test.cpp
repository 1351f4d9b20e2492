// Maps on grids small enough to know what the result must be.
#include "app/lab/map/stability_map.h"
#include "tests/lab/falling_ball.h"

#include "app/lab/map/map_resume.h"
#include "app/lab/map/theory.h"
#include "tests/lab/csv_reader.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// Starts at rest before a wall, and is struck by a body ten times as heavy that touches it. It
// leaves at 10/11 of the striker's speed, 0.3 m from the middle of the wall; half the wall's
// thickness and half its own size add up to 0.15 m.
constexpr const char *struck = R"(
title = "Struck"
[world]
gravity = [0, 0, 0]
[[material]]
name = "steel"
friction = 0
[[body]]
name = "wall"
shape = "box"
kind = "static"
half_extents = [0.05, 2, 2]
material = "steel"
[[body]]
name = "resting"
shape = "sphere"
radius = 0.1
mass = 1
material = "steel"
position = [-0.3, 0, 0]
[[body]]
name = "heavy"
shape = "sphere"
radius = 0.1
mass = 10
material = "steel"
position = [-0.5, 0, 0]
velocity = [20, 0, 0]
)";

StabilityMap map_of(const char *text, const char *x, const char *y,
                    const std::vector<std::string> &methods, TaskPool *tasks = nullptr,
                    std::optional<double> duration = {}) {
    MapOptions options;
    options.methods = methods;
    options.tasks = tasks;
    options.duration = duration;
    return map_scene({"scene.toml", text}, parse_map_axis(x), parse_map_axis(y), options);
}

std::string complaint(const char *text, const char *x, const char *y) {
    try {
        (void)map_of(text, x, y, {"soft_step"});
    } catch (const std::invalid_argument &error) {
        return error.what();
    }
    return "";
}

std::string csv_of(const StabilityMap &map) {
    std::ostringstream csv;
    write_map_csv(csv, map);
    return csv.str();
}

// v dt = thickness + size, with v = 10/11 of the striker's speed.
double theory_dt(double speed) {
    return (0.1 + 0.2) / (speed * 10 / 11);
}

TEST(StabilityMap, WhatIsStruckPassesAWallWhereTheoryHasItUnlessTheMethodLooksAhead) {
    const StabilityMap map =
        map_of(struck, "dt=0.005..0.08:9log", "body.heavy.velocity.x=6,12,24",
               {"soft_step", "tgs_soft", "sequential_impulses", "naive_impulses"}, nullptr, 0.5);
    ASSERT_EQ(map.methods.size(), 4U);
    for (const MethodMap &of_method : map.methods) {
        if (of_method.method->name == "naive_impulses") {
            // It ignores approaching bodies, and this is not its limit.
            ASSERT_FALSE(of_method.limits.empty());
            EXPECT_LT(of_method.limits.front().high, 0.6 * theory_dt(of_method.limits.front().y));
            continue;
        }
        const bool looks = of_method.method->looks_ahead;
        EXPECT_EQ(looks, of_method.method->name == "soft_step");
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t column = 0; column < 9; ++column) {
                const double dt = map.x.values[column];
                // Within a cell of the limit either result will do.
                if (!looks && std::abs(std::log2(dt / theory_dt(map.y.values[row]))) <= 0.5)
                    continue;
                const bool passes = !looks && dt > theory_dt(map.y.values[row]);
                const RunFailing &failing = map.cell(of_method, column, row)->failing;
                EXPECT_EQ(failing.failing, passes ? Failing::passed_through : Failing::none)
                    << of_method.method->name << " v=" << map.y.values[row] << " dt=" << dt << ": "
                    << info_of(failing.failing).name << " " << failing.what;
                if (passes) {
                    EXPECT_EQ(failing.what, "resting through wall");
                }
            }
        if (looks) {
            EXPECT_TRUE(of_method.limits.empty());
            continue;
        }
        ASSERT_EQ(of_method.limits.size(), 3U) << of_method.method->name;
        for (const MapLimit &limit : of_method.limits) {
            EXPECT_TRUE(limit.held_below);
            EXPECT_EQ(limit.failing.failing, Failing::passed_through);
            EXPECT_LE(limit.high - limit.low, 0.0025 * limit.high);
            EXPECT_GT(limit.high - limit.low, 0.5 * 0.0025 * limit.low) << "and no more runs";
            const double found = between(map.x, limit.low, limit.high);
            EXPECT_LE(std::abs(std::log2(found / theory_dt(limit.y))), 0.5)
                << of_method.method->name << " v=" << limit.y;
        }
    }
}

// The deviation within that cell is the striker's: it pushes on until the solver converges.
TEST(StabilityMap, AConvergedMethodPassesAWallJustWhereTheoryHasIt) {
    MapOptions options;
    options.methods = {"sequential_impulses"};
    options.duration = 0.5;
    options.base.settings = parse_setting("substeps=4");
    options.base.settings.give(parse_setting("iterations=50"));
    const StabilityMap map = map_scene({"scene.toml", struck}, parse_map_axis("dt=0.01..0.08:4log"),
                                       parse_map_axis("body.heavy.velocity.x=6,12"), options);
    ASSERT_EQ(map.methods[0].limits.size(), 2U);
    for (const MapLimit &limit : map.methods[0].limits) {
        EXPECT_EQ(limit.failing.failing, Failing::passed_through);
        EXPECT_NEAR(between(map.x, limit.low, limit.high) / theory_dt(limit.y), 1, 0.01);
    }
}

TEST(StabilityMap, TheoryIsReadFromTheScene) {
    const StabilityMap map = map_of(struck, "dt=0.01,0.02", "body.heavy.velocity.x=6,12",
                                    {"soft_step", "tgs_soft", "naive_impulses"}, nullptr, 0.1);
    const std::vector<TheoryCurve> curves = theory_of(map);
    ASSERT_EQ(curves.size(), 1U);
    ASSERT_EQ(curves[0].methods.size(), 1U);
    EXPECT_EQ(curves[0].methods[0]->name, "tgs_soft");
    for (const glm::dvec2 &point : curves[0].points)
        EXPECT_NEAR(point.x, theory_dt(point.y), 1e-12);
    // Neither for a body that strikes nothing, nor without a wall to pass through.
    EXPECT_FALSE(struck_before_wall(map.scene, "resting", 0));
    EXPECT_FALSE(struck_before_wall(map.scene, "heavy", 1));
    SceneDesc open = map.scene;
    open.bodies.erase(open.bodies.begin());
    EXPECT_FALSE(struck_before_wall(open, "heavy", 0));
    EXPECT_TRUE(struck_before_wall(map.scene, "heavy", 0));
}

// A column that leans slightly, under slightly tilted gravity, stays that way or buckles.
TEST(StabilityMap, AColumnOfCubesBucklesWhereGreenhillHasIt) {
    constexpr const char *column = R"(
[world]
gravity = [1e-3, -9.81, 0]
[[body]]
name = "ground"
shape = "plane"
[[body]]
name = "box"
shape = "box"
half_extents = [0.5, 0.5, 0.5]
position = [0, 0.5, 0]
repeat = { kind = "stack", count = 8 }
[[expect]]
name = "nothing falls"
quantity = "kinetic_energy"
reduce = "max"
from = 2
to = 20
at_most = 1000
source = "it stands"
)";
    MapOptions options;
    options.methods = {"soft_step", "tgs_soft"};
    options.base.precision = Precision::f64;
    for (const char *setting : {"substeps=2", "max_substeps=1", "sleep_after=0", "kept_travel=0"})
        options.base.settings.give(parse_setting(setting));
    const StabilityMap map =
        map_scene({"scene.toml", column}, parse_map_axis("dt=1/240..1/15:17log"),
                  parse_map_axis("body.box.repeat.count=8,12,16"), options);
    EXPECT_EQ(theory_of(map, options.base).size(), 2U);
    const double cell = std::pow(16, 1.0 / 16);
    for (const MethodMap &of_method : map.methods) {
        RunOptions run = options.base;
        run.method = std::string(of_method.method->name);
        run.settings.give(&StepSettings::dt, 1.0 / 60);
        const double highest = highest_column(resolve_run(map.scene, run), 1).value_or(0);
        EXPECT_NEAR(highest, of_method.method->name == "soft_step" ? 12.11 : 9.61, 0.01);
        EXPECT_EQ(of_method.limits.size(), 3U) << of_method.method->name;
        for (const MapLimit &limit : of_method.limits) {
            const double dt = std::pow(highest / limit.y, 1.5) / 60;
            EXPECT_LT(std::abs(std::log(between(map.x, limit.low, limit.high) / dt)),
                      std::log(cell))
                << of_method.method->name << ' ' << limit.y << ": " << limit.low << " .. "
                << limit.high << ", not " << dt;
        }
    }
    options.base.settings.give(parse_setting("kept_travel=0.005"));
    EXPECT_EQ(theory_of(map, options.base).size(), 1U); // TGS Soft's, which keeps no travel
}

// Lanes whose balls start an eighth of that distance apart: above 9/8 of the limit at least one
// goes undetected, below the limit none passes.
TEST(StabilityMap, WhatIsThrownPassesAWallWhereTheoryHasIt) {
    constexpr const char *thrown = R"(
[world]
gravity = [0, 0, 0]
[[material]]
name = "steel"
friction = 0
[[body]]
name = "wall"
shape = "box"
kind = "static"
half_extents = [0.05, 2, 8]
material = "steel"
[[body]]
name = "ball"
shape = "sphere"
radius = 0.1
material = "steel"
position = [-1, 0, -4]
velocity = [10, 0, 0]
repeat = { kind = "line", count = 11, step = [-0.01875, 0, 0.8] }
)";
    const StabilityMap map = map_of(thrown, "dt=0.002..0.064:11log", "body.ball.velocity.x=10,20",
                                    {"naive_impulses", "tgs_soft"}, nullptr, 0.5);
    const std::vector<TheoryCurve> curves = theory_of(map);
    ASSERT_EQ(curves.size(), 1U);
    ASSERT_EQ(curves[0].methods.size(), 1U);
    EXPECT_EQ(curves[0].methods[0]->name, "naive_impulses");
    for (const glm::dvec2 &point : curves[0].points)
        EXPECT_NEAR(point.x * point.y, 0.15, 1e-12);
    for (const MethodMap &of_method : map.methods) {
        if (of_method.method->name != "naive_impulses") {
            EXPECT_TRUE(of_method.limits.empty());
            continue;
        }
        ASSERT_EQ(of_method.limits.size(), 2U);
        for (const MapLimit &limit : of_method.limits) {
            EXPECT_TRUE(limit.held_below);
            EXPECT_EQ(limit.failing.failing, Failing::passed_through);
            const double found = limit.y * between(map.x, limit.low, limit.high);
            EXPECT_GT(found, 0.99 * 0.15);
            EXPECT_LT(found, 1.02 * 9 / 8 * 0.15);
        }
    }
    // Neither from inside the wall, nor towards another body.
    EXPECT_TRUE(way_into_wall(map.scene, "ball", 0));
    EXPECT_FALSE(way_into_wall(map.scene, "ball", 1));
    SceneDesc within = map.scene;
    within.bodies.at(1).position.x = 0;
    EXPECT_FALSE(way_into_wall(within, "ball", 0));
    SceneDesc other = map.scene;
    other.bodies.at(1).name = "stone";
    EXPECT_FALSE(way_into_wall(other, "ball", 0));
}

// Semi-implicit Euler falls g t (t + h) / 2, with h the substep. It reaches 5.085 m, the least
// within tolerance, when 1 + h = 2 (10 - 5.085) / g. RK4 makes no error in free fall.
TEST(StabilityMap, FindsTheStepUpToWhichAnIntegratorIsTrueEnough) {
    const StabilityMap map = map_of(falling_ball, "dt=1/2000..1/25:5log", "substeps=1,2",
                                    {"semi_implicit_euler", "rk4"});
    ASSERT_EQ(map.methods.size(), 2U);
    for (const MethodMap &of_method : map.methods) {
        const bool is_first_order = of_method.method->name == "semi_implicit_euler";
        EXPECT_EQ(of_method.limits.size(), is_first_order ? 2U : 0U);
        for (const MapLimit &limit : of_method.limits) {
            EXPECT_EQ(limit.failing.failing, Failing::missed);
            EXPECT_EQ(limit.failing.what, "height");
            EXPECT_NEAR(between(map.x, limit.low, limit.high) / limit.y,
                        2 * (10 - 5.085) / 9.81 - 1, 0.003 * limit.low / limit.y);
        }
    }
}

TEST(StabilityMap, NarrowsALimitDownHoweverCoarseTheGrid) {
    const StabilityMap map =
        map_of(falling_ball, "dt=1/2000,1/25", "substeps=1,2", {"semi_implicit_euler"});
    ASSERT_EQ(map.methods[0].limits.size(), 2U);
    for (const MapLimit &limit : map.methods[0].limits) {
        EXPECT_LE(limit.high - limit.low, 0.0025 * limit.high);
        EXPECT_NEAR(between(map.x, limit.low, limit.high) / limit.y, 2 * (10 - 5.085) / 9.81 - 1,
                    0.003 * limit.low / limit.y);
    }
    // Around 0 no fraction of the value is small enough; the axis's own resolution is.
    const MapAxis around_zero = parse_map_axis("gravity.y=-10..10:2");
    EXPECT_EQ(runs_to_limit(around_zero, -10, 10), 24);
    EXPECT_EQ(runs_to_limit(parse_map_axis("dt=0.01..0.1:4log"), 0.01, 0.0215443), 9);
    EXPECT_EQ(runs_to_limit(parse_map_axis("dt=0.01..0.0101:3log"), 0.01, 0.01005), 5);
    EXPECT_EQ(runs_to_limit(parse_map_axis("substeps=1..9:2"), 1, 9), 3);
}

TEST(StabilityMap, IsTheSameForAnyNumberOfThreads) {
    TaskPool tasks(3);
    const auto map = [&](TaskPool *pool) {
        return csv_of(map_of(struck, "dt=0.005..0.08:4log", "body.heavy.velocity.x=6,24",
                             {"tgs_soft", "soft_step"}, pool, 0.3));
    };
    const std::string one = map(nullptr);
    EXPECT_EQ(one, map(&tasks));
    const auto rows = read_csv(one);
    EXPECT_EQ(rows[0][2], "dt");
    EXPECT_EQ(rows[0][3], "body.heavy.velocity.x");
    for (const char *column : {"substeps", "iterations", "precision", "machine", "commit", "run"})
        EXPECT_NE(std::ranges::find(rows[0], column), rows[0].end()) << column;
    std::size_t cells = 0;
    for (const auto &row : rows)
        cells += row[0] == "cell" ? 1U : 0U;
    EXPECT_EQ(cells, 2U * 8);
    EXPECT_GT(rows.size(), 1 + cells) << "and limits";
    for (const auto &row : rows)
        EXPECT_EQ(row.size(), rows[0].size());
}

TEST(StabilityMap, OfACountGoesThroughWholeNumbers) {
    const std::string stack = std::string(falling_ball) + R"(
[[body]]
name = "box"
shape = "box"
half_extents = [0.5, 0.5, 0.5]
position = [20, 0.5, 0]
repeat = { kind = "stack", count = 2 }
)";
    const StabilityMap map =
        map_of(stack.c_str(), "body.box.repeat.count=1..3:6", "dt=0.1,0.2", {"rk4", "tgs_soft"});
    EXPECT_EQ(map.x.values, (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(map.methods.size(), 1U);
    EXPECT_EQ(map.left_out.size(), 1U); // rk4 has no contacts
}

TEST(StabilityMap, OfACountLeavesOutWhatIsExpectedOfACopyThatIsNotThere) {
    const std::string stack = R"(
[[body]]
name = "ground"
shape = "plane"
[[body]]
name = "box"
shape = "box"
half_extents = [0.5, 0.5, 0.5]
position = [0, 0.5, 0]
repeat = { kind = "stack", count = 3 }
[[expect]]
name = "stays"
quantity = "displacement"
body = "box_2"
reduce = "max"
to = 0.2
at_most = 0.05
source = "statics"
)";
    const std::string with_another = stack + R"(
[[expect]]
name = "solid"
quantity = "penetration"
reduce = "max"
to = 0.2
at_most = 0.05
source = "rigid"
)";
    const StabilityMap map =
        map_of(with_another.c_str(), "dt=1/120,1/60", "body.box.repeat.count=2,4", {"soft_step"});
    ASSERT_EQ(map.unjudged.size(), 1U);
    EXPECT_NE(map.unjudged[0].find("\"stays\""), std::string::npos);
    EXPECT_NE(map.unjudged[0].find("count = 2,"), std::string::npos);
    for (const auto &cell : map.methods[0].cells)
        EXPECT_EQ(cell->failing.failing, Failing::none) << cell->failing.what;
    std::ostringstream text;
    print(text, map);
    EXPECT_NE(text.str().find(map.unjudged[0]), std::string::npos);
    // With no other expectation there is nothing to judge it by.
    EXPECT_NE(complaint(stack.c_str(), "dt=1/120,1/60", "body.box.repeat.count=2,4")
                  .find("no expectation is left"),
              std::string::npos);
}

TEST(StabilityMap, SaysWhatIsWrongWithAnAxis) {
    EXPECT_NE(complaint(falling_ball, "body.bal.mass=1..2", "dt=0.1,0.2").find("\"ball\"?"),
              std::string::npos);
    EXPECT_NE(complaint(falling_ball, "body.ball.radius=-1..2", "dt=0.1,0.2").find("radius"),
              std::string::npos);
    for (const auto &[x, y] : {std::pair{"dt=0.1,0.2", "body.ball.mas=1..2:2"},
                               std::pair{"body.ball.mas=1..2:2", "dt=0.1,0.2"}}) {
        const std::string mass = complaint(falling_ball, x, y);
        EXPECT_EQ(mass.rfind("with body.ball.mas=1: ", 0), 0U) << mass;
    }
    EXPECT_NE(complaint(falling_ball, "body.ball.rdius=1..2", "dt=0.1,0.2").find("\"radius\"?"),
              std::string::npos);
    EXPECT_NE(complaint(falling_ball, "world.substeps=1..2", "dt=0.1,0.2").find("write substeps"),
              std::string::npos);
    EXPECT_NE(complaint(falling_ball, "dt=0.1,0.2", "dt=0.1,0.2").find("both axes"),
              std::string::npos);
    const std::string two = std::string(falling_ball) + "[[body]]\nname = \"other\"\n"
                                                        "shape = \"sphere\"\nradius = 0.5\n";
    try {
        (void)map_of(two.c_str(), "dt=0.1,0.2", "substeps=1,2", {"rk4"});
        ADD_FAILURE();
    } catch (const std::invalid_argument &error) {
        const std::string why = error.what();
        EXPECT_EQ(why.rfind("no method can run this scene: rk4 ", 0), 0U) << why;
        EXPECT_NE(why.find("contacts"), std::string::npos) << why;
    }
    MapOptions options;
    options.duration = 3;
    EXPECT_THROW((void)map_scene({"scene.toml", falling_ball}, parse_map_axis("dt=0.1,0.2"),
                                 parse_map_axis("substeps=1,2"), options),
                 std::invalid_argument);
}

// A map resumed from any of its first rows gives the same table.
TEST(StabilityMap, GoesOnFromWhatIsLeftOfIt) {
    const SceneText scene{"scene.toml", struck};
    const MapAxis x = parse_map_axis("dt=0.005..0.08:4log"),
                  y = parse_map_axis("body.heavy.velocity.x=6,24");
    MapOptions options;
    options.methods = {"tgs_soft"};
    options.duration = 0.3;
    const auto run = [&] {
        StabilityMap map = map_scene(scene, x, y, options);
        map.fingerprint = map_fingerprint(scene, x, y, options);
        return csv_of(map);
    };
    const std::string whole = run();
    for (const std::size_t length : {whole.size() / 2, whole.size() - 5, whole.size()}) {
        std::istringstream partial(whole.substr(0, length));
        options.known = read_map_csv(partial, map_fingerprint(scene, x, y, options));
        EXPECT_GT(options.known.cells.size(), 2U);
        EXPECT_EQ(run(), whole) << length;
    }
    // Known cells are not run again: even a false row stays as it is.
    for (auto &[place, known] : options.known.cells)
        known.failing = {Failing::drift, "a \"chain\", torn"};
    options.known.limits.clear();
    const std::string told = run();
    EXPECT_EQ(read_csv(told).size(), 1U + 8);
    std::istringstream back(told);
    const KnownRows again = read_map_csv(back, map_fingerprint(scene, x, y, options));
    EXPECT_EQ(again.cells.begin()->second.failing.what, "a \"chain\", torn");
}

TEST(StabilityMap, GoesOnFromNothingElse) {
    const SceneText scene{"scene.toml", struck};
    const MapAxis x = parse_map_axis("dt=0.01,0.02"), y = parse_map_axis("substeps=1,2");
    const MapOptions options;
    const std::string own = map_fingerprint(scene, x, y, options);
    EXPECT_EQ(own, map_fingerprint(scene, x, y, options));
    MapOptions longer = options;
    longer.duration = 2;
    MapOptions other = options;
    other.base.settings = parse_setting("iterations=2");
    EXPECT_NE(own, map_fingerprint(scene, x, y, longer));
    EXPECT_NE(own, map_fingerprint(scene, x, y, other));
    EXPECT_NE(own, map_fingerprint(scene, y, x, options));
    EXPECT_NE(own, map_fingerprint({"scene.toml", falling_ball}, x, y, options));
}

TEST(StabilityMap, StopsWhenToldAndKeepsWhatWasDone) {
    MapOptions options;
    options.methods = {"rk4"};
    int asked = 0;
    options.stop = [&] { return ++asked > 40; };
    const StabilityMap map = map_scene({"scene.toml", falling_ball}, parse_map_axis("dt=0.05,0.1"),
                                       parse_map_axis("substeps=1,2,4,8"), options);
    EXPECT_TRUE(map.interrupted);
    EXPECT_TRUE(map.methods[0].cells.front());
    EXPECT_FALSE(map.methods[0].cells.back());
    std::ostringstream text;
    print(text, map);
    EXPECT_NE(text.str().find("interrupted"), std::string::npos);
}

} // namespace
} // namespace plumb

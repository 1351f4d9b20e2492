// Maps on grids small enough to know what the result must be.
#include "app/lab/map/stability_map.h"

#include "app/lab/map/map_resume.h"
#include "app/lab/map/theory.h"
#include "tests/lab/csv_reader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
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

// Falls from rest for a second: 5.095 m by s = g t^2 / 2, whatever the step.
constexpr const char *falling_ball = R"(
[world]
dt = "1/60"
[[body]]
name = "ball"
shape = "sphere"
radius = 0.5
position = [0, 10, 0]
velocity = [0, 0, 0]
[[expect]]
name = "height"
quantity = "position.y"
body = "ball"
to = 1
equals = 5.095
tolerance = 0.01
source = "s = g t^2 / 2"
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
            // A cell is a factor of sqrt(2), cut into 32 parts.
            EXPECT_NEAR(std::log2(limit.high / limit.low), 0.5 / 32, 1e-9);
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
        // A cell is a factor of 2, cut into 32 parts.
        EXPECT_NEAR(between(map.x, limit.low, limit.high) / theory_dt(limit.y), 1, 0.02);
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

// An oscillator of angular frequency omega, released at rest: explicit methods are stable up to
// omega h = 2, RK4 up to 2 sqrt(2).
TEST(StabilityMap, ASpringIsThrownWhereTheoryHasIt) {
    constexpr const char *spring = R"(
[world]
gravity = [0, 0, 0]
[[particle]]
name = "bob"
position = [0, -1.05, 0]
[[spring]]
name = "coil"
b = "bob"
anchor_a = [0, 0, 0]
rest_length = 1
frequency = 1
[[expect]]
name = "bounded"
quantity = "energy_error"
reduce = "max"
to = 10
at_most = 300
source = "linear stability"
)";
    for (const int substeps : {1, 3}) {
        MapOptions options;
        options.methods = {"soft_step", "semi_implicit_euler", "stormer_verlet", "velocity_verlet",
                           "rk4",       "backward_euler",      "explicit_euler"};
        options.base.settings = parse_setting("substeps=" + std::to_string(substeps));
        const StabilityMap map =
            map_scene({"scene.toml", spring}, parse_map_axis("dt=1/60..1/4:17log"),
                      parse_map_axis("spring.coil.frequency=4,8"), options);
        std::map<const MethodInfo *, std::vector<glm::dvec2>> theory;
        for (const TheoryCurve &curve : theory_of(map, options.base))
            for (const MethodInfo *method : curve.methods)
                theory[method] = curve.points;
        EXPECT_EQ(theory.size(), 5U);
        for (const MethodMap &of_method : map.methods) {
            if (of_method.method->name == "explicit_euler") {
                EXPECT_TRUE(theory[of_method.method].empty()) << "stable at no step";
                for (const auto &cell : of_method.cells)
                    EXPECT_NE(cell->failing.failing, Failing::none);
                continue;
            }
            if (!theory.contains(of_method.method)) {
                EXPECT_TRUE(of_method.limits.empty()) << of_method.method->name;
                continue;
            }
            const double limit = of_method.method->name == "rk4" ? std::sqrt(8.0) : 2;
            for (const glm::dvec2 &point : theory[of_method.method])
                EXPECT_NEAR(2 * std::numbers::pi * point.y * point.x, limit * substeps, 1e-12);
            for (const MapLimit &found : of_method.limits)
                // A cell is a factor of 15^(1/16), cut into 32 parts.
                EXPECT_NEAR(2 * std::numbers::pi * found.y * between(map.x, found.low, found.high),
                            limit * substeps, 0.01 * limit * substeps)
                    << of_method.method->name;
            EXPECT_FALSE(of_method.limits.empty());
        }
    }
}

// The same limits over the stiffness k = m omega^2 of a spring that holds a particle; one that
// holds a body might hold it off its centre.
TEST(StabilityMap, AStiffSpringIsThrownWhereTheoryHasIt) {
    const auto spring = [](const char *what) {
        return std::string("[world]\ngravity = [0, 0, 0]\n[[") + what + R"(]]
name = "bob"
position = [0, -1.05, 0]
mass = 3
[[spring]]
name = "coil"
b = "bob"
anchor_a = [0, 0, 0]
rest_length = 1
stiffness = 100
[[expect]]
name = "bounded"
quantity = "energy_error"
reduce = "max"
to = 10
at_most = 300
source = "linear stability"
)";
    };
    MapOptions options;
    options.methods = {"semi_implicit_euler", "rk4"};
    const StabilityMap map =
        map_scene({"scene.toml", spring("particle")}, parse_map_axis("dt=1/60..1/4:9log"),
                  parse_map_axis("spring.coil.stiffness=2000,6000"), options);
    const std::vector<TheoryCurve> curves = theory_of(map, options.base);
    ASSERT_EQ(curves.size(), 2U);
    for (const TheoryCurve &curve : curves) {
        const double limit = curve.methods.front()->name == "rk4" ? std::sqrt(8.0) : 2;
        for (const glm::dvec2 &point : curve.points)
            EXPECT_NEAR(std::sqrt(point.y / 3) * point.x, limit, 1e-12);
        const auto found =
            std::ranges::find(map.methods, curve.methods.front(), &MethodMap::method);
        EXPECT_EQ(found->limits.size(), 2U);
        for (const MapLimit &each : found->limits)
            // A cell is a factor of 15^(1/8), cut into 32 parts.
            EXPECT_NEAR(std::sqrt(each.y / 3) * between(map.x, each.low, each.high), limit,
                        0.02 * limit);
    }
    std::string ball = spring("body");
    ball.insert(ball.find("mass"), "shape = \"sphere\"\nradius = 0.1\n");
    const StabilityMap of_body =
        map_scene({"scene.toml", ball}, parse_map_axis("dt=1/60,1/30"),
                  parse_map_axis("spring.coil.stiffness=2000,6000"), options);
    EXPECT_TRUE(theory_of(of_body).empty());
}

TEST(StabilityMap, ASpringWithDampingOrANeighbourHasNoTheory) {
    SceneDesc scene;
    SpringDesc &spring = scene.springs.emplace_back();
    spring.name = "coil";
    spring.b = "bob";
    EXPECT_TRUE(swings_by_itself(scene, "coil"));
    EXPECT_FALSE(swings_by_itself(scene, "other"));
    spring.damping = 1;
    EXPECT_FALSE(swings_by_itself(scene, "coil"));
    spring.damping = 0;
    spring.a = "bib";
    EXPECT_FALSE(swings_by_itself(scene, "coil"));
    spring.a = "";
    scene.springs.resize(2);
    EXPECT_FALSE(swings_by_itself(scene, "coil"));
}

// Watched for that many seconds; omega = 10.
std::string damped_spring(int seconds) {
    return R"(
[world]
gravity = [0, 0, 0]
[[particle]]
name = "bob"
mass = 2
position = [0, -1.001, 0]
[[spring]]
name = "coil"
b = "bob"
anchor_a = [0, 0, 0]
rest_length = 1
stiffness = 200
damping = 0
[[expect]]
name = "bounded"
quantity = "energy_error"
reduce = "max"
to = )" + std::to_string(seconds) +
           R"(
at_most = 300
source = "linear stability"
)";
}

// For the spring x'' = -omega^2 x - (c / m) x', the longest stable step is where an eigenvalue of
// the step leaves the unit circle.
TEST(StabilityMap, ADampedSpringIsThrownWhereTheoryHasIt) {
    const std::string spring = damped_spring(20);
    // omega = 10, rates of 40 and 80: overdamped, the faster decays at 20 + sqrt(300) and at 40 +
    // sqrt(1500).
    const std::map<std::string, std::pair<double, double>> expected{
        {"explicit_euler", {2 / 37.3205081, 2 / 78.7298335}},
        {"rk4", {2.7852936 / 37.3205081, 2.7852936 / 78.7298335}},
        {"semi_implicit_euler", {4 / (std::sqrt(2000.0) + 40), 4 / (std::sqrt(6800.0) + 80)}},
        {"stormer_verlet", {2.0 / 40, 2.0 / 80}}};
    for (const int substeps : {1, 2}) {
        MapOptions options;
        for (const auto &[method, limits] : expected)
            options.methods.push_back(method);
        options.methods.emplace_back("backward_euler");
        options.base.settings = parse_setting("substeps=" + std::to_string(substeps));
        const StabilityMap map =
            map_scene({"scene.toml", spring}, parse_map_axis("dt=1/120..1/4:11log"),
                      parse_map_axis("spring.coil.damping=80,160"), options);
        const std::vector<TheoryCurve> curves = theory_of(map, options.base);
        EXPECT_EQ(curves.size(), expected.size());
        for (const TheoryCurve &curve : curves)
            for (const glm::dvec2 &point : curve.points)
                EXPECT_NEAR(
                    point.x,
                    substeps *
                        longest_damped_step(curve.methods.at(0)->name, 10, point.y / 2).value_or(0),
                    1e-12);
        for (const MethodMap &of_method : map.methods) {
            const auto known = expected.find(std::string(of_method.method->name));
            if (known == expected.end()) {
                EXPECT_TRUE(of_method.limits.empty());
                continue;
            }
            EXPECT_EQ(of_method.limits.size(), 2U) << known->first;
            for (const MapLimit &limit : of_method.limits) {
                const double h = limit.y == 80 ? known->second.first : known->second.second;
                EXPECT_NEAR(longest_damped_step(known->first, 10, limit.y / 2).value_or(0), h,
                            1e-6 * h)
                    << known->first;
                EXPECT_NEAR(between(map.x, limit.low, limit.high) / (substeps * h), 1, 0.02)
                    << known->first << ' ' << limit.y;
            }
        }
    }
    EXPECT_EQ(longest_damped_step("explicit_euler", 10, 0), 0) << "undamped at none";
    EXPECT_NEAR(longest_damped_step("semi_implicit_euler", 10, 0).value_or(0), 2.0 / 10, 1e-12);
    EXPECT_NEAR(longest_damped_step("explicit_euler", 10, 1).value_or(0), 0.01, 1e-12);
}

// Whether one substep of velocity Verlet, as the method does it, damps x'' = -omega^2 x - rate x'
// in the long run, by the eigenvalues of its matrix.
bool verlet_shrinks(double omega, double rate, double h) {
    const auto step = [&](double x, double v) {
        const double half = v + h / 2 * (-omega * omega * x - rate * v);
        const double to = x + h * half;
        const double guess = half + h / 2 * (-omega * omega * to - rate * half);
        return glm::dvec2(to, half + h / 2 * (-omega * omega * to - rate * guess));
    };
    const glm::dvec2 a = step(1, 0), b = step(0, 1);
    const double trace = a.x + b.y, determinant = a.x * b.y - a.y * b.x;
    const double inside = trace * trace / 4 - determinant;
    const double greatest =
        inside < 0 ? std::sqrt(determinant) : std::abs(trace) / 2 + std::sqrt(inside);
    return greatest <= 1;
}

TEST(StabilityMap, VelocityVerletThrowsADampedSpringWhereItsMatrixSays) {
    const std::string spring = damped_spring(40);
    // omega = 10; from a fifth of critical damping to four times that.
    for (const double rate : {4.0, 20.0, 40.0, 80.0}) {
        const double h = longest_damped_step("velocity_verlet", 10, rate).value_or(0);
        EXPECT_TRUE(verlet_shrinks(10, rate, 0.999999 * h)) << rate;
        EXPECT_FALSE(verlet_shrinks(10, rate, 1.000001 * h)) << rate;
    }
    EXPECT_NEAR(longest_damped_step("velocity_verlet", 10, 0).value_or(0), 0.2, 1e-12);
    EXPECT_NEAR(longest_damped_step("velocity_verlet", 10, 1e6).value_or(0), 3.08738e-6, 1e-10);

    MapOptions options;
    options.methods = {"velocity_verlet"};
    options.base.precision = Precision::f64;
    const StabilityMap map =
        map_scene({"scene.toml", spring}, parse_map_axis("dt=1/120..1/3:11log"),
                  parse_map_axis("spring.coil.damping=8,40,80,160"), options);
    ASSERT_EQ(theory_of(map, options.base).size(), 1U);
    const MethodMap &found = map.methods.at(0);
    EXPECT_EQ(found.limits.size(), 4U);
    for (const MapLimit &limit : found.limits)
        EXPECT_NEAR(between(map.x, limit.low, limit.high) /
                        longest_damped_step("velocity_verlet", 10, limit.y / 2).value_or(0),
                    1, 0.01)
            << limit.y;
    options.base.settings = parse_setting("substeps=2");
    EXPECT_TRUE(theory_of(map, options.base).empty());
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

// Semi-implicit Euler falls g t (t + dt) / 2. It reaches 5.085 m, the least within tolerance, when
// 1 + dt = 2 (10 - 5.085) / g. RK4 makes no error in free fall.
TEST(StabilityMap, FindsTheStepUpToWhichAnIntegratorIsTrueEnough) {
    const StabilityMap map = map_of(falling_ball, "dt=1/2000..1/25:5log", "gravity.y=-9.81,-9.8",
                                    {"semi_implicit_euler", "rk4"});
    ASSERT_EQ(map.methods.size(), 2U);
    for (const MethodMap &of_method : map.methods) {
        const bool is_first_order = of_method.method->name == "semi_implicit_euler";
        EXPECT_EQ(of_method.limits.size(), is_first_order ? 2U : 0U);
        for (const MapLimit &limit : of_method.limits) {
            EXPECT_EQ(limit.failing.failing, Failing::missed);
            EXPECT_EQ(limit.failing.what, "height");
            // A cell is a factor of 80^(1/4), cut into 32 parts.
            EXPECT_NEAR(between(map.x, limit.low, limit.high), 2 * (10 - 5.085) / -limit.y - 1,
                        0.035 * limit.low);
        }
    }
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

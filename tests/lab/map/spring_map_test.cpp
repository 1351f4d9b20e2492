// Maps of a lone spring, against the theory of linear stability.
#include "app/lab/map/stability_map.h"
#include "app/lab/map/theory.h"

#include "engine/scene/file/change.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// Held by a spring of 1 m and released 5 cm off its rest; `what` holds it, `numbers` are the bob's
// mass and the like, and `spring` says how stiff the spring is.
std::string bob_on_spring(const std::string &what, const std::string &numbers,
                          const std::string &spring) {
    return "[world]\ngravity = [0, 0, 0]\n[[" + what +
           "]]\nname = \"bob\"\nposition = [0, -1.05, 0]\n" + numbers + R"(
[[spring]]
name = "coil"
b = "bob"
anchor_a = [0, 0, 0]
rest_length = 1
)" + spring +
           R"(
[[expect]]
name = "bounded"
quantity = "energy_error"
reduce = "max"
to = 10
at_most = 300
source = "linear stability"
)";
}

// An oscillator of angular frequency omega, released at rest: explicit methods are stable up to
// omega h = 2, RK4 up to 2 sqrt(2).
TEST(SpringMap, ASpringIsThrownWhereTheoryHasIt) {
    const std::string spring = bob_on_spring("particle", "", "frequency = 1");
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
                EXPECT_NEAR(2 * std::numbers::pi * found.y * between(map.x, found.low, found.high),
                            limit * substeps, 0.01 * limit * substeps)
                    << of_method.method->name;
            EXPECT_FALSE(of_method.limits.empty());
        }
    }
}

// Four columns over a decade, in equal ratios or steps: as good as any finer grid.
TEST(SpringMap, ACoarseGridFindsTheLimitWithinOnePerCent) {
    MapOptions options;
    options.methods = {"semi_implicit_euler", "stormer_verlet", "velocity_verlet", "rk4"};
    for (const char *x : {"dt=0.01..0.1:4log", "dt=0.01..0.1:4", "dt=0.01,0.1"}) {
        const StabilityMap map =
            map_scene({"scene.toml", bob_on_spring("particle", "", "frequency = 1")},
                      parse_map_axis(x), parse_map_axis("spring.coil.frequency=5,8"), options);
        for (const MethodMap &of_method : map.methods) {
            const double limit = of_method.method->name == "rk4" ? std::sqrt(8.0) : 2;
            EXPECT_EQ(of_method.limits.size(), 2U) << x << ' ' << of_method.method->name;
            for (const MapLimit &found : of_method.limits)
                EXPECT_NEAR(2 * std::numbers::pi * found.y * between(map.x, found.low, found.high),
                            limit, 0.01 * limit)
                    << x << ' ' << of_method.method->name;
        }
    }
}

// exp(omega^2 h t) is what explicit Euler multiplies the energy by: at 1 Hz and 1/480 s by 2.3 in
// 10 s, far from the 300 that count here. Such cells are not called held; nor is a limit drawn
// beside them, which would be that of the time given. Where it shows, they fail.
TEST(SpringMap, ExplicitEulerNeverHoldsASpring) {
    MapOptions options;
    options.methods = {"explicit_euler", "semi_implicit_euler"};
    for (const auto &[what, numbers] :
         {std::pair{"particle", ""}, std::pair{"body", "shape = \"sphere\"\nradius = 0.1"}}) {
        const StabilityMap map =
            map_scene({"scene.toml", bob_on_spring(what, numbers, "frequency = 1")},
                      parse_map_axis("dt=1/480..1/30:4log"),
                      parse_map_axis("spring.coil.frequency=1,4"), options);
        const auto of = [&](const MethodMap &of_method, std::size_t column, std::size_t row) {
            return map.cell(of_method, column, row)->failing.failing;
        };
        EXPECT_EQ(of(map.methods[0], 0, 0), Failing::undecided) << what;
        EXPECT_EQ(of(map.methods[0], 3, 0), Failing::energy_grew) << what;
        for (std::size_t column = 0; column < 4; ++column) {
            EXPECT_NE(of(map.methods[0], column, 1), Failing::undecided) << what << column;
            EXPECT_NE(of(map.methods[0], column, 1), Failing::none) << what << column;
            EXPECT_EQ(of(map.methods[1], column, 0), Failing::none) << "known to be stable";
        }
        EXPECT_TRUE(map.methods[0].limits.empty());
        std::ostringstream said;
        print(said, map);
        EXPECT_NE(said.str().find("\n  ?  undecided: by theory it grows"), std::string::npos)
            << said.str();
        std::ostringstream csv;
        write_map_csv(csv, map);
        EXPECT_NE(csv.str().find(",undecided,"), std::string::npos);
    }
}

TEST(SpringMap, TheShippedSceneShowsThatExplicitEulerHoldsNoSpring) {
    std::vector<SceneMessage> messages;
    const std::filesystem::path path = PLUMB_SOURCE_DIR "/scenes/springs/spring_limit.toml";
    const std::optional<std::string> text = read_scene_text(path, messages);
    ASSERT_TRUE(text);
    MapOptions options;
    options.methods = {"explicit_euler"};
    const StabilityMap map = map_scene({path, *text}, parse_map_axis("dt=1/480,1/15"),
                                       parse_map_axis("spring.coil.frequency=1..32:6log"), options);
    for (const auto &cell : map.methods[0].cells) {
        EXPECT_NE(cell->failing.failing, Failing::none);
        EXPECT_NE(cell->failing.failing, Failing::undecided);
    }
}

// Known is only what theory covers.
TEST(SpringMap, GrowthIsKnownOfExplicitEulerAlone) {
    SceneDesc scene;
    scene.particles.emplace_back().name = "bob";
    SpringDesc &spring = scene.springs.emplace_back();
    spring.name = "coil";
    spring.b = "bob";
    spring.stiffness = 100;
    const auto grows = [&](const char *method, double dt = 0.01) {
        RunOptions run;
        run.method = method;
        run.settings.give(&StepSettings::dt, dt);
        return grows_by_theory(scene, resolve_run(scene, run));
    };
    EXPECT_TRUE(grows("explicit_euler"));
    EXPECT_FALSE(grows("semi_implicit_euler"));
    EXPECT_FALSE(grows("rk4", 1));
    spring.damping = 2; // up to c / k = 0.02 s
    EXPECT_FALSE(grows("explicit_euler", 0.019));
    EXPECT_TRUE(grows("explicit_euler", 0.021));
    spring.damping = 0;
    spring.tear_strain = 1;
    EXPECT_FALSE(grows("explicit_euler"));
    spring.tear_strain = 0;
    scene.springs.push_back(spring);
    EXPECT_FALSE(grows("explicit_euler"));
    scene.springs.pop_back();
    scene.particles.clear();
    scene.bodies.emplace_back().name = "bob";
    EXPECT_TRUE(grows("explicit_euler"));
    scene.bodies[0].linear_damping = 0.1;
    EXPECT_FALSE(grows("explicit_euler"));
}

// The same limits over the stiffness k = m omega^2 of a spring that holds a particle; one that
// holds a body might hold it off its centre.
TEST(SpringMap, AStiffSpringIsThrownWhereTheoryHasIt) {
    MapOptions options;
    options.methods = {"semi_implicit_euler", "rk4"};
    const StabilityMap map =
        map_scene({"scene.toml", bob_on_spring("particle", "mass = 3", "stiffness = 100")},
                  parse_map_axis("dt=1/60..1/4:9log"),
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
            EXPECT_NEAR(std::sqrt(each.y / 3) * between(map.x, each.low, each.high), limit,
                        0.01 * limit);
    }
    const std::string ball =
        bob_on_spring("body", "shape = \"sphere\"\nradius = 0.1\nmass = 3", "stiffness = 100");
    const StabilityMap of_body =
        map_scene({"scene.toml", ball}, parse_map_axis("dt=1/60,1/30"),
                  parse_map_axis("spring.coil.stiffness=2000,6000"), options);
    EXPECT_TRUE(theory_of(of_body).empty());
}

TEST(SpringMap, ASpringWithDampingOrANeighbourHasNoTheory) {
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
TEST(SpringMap, ADampedSpringIsThrownWhereTheoryHasIt) {
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

TEST(SpringMap, VelocityVerletThrowsADampedSpringWhereItsMatrixSays) {
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

} // namespace
} // namespace plumb

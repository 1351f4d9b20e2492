// Swings in hollows of many facets, which a body crosses by the step: their energy does not grow,
// and falls as facets take it.
#include "tests/dynamics/worlds.h"

#include <cmath>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

// The lower part of a pipe along z whose facets touch a circle of this radius from outside.
std::shared_ptr<const TriangleSurface> pipe(double radius, int facets) {
    TriangleMesh mesh;
    const int half = 2 * facets / 5;
    const double to_corner = radius / std::cos(pi / facets);
    for (int i = -half; i <= half; ++i) {
        const double angle = 2 * pi * (i + 0.5) / facets;
        for (const double z : {-radius, radius})
            mesh.vertices.push_back(
                narrow(V{to_corner * std::sin(angle), -to_corner * std::cos(angle), z}));
    }
    for (int i = 0; i < 2 * half; ++i) {
        const auto at = static_cast<std::uint32_t>(2 * i);
        mesh.triangles.push_back({at, at + 1, at + 2});
        mesh.triangles.push_back({at + 1, at + 3, at + 2});
    }
    return std::make_shared<const TriangleSurface>(mesh, Sides::front);
}

std::shared_ptr<const TriangleSurface> bowl(double radius, double spacing, double half) {
    HeightField field;
    const int cells = static_cast<int>(std::lround(2 * half / spacing));
    field.rows = field.columns = cells + 1;
    field.spacing = Real(spacing);
    field.origin = narrow(V{-half, 0, -half});
    for (int row = 0; row <= cells; ++row)
        for (int column = 0; column <= cells; ++column) {
            const double x = column * spacing - half, z = row * spacing - half;
            field.heights.push_back(Real((x * x + z * z) / (2 * radius)));
        }
    return std::make_shared<const TriangleSurface>(field, Sides::front);
}

BodyDef fixed(std::shared_ptr<const TriangleSurface> surface, double friction) {
    BodyDef def;
    def.kind = BodyKind::static_body;
    def.colliders.emplace_back().surface = std::move(surface);
    return with_material(def, friction, 0);
}

StepSettings at_rate(double rate) {
    StepSettings settings = settings_for("soft_step");
    settings.dt = 1 / rate;
    return settings;
}

struct Swing {
    double left = 0;   // of the energy, in the end
    double most = 0;   // of the energy, at any time
    double period = 0; // mean (s)
};
// Follows a body that was let go at rest, with its energy above `lowest` (J).
Swing follow(World &world, BodyId id, double lowest, double duration) {
    Swing swing;
    const double begun = world.energy() - lowest;
    const auto steps = static_cast<int>(duration / world.settings().dt);
    double before = position_of(world, id).x, first = 0, last = 0;
    int passes = 0;
    for (int i = 0; i < steps; ++i) {
        world.step(nullptr);
        swing.left = (world.energy() - lowest) / begun;
        swing.most = std::max(swing.most, swing.left);
        const double x = position_of(world, id).x;
        if (before * x < 0) {
            last = world.time() - world.settings().dt * x / (x - before);
            first = passes++ == 0 ? last : first;
        }
        before = x;
    }
    swing.period = passes > 1 ? 2 * (last - first) / (passes - 1) : 0;
    return swing;
}

// Energy that is left after ten swings from `angle` where each facet, `turn` (rad) from the last,
// takes turn^2 of what is in straight motion, which is `straight` of the kinetic energy: that is
// half of the energy on average.
double facets_leave(double angle, double turn, double straight) {
    return std::exp(-10 * 4 * angle * turn * 0.5 * straight);
}

// A ball's closed form: it swings like a pendulum as long as the way of its middle, and if it rolls
// with 7/5 of its inertia.
TEST(Hollow, ABallSwingsAsLongAsFacetsLet) {
    struct Case {
        double radius, angle, facet, friction, rate;
    };
    for (const Case &c :
         {Case{0.5, 0.2, 0.008, 0, 60}, Case{0.5, 0.2, 0.008, 0.8, 60}, Case{0.5, 1, 0.004, 0, 60},
          Case{0.5, 0.5, 0.004, 0.8, 30}, Case{0.5, 0.5, 0.1, 0, 60}, Case{2, 0.1, 0.008, 0, 60},
          Case{2, 0.2, 0.008, 0.8, 60}, Case{2, 0.5, 0.008, 0, 30}, Case{2, 0.5, 0.008, 0, 120},
          Case{2, 0.5, 0.03, 0.8, 60}, Case{2, 1, 0.02, 0, 60}, Case{10, 0.2, 0.04, 0, 60},
          Case{10, 0.5, 0.02, 0.8, 30}}) {
        World world("soft_step", at_rate(c.rate));
        const int facets = static_cast<int>(2 * pi * c.radius / c.facet);
        world.add_body(fixed(pipe(c.radius, facets), c.friction));
        const double size = 0.15 * c.radius, length = c.radius - size;
        const double inertia = c.friction > 0 ? 1.4 : 1;
        const BodyId id = world.add_body(with_material(
            dynamic_body(ball(size), 1, length * V{std::sin(c.angle), -std::cos(c.angle), 0}),
            c.friction, 0));
        const double period = 2 * pi * std::sqrt(inertia * length / gravity) *
                              (1 + c.angle * c.angle / 16 + 11 * std::pow(c.angle, 4) / 3072);
        const Swing swing = follow(world, id, -length * gravity, 10 * period);
        const double expected = facets_leave(c.angle, 2 * pi / facets, 1 / inertia);
        const std::string what = std::to_string(c.radius) + " m, " + std::to_string(c.angle) +
                                 " rad, " + std::to_string(c.facet) + " m, friction " +
                                 std::to_string(c.friction) + ", " + std::to_string(c.rate) + " Hz";
        EXPECT_LE(swing.most, 1.005) << what;
        EXPECT_GE(swing.left, 0.85 * expected) << what;
        if (c.angle <= 0.2) {
            EXPECT_NEAR(swing.period, period, 0.01 * period) << what;
        }
    }
}

// A cylinder and a capsule that lie along the pipe, a box on two of its edges, and a coin on its
// rim.
TEST(Hollow, SolidsOfAllShapesSwingWithoutGain) {
    constexpr double radius = 2, angle = 0.5, half = 0.2;
    const glm::dquat along_z = glm::angleAxis(pi / 2, V{1, 0, 0});
    const Cylinder log{narrow(V{0, -0.4, 0}), narrow(V{0, 0.4, 0}), Real(0.3)};
    const Cylinder coin{narrow(V{0, -0.03, 0}), narrow(V{0, 0.03, 0}), Real(0.3)};
    for (const double facet : {0.008, 0.03})
        for (const auto &[name, shape] :
             {std::pair{"cylinder", Shape{log}}, std::pair{"coin", Shape{coin}},
              std::pair{"capsule", Shape{upright_capsule(0.4, 0.3)}},
              std::pair{"box", Shape{block(V{half, half, 0.4})}}})
            for (const double friction : {0.0, 0.8}) {
                const bool is_box = std::holds_alternative<Box>(shape);
                if (is_box && friction > 0)
                    continue; // stays where it is
                World world("soft_step", at_rate(60));
                world.add_body(
                    fixed(pipe(radius, static_cast<int>(2 * pi * radius / facet)), friction));
                const double length =
                    is_box ? std::sqrt(radius * radius - half * half) - half : radius - 0.3;
                BodyDef def =
                    dynamic_body(shape, 1, length * V{std::sin(angle), -std::cos(angle), 0});
                def.pose.rotation = narrow(is_box ? glm::angleAxis(angle, V{0, 0, 1}) : along_z);
                const BodyId id = world.add_body(with_material(def, friction, 0));
                const Swing swing = follow(world, id, -length * gravity, 7);
                EXPECT_LE(swing.most, 1.005) << name << facet << ", friction " << friction;
                EXPECT_GE(swing.left, 0.85) << name << facet << ", friction " << friction;
            }
}

// To and fro, and around.
TEST(Hollow, ABallKeepsItsEnergyInABowl) {
    constexpr double radius = 2, size = 0.1, start = 0.6;
    for (const double spacing : {0.02, 0.1})
        for (const double friction : {0.0, 0.8})
            for (const double across : {0.0, 0.4}) {
                World world("soft_step", at_rate(60));
                world.add_body(fixed(bowl(radius, spacing, 0.8), friction));
                const V up = glm::normalize(V{-start / radius, 1, 0});
                BodyDef def = dynamic_body(ball(size), 1,
                                           V{start, start * start / (2 * radius), 0} + size * up,
                                           V{0, 0, across});
                def.angular_velocity =
                    narrow((friction > 0 ? 1 / size : 0) * glm::cross(up, V{0, 0, across}));
                const BodyId id = world.add_body(with_material(def, friction, 0));
                const Swing swing = follow(world, id, gravity * size, 20);
                EXPECT_LE(swing.most, 1.005) << spacing << ", " << friction << ", " << across;
                EXPECT_GE(swing.left, spacing < 0.05 ? 0.95 : 0.8)
                    << spacing << ", " << friction << ", " << across;
            }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION

// Piles of bodies in a pen: no step adds energy, however hard the bodies are squeezed, and none is
// deep at rest.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

std::shared_ptr<const HullMesh> any_rock(Random &random, double radius) {
    std::vector<Vec3> points;
    for (int i = 0; i < 14; ++i) {
        const V way = any_vector(random, 1);
        points.push_back(narrow(radius / std::max(0.3, glm::length(way)) * way));
    }
    return std::make_shared<const HullMesh>(*convex_hull(points, 64).mesh);
}

// A box, ball, capsule, cylinder, hull or cross of about the given size, at a height, with a random
// rotation.
BodyDef any_piece(Random &random, double size, double height) {
    const std::uint32_t kind = random.next_index(6);
    const double a = size * random.next_in(0.2, 0.5), b = size * random.next_in(0.1, 0.4);
    const double c = size * random.next_in(0.1, 0.4);
    const double mass = 4000 * a * b * c; // kg
    const double x = size * random.next_in(-1.5, 1.5), z = size * random.next_in(-1.5, 1.5);
    BodyDef def = dynamic_body(ball(a), mass, V{x, height, z});
    Shape &shape = def.colliders[0].shape;
    if (kind == 0)
        shape = block(V{a, b, c});
    else if (kind == 2)
        shape = upright_capsule(a, b);
    else if (kind == 3)
        shape = Cylinder{narrow(V{0, -b, 0}), narrow(V{0, b, 0}), Real(a)};
    else if (kind == 4) {
        const auto mesh = any_rock(random, a);
        shape = ConvexHull{mesh.get(), Vec3{Real(0)}, identity_rotation};
        def.colliders[0].hull = mesh;
    } else if (kind == 5) {
        shape = block(V{a, 0.3 * b, 0.3 * b});
        def.colliders.emplace_back().shape = block(V{0.3 * b, a, 0.3 * b});
        def.colliders.emplace_back().shape = block(V{0.3 * b, 0.3 * b, a});
    }
    def.pose.rotation = narrow(any_rotation(random));
    return def;
}

// The most energy that one step adds to ten pieces falling into a pen, as a share of their initial
// energy.
double worst_gain(std::uint32_t seed, double size, double rate, double friction) {
    Random random(seed);
    StepSettings settings = settings_for("soft_step");
    settings.dt = 1 / rate;
    World world("soft_step", settings);
    world.add_body(ground(friction, 0));
    for (int side = 0; side < 4; ++side) {
        const double angle = 0.5 * pi * side;
        const V at = size * V{3 * std::cos(angle), 1, 3 * std::sin(angle)};
        const V half = size * (side % 2 == 0 ? V{0.2, 1, 3} : V{3, 1, 0.2});
        world.add_body(with_material(static_body(block(half), at), friction, 0));
    }
    for (int i = 0; i < 10; ++i)
        world.add_body(with_material(any_piece(random, size, size * (1 + 0.9 * i)), friction, 0));
    const double first = world.energy();
    double before = first, worst = 0;
    for (int step = 0; step < 1.5 * rate; ++step) {
        world.step(nullptr);
        worst = std::max(worst, world.energy() - before);
        before = world.energy();
    }
    return worst / first;
}

TEST(Piles, GainNoEnergyInAnyStep) {
    const double gains = 0.03;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        EXPECT_LT(worst_gain(seed, 0.1, 60, 0.1), gains) << seed;
        EXPECT_LT(worst_gain(seed, 0.01, 240, 0.1), gains) << seed;
        EXPECT_LT(worst_gain(seed, 0.5, 60, 0.6), gains) << seed;
    }
}

// Few substeps make soft contacts, above all where one corner bears the load of a face.
TEST(Piles, AreNotDeepAtRestWithFewSubsteps) {
    for (const auto &[size, share] : {std::pair(0.1, 0.08), {1.0, 0.01}})
        for (std::uint32_t seed = 1; seed <= 2; ++seed) {
            Random random(seed);
            StepSettings settings = settings_for("soft_step");
            settings.substep_budget = 256;
            settings.sleep_after = 0;
            World world("soft_step", settings);
            world.add_body(ground(0.6, 0));
            for (int side = 0; side < 4; ++side) {
                const double angle = 0.5 * pi * side;
                const V at = size * V{3 * std::cos(angle), 10, 3 * std::sin(angle)};
                world.add_body(
                    static_body(block(size * (side % 2 == 0 ? V{0.5, 10, 3} : V{3, 10, 0.5})), at));
            }
            for (int i = 0; i < 400; ++i) {
                const V at = V{i % 5 - 2, 0.5 + i / 25, i / 5 % 5 - 2} + any_vector(random, 0.02);
                Shape shape = ball(0.3 * size);
                if (i % 3 > 0)
                    shape = block(size * V{0.3, 0.2, 0.25});
                BodyDef def = dynamic_body(shape, 100 * size * size * size, size * at);
                def.pose.rotation = narrow(any_rotation(random));
                world.add_body(def);
            }
            run(world, 60 * 8);
            const Measures m = world.measure();
            EXPECT_LT(m.max_penetration, share * size) << size << ' ' << seed;
            EXPECT_LT(m.kinetic_energy, 1e-5 * m.potential_energy) << size << ' ' << seed;
        }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION

// Bodies on meshes and height fields.
#include "engine/dynamics/contacts/surface_contact.h"
#include "tests/dynamics/worlds.h"
#include "tests/space/meshes.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

// A mesh of n x n square cells of the given size, with its heights from `height`.
template <typename Height> TriangleMesh grid(int n, double cell, Height &&height) {
    TriangleMesh mesh;
    for (int row = 0; row <= n; ++row)
        for (int column = 0; column <= n; ++column) {
            const double x = (column - 0.5 * n) * cell, z = (row - 0.5 * n) * cell;
            mesh.vertices.push_back(narrow(V{x, height(x, z), z}));
        }
    const auto at = [&](int row, int column) { return std::uint32_t(row * (n + 1) + column); };
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            mesh.triangles.push_back(
                {at(row, column), at(row + 1, column), at(row + 1, column + 1)});
            mesh.triangles.push_back(
                {at(row, column), at(row + 1, column + 1), at(row, column + 1)});
        }
    return mesh;
}

template <typename Height> HeightField field(int n, double cell, Height &&height) {
    HeightField out;
    out.rows = out.columns = n + 1;
    out.spacing = Real(cell);
    out.origin = narrow(V{-0.5 * n * cell, 0, -0.5 * n * cell});
    for (int row = 0; row <= n; ++row)
        for (int column = 0; column <= n; ++column)
            out.heights.push_back(Real(height((column - 0.5 * n) * cell, (row - 0.5 * n) * cell)));
    return out;
}

constexpr auto flat = [](double, double) { return 0.0; };

BodyDef surface_body(std::shared_ptr<const TriangleSurface> surface, double friction) {
    BodyDef def;
    def.kind = BodyKind::static_body;
    def.colliders.emplace_back().surface = std::move(surface);
    return with_material(def, friction, 0);
}

std::shared_ptr<const TriangleSurface> flat_surface(bool as_field, Sides sides = Sides::front) {
    return as_field ? std::make_shared<const TriangleSurface>(field(40, 0.5, flat), sides)
                    : std::make_shared<const TriangleSurface>(grid(40, 0.5, flat), sides);
}

TEST(Surface, FlatEdgesAreInnerAndRidgesOuter) {
    const TriangleSurface level(grid(4, 1, flat), Sides::front);
    const TriangleSurface roof(grid(2, 1, [](double x, double) { return -std::abs(x); }),
                               Sides::front);
    const TriangleSurface ditch(grid(2, 1, [](double x, double) { return std::abs(x); }),
                                Sides::front);
    const auto outer = [](const TriangleSurface &surface) {
        int count = 0;
        for (std::uint32_t i = 0; i < surface.triangle_count(); ++i)
            for (int edge = 0; edge < 3; ++edge)
                count += surface.is_outer_edge(i, edge) ? 1 : 0;
        return count;
    };
    EXPECT_EQ(outer(level), 16);   // the border
    EXPECT_EQ(outer(ditch), 8);    // the border
    EXPECT_EQ(outer(roof), 8 + 4); // the border, and both sides of two ridge edges
}

TEST(Surface, EverythingRestsAtItsHeight) {
    for (const bool as_field : {false, true}) {
        World world("soft_step", settings_for("soft_step"));
        world.add_body(surface_body(flat_surface(as_field), 0.5));
        std::vector<std::pair<BodyId, double>> bodies;
        const std::vector<std::pair<Shape, double>> shapes{
            {ball(0.3), 0.3},
            {block(V{0.3, 0.2, 0.4}), 0.2},
            {upright_capsule(0.4, 0.2), 0.6},
            {Cylinder{Vec3{0, Real(-0.25), 0}, Vec3{0, Real(0.25), 0}, Real(0.4)}, 0.25}};
        int i = 0;
        for (const auto &[shape, height] : shapes) {
            BodyDef def = dynamic_body(shape, 1, V{1.7 * i - 2.1, height + 0.01, 0.13 * i});
            if (std::holds_alternative<Capsule>(shape))
                def.locked = {false, false, false, true, true, true};
            bodies.emplace_back(world.add_body(def), height);
            ++i;
        }
        run(world, 240);
        for (const auto &[id, height] : bodies) {
            EXPECT_NEAR(position_of(world, id).y, height, 1e-3) << id.index;
            EXPECT_LE(glm::length(velocity_of(world, id)), 2e-3) << id.index;
        }
    }
}

// Seams do not matter: a body sliding without friction keeps its speed and does not hop.
TEST(Surface, ABoxSlidesOverSeamsUnchanged) {
    for (const bool as_field : {false, true})
        for (const double speed : {0.5, 3.0, 8.0})
            for (const double heading : {0.0, 0.4, 0.7853981}) {
                World world("soft_step", settings_for("soft_step"));
                world.add_body(surface_body(flat_surface(as_field), 0));
                const V velocity = speed * V{std::cos(heading), 0, std::sin(heading)};
                const BodyId id = world.add_body(with_material(
                    dynamic_body(block(V{0.25}), 1, V{-4, 0.25, -3.9}, velocity), 0, 0));
                double highest = 0;
                for (int i = 0; i < 60; ++i) {
                    world.step(nullptr);
                    highest = std::max(highest, position_of(world, id).y);
                }
                EXPECT_LE(glm::distance(velocity_of(world, id), velocity), 2e-3 * speed)
                    << speed << " at " << heading << (as_field ? " field" : " mesh");
                EXPECT_LE(highest, 0.2505);
            }
}

TEST(Surface, ABallRollsOverSeamsAsOnAPlane) {
    for (const double speed : {1.0, 6.0}) {
        std::vector<double> ends;
        for (const bool on_mesh : {false, true}) {
            World world("soft_step", settings_for("soft_step"));
            if (on_mesh)
                world.add_body(surface_body(flat_surface(false), 0.5));
            else
                world.add_body(ground(0.5, 0));
            BodyDef def = with_material(
                dynamic_body(ball(0.2), 1, V{-4, 0.2, 0.1}, V{speed, 0, 0.2 * speed}), 0.5, 0);
            def.angular_velocity = narrow(V{0.2 * speed / 0.2, 0, -speed / 0.2});
            const BodyId id = world.add_body(def);
            run(world, 60);
            ends.push_back(position_of(world, id).x);
            EXPECT_NEAR(glm::length(velocity_of(world, id)), speed * std::sqrt(1.04), 0.01 * speed);
        }
        EXPECT_NEAR(ends[0], ends[1], 0.01 * speed);
    }
}

TEST(Surface, OneSidedLetsPassFromBehindAndTwoSidedDoesNot) {
    for (const Sides sides : {Sides::front, Sides::both}) {
        World world("soft_step", weightless(settings_for("soft_step")));
        world.add_body(surface_body(flat_surface(false, sides), 0.5));
        const BodyId id = world.add_body(dynamic_body(ball(0.2), 1, V{0.1, -1, 0.17}, V{0, 2, 0}));
        run(world, 90);
        EXPECT_EQ(position_of(world, id).y > 1, sides == Sides::front);
    }
}

// Each face's deepest point may lie over the other face, so neither would hold a body coming down
// on the ridge.
TEST(Surface, NothingFallsThroughHills) {
    const auto hills = [](double x, double z) { return std::sin(0.9 * x) * std::cos(0.8 * z); };
    for (const bool as_field : {false, true}) {
        const auto surface =
            as_field ? std::make_shared<const TriangleSurface>(field(16, 1.6, hills), Sides::front)
                     : std::make_shared<const TriangleSurface>(grid(16, 1.6, hills), Sides::front);
        Random random(5);
        World world("soft_step", settings_for("soft_step"));
        world.add_body(surface_body(surface, 0.5));
        std::vector<BodyId> boxes;
        for (int i = 0; i < 60; ++i) {
            BodyDef box =
                dynamic_body(block(V{0.5, random.next_in(0.1, 0.3), 0.25}), 100,
                             V{random.next_in(-8, 8), random.next_in(2, 4), random.next_in(-8, 8)});
            box.pose.rotation = narrow(any_rotation(random));
            box.colliders.front().filter = {.layer = 1, .ignores = 2}; // not each other
            boxes.push_back(world.add_body(box));
        }
        run(world, 180);
        for (const BodyId id : boxes) {
            const V at = position_of(world, id);
            if (std::abs(at.x) < 12 && std::abs(at.z) < 12) {
                EXPECT_GT(at.y, hills(at.x, at.z) - 0.3) << as_field << ", " << id.index;
            }
        }
    }
}

// A body landing on one edge slaps down within the step, so by its end the other edge is in deeper
// than the body is thick.
TEST(Surface, NothingThinFallsThrough) {
    const std::vector<std::pair<std::string, std::shared_ptr<const TriangleSurface>>> grounds{
        {"field", std::make_shared<const TriangleSurface>(field(8, 1, flat), Sides::front)},
        {"two triangles", std::make_shared<const TriangleSurface>(grid(1, 8, flat), Sides::front)},
        {"two-sided", std::make_shared<const TriangleSurface>(grid(16, 0.5, flat), Sides::both)}};
    const std::vector<std::pair<std::string, Shape>> solids{
        {"plate", block(V{0.3, 0.02, 0.2})},
        {"stick", block(V{0.3, 0.02, 0.02})},
        {"disc", Cylinder{narrow(V{0, -0.02, 0}), narrow(V{0, 0.02, 0}), Real(0.25)}}};
    Random random(7);
    for (const auto &[ground, surface] : grounds)
        for (const auto &[name, solid] : solids)
            for (const double speed : {0.0, 5.0}) {
                int fallen = 0;
                for (int trial = 0; trial < 30; ++trial) {
                    World world("soft_step", settings_for("soft_step"));
                    world.add_body(surface_body(surface, 0.4));
                    BodyDef def = dynamic_body(solid, 1, V{0.13, random.next_in(0.45, 0.55), 0.09},
                                               V{0, -speed, 0});
                    def.pose.rotation = glm::normalize(narrow(any_rotation(random)));
                    def.angular_velocity = narrow(any_vector(random, 6 * speed));
                    const BodyId id = world.add_body(with_material(def, 0.4, 0));
                    run(world, 60);
                    fallen += position_of(world, id).y < 0 ? 1 : 0;
                }
                EXPECT_EQ(fallen, 0) << name << " on " << ground << " at " << speed << " m/s";
            }
}

// A bar with one edge along a gutter, sunk below both of its faces: it touches at least one of
// them.
TEST(Surface, AnEdgeInAGutterTouchesAFace) {
    for (const double steep : {0.1, 0.4, 0.8})
        for (const double depth : {1e-4, 1e-3, 1e-2, 0.05})
            for (const double lean : {-0.9, -0.3, 0.0, 0.3, 0.9}) {
                const TriangleSurface gutter(
                    grid(2, 2, [&](double x, double) { return steep * std::abs(x); }),
                    Sides::front);
                const double more = lean * (pi / 4 - std::atan(steep)), half = 0.3;
                const V edge = std::sqrt(2) * half * V{std::sin(more), -std::cos(more), 0};
                const Box bar{narrow(V{0, -depth, 0} - edge),
                              narrow(glm::angleAxis(pi / 4 + more, V{0, 0, 1})),
                              narrow(V{half, half, 0.7})};
                int touched = 0;
                for (std::uint32_t i = 0; i < gutter.triangle_count(); ++i)
                    touched += collide(Shape{bar}, gutter, Transform{}, i, Real(0)).count;
                EXPECT_GT(touched, 0) << steep << ", " << depth << ", " << lean;
            }
}

TEST(Surface, ABallComesToRestInABowl) {
    World world("soft_step", settings_for("soft_step"));
    const auto bowl = [](double x, double z) { return 0.1 * (x * x + z * z); };
    world.add_body(surface_body(
        std::make_shared<const TriangleSurface>(field(40, 0.2, bowl), Sides::front), 0.5));
    BodyDef def = dynamic_body(ball(0.25), 1, V{2, 1.2, -1});
    def.angular_damping = Real(2);
    const BodyId id = world.add_body(def);
    run(world, 1200);
    const V at = position_of(world, id);
    EXPECT_LE(std::hypot(at.x, at.z), 0.3);
    EXPECT_NEAR(at.y, 0.25, 0.02);
}

// On a tilted mesh: no creep below the friction angle, the closed form above it.
TEST(Surface, SlopesGripAndSlide) {
    for (const double friction : {0.8, 0.2}) {
        World world("soft_step", settings_for("soft_step"));
        const double slope = std::tan(0.5);
        BodyDef hill = surface_body(
            std::make_shared<const TriangleSurface>(
                grid(60, 0.5, [&](double x, double) { return slope * x; }), Sides::front),
            friction);
        world.add_body(hill);
        const glm::dquat turn = glm::angleAxis(0.5, V{0, 0, 1});
        BodyDef def =
            with_material(dynamic_body(block(V{0.25}), 1, turn * V{0, 0.25, 0}), friction, 0);
        def.pose.rotation = narrow(turn);
        const BodyId id = world.add_body(def);
        const V start = position_of(world, id);
        run(world, 60);
        const double gone = glm::distance(position_of(world, id), start);
        const double expected =
            std::max(0.0, 0.5 * gravity * (std::sin(0.5) - friction * std::cos(0.5)));
        EXPECT_NEAR(gone, expected, 0.02 * expected + 1e-3) << friction;
    }
}

// A body coming down a hilly field rolls and tumbles over the ridges and lands with a far end on
// the next face: it penetrates so little that pushing it out adds little energy.
TEST(Surface, WhatTumblesDownHillsGainsLittleEnergy) {
    const auto hills = [](double x, double z) { return 0.3 * std::sin(x) * std::cos(z); };
    const auto surface =
        std::make_shared<const TriangleSurface>(field(40, 0.5, hills), Sides::front);
    for (const bool is_box : {true, false}) {
        Random random(11);
        int more = 0;
        constexpr int count = 100;
        for (int trial = 0; trial < count; ++trial) {
            const double friction = random.next_in(0.05, 1.2);
            const double size = std::pow(10, random.next_in(-1.5, 0));
            const auto side = [&] { return size * random.next_in(0.2, 1); };
            const double x = side(), y = side(), z = side();
            const Shape shape =
                is_box ? Shape{block(V{x, y, z})}
                       : Shape{Cylinder{narrow(V{0, -y, 0}), narrow(V{0, y, 0}), Real(size)}};
            World world("soft_step", settings_for("soft_step"));
            world.add_body(surface_body(surface, friction));
            BodyDef body = dynamic_body(shape, 10, V{0.13, 0.35 + 1.5 * size, 0});
            body.pose.rotation = narrow(any_rotation(random));
            body.angular_velocity = narrow(any_vector(random, std::sqrt(gravity / size)));
            world.add_body(with_material(body, friction, 0));
            const double begun = world.energy() - 10 * gravity * (0.35 + 0.5 * size);
            const double gain = regained_energy(world, 600);
            EXPECT_LT(gain, (is_box ? 0.05 : 0.25) * begun) << is_box << ", " << trial;
            more += gain > 0.01 * begun ? 1 : 0;
        }
        EXPECT_LT(more, is_box ? 2 : 13) << is_box;
    }
}

// A mesh that is solid pushes what is inside out by the shortest way; one that is not lets it fall
// through to the ground.
TEST(Surface, WhatIsInsideASolidMeshIsPushedOut) {
    constexpr double half = 0.5;
    for (const Sides sides : {Sides::front, Sides::solid})
        for (const bool is_cube : {true, false}) {
            const auto mesh = std::make_shared<const TriangleSurface>(
                is_cube ? meshes::cube(3, half) : meshes::sphere(24, 16, half), sides);
            Random random(5);
            for (int trial = 0; trial < 40; ++trial) {
                World world("soft_step", weightless(settings_for("soft_step")));
                world.add_body(surface_body(mesh, 0.5));
                const V from = any_vector(random, 0.45 * half);
                const bool is_ball = trial % 2 == 0;
                BodyDef def =
                    dynamic_body(is_ball ? Shape{ball(0.05)} : Shape{block(V{0.05})}, 1, from);
                if (!is_ball)
                    def.pose.rotation = narrow(any_rotation(random));
                const BodyId id = world.add_body(def);
                const auto reach = [&] {
                    const V at = glm::abs(position_of(world, id));
                    return is_cube ? std::max({at.x, at.y, at.z}) : glm::length(at);
                };
                const double left = half - reach();
                int steps = 0;
                for (; steps < 90 && reach() < half; ++steps) {
                    run(world, 1);
                    if (sides == Sides::solid && is_cube && is_ball && reach() < half) {
                        EXPECT_NEAR(world.measure().max_penetration, half + 0.05 - reach(), 1e-5);
                    }
                }
                if (sides == Sides::front) {
                    EXPECT_LT(glm::distance(position_of(world, id), from), 1e-3) << "it is held";
                    continue;
                }
                EXPECT_LT(steps, 30) << is_cube << is_ball;
                EXPECT_LT(glm::distance(position_of(world, id), from), 1.2 * left + 0.05);
                // As from a solid ball, what turns out of it keeps some of the speed.
                EXPECT_LT(glm::length(velocity_of(world, id)), is_ball ? 0.01 : 1.2);
            }
        }
}

// The ground below a solid height field: as on a half-space, what is inside comes up and rests.
TEST(Surface, WhatIsInSolidGroundComesUpAndRests) {
    const auto hills = [](double x, double z) { return 0.3 * std::sin(x) * std::cos(0.7 * z); };
    for (const Sides sides : {Sides::front, Sides::solid}) {
        const auto ground = std::make_shared<const TriangleSurface>(field(40, 0.25, hills), sides);
        for (const double deep : {0.05, 0.3, 1.0, 4.0}) {
            World world("soft_step", settings_for("soft_step"));
            world.add_body(surface_body(ground, 1));
            const V start{0.4, hills(0.4, -0.3) - deep, -0.3};
            const BodyId id =
                world.add_body(with_material(dynamic_body(ball(0.1), 1, start), 1, 0));
            run(world, 240);
            const V at = position_of(world, id);
            if (sides == Sides::front)
                EXPECT_LT(at.y, -10) << deep;
            else
                EXPECT_GT(at.y, hills(at.x, at.z) + 0.09) << deep;
        }
    }
}

// What never is inside does not notice: the same bits.
TEST(Surface, SolidIsAsOneSidedFromOutside) {
    const auto hills = [](double x, double z) { return 0.3 * std::sin(x) * std::cos(0.7 * z); };
    std::array<V, 2> ends{};
    for (const Sides sides : {Sides::front, Sides::solid}) {
        World world("soft_step", settings_for("soft_step"));
        world.add_body(surface_body(
            std::make_shared<const TriangleSurface>(field(40, 0.25, hills), sides), 0.5));
        const BodyId id = world.add_body(
            dynamic_body(block(V{0.2, 0.1, 0.3}), 1, V{0.2, 1.5, 0.4}, V{1, 0, 0.5}));
        run(world, 300);
        ends[sides == Sides::solid ? 1 : 0] = position_of(world, id);
    }
    EXPECT_EQ(ends[0], ends[1]);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION

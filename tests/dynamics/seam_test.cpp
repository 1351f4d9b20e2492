// Static bodies lying flush side by side act as one.
#include "tests/dynamics/rest_methods.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

class Seams : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, Seams, testing::ValuesIn(rest_methods()), name_of);

// Two triangles, a metre square, top at y = 0, centred on the origin.
std::shared_ptr<const TriangleSurface> flat_tile(bool as_field) {
    if (as_field) {
        HeightField field;
        field.rows = field.columns = 2;
        field.spacing = Real(1);
        field.origin = narrow(V{-0.5, 0, -0.5});
        field.heights = {Real(0), Real(0), Real(0), Real(0)};
        return std::make_shared<const TriangleSurface>(std::move(field), Sides::front);
    }
    TriangleMesh mesh;
    for (const V &corner : {V{-0.5, 0, -0.5}, V{-0.5, 0, 0.5}, V{0.5, 0, 0.5}, V{0.5, 0, -0.5}})
        mesh.vertices.push_back(narrow(corner));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return std::make_shared<const TriangleSurface>(std::move(mesh), Sides::front);
}

enum class Tile { box, mesh, field };

// A floor of 30 x 3 tiles of a metre, starting at x = -1, with its top at y = 0.
void add_floor(World &world, Tile kind, double friction) {
    for (int i = 0; i < 30; ++i)
        for (int j = -1; j <= 1; ++j) {
            BodyDef tile;
            if (kind == Tile::box) {
                tile = static_body(block(V{0.5, 0.25, 0.5}), V{i - 0.5, -0.25, double(j)});
            } else {
                tile.kind = BodyKind::static_body;
                tile.colliders.emplace_back().surface = flat_tile(kind == Tile::field);
                tile.pose.position = narrow(V{i - 0.5, 0, double(j)});
            }
            world.add_body(with_material(tile, friction, 0));
        }
}

struct Ride {
    double kept = 0;   // as a share of the speed
    double hop = 0;    // m
    double swerve = 0; // m
};

Ride ride(World &world, const BodyDef &def, double speed, double side) {
    const BodyId id = world.add_body(def);
    Ride out;
    const int steps = int(std::min(25 / speed, 8.0) / world.settings().dt);
    for (int i = 0; i < steps; ++i) {
        world.step(nullptr);
        out.hop = std::max(out.hop, position_of(world, id).y - side);
    }
    out.kept = velocity_of(world, id).x / speed;
    out.swerve = std::abs(position_of(world, id).z - double(def.pose.position.z));
    return out;
}

TEST_P(Seams, ABoxSlidesOverTilesAsOverOneSlab) {
    for (const double speed : {0.3, 1.0, 3.0, 10.0}) {
        World world(GetParam(), settings_for(GetParam()));
        add_floor(world, Tile::box, 0);
        const Ride seen =
            ride(world,
                 with_material(dynamic_body(block(V{0.2}), 8, V{-0.5, 0.2, 0.013}, V{speed, 0, 0}),
                               0, 0),
                 speed, 0.2);
        // Known failing: tgs_soft, which sags deeper, keeps 99.6 % at 0.3 m/s.
        EXPECT_NEAR(seen.kept, 1, GetParam() == "tgs_soft" ? 5e-3 : 1e-3) << speed;
        EXPECT_LT(seen.hop, 1e-3) << speed;
        EXPECT_LT(seen.swerve, 1e-2) << speed;
    }
}

TEST_P(Seams, ABallRollsOverTilesAsOverOneSlab) {
    for (const Tile kind : {Tile::box, Tile::mesh, Tile::field})
        for (const double speed : {0.3, 1.0, 3.0, 10.0}) {
            World world(GetParam(), settings_for(GetParam()));
            add_floor(world, kind, 0.5);
            BodyDef def = dynamic_body(ball(0.2), 8, V{-0.5, 0.2, 0.013}, V{speed, 0, 0});
            def.angular_velocity = narrow(V{0, 0, -speed / 0.2});
            const Ride seen = ride(world, with_material(def, 0.5, 0), speed, 0.2);
            // Known failing: XPBD, whose spins decay, keeps 85 % at 10 m/s.
            EXPECT_NEAR(seen.kept, 1, GetParam() == "xpbd" ? 0.02 * speed : 2e-3)
                << int(kind) << ' ' << speed;
            EXPECT_LT(seen.hop, 1e-3) << int(kind) << ' ' << speed;
            EXPECT_LT(seen.swerve, 1e-2) << int(kind) << ' ' << speed;
        }
}

// With other steps, and rotated by some angle to the tiles. Known failing: two substeps of 1/60 s
// keep 99.5 %.
TEST(SoftStepSeams, DoNotDependOnStepOrAngle) {
    for (const int substeps : {2, 4, 8})
        for (const double dt : {1 / 60.0, 1 / 120.0, 1 / 240.0})
            for (const double angle : {0.0, 0.4, 0.785}) {
                StepSettings settings = settings_for("soft_step");
                settings.substeps = substeps;
                settings.dt = dt;
                World world("soft_step", settings);
                add_floor(world, Tile::box, 0);
                BodyDef def = dynamic_body(block(V{0.2}), 8, V{-0.5, 0.2, 0.013}, V{3, 0, 0});
                def.pose.rotation = glm::normalize(narrow(glm::angleAxis(angle, V{0, 1, 0})));
                const Ride seen = ride(world, with_material(def, 0, 0), 3, 0.2);
                const bool coarse = substeps == 2 && dt > 1 / 70.0;
                EXPECT_NEAR(seen.kept, 1, coarse ? 5e-3 : 1e-3)
                    << substeps << ' ' << dt << ' ' << angle;
                EXPECT_LT(seen.hop, 2e-3) << substeps << ' ' << dt << ' ' << angle;
            }
}

// By Galileo's principle: tiles that move on beneath a body at rest, as separate bodies or as one.
TEST_P(Seams, MovingTilesActAsOneSlabToo) {
    for (const bool is_one_body : {false, true})
        for (const double friction : {0.0, 0.1})
            for (const double speed : {0.01, 0.1, 0.6, 6.0}) {
                World world(GetParam(), settings_for(GetParam()));
                BodyDef belt;
                belt.kind = BodyKind::kinematic;
                belt.velocity = narrow(V{speed, 0, 0});
                for (int i = 0; i < 16; ++i) {
                    const double x = -0.49 - i;
                    BodyDef tile = static_body(block(V{0.5, 0.25, 1}), V{x + 0.5, -0.25, 0});
                    ColliderDef collider = tile.colliders.front();
                    collider.shape = Box{narrow(V{x + 0.5, -0.25, 0}), identity_rotation,
                                         narrow(V{0.5, 0.25, 1})};
                    belt.colliders.push_back(collider);
                    tile.kind = BodyKind::kinematic;
                    tile.velocity = belt.velocity;
                    if (!is_one_body)
                        world.add_body(with_material(tile, friction, 0));
                }
                if (is_one_body)
                    world.add_body(with_material(belt, friction, 0));
                const BodyId id = world.add_body(with_material(
                    dynamic_body(block(V{0.2}), 8, V{-0.6, 0.2, 0.013}), friction, 0));
                double hop = 0;
                for (int i = 0; i < 90; ++i) {
                    run(world, 1);
                    hop = std::max(hop, position_of(world, id).y - 0.2);
                }
                const double share = std::min(friction * gravity * 1.5 / speed, 1.0);
                // Known failing: XPBD's friction is off by a few per cent.
                const double off = GetParam() == "xpbd" ? 0.05 : 5e-3;
                EXPECT_NEAR(velocity_of(world, id).x / speed, share, off)
                    << is_one_body << ' ' << friction << ' ' << speed;
                EXPECT_LT(hop, 1e-3) << is_one_body << ' ' << friction << ' ' << speed;
            }
}

// What stands on the seam of a turning table of two halves, without friction.
TEST(SoftStepSeams, ATurningTableOfTwoHalvesDoesNotFling) {
    for (const double spin : {0.3, 3.0, 10.0})
        for (const double x : {0.0, 0.3}) {
            World world("soft_step", settings_for("soft_step"));
            BodyDef table;
            table.kind = BodyKind::kinematic;
            table.angular_velocity = narrow(V{0, spin, 0});
            for (const double side : {-1.0, 1.0})
                table.colliders.emplace_back().shape =
                    Box{narrow(V{0, -0.25, side}), identity_rotation, narrow(V{2, 0.25, 1})};
            world.add_body(with_material(table, 0, 0));
            const BodyId id =
                world.add_body(with_material(dynamic_body(block(V{0.5}), 8, V{x, 0.5, 0}), 0, 0));
            run(world, 240);
            EXPECT_LT(glm::length(velocity_of(world, id)), 1e-3) << spin << ' ' << x;
            EXPECT_NEAR(position_of(world, id).y, 0.5, 1e-3) << spin << ' ' << x;
        }
}

// Sliding along a wall of blocks, pressed against it.
TEST_P(Seams, AWallOfBlocksIsOneWall) {
    World world(GetParam(), settings_for(GetParam()));
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 3; ++j)
            world.add_body(with_material(
                static_body(block(V{0.5, 0.5, 0.25}), V{i - 0.5, j - 1.0, -0.25}), 0, 0));
    StepSettings settings = world.settings();
    settings.gravity = V{0, 0, -9.81};
    world.set_settings(settings);
    const BodyId id = world.add_body(
        with_material(dynamic_body(block(V{0.2}), 8, V{-0.5, 0.1, 0.2}, V{2, 0.1, 0}), 0, 0));
    run(world, 480);
    EXPECT_LE(glm::distance(velocity_of(world, id), V{2, 0.1, 0}), 2e-3);
}

// A step that is not flush still stops a body, and a real corner still holds.
TEST_P(Seams, AStepUpIsStillInTheWay) {
    for (const double height : {0.02, 0.1}) {
        World world(GetParam(), settings_for(GetParam()));
        add_floor(world, Tile::box, 0);
        world.add_body(
            with_material(static_body(block(V{0.5, 0.25, 1.5}), V{5.5, height - 0.25, 0}), 0, 0));
        const BodyId id = world.add_body(
            with_material(dynamic_body(block(V{0.2}), 8, V{3, 0.2, 0.013}, V{1, 0, 0}), 0, 0));
        run(world, 300);
        EXPECT_LT(position_of(world, id).x, 4.81) << height;
    }
}

TEST_P(Seams, ABoxAtTheFootOfAWallRests) {
    for (const double gap : {0.0, 1e-5, 1e-3}) {
        World world(GetParam(), settings_for(GetParam()));
        add_floor(world, Tile::box, 0.5);
        world.add_body(
            with_material(static_body(block(V{0.5, 1, 1.5}), V{3.5, 1, 0}), 0.5, 0)); // face x = 3
        const BodyId id = world.add_body(
            with_material(dynamic_body(block(V{0.2}), 8, V{2.8 - gap, 0.2, 0.1}), 0.5, 0));
        run(world, 240);
        EXPECT_LE(glm::distance(position_of(world, id), V{2.8 - gap, 0.2, 0.1}), 2e-3) << gap;
    }
}

// A plank leaning with its foot in the corner of a floor and a wall penetrates neither.
TEST_P(Seams, AFootInACornerIsHeld) {
    World world(GetParam(), settings_for(GetParam()));
    world.add_body(with_material(static_body(block(V{2, 0.25, 2}), V{-2, -0.25, 0}), 0, 0));
    world.add_body(with_material(static_body(block(V{0.25, 2, 2}), V{0.25, 0, 0}), 0, 0));
    BodyDef plank = dynamic_body(block(V{0.02, 0.5, 0.1}), 1, V{-0.4, 0.4, 0});
    plank.pose.rotation = glm::normalize(narrow(glm::angleAxis(pi / 4, V{0, 0, 1})));
    const BodyId id = world.add_body(with_material(plank, 0, 0));
    for (int i = 0; i < 240; ++i) {
        world.step(nullptr);
        ASSERT_GT(position_of(world, id).y, 0.0) << i;
        ASSERT_LT(position_of(world, id).x, 0.0) << i;
    }
}

// Two slabs meet in a ridge that a body can balance on.
TEST(SoftStepSeams, ARidgeHolds) {
    World world("soft_step", settings_for("soft_step"));
    for (const double side : {-1.0, 1.0}) {
        BodyDef slab = static_body(block(V{1, 0.1, 1}));
        const glm::dquat tilt = glm::angleAxis(-side * 0.3, V{0, 0, 1});
        slab.pose.rotation = glm::normalize(narrow(tilt));
        slab.pose.position = narrow(tilt * V{side * 1, -0.1, 0});
        world.add_body(with_material(slab, 0.8, 0));
    }
    const BodyId id = world.add_body(
        with_material(dynamic_body(block(V{0.2, 0.1, 0.2}), 1, V{0, 0.1, 0}), 0.8, 0));
    run(world, 30);
    EXPECT_NEAR(position_of(world, id).y, 0.1, 5e-3);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION

// Blocks that rock from edge to edge: Housner 1963, "The Behavior of Inverted Pendulum Structures
// During Earthquakes". Between impacts energy is constant; an impact passes on the angular momentum
// about the edge that it begins to turn on.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

struct Block {
    double height = 0;
    double slenderness = 0; // height over width

    double critical_angle() const { return std::atan(1 / slenderness); }
    double energy_at_rest() const { return gravity * height / 2; } // of 1 kg
    // What an impact leaves of the energy, with I = 4/3 m R^2 about the edge: (1 - m R^2 / I (1 -
    // cos 2 alpha))^2.
    double left_by_impact() const {
        const double sine = std::sin(critical_angle());
        return std::pow(1 - 1.5 * sine * sine, 2);
    }
};

// Stands on one edge, tilted by `tilt` (rad).
BodyDef tilted(const Block &block, double tilt, double friction) {
    const double width = block.height / block.slenderness;
    const glm::dquat rotation = glm::angleAxis(-tilt, V{0, 0, 1});
    BodyDef def = dynamic_body(trial::block(V{width / 2, block.height / 2, width}), 1,
                               rotation * V{-width / 2, block.height / 2, 0});
    def.pose.rotation = narrow(rotation);
    return with_material(def, friction, 0);
}

double tilt_of(const World &world, BodyId id) {
    const V up = wide(motion_of(world, id).rotation) * V{0, 1, 0};
    return std::atan2(up.x, up.y);
}

// Above rest, at the start, before and after the first impact, and before the second (J).
struct Rocked {
    double begun = 0;
    double before = 0;
    double after = 0;
    double before_next = 0;
};
Rocked rocked(World &world, BodyId id, double at_rest) {
    constexpr int most = 10000, settled = 2; // steps
    const auto now = [&] { return world.energy() - at_rest; };
    Rocked rocked{.begun = now()};
    const auto until_impact = [&] {
        double before = now();
        const double side = tilt_of(world, id);
        for (int i = 0; i < most && tilt_of(world, id) * side > 0; ++i) {
            before = now();
            world.step(nullptr);
        }
        return before;
    };
    rocked.before = until_impact();
    run(world, settled);
    rocked.after = now();
    rocked.before_next = until_impact();
    return rocked;
}

// Arms that are held for the step lag behind by half of it on average, and those of a kept contact
// by more: blocks would lose two or three times what impacts take.
TEST(Rocking, BlocksLoseEnergyOnlyInImpacts) {
    for (const double rate : {30, 60, 240})
        for (const double height : {0.1, 0.5, 2.0, 8.0})
            for (const double slenderness : {3, 5, 8})
                for (const double share : {0.4, 0.7}) {
                    const Block block{height, slenderness};
                    StepSettings settings = settings_for("soft_step");
                    settings.dt = 1 / rate;
                    World world("soft_step", settings);
                    world.add_body(ground(2, 0));
                    const BodyId id =
                        world.add_body(tilted(block, share * block.critical_angle(), 2));
                    const Rocked energy = rocked(world, id, block.energy_at_rest());
                    SCOPED_TRACE(testing::Message() << rate << " Hz, " << height << " m, "
                                                    << slenderness << ", " << share);
                    // The contact's first steps take a little.
                    EXPECT_NEAR(energy.before / energy.begun, 1, 6e-3);
                    EXPECT_NEAR(energy.after / energy.before / block.left_by_impact(), 1, 0.04);
                    EXPECT_NEAR(energy.before_next / energy.after, 1, 1e-3);
                }
}

// On a slab that is a body, too.
TEST(Rocking, OnASlabBlocksLoseEnergyOnlyInImpacts) {
    const Block block{1, 5};
    World world("soft_step", settings_for("soft_step"));
    world.add_body(ground(2, 0));
    constexpr double thickness = 0.2;
    world.add_body(with_material(
        dynamic_body(trial::block(V{2, thickness / 2, 2}), 500, V{0, thickness / 2, 0}), 2, 0));
    run(world, 60);
    BodyDef def = tilted(block, 0.6 * block.critical_angle(), 2);
    def.pose.position.y += Real(thickness);
    const double before = world.energy();
    const BodyId id = world.add_body(def);
    const Rocked energy = rocked(world, id, before + block.energy_at_rest() + gravity * thickness);
    EXPECT_NEAR(energy.before / energy.begun, 1, 0.01);
    EXPECT_NEAR(energy.after / energy.before / block.left_by_impact(), 1, 0.05);
    EXPECT_NEAR(energy.before_next / energy.after, 1, 2e-3);
}

// An edge that comes down over another triangle than the one the block stands on is stopped there,
// and not pushed out of it.
TEST(Rocking, BlocksOnAHeightFieldGainNothing) {
    for (const double height : {0.1, 0.5, 2.0})
        for (const double slenderness : {3, 5, 8})
            for (const double share : {0.4, 0.7}) {
                const Block block{height, slenderness};
                World world("soft_step", settings_for("soft_step"));
                constexpr int side = 17;
                HeightField flat;
                flat.origin = narrow(V{-3.03, 0, -3.07});
                flat.spacing = Real(0.37);
                flat.columns = flat.rows = side;
                flat.heights.assign(std::size_t{side} * side, Real(0));
                BodyDef field;
                field.kind = BodyKind::static_body;
                field.colliders.emplace_back().surface =
                    std::make_shared<const TriangleSurface>(flat, Sides::front);
                world.add_body(with_material(field, 2, 0));
                world.add_body(tilted(block, share * block.critical_angle(), 2));
                const double begun = world.energy() - block.energy_at_rest();
                EXPECT_LT(regained_energy(world, 600), 0.03 * begun)
                    << height << " m, " << slenderness << ", " << share;
            }
}

// However short the steps are.
TEST(Rocking, WhatFallsOverItsEdgeKeepsItsEnergy) {
    for (const double rate : {30, 60, 240, 1920}) {
        StepSettings settings = settings_for("soft_step");
        settings.dt = 1 / rate;
        World world("soft_step", settings);
        world.add_body(ground(5, 0));
        const Block block{1, 6};
        const BodyId id = world.add_body(tilted(block, 1.1 * block.critical_angle(), 5));
        const double begun = world.energy();
        while (tilt_of(world, id) < 0.8 && world.time() < 5)
            world.step(nullptr);
        EXPECT_GT(world.measure().kinetic_energy, 0.9);
        EXPECT_NEAR(world.energy(), begun, 0.01 * world.measure().kinetic_energy) << rate;
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION

// Motors that hold, drive, slip and drive against contacts.
#include "tests/dynamics/worlds.h"

#include <cmath>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

const Quat about_y = narrow(glm::angleAxis(pi / 2, V{0, 0, 1}));
const Quat about_z = narrow(glm::angleAxis(-pi / 2, V{0, 1, 0}));

BodyDef without_contacts(BodyDef def) {
    for (ColliderDef &collider : def.colliders)
        collider.filter = {0, 1};
    return def;
}

// Level links of 1 m and 5 kg in a row, each braked on the one before; the last weighs `tip`. The
// first turns about the world's y axis if `rate` is not 0.
struct Arm {
    World world;
    std::vector<BodyId> links;

    Arm(int count, double tip, double dt, double rate = 0)
        : world("soft_step", [&] {
              StepSettings settings = settings_for("soft_step");
              settings.dt = dt;
              return settings;
          }()) {
        for (int i = 0; i < count; ++i) {
            links.push_back(world.add_body(without_contacts(dynamic_body(
                block({0.5, 0.05, 0.05}), i + 1 == count ? tip : 5, {0.5 + i, 0, 0}))));
            JointDef def;
            def.type = JointType::hinge;
            def.a = i > 0 ? links[std::size_t(i - 1)] : BodyId{};
            def.b = links.back();
            def.anchor_a_local = narrow(V{i > 0 ? 0.5 : 0, 0, 0});
            def.anchor_b_local = narrow(V{-0.5, 0, 0});
            const bool is_base = i == 0 && rate != 0;
            def.frame_a_local = def.frame_b_local = is_base ? about_y : about_z;
            def.motor = JointMotor{Real(is_base ? rate : 0), Real(1e6)};
            world.add_joint(def);
        }
    }
    double tip() { return position_of(world, links.back()).y; }
};

TEST(Motors, HoldAnArmLevel) {
    for (const double dt : {1 / 30.0, 1 / 60.0, 1 / 240.0})
        for (const int count : {1, 2, 3, 4})
            for (const double tip : {5.0, 50.0, 500.0}) {
                Arm arm(count, tip, dt);
                const auto run_for = [&](double seconds) {
                    run(arm.world, static_cast<int>(std::lround(seconds / dt)));
                };
                run_for(2);
                const double soon = arm.tip();
                run_for(20);
                SCOPED_TRACE(testing::Message() << count << " links, " << tip << " kg, dt " << dt);
                EXPECT_NEAR(arm.tip(), 0, 0.005 * std::pow(60 * dt, 2));
                EXPECT_NEAR(arm.tip(), soon, 2e-5);
            }
}

TEST(Motors, HoldAnArmOnATurningBase) {
    for (const double rate : {1.0, 3.0, 6.0, 10.0})
        for (const int count : {2, 4}) {
            Arm arm(count, 5, 1 / 60.0, rate);
            run(arm.world, 1800);
            EXPECT_NEAR(arm.tip(), 0, 1e-3) << count << " links at " << rate << " rad/s";
            const V at = position_of(arm.world, arm.links.back());
            EXPECT_NEAR(std::hypot(at.x, at.z), count - 0.5, 1e-3);
        }
}

// Sliders one below the other, the lower one with `ratio` times the mass.
TEST(Motors, HoldSlidersInARow) {
    for (const double ratio : {1.0, 10.0, 1000.0}) {
        World world("soft_step", settings_for("soft_step"));
        BodyId above{};
        for (const double mass : {1.0, ratio}) {
            const BodyId next =
                world.add_body(without_contacts(dynamic_body(block(V{0.1}), mass, V{0})));
            JointDef def;
            def.type = JointType::slider;
            def.a = above;
            def.b = next;
            def.frame_a_local = def.frame_b_local = about_y;
            def.motor = JointMotor{Real(0), Real(1e6)};
            world.add_joint(def);
            above = next;
        }
        run(world, 1800);
        EXPECT_NEAR(position_of(world, above).y, 0, 1e-4) << ratio;
    }
}

// A brake is dry friction: what it cannot hold slips at its force.
TEST(Motors, SlipAtTheirForce) {
    for (const double share : {0.5, 0.9, 0.99, 1.01, 2.0}) {
        World world("soft_step", settings_for("soft_step"));
        const BodyId body = world.add_body(dynamic_body(block(V{0.1}), 3, V{0}));
        JointDef def;
        def.type = JointType::slider;
        def.b = body;
        def.frame_a_local = def.frame_b_local = about_y;
        def.motor = JointMotor{Real(0), Real(share * 3 * gravity)};
        world.add_joint(def);
        run(world, 120);
        const double slip = std::max(0.0, 1 - share) * gravity;
        EXPECT_NEAR(velocity_of(world, body).y, -2 * slip, 1e-3 + 0.001 * slip) << share;
        EXPECT_NEAR(position_of(world, body).y, -2 * slip, 1e-3 + 0.005 * slip) << share;
    }
}

TEST(Motors, BrakeASpinInTheTimeOfTheirTorque) {
    World world("soft_step", weightless(settings_for("soft_step")));
    BodyDef def = dynamic_body(ball(0.5), 10, V{0}); // 1 kg m^2
    def.angular_velocity = narrow(V{0, 0, 8});
    const BodyId body = world.add_body(def);
    JointDef joint;
    joint.type = JointType::hinge;
    joint.b = body;
    joint.frame_a_local = joint.frame_b_local = about_z;
    joint.motor = JointMotor{Real(0), Real(2)};
    world.add_joint(joint);
    run(world, 120);
    EXPECT_NEAR(spin_of(world, body).z, 4, 0.01);
    run(world, 180);
    EXPECT_NEAR(spin_of(world, body).z, 0, 1e-6);
}

// A gear of boxes around a cylinder, about z.
BodyDef gear(double radius, int teeth, double turned, const V &at, double mass) {
    BodyDef def;
    def.mass = Real(mass);
    def.pose.position = narrow(at);
    def.colliders.emplace_back().shape =
        Cylinder{narrow(V{0, 0, -0.05}), narrow(V{0, 0, 0.05}), Real(radius)};
    for (int i = 0; i < teeth; ++i) {
        const double angle = turned + 2 * pi * i / teeth;
        const double out = radius + 0.03;
        const V middle = out * V{std::cos(angle), std::sin(angle), 0};
        def.colliders.emplace_back().shape =
            Box{narrow(middle), narrow(glm::angleAxis(angle, V{0, 0, 1})),
                narrow(V{0.03, 0.4 * pi * out / teeth, 0.05})};
    }
    return with_material(def, 0.3, 0);
}

// A motor far stronger than it needs starts at once, but does not run into what it drives.
TEST(Motors, DriveGears) {
    for (const double speed : {2.0, 5.0, 10.0})
        for (const double load : {0.0, 50.0}) {
            World world("soft_step", settings_for("soft_step"));
            constexpr double apart = 0.3 + 0.63 + 0.07;
            const BodyId first = world.add_body(gear(0.3, 12, 0, V{0}, 5));
            const BodyId second = world.add_body(gear(0.63, 24, pi / 24 + pi, V{apart, 0, 0}, 20));
            const auto mount = [&](BodyId body, double x) {
                JointDef def;
                def.type = JointType::hinge;
                def.b = body;
                def.anchor_a_local = narrow(V{x, 0, 0});
                def.frame_a_local = def.frame_b_local = about_z;
                return def;
            };
            JointDef motor = mount(first, 0), other = mount(second, apart);
            motor.motor = JointMotor{Real(speed), Real(1e4)};
            if (load > 0)
                other.motor = JointMotor{Real(0), Real(load)};
            world.add_joint(motor);
            world.add_joint(other);
            double turned_first = 0, turned_second = 0;
            for (int step = 0; step < 600; ++step) {
                world.step(nullptr);
                turned_first += spin_of(world, first).z / 60;
                turned_second += spin_of(world, second).z / 60;
            }
            EXPECT_NEAR(turned_first, 10 * speed, 0.1 + 0.01 * 10 * speed) << speed << " " << load;
            EXPECT_NEAR(turned_second, -5 * speed, 0.2 + 0.01 * 5 * speed) << speed << " " << load;
        }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION

// Structures of joints that close on themselves: shelves, frames, scissors. Their joints hold
// angles, and share loads that no one of them determines.
#include "tests/dynamics/worlds.h"

#include <array>
#include <utility>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

// What is built of bodies that do not collide.
class Structure {
  public:
    World world;

    explicit Structure(const StepSettings &settings) : world("soft_step", settings) {}

    BodyId add(const V &half, double mass, const V &at, const V &spin = V{0}) {
        BodyDef def = dynamic_body(block(half), mass, at, glm::cross(spin, at));
        def.angular_velocity = narrow(spin);
        def.colliders[0].filter = {0, 1};
        return world.add_body(def);
    }

    // A hinge's axis is z.
    void join(JointType type, BodyId a, BodyId b, const V &at) {
        JointDef def;
        def.type = type;
        def.a = a;
        def.b = b;
        const auto seen_from = [&](BodyId id) {
            return narrow(id == BodyId{} ? at : at - position_of(world, id));
        };
        def.anchor_a_local = seen_from(a);
        def.anchor_b_local = seen_from(b);
        def.frame_a_local = def.frame_b_local = narrow(glm::angleAxis(-pi / 2, V{0, 1, 0}));
        world.add_joint(def);
    }
};

struct Motionless {
    double gain = 0; // the greatest energy above that at the start, J
    double kinetic = 0;
    double drift = 0;
};
Motionless watch(World &world, double seconds) {
    const double first = world.energy();
    Motionless seen;
    for (int step = 0; step < seconds / world.settings().dt; ++step) {
        world.step(nullptr);
        const Measures now = world.measure();
        seen.gain = std::max(seen.gain, now.energy() - first);
        seen.drift = std::max(seen.drift, now.max_joint_drift);
        seen.kinetic = now.kinetic_energy;
    }
    return seen;
}

// Boards on four posts each, one above the other (up: 1) or hung (-1).
Structure shelf(JointType type, int boards, double board, double post, double up,
                const StepSettings &settings) {
    Structure shelf(settings);
    BodyId below{};
    for (int tier = 0; tier < boards; ++tier) {
        const V seat{0, up * (tier + 1), 0};
        const BodyId next = shelf.add(V{0.5, 0.03, 0.4}, board, seat);
        for (const double x : {-0.45, 0.45})
            for (const double z : {-0.36, 0.36}) {
                const V foot{x, up * tier, z};
                const BodyId leg = shelf.add(V{0.02, 0.5, 0.02}, post, foot + V{0, 0.5 * up, 0});
                shelf.join(type, below, leg, foot);
                shelf.join(type, leg, next, foot + V{0, up, 0});
            }
        below = next;
    }
    return shelf;
}

TEST(Structures, ShelvesStandAndHang) {
    StepSettings settings = settings_for("soft_step");
    settings.sleep_after = 0;
    for (const double dt : {1.0 / 30, 1.0 / 120})
        for (const JointType type : {JointType::fixed, JointType::hinge})
            for (const int boards : {1, 2, 6})
                for (const auto &[board, post] : {std::pair{5.0, 1.0}, std::pair{1.0, 5.0}}) {
                    settings.dt = dt;
                    Structure hung = shelf(type, boards, board, post, -1, settings);
                    const Motionless seen = watch(hung.world, 5);
                    EXPECT_LT(seen.gain, 1e-4) << boards << ", " << board << ", " << dt;
                    EXPECT_LT(seen.kinetic, 1e-6) << boards << ", " << board << ", " << dt;
                    EXPECT_LT(seen.drift, 2e-4) << boards << ", " << board << ", " << dt;
                    if (type == JointType::hinge)
                        continue; // falls to a side, and may
                    Structure standing = shelf(type, boards, board, post, 1, settings);
                    const Motionless stood = watch(standing.world, 5);
                    EXPECT_LT(stood.gain, 1e-4) << boards << ", " << board << ", " << dt;
                    EXPECT_LT(stood.kinetic, 1e-6) << boards << ", " << board << ", " << dt;
                    EXPECT_LT(stood.drift, 2e-4) << boards << ", " << board << ", " << dt;
                }
}

// Nodes in a grid, joined by bars; welded to the world by its lowest nodes, or free and spinning.
Structure frame(JointType type, const std::array<int, 3> &size, bool stands,
                const StepSettings &settings) {
    constexpr double cell = 0.5;
    const V spin = stands ? V{0} : V{2, 3, 1};
    const V middle = stands ? V{0} : 0.5 * cell * V{size[0] - 1, size[1] - 1, size[2] - 1};
    const auto place = [&](int x, int y, int z) { return cell * V{x, y, z} - middle; };
    const auto index = [&](int x, int y, int z) {
        return static_cast<std::size_t>((x * size[1] + y) * size[2] + z);
    };
    Structure frame(settings);
    std::vector<BodyId> nodes;
    const auto each = [&](auto &&use) {
        for (int x = 0; x < size[0]; ++x)
            for (int y = 0; y < size[1]; ++y)
                for (int z = 0; z < size[2]; ++z)
                    use(x, y, z);
    };
    each([&](int x, int y, int z) {
        nodes.push_back(frame.add(V{0.03}, 0.3, place(x, y, z), spin));
        if (stands && y == 0)
            frame.join(JointType::fixed, BodyId{}, nodes.back(), place(x, y, z));
    });
    each([&](int x, int y, int z) {
        for (int axis = 0; axis < 3; ++axis) {
            const int to_x = x + (axis == 0 ? 1 : 0), to_y = y + (axis == 1 ? 1 : 0),
                      to_z = z + (axis == 2 ? 1 : 0);
            if (to_x == size[0] || to_y == size[1] || to_z == size[2])
                continue;
            V half{0.02};
            half[axis] = 0.5 * cell;
            const V from = place(x, y, z), to = place(to_x, to_y, to_z);
            const BodyId bar = frame.add(half, 0.5, 0.5 * (from + to), spin);
            frame.join(type, nodes[index(x, y, z)], bar, from);
            frame.join(type, bar, nodes[index(to_x, to_y, to_z)], to);
        }
    });
    return frame;
}

TEST(Structures, WeldedFramesStand) {
    StepSettings settings = settings_for("soft_step");
    settings.sleep_after = 0;
    for (const std::array<int, 3> &size :
         {std::array{2, 2, 2}, {2, 4, 2}, {3, 2, 3}, {3, 3, 3}, {6, 4, 1}, {2, 8, 2}}) {
        Structure stands = frame(JointType::fixed, size, true, settings);
        const Motionless seen = watch(stands.world, 5);
        EXPECT_LT(seen.gain, 1e-4) << size[0] << size[1] << size[2];
        EXPECT_LT(seen.kinetic, 1e-6) << size[0] << size[1] << size[2];
        EXPECT_LT(seen.drift, 1e-4) << size[0] << size[1] << size[2];
    }
}

TEST(Structures, FramesSpinOnInSpace) {
    const StepSettings settings = weightless(settings_for("soft_step"));
    for (const JointType type : {JointType::fixed, JointType::hinge, JointType::ball})
        for (const std::array<int, 3> &size :
             {std::array{2, 2, 2}, {2, 4, 2}, {3, 2, 3}, {3, 3, 3}, {6, 4, 1}}) {
            Structure spins = frame(type, size, false, settings);
            const double first = spins.world.energy();
            const V momentum = spins.world.measure().angular_momentum;
            const Motionless seen = watch(spins.world, 5);
            EXPECT_LT(seen.gain, 1e-3 * first) << size[0] << size[1] << size[2];
            EXPECT_GT(seen.kinetic, 0.98 * first) << size[0] << size[1] << size[2];
            EXPECT_LT(glm::length(spins.world.measure().angular_momentum - momentum),
                      2e-3 * glm::length(momentum))
                << size[0] << size[1] << size[2];
        }
}

// Bars that cross, pinned where they do and to the next pair at their ends, each 5 cm off the plane
// of the pins to its side; the feet are held.
TEST(Structures, ScissorsHoldWhatTheyBear) {
    StepSettings settings = settings_for("soft_step");
    settings.sleep_after = 0;
    for (const int pairs : {1, 2, 3, 5}) {
        Structure lift(settings);
        std::array<BodyId, 2> before{};
        for (int i = 0; i < pairs; ++i) {
            std::array<BodyId, 2> bars;
            const V middle{0, 0.4 * i + 0.2, 0};
            for (const int side : {0, 1}) {
                const double lean = side == 0 ? 1 : -1;
                BodyDef def =
                    dynamic_body(block(V{0.35, 0.02, 0.03}), 2, middle + V{0, 0, 0.05 * lean});
                def.pose.rotation = narrow(glm::angleAxis(lean * std::atan2(0.4, 0.5), V{0, 0, 1}));
                def.colliders[0].filter = {0, 1};
                bars[std::size_t(side)] = lift.world.add_body(def);
            }
            const auto pin = [&](BodyId a, BodyId b, const V &at) {
                JointDef joint;
                joint.type = JointType::hinge;
                joint.a = a;
                joint.b = b;
                const auto attach = [&](BodyId id, Vec3 &anchor, Quat &axis) {
                    const Transform pose =
                        id == BodyId{} ? Transform{} : lift.world.pose_of(id.index);
                    anchor = glm::conjugate(pose.rotation) * (narrow(at) - pose.position);
                    axis =
                        glm::conjugate(pose.rotation) * narrow(glm::angleAxis(-pi / 2, V{0, 1, 0}));
                };
                attach(a, joint.anchor_a_local, joint.frame_a_local);
                attach(b, joint.anchor_b_local, joint.frame_b_local);
                lift.world.add_joint(joint);
            };
            pin(bars[0], bars[1], middle);
            // A bar that leans to the right begins at the left.
            pin(before[1], bars[0], middle + V{-0.25, -0.2, 0});
            pin(before[0], bars[1], middle + V{0.25, -0.2, 0});
            before = bars;
        }
        const Motionless seen = watch(lift.world, 10);
        EXPECT_LT(seen.gain, 1e-4) << pairs;
        EXPECT_LT(seen.kinetic, 1e-2) << pairs;
        EXPECT_LT(seen.drift, 1e-3) << pairs;
    }
}

// Two bodies on a joint, tumbling in space. On hinges they lost up to a fifth in a minute, whatever
// the step, and on sliders at a stop they multiplied their energy.
TEST(Structures, JoinedPairsTumbleOn) {
    struct Pair {
        JointType type;
        bool is_stopped;
        double spin;
        double dt;
        double most; // change of energy, as a share
    };
    for (const Pair &pair : {Pair{JointType::hinge, false, 4, 1.0 / 60, 0.005},
                             {JointType::hinge, false, 12, 1.0 / 60, 0.02},
                             {JointType::hinge, false, 12, 1.0 / 240, 0.005},
                             {JointType::slider, true, 10, 1.0 / 60, 0.005},
                             {JointType::slider, true, 20, 1.0 / 60, 0.015},
                             {JointType::slider, true, 20, 1.0 / 240, 0.005}})
        for (std::uint32_t seed = 1; seed <= 8; ++seed) {
            Random random(seed);
            StepSettings settings = weightless(settings_for("soft_step"));
            settings.dt = pair.dt;
            World world("soft_step", settings);
            const V out = 0.2 * glm::normalize(any_vector(random, 1));
            const V spin = pair.spin * glm::normalize(any_vector(random, 1));
            const glm::dquat axis = any_rotation(random);
            JointDef joint;
            joint.type = pair.type;
            const auto add = [&](const V &at, Vec3 &anchor, Quat &frame) {
                BodyDef def = dynamic_body(block(V{0.15, 0.1, 0.05}), 1, at, glm::cross(spin, at));
                const glm::dquat turn = any_rotation(random);
                def.pose.rotation = narrow(turn);
                def.angular_velocity = narrow(spin);
                def.colliders[0].filter = {0, 1};
                anchor = narrow(glm::conjugate(turn) * -at);
                frame = narrow(glm::conjugate(turn) * axis);
                return world.add_body(def);
            };
            joint.a = add(-out, joint.anchor_a_local, joint.frame_a_local);
            joint.b = add(out, joint.anchor_b_local, joint.frame_b_local);
            if (pair.is_stopped)
                joint.limits = JointLimits{Real(0), Real(0)};
            world.add_joint(joint);
            const double first = world.energy();
            run(world, static_cast<int>(30 / pair.dt));
            EXPECT_NEAR(world.energy(), first, pair.most * first)
                << static_cast<int>(pair.type) << ", " << pair.spin << " rad/s, " << pair.dt << ", "
                << seed;
        }
}

// How precisely a joint is held does not depend on where the frame of what holds it lies.
TEST(Structures, AJointIsAsStiffWhereverItsWorldBegins) {
    std::vector<double> heights;
    for (const double away : {0.0, 1.0, 100.0}) {
        Structure chain(settings_for("soft_step"));
        BodyDef post = static_body(block(V{0.1}), V{away, 0, 0});
        post.colliders[0].filter = {0, 1};
        BodyId above = chain.world.add_body(post);
        for (int i = 0; i < 5; ++i) {
            const V at{0.5 * i + 0.25, 0, 0};
            const BodyId link = chain.add(V{0.2, 0.05, 0.05}, i == 4 ? 100 : 1, at);
            chain.join(JointType::ball, above, link, at - V{0.25, 0, 0});
            above = link;
        }
        run(chain.world, 60);
        heights.push_back(position_of(chain.world, above).y);
    }
    EXPECT_NEAR(heights[1], heights[0], is_double ? 1e-9 : 1e-3);
    EXPECT_NEAR(heights[2], heights[0], is_double ? 1e-9 : 1e-3);
}

// Left to Gauss-Seidel they come apart by half a metre where they whip.
TEST(Structures, NetsHoldWhereTheyWhip) {
    for (const auto &[balls, steps] : {std::pair{20, 600}, {25, 300}}) {
        StepSettings settings = settings_for("soft_step");
        settings.sleep_after = 0;
        World world("soft_step", settings);
        add_joined_net(world, balls, V{0, 10, 0});
        double drift = 0;
        for (int step = 0; step < steps; ++step) {
            world.step(nullptr);
            drift = std::max(drift, world.measure().max_joint_drift);
        }
        EXPECT_LT(drift, 0.005) << balls;
    }
}

// Its budget affords four substeps, too few where it whips after nine seconds. It would be let go
// there, and fall apart.
TEST(Structures, ALargeNetHoldsWhereItWhips) {
    StepSettings settings = settings_for("soft_step");
    settings.sleep_after = 0;
    World world("soft_step", settings);
    add_joined_net(world, 40, V{0, 10, 0});
    double drift = 0;
    for (int step = 0; step < 600; ++step) {
        world.step(nullptr);
        if (step % 10 == 0)
            drift = std::max(drift, world.measure().max_joint_drift);
    }
    EXPECT_LT(drift, 0.05);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION

// Helpers shared by the dynamics tests: short ways to make bodies, worlds and random numbers.
#pragma once

#include "engine/core/random.h"
#include "engine/dynamics/world.h"
#include "engine/geometry/quickhull.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace trial {

using V = glm::dvec3;

inline constexpr double pi = std::numbers::pi;
inline constexpr double gravity = 9.81;
// Machine epsilon of the precision under test.
inline constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());
inline constexpr bool is_double = sizeof(Real) == sizeof(double);

inline V wide(const Vec3 &v) {
    return {double(v.x), double(v.y), double(v.z)};
}
inline Vec3 narrow(const V &v) {
    return {Real(v.x), Real(v.y), Real(v.z)};
}
inline Quat narrow(const glm::dquat &q) {
    return {Real(q.w), Real(q.x), Real(q.y), Real(q.z)};
}
inline glm::dquat wide(const Quat &q) {
    return {double(q.w), double(q.x), double(q.y), double(q.z)};
}

inline V any_vector(Random &random, double reach) {
    const double x = random.next_in(-reach, reach), y = random.next_in(-reach, reach);
    const double z = random.next_in(-reach, reach);
    return {x, y, z};
}
inline glm::dquat any_rotation(Random &random) {
    for (;;) {
        const double w = random.next_in(-1, 1), x = random.next_in(-1, 1);
        const double y = random.next_in(-1, 1), z = random.next_in(-1, 1);
        const double length = std::sqrt(w * w + x * x + y * y + z * z);
        if (length > 0.1 && length < 1)
            return glm::dquat(w / length, x / length, y / length, z / length);
    }
}

inline Sphere ball(double radius) {
    return {Vec3{Real(0)}, Real(radius)};
}
inline Box block(const V &half_extents) {
    return {Vec3{Real(0)}, identity_rotation, narrow(half_extents)};
}
inline Capsule upright_capsule(double half_length, double radius) {
    return {Vec3{0, Real(-half_length), 0}, Vec3{0, Real(half_length), 0}, Real(radius)};
}

// A random ball, box or capsule, 0.1 to 0.8 m in size.
inline Shape any_shape(Random &random) {
    const std::uint32_t kind = random.next_index(3);
    const double a = random.next_in(0.1, 0.3), b = random.next_in(0.1, 0.3);
    const double c = random.next_in(0.1, 0.3);
    if (kind == 0)
        return ball(a);
    if (kind == 1)
        return block(V{a, b, c});
    return upright_capsule(a, 0.6 * b);
}

inline BodyDef dynamic_body(const Shape &shape, double mass, const V &position,
                            const V &velocity = V{0}) {
    BodyDef def;
    def.colliders.emplace_back().shape = shape;
    def.mass = Real(mass);
    def.pose.position = narrow(position);
    def.velocity = narrow(velocity);
    return def;
}
inline BodyDef with_material(BodyDef def, double friction, double restitution) {
    for (ColliderDef &collider : def.colliders)
        collider.material = {Real(friction), Real(restitution)};
    return def;
}
inline BodyDef static_body(const Shape &shape, const V &position = V{0}) {
    BodyDef def;
    def.kind = BodyKind::static_body;
    def.colliders.emplace_back().shape = shape;
    def.pose.position = narrow(position);
    return def;
}
// The half space below the plane through the origin with this normal.
inline BodyDef ground(double friction, double restitution, const V &normal = V{0, 1, 0}) {
    return with_material(static_body(HalfSpace{narrow(normal), Real(0)}), friction, restitution);
}

// Gives a distance joint a fixed length.
inline void set_length(JointDef &joint, Real length) {
    joint.min_length = joint.max_length = length;
}

// A level net of n by n balls of 1 kg, half a metre apart, on ball joints and not colliding with
// each other, held by two corners. The joints come in four groups, within each of which no two
// share a ball.
inline void add_joined_net(World &world, int n, const V &corner) {
    const auto first = static_cast<std::uint32_t>(world.bodies().size());
    for (int i = 0; i < n * n; ++i) {
        BodyDef def = dynamic_body(Sphere{Vec3{0}, Real(0.1)}, 1,
                                   corner + V{0.5 * (i % n), 0, 0.5 * (i / n)});
        def.colliders[0].filter = {0, 1};
        world.add_body(def);
    }
    const auto join = [&](int from, int step, const V &way) {
        JointDef joint;
        joint.a = world.body_id(first + static_cast<std::uint32_t>(from));
        joint.b = world.body_id(first + static_cast<std::uint32_t>(from + step));
        joint.anchor_a_local = narrow(0.5 * way);
        joint.anchor_b_local = narrow(-0.5 * way);
        world.add_joint(joint);
    };
    for (const int odd : {0, 1})
        for (int i = 0; i < n * n; ++i) {
            if (i % n + 1 < n && i % n % 2 == odd)
                join(i, 1, {0.5, 0, 0});
        }
    for (const int odd : {0, 1})
        for (int i = 0; i + n < n * n; ++i)
            if (i / n % 2 == odd)
                join(i, n, {0, 0, 0.5});
    for (const int i : {0, n - 1}) {
        JointDef joint;
        joint.b = world.body_id(first + static_cast<std::uint32_t>(i));
        joint.anchor_a_local = world.pose_of(joint.b.index).position;
        world.add_joint(joint);
    }
}

// A semicircular arch of 100 kg wedges, from 2 to 2.6 m in radius, standing on the ground and
// supporting each other by shape alone.
inline void add_arch(World &world) {
    constexpr int stones = 13;
    constexpr double inner = 2, outer = 2.6, deep = 0.3;
    const double half = 0.5 * pi / stones;
    std::vector<Vec3> corners;
    for (const double radius : {inner, outer})
        for (const double side : {-1.0, 1.0})
            for (const double z : {-deep, deep})
                corners.push_back(
                    narrow(V{side * radius * std::sin(half), radius * std::cos(half), z}));
    const auto mesh = std::make_shared<const HullMesh>(*convex_hull(corners, 64).mesh);
    world.add_body(ground(0.7, 0));
    for (int i = 0; i < stones; ++i) {
        BodyDef stone =
            dynamic_body(ConvexHull{mesh.get(), Vec3{Real(0)}, identity_rotation}, 100, V{0});
        stone.colliders[0].hull = mesh;
        stone.pose.rotation = narrow(glm::angleAxis((2 * i + 1) * half - pi / 2, V{0, 0, 1}));
        world.add_body(with_material(stone, 0.7, 0));
    }
}

// The accumulated impulses of a joint's first rows (N s).
inline V impulse_of(const World &world, std::size_t joint) {
    const auto &impulses = world.state().joints[joint].impulses;
    return {double(impulses[0]), double(impulses[1]), double(impulses[2])};
}

// The method's default settings; for sequential impulses with all our additions, as for NNCG.
inline StepSettings settings_for(const std::string &method) {
    StepSettings settings = find_method(method)->info.defaults;
    if (method == "sequential_impulses") {
        settings.foresee_turns = settings.closed_form_flight = 1;
        settings.push_velocity = 3;
        settings.impact_sweeps = 32;
    }
    return settings;
}
inline StepSettings weightless(StepSettings settings) {
    settings.gravity = V{0};
    return settings;
}
// The duration of a substep.
inline double substep_of(const World &world) {
    return world.settings().dt / world.settings().substeps;
}

// Naive impulses come before gravity's, so what rests falls by g h^2 in each substep, still moves
// at g h after it, and a share (baumgarte) of its drift is taken back.
inline double speed_left_at_rest(const World &world) {
    return world.method().info.name == "naive_impulses" ? gravity * substep_of(world) : 0;
}
inline double sag_of_joints(const World &world) {
    return speed_left_at_rest(world) * substep_of(world) / world.settings().baumgarte;
}
// With k (x + h v) + c v = m g for v = g h: the sag beyond m g / k.
inline double more_sag_of_springs(const World &world, double omega, double damping_ratio) {
    return speed_left_at_rest(world) * (substep_of(world) + 2 * damping_ratio / omega);
}

// The spin XPBD loses over a time in which the integral of its cube is `cubed`. XPBD rotates by a
// quaternion's first order and recovers the spin from the imaginary part (Mueller et al. 2020, alg.
// 2), which falls (w h)^2 / 8 short of it in each substep h.
inline double spin_lost_by_xpbd(const World &world, double cubed) {
    return cubed * substep_of(world) / 8;
}

inline void run(World &world, int steps) {
    for (int i = 0; i < steps; ++i)
        world.step(nullptr);
}
// The largest rise of a world's energy above its previous minimum (J).
inline double regained_energy(World &world, int steps) {
    double low = world.energy();
    double most = 0;
    for (int i = 0; i < steps; ++i) {
        world.step(nullptr);
        low = std::min(low, world.energy());
        most = std::max(most, world.energy() - low);
    }
    return most;
}
inline bool all_sleep(const World &world) {
    for (std::size_t i = 0; i < world.bodies().size(); ++i)
        if (world.bodies()[i].alive && world.bodies()[i].kind == BodyKind::dynamic &&
            !world.state().paces[i].is_asleep())
            return false;
    return true;
}

inline const Motion &motion_of(const World &world, BodyId id) {
    return world.motions()[id.index];
}
inline V position_of(const World &world, BodyId id) {
    return wide(motion_of(world, id).position);
}
inline V velocity_of(const World &world, BodyId id) {
    return wide(motion_of(world, id).velocity);
}
inline V spin_of(const World &world, BodyId id) {
    return wide(motion_of(world, id).angular_velocity);
}

// Names of the registered methods with a given ability, for parameterised tests.
inline std::vector<std::string> all_methods() {
    std::vector<std::string> names;
    for (const Method &method : methods())
        names.emplace_back(method.info.name);
    return names;
}
inline std::vector<std::string> contact_methods() {
    std::vector<std::string> names;
    for (const Method &method : methods())
        if (method.info.contacts)
            names.emplace_back(method.info.name);
    return names;
}
inline std::vector<std::string> joint_methods() {
    std::vector<std::string> names;
    for (const Method &method : methods())
        if (method.info.joints)
            names.emplace_back(method.info.name);
    return names;
}
// Methods that resolve each impact separately and integrate free flight in closed form.
inline std::vector<std::string> impact_methods() {
    std::vector<std::string> names;
    for (const Method &method : methods())
        if (std::ranges::find(method.info.reads, SettingGroup::impacts) != method.info.reads.end())
            names.emplace_back(method.info.name);
    return names;
}
inline std::string name_of(const testing::TestParamInfo<std::string> &info) {
    return info.param;
}

} // namespace trial
} // namespace plumb::inline PLUMB_PRECISION

// A world with some of everything a method can step.
#pragma once

#include "engine/geometry/quickhull.h"
#include "tests/dynamics/particles.h"

#include <memory>
#include <utility>

namespace plumb::inline PLUMB_PRECISION {
namespace trial {

inline double hilly(double x, double z) {
    return 0.15 * std::sin(1.7 * x) * std::cos(2.3 * z);
}

// Hills over a square of n by n cells, as a mesh and as a height field.
inline TriangleMesh hilly_mesh(int n, double cell) {
    TriangleMesh mesh;
    for (int row = 0; row <= n; ++row)
        for (int column = 0; column <= n; ++column) {
            const double x = (column - 0.5 * n) * cell, z = (row - 0.5 * n) * cell;
            mesh.vertices.push_back(narrow(V{x, hilly(x, z), z}));
        }
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            const auto at = std::uint32_t(row * (n + 1) + column);
            const auto below = at + std::uint32_t(n + 1);
            mesh.triangles.push_back({at, below, below + 1});
            mesh.triangles.push_back({at, below + 1, at + 1});
        }
    return mesh;
}
inline HeightField hilly_field(int n, double cell) {
    HeightField field;
    field.rows = field.columns = n + 1;
    field.spacing = Real(cell);
    field.origin = narrow(V{-0.5 * n * cell, 0, -0.5 * n * cell});
    for (int row = 0; row <= n; ++row)
        for (int column = 0; column <= n; ++column)
            field.heights.push_back(Real(hilly((column - 0.5 * n) * cell, (row - 0.5 * n) * cell)));
    return field;
}

inline BodyDef hilly_ground(bool as_field, const V &at) {
    constexpr int n = 16;
    constexpr double cell = 0.5;
    BodyDef def;
    def.kind = BodyKind::static_body;
    def.colliders.emplace_back().surface =
        as_field ? std::make_shared<const TriangleSurface>(hilly_field(n, cell), Sides::front)
                 : std::make_shared<const TriangleSurface>(hilly_mesh(n, cell), Sides::front);
    def.pose.position = narrow(at);
    return with_material(def, 0.6, 0.1);
}

inline ColliderDef hull_collider(Random &random) {
    for (;;) {
        std::vector<Vec3> points;
        for (int i = 0; i < 12; ++i)
            points.push_back(narrow(any_vector(random, 0.25)));
        HullResult hull = convex_hull(points, 32);
        if (!hull.mesh)
            continue;
        ColliderDef def;
        def.hull = std::make_shared<const HullMesh>(std::move(*hull.mesh));
        def.shape = ConvexHull{def.hull.get(), Vec3{Real(0)}, identity_rotation};
        return def;
    }
}

// Cycles through balls, boxes, capsules, cylinders, hulls and compounds; every fourth compound has
// a sensor.
inline BodyDef one_of_all_sorts(Random &random, int i, const V &at) {
    const double size = random.next_in(0.15, 0.22);
    BodyDef def = dynamic_body(ball(size), random.next_in(0.5, 2), at, any_vector(random, 1));
    ColliderDef &first = def.colliders.front();
    switch (i % 6) {
    case 0:
        break;
    case 1:
        first.shape = block(V{size, 0.8 * size, 0.6 * size});
        break;
    case 2:
        first.shape = upright_capsule(0.6 * size, 0.5 * size);
        break;
    case 3:
        first.shape =
            Cylinder{narrow(V{0, -0.7 * size, 0}), narrow(V{0, 0.7 * size, 0}), Real(0.8 * size)};
        break;
    case 4:
        first = hull_collider(random);
        break;
    default:
        first.shape = block(V{size, 0.3 * size, 0.3 * size});
        ColliderDef &second = def.colliders.emplace_back();
        second.shape = Sphere{narrow(V{size, 0, 0}), Real(0.5 * size)};
        second.sensor = i % 24 == 5;
        break;
    }
    def.pose.rotation = glm::normalize(narrow(any_rotation(random)));
    def.angular_velocity = narrow(any_vector(random, 2));
    def.locked[5] = i % 11 == 10;
    def.linear_damping = Real(i % 13 == 0 ? 0.5 : 0);
    if (i % 17 == 3) {
        def.force = Vec3{Real(0.5), Real(-1), Real(0.2)};
        def.torque = Vec3{Real(0), Real(0.1), Real(0.05)};
    }
    return with_material(def, random.next_unit(), 0.3 * random.next_unit());
}

// A joint between two bodies at their current poses. Cycles through all types, with motors, limits,
// springs and breaking.
inline JointDef joint_of_all_sorts(const World &world, int i, BodyId a, BodyId b) {
    const Transform pose_a = world.pose_of(a.index), pose_b = world.pose_of(b.index);
    const Vec3 middle = Real(0.5) * (pose_a.position + pose_b.position);
    JointDef def;
    def.type = static_cast<JointType>(i % 5);
    def.a = a;
    def.b = b;
    def.anchor_a_local = glm::conjugate(pose_a.rotation) * (middle - pose_a.position);
    def.anchor_b_local = glm::conjugate(pose_b.rotation) * (middle - pose_b.position);
    def.frame_a_local = glm::normalize(glm::conjugate(pose_a.rotation));
    def.frame_b_local = glm::normalize(glm::conjugate(pose_b.rotation));
    def.min_length = Real(i % 2 == 0 ? 0 : 0.1);
    def.max_length = Real(0.2);
    if (def.type == JointType::hinge || def.type == JointType::slider) {
        if (i / 5 % 2 == 0)
            def.motor = {Real(2), Real(3)};
        if (i / 5 % 3 == 0)
            def.limits = {Real(-0.3), Real(0.2)};
    }
    def.frequency = Real(i / 5 % 4 == 3 ? 4 : 0);
    def.break_force = Real(i / 5 % 5 == 4 ? 20 : 0);
    def.collide_connected = i % 3 == 0;
    return def;
}

// A falling cloth with springs that tear, attached to a body, the world and itself.
inline void add_falling_cloth(World &world, int n, const V &corner, BodyId body) {
    const auto first = std::uint32_t(world.state().particles.size());
    constexpr double cell = 0.2;
    const auto at = [&](int i, int j) { return of_particle(first + std::uint32_t(i * n + j)); };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            world.add_particle(particle_at(corner + V{cell * i, 0, cell * j}, 0.02));
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (const auto &[to_i, to_j] : {std::pair{i + 1, j}, std::pair{i, j + 1}})
                if (to_i < n && to_j < n) {
                    SpringDef def = spring(at(i, j), at(to_i, to_j), cell, 60, 0.1);
                    def.tear_strain = Real(j == n / 2 ? 0.05 : 0);
                    world.add_spring(def);
                }
    world.add_spring(spring(at(0, 0), of_world(corner + V{0, 0.5, 0}), 0.5, 80, 0.1));
    world.add_spring(spring(at(n - 1, 0), of_body(body, {0, 0.1, 0}), 0.3, 40, 0.1));
}

// A heap of mixed bodies that falls through a sensor onto a mesh, a height field, a plane below
// both and a turning platform; with joints, a net, a cloth and a grab where the method supports
// them, and free slots left by removed bodies.
inline World world_of_all_sorts(const std::string &method, int bodies) {
    const MethodInfo &info = find_method(method)->info;
    Random random(17);
    World world(method, settings_for(method));
    world.add_body(hilly_ground(false, {-4, 0, 0}));
    const BodyId doomed = world.add_body(hilly_ground(true, {-4, 3, 0}));
    world.add_body(hilly_ground(true, {4, 0, 0}));
    BodyDef below = ground(0.5, 0);
    below.pose.position.y = Real(-1);
    world.add_body(below);
    BodyDef platform = static_body(block(V{0.8, 0.1, 0.8}), V{0, 0.3, 1});
    platform.kind = BodyKind::kinematic;
    platform.velocity = narrow(V{0, 0.25, 0});
    platform.angular_velocity = narrow(V{0, 0.7, 0});
    world.add_body(platform);
    BodyDef sensor = static_body(block(V{1, 0.3, 1}), V{-1, 0.5, 0});
    sensor.colliders.front().sensor = true;
    world.add_body(sensor);
    std::vector<BodyId> ids;
    for (int i = 0; i < bodies; ++i)
        ids.push_back(world.add_body(one_of_all_sorts(
            random, i, V{0.4 * (i % 8) - 1.5, 0.45 + 0.4 * (i / 32), 0.4 * (i / 8 % 4) - 0.6})));
    world.remove_body(doomed);
    if (info.joints)
        for (int i = 0; i + 1 < bodies; i += 2)
            world.add_joint(
                joint_of_all_sorts(world, i / 2, ids[std::size_t(i)], ids[std::size_t(i) + 1]));
    if (info.springs) {
        const double top = 0.35 + 0.4 * ((bodies + 31) / 32);
        const int n = bodies >= 64 ? 12 : 5;
        add_falling_cloth(world, n, V{-1.5, top, -0.8}, ids.back());
        add_net(world, {.n = n,
                        .side = 2,
                        .middle = {0.5, top + 0.3, 0},
                        .mass = 0.5,
                        .stiffness = 200,
                        .damping = 0.2});
    }
    world.remove_body(ids[4]); // with its joint
    world.grab(ids[7], narrow(V{0.1, 0, 0}), narrow(V{0, 2, 0}), Real(50));
    return world;
}

} // namespace trial
} // namespace plumb::inline PLUMB_PRECISION

// write_scene gives text that parses to the same values, bit for bit.
#include "engine/scene/scene_file.h"
#include "tests/trials.h"

#include "engine/core/random.h"
#include "engine/scene/cloth.h"
#include "engine/scene/expect.h"
#include "engine/scene/file/number.h"
#include "engine/scene/joint_type.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

// ---- a scene as a list of words, so that equal lists mean equal bits ----

class Words {
  public:
    void add(const std::string &value) { words_.push_back('"' + value + '"'); }
    void add(double value) { number(std::bit_cast<std::uint64_t>(value)); }
    void add(float value) { number(std::bit_cast<std::uint32_t>(value)); }
    void number(std::uint64_t value) { words_.push_back(std::to_string(value)); }
    void add(const glm::dvec3 &v) { add(v.x), add(v.y), add(v.z); }
    void add(const glm::vec3 &v) { add(v.x), add(v.y), add(v.z); }
    void add(const glm::dquat &q) { add(q.w), add(q.x), add(q.y), add(q.z); }
    template <typename T> void add(const std::optional<T> &value) {
        number(value.has_value());
        if (value)
            add(*value);
    }
    void add(const std::array<double, 2> &pair) { add(pair[0]), add(pair[1]); }
    void add(const SphereDesc &s) { add(s.radius); }
    void add(const BoxDesc &b) { add(b.half_extents); }
    void add(const CapsuleDesc &c) { add(c.half_height), add(c.radius); }
    void add(const CylinderDesc &c) { add(c.half_height), add(c.radius); }
    void add(const HullDesc &h) {
        for (const glm::dvec3 &point : *h.points)
            add(point);
    }
    void add(const PlaneDesc &) {}
    void add(const MeshDesc &m) {
        for (const glm::dvec3 &vertex : m.data->vertices)
            add(vertex);
        for (const auto &triangle : m.data->triangles)
            for (const std::uint32_t corner : triangle)
                number(corner);
        number(m.source.index()), number(static_cast<std::uint64_t>(m.sides));
    }
    void add(const HeightFieldDesc &f) {
        for (const double height : *f.heights)
            add(height);
        number(static_cast<std::uint64_t>(f.rows)), number(static_cast<std::uint64_t>(f.columns));
        add(f.spacing), number(f.hills.has_value()), number(f.is_solid);
    }
    void add(const MassPoseDesc &pose) { add(pose.position), add(pose.orientation); }
    void add(const GivenSettings &given) {
        for (const SettingNumber number : setting_numbers())
            add(given.find(number));
    }

    const std::vector<std::string> &get() const { return words_; }

  private:
    std::vector<std::string> words_;
};

std::vector<std::string> words(const SceneDesc &scene) {
    Words w;
    w.add(scene.title), w.add(scene.description);
    const WorldDesc &world = scene.world;
    w.add(world.method), w.add(world.settings);
    for (const auto &[method, settings] : world.other_methods)
        w.add(method), w.add(settings);
    w.number(static_cast<std::uint64_t>(world.precision)), w.number(world.seed);
    w.add(scene.camera.target), w.add(scene.camera.distance), w.add(scene.camera.yaw);
    w.add(scene.camera.pitch), w.add(scene.camera.fov);
    for (const MaterialDesc &m : scene.materials)
        w.add(m.name), w.add(m.density), w.add(m.friction), w.add(m.restitution), w.add(m.colour);
    for (const BodyDesc &b : scene.bodies) {
        w.add(b.name), w.number(static_cast<std::uint64_t>(b.kind)), w.number(b.colliders.size());
        for (const ColliderDesc &c : b.colliders) {
            w.number(c.shape.index());
            std::visit([&](const auto &shape) { w.add(shape); }, c.shape);
            w.add(c.position), w.add(c.orientation), w.add(c.material), w.add(c.density);
            w.number(static_cast<std::uint64_t>(c.filter.layer)), w.number(c.filter.ignores);
            w.number(c.sensor);
        }
        w.add(b.center_of_mass), w.add(b.inertia), w.add(b.mass_pose), w.add(b.gravity_scale);
        w.number(static_cast<std::uint64_t>(b.pace.substeps));
        w.number(static_cast<std::uint64_t>(b.pace.wanted));
        w.number(static_cast<std::uint64_t>(b.pace.rested));
        w.number(static_cast<std::uint64_t>(b.pace.struck));
        w.add(b.linear_damping), w.add(b.angular_damping), w.add(b.force), w.add(b.torque);
        for (const bool is_locked : b.locked)
            w.number(is_locked);
        w.add(b.material), w.add(b.mass), w.add(b.density), w.add(b.position), w.add(b.orientation);
        w.add(b.velocity), w.add(b.angular_velocity), w.add(b.colour);
    }
    for (const JointDesc &j : scene.joints) {
        w.add(j.name), w.number(static_cast<std::uint64_t>(j.type)), w.add(j.body_a);
        w.add(j.body_b), w.add(j.anchor_a_local), w.add(j.anchor_b_local);
        w.add(j.frame_a_local), w.add(j.frame_b_local), w.add(j.min_length), w.add(j.max_length);
        w.add(j.limits), w.add(j.motor_speed), w.add(j.max_motor_force), w.add(j.frequency);
        w.add(j.damping_ratio), w.add(j.break_force);
        w.number(j.collide_connected), w.number(j.broken);
        for (const double impulse : j.impulses)
            w.add(impulse);
    }
    for (const ParticleDesc &p : scene.particles) {
        w.add(p.name), w.add(p.position), w.add(p.velocity), w.add(p.mass), w.add(p.radius);
        w.number(p.pinned), w.add(p.material), w.add(p.colour);
    }
    for (const ClothDesc &c : scene.cloths) {
        w.add(c.name), w.add(c.position), w.add(c.orientation);
        for (const int cells : c.cells)
            w.number(static_cast<std::uint64_t>(cells));
        w.add(c.size.x), w.add(c.size.y), w.add(c.mass), w.add(c.radius), w.add(c.stretch);
        w.add(c.shear), w.add(c.bend), w.add(c.damping), w.add(c.tear_strain);
        w.add(c.material), w.add(c.colour), w.number(c.pins.size()), w.number(c.torn.size());
        for (const std::vector<std::uint32_t> *all : {&c.pins, &c.torn})
            for (const std::uint32_t each : *all)
                w.number(each);
        for (const ParticleState &p : c.particles)
            w.add(p.position), w.add(p.velocity);
    }
    for (const SpringDesc &s : scene.springs) {
        w.add(s.name), w.add(s.a), w.add(s.b), w.add(s.anchor_a_local), w.add(s.anchor_b_local);
        w.add(s.rest_length), w.add(s.stiffness), w.add(s.damping), w.add(s.tear_strain);
        w.number(s.torn);
    }
    for (const ExpectDesc &e : scene.expects) {
        w.add(e.name), w.add(e.quantity), w.add(e.body), w.add(e.reduce), w.add(e.level);
        w.add(e.from), w.add(e.to), w.number(static_cast<std::uint64_t>(e.relation));
        w.add(e.value), w.add(e.tolerance), w.add(e.estimate), w.add(e.source);
        w.number(e.curve.size());
        for (const double value : e.curve)
            w.add(value);
    }
    w.number(scene.step_count), w.number(scene.dt_since_step), w.add(scene.dt_since_time);
    if (const GrabStateDesc grab = scene.grab.value_or(GrabStateDesc{}); scene.grab) {
        w.add(grab.body), w.add(grab.particle), w.add(grab.point_local), w.add(grab.target);
        w.add(grab.max_force), w.add(grab.frequency), w.add(grab.damping_ratio);
        w.add(grab.impulse), w.add(grab.held_mass);
    }
    for (const ContactStateDesc &c : scene.contacts) {
        w.add(c.body_a), w.add(c.body_b);
        w.add(c.normal), w.add(c.offset), w.add(c.rotation_a), w.add(c.rotation_b);
        for (const ContactStateDesc::Point &p : c.points)
            w.number(p.feature), w.add(p.impulse), w.add(p.core_a), w.add(p.core_b);
    }
    return w.get();
}

// ---- random scenes that use everything ----

class Scenes {
  public:
    explicit Scenes(std::uint64_t seed) : random_(seed) {}

    SceneDesc next() {
        SceneDesc scene;
        scene.title = text();
        scene.description = text();
        WorldDesc &world = scene.world;
        world.method = text();
        world.settings = settings(true);
        for (std::uint32_t i = random_.next_index(3); i > 0; --i)
            world.other_methods["another " + text()] = settings(false);
        world.precision = one_in(2) ? Precision::f32 : Precision::f64;
        world.seed = one_in(2) ? random_.next_u64() : random_.next_index(10);
        scene.camera.target = vector();
        scene.camera.distance = positive();
        scene.camera.yaw = one_in(2) ? random_.next_in(-7, 7) : degrees(-400, 400);
        scene.camera.pitch = one_in(2) ? random_.next_in(-1.5, 1.5) : degrees(-90, 90);
        scene.camera.fov = one_in(2) ? random_.next_in(0.1, 2.5) : degrees(1, 170);
        for (int i = 0; i < 3; ++i)
            scene.materials.push_back(
                {unique(), positive(), random_.next_unit() * 3, random_.next_unit(), colour()});
        for (int i = 0; i < 8; ++i)
            scene.bodies.push_back(body(scene));
        for (int i = 0; i < 4; ++i)
            scene.joints.push_back(joint(scene));
        for (int i = 0; i < 3; ++i)
            scene.particles.push_back(particle(scene));
        for (int i = 0; i < 2; ++i)
            scene.cloths.push_back(cloth(scene));
        for (int i = 0; i < 3; ++i)
            scene.springs.push_back(spring(scene));
        for (int i = 0; i < 3; ++i)
            scene.expects.push_back(expect(scene));
        scene.step_count = one_in(3) ? random_.next_u64() : random_.next_index(1000);
        if (scene.step_count > 0 && one_in(2)) {
            scene.dt_since_step = 1 + (random_.next_u64() % scene.step_count);
            scene.dt_since_time = positive();
        }
        if (one_in(2))
            scene.grab = grab(scene);
        for (std::uint32_t i = random_.next_index(3); i > 0; --i) {
            ContactStateDesc contact;
            contact.body_a = scene.bodies[0].name;
            contact.body_b = scene.bodies[i].name;
            contact.child_a = random_.next_index(3);
            if (one_in(3))
                contact.triangle = static_cast<std::uint32_t>(random_.next_u64());
            for (std::uint32_t k = random_.next_index(5); k > 0; --k)
                contact.points.push_back(
                    {static_cast<std::uint32_t>(random_.next_u64()), vector(), vector(), vector()});
            contact.normal = vector();
            contact.offset = vector();
            contact.rotation_a = scene.bodies[1].orientation;
            contact.rotation_b = scene.bodies[2].orientation;
            scene.contacts.push_back(contact);
        }
        return scene;
    }

  private:
    bool one_in(std::uint32_t n) { return random_.next_index(n) == 0; }

    // Magnitudes up to 1e9 of every order, and also round numbers, both zeros and subnormals.
    double number() {
        switch (random_.next_index(6)) {
        case 0:
            return one_in(2) ? 0.0 : -0.0;
        case 1:
            return static_cast<double>(random_.next_index(2001)) - 1000;
        case 2:
            return (static_cast<double>(random_.next_index(2001)) - 1000) / 100;
        case 3:
            return 3 * std::numeric_limits<double>::denorm_min();
        default:
            return (one_in(2) ? -1 : 1) * std::pow(10, random_.next_in(-300, 9));
        }
    }
    double positive() { return std::pow(10, random_.next_in(-2, 2)); }
    double degrees(double low, double high) {
        return std::round(random_.next_in(low, high)) * (3.14159265358979323846 / 180);
    }
    glm::dvec3 vector() {
        const double x = number();
        const double y = number();
        return {x, y, number()};
    }

    std::string text() {
        static const std::vector<std::string> parts{
            "a", "Z", " ", "\"",   "\\",     "\n",   "\t",   "\r",      "'", "#", "=", "[",
            "]", "é", "→", "🧱", "\"\"\"", "\x01", "\x7f", "\\u0041", "9", ".", "-", "\r\n"};
        std::string result = "t";
        for (std::uint32_t i = random_.next_index(12); i > 0; --i)
            result += parts[random_.next_index(static_cast<std::uint32_t>(parts.size()))];
        return result;
    }
    std::string unique() { return text() + std::to_string(++names_); }

    std::optional<glm::vec3> colour() {
        if (one_in(2))
            return std::nullopt;
        const auto channel = [&] { return static_cast<float>(random_.next_unit()); };
        const float r = channel();
        const float g = channel();
        return glm::vec3(r, g, channel());
    }

    // Half of the settings, anywhere in their ranges.
    GivenSettings settings(bool of_world) {
        GivenSettings given;
        for (const SettingNumber number : setting_numbers()) {
            const SettingRow &row = number.setting();
            const bool chosen = number.component > 0 ? given.has(row) : one_in(2);
            if (!chosen || (row.group == SettingGroup::world && !of_world))
                continue;
            double value = one_in(2) ? 1.0 / (2 + random_.next_index(1000))
                                     : random_.next_in(row.min, row.max);
            if (is_whole(row))
                value = std::round(random_.next_in(row.min, row.max));
            given.give(number, value);
        }
        return given;
    }

    glm::dquat rotation() {
        // Drawn one by one: the evaluation order of arguments is unspecified.
        double q[4];
        for (double &part : q)
            part = random_.next_in(-1, 1);
        return glm::normalize(glm::dquat(q[0], q[1], q[2], q[3]));
    }

    std::shared_ptr<const std::vector<glm::dvec3>> corners() {
        const double size = 1 + random_.next_unit();
        return std::make_shared<const std::vector<glm::dvec3>>(
            std::vector<glm::dvec3>{{0, 0, 0}, {size, 0, 0}, {0, 1 / size, 0}, {0, 0, size}});
    }

    // One of the first `kinds` kinds; the last three never move.
    ShapeDesc shape(std::uint32_t kinds) {
        const double x = positive();
        const double y = positive();
        switch (random_.next_index(kinds)) {
        case 0:
            return SphereDesc{x};
        case 1:
            return BoxDesc{{x, y, positive()}};
        case 2:
            return CapsuleDesc{x, y};
        case 3:
            return CylinderDesc{x, y};
        case 4: {
            HullDesc hull;
            hull.points = corners();
            return hull;
        }
        case 5:
            return PlaneDesc{};
        case 6: {
            MeshDesc mesh;
            mesh.data = std::make_shared<const MeshData>(MeshData{*corners(), {{0, 2, 1}}});
            mesh.sides = one_in(2) ? MeshSides::one : MeshSides::both;
            return mesh;
        }
        default: {
            HeightFieldDesc field;
            field.columns = 3;
            field.spacing = x;
            field.is_solid = one_in(2);
            field.heights = std::make_shared<const std::vector<double>>(6, number());
            return field;
        }
        }
    }

    void place(ColliderDesc &collider, const SceneDesc &scene) {
        collider.position = vector();
        collider.orientation = rotation();
        if (one_in(2))
            collider.material = scene.materials[random_.next_index(3)].name;
        if (one_in(2) && collider.shape.index() < 5)
            collider.density = positive();
    }

    BodyDesc body(const SceneDesc &scene) {
        BodyDesc b;
        b.name = unique();
        b.kind = static_cast<BodyKind>(random_.next_index(3));
        const std::size_t shapes = one_in(2) ? 1 : 1 + random_.next_index(3);
        for (std::size_t i = 0; i < shapes; ++i) {
            ColliderDesc &collider = b.colliders.emplace_back();
            collider.shape = shape(b.kind == BodyKind::static_body ? 8 : 5);
            if (shapes > 1)
                place(collider, scene);
            if (one_in(3)) {
                collider.filter.layer = static_cast<int>(random_.next_index(32));
                collider.filter.ignores = static_cast<std::uint32_t>(random_.next_u64());
                collider.sensor = one_in(2);
            }
        }
        const bool can_move = std::ranges::all_of(
            b.colliders, [](const ColliderDesc &c) { return c.shape.index() < 5; });
        if (can_move) {
            // An explicit mass, because the materials' densities may give too much for a scene.
            b.mass = positive();
            if (one_in(3)) {
                b.center_of_mass = vector();
                const double i = positive();
                b.inertia = glm::dvec3(i, i, 1.5 * i);
                b.mass_pose = MassPoseDesc{vector(), rotation()};
            }
        }
        if (one_in(3))
            b.pace = {1 + static_cast<int>(random_.next_index(10000)),
                      static_cast<int>(random_.next_index(65536)),
                      static_cast<int>(random_.next_index(65536))};
        for (bool &is_locked : b.locked)
            is_locked = one_in(4);
        if (one_in(3)) {
            b.gravity_scale = number();
            b.linear_damping = positive();
            b.angular_damping = positive();
        }
        if (b.kind == BodyKind::dynamic && one_in(4)) {
            b.force = vector();
            b.torque = vector();
        }
        if (!one_in(3))
            b.material = scene.materials[random_.next_index(3)].name;
        b.position = vector();
        if (!one_in(3))
            b.orientation = rotation();
        if (b.kind != BodyKind::static_body && one_in(2)) {
            b.velocity = vector();
            b.angular_velocity = vector();
        }
        b.colour = colour();
        return b;
    }

    JointDesc joint(const SceneDesc &scene) {
        JointDesc j;
        j.name = unique();
        const auto types = joint_types();
        const JointTypeInfo &type =
            *types[random_.next_index(static_cast<std::uint32_t>(types.size()))];
        j.type = type.type;
        j.body_a = scene.bodies[random_.next_index(4)].name;
        j.body_b = one_in(3) ? "" : scene.bodies[4 + random_.next_index(4)].name;
        if (one_in(2))
            std::swap(j.body_a, j.body_b);
        j.anchor_a_local = vector();
        j.anchor_b_local = vector();
        if (type.frames != JointTypeInfo::Frames::none) {
            j.frame_a_local = rotation();
            j.frame_b_local = rotation();
        }
        for (const std::vector<JointKey> *keys : {&type.keys, &common_joint_keys()})
            for (const JointKey &key : *keys)
                if (one_in(2))
                    std::visit([&](auto member) { set(j, key, member); }, key.member);
        if (j.type == JointType::distance && j.max_length < j.min_length)
            std::swap(j.min_length, j.max_length);
        if (j.type == JointType::distance && j.max_length == 0)
            j.max_length = positive();
        if (one_in(2))
            for (std::size_t i = 0; i < type.rows.size(); ++i)
                j.impulses[i] = one_in(3) ? number() : 0;
        return j;
    }

    // Within the key's bounds, which are in degrees for angles.
    double value(const JointKey &key) {
        const double share = random_.next_unit();
        const double low = std::max(key.bounds.min, -1000.0);
        const double value = low + share * (std::min(key.bounds.max, 1000.0) - low);
        const double written = one_in(2) ? std::clamp(std::round(value), low, 1000.0) : value;
        return key.is_angle() ? written * (std::numbers::pi / 180) : written;
    }
    void set(JointDesc &j, const JointKey &key, JointKey::Length) {
        j.min_length = j.max_length = value(key);
    }
    void set(JointDesc &j, const JointKey &, bool JointDesc::*member) { j.*member = true; }
    void set(JointDesc &j, const JointKey &key, double JointDesc::*member) {
        j.*member = value(key);
    }
    void set(JointDesc &j, const JointKey &key, std::optional<double> JointDesc::*member) {
        j.*member = value(key);
    }
    void set(JointDesc &j, const JointKey &key,
             std::optional<std::array<double, 2>> JointDesc::*member) {
        const double a = value(key);
        const double b = value(key);
        j.*member = {std::min(a, b), std::max(a, b)};
    }

    GrabStateDesc grab(const SceneDesc &scene) {
        GrabStateDesc g;
        if (one_in(2)) {
            g.body = scene.bodies[random_.next_index(4)].name;
            g.point_local = vector();
            g.impulse = vector();
        } else {
            g.particle = scene.particles[random_.next_index(3)].name;
            g.held_mass = positive();
        }
        g.target = vector();
        g.max_force = positive();
        g.frequency = positive();
        g.damping_ratio = positive();
        return g;
    }

    ParticleDesc particle(const SceneDesc &scene) {
        ParticleDesc p;
        p.name = unique();
        p.position = vector();
        p.mass = positive();
        p.radius = positive();
        p.pinned = one_in(3);
        if (!p.pinned && one_in(2))
            p.velocity = vector();
        if (one_in(2))
            p.material = scene.materials[random_.next_index(3)].name;
        p.colour = colour();
        return p;
    }

    ClothDesc cloth(const SceneDesc &scene) {
        ClothDesc c;
        c.name = unique();
        c.cells = {1 + static_cast<int>(random_.next_index(4)),
                   1 + static_cast<int>(random_.next_index(4))};
        c.size = {positive(), positive()};
        c.position = vector();
        if (one_in(2))
            c.orientation = rotation();
        c.mass = 1 + positive();
        c.radius = positive();
        if (one_in(2)) {
            c.stretch = positive();
            c.shear = 0;
            c.bend = positive();
            c.damping = 0;
            c.tear_strain = positive();
        }
        const std::size_t count = particle_count(c);
        for (std::uint32_t i = 0; i < count; ++i)
            if (one_in(4))
                c.pins.push_back(i);
        if (one_in(2))
            for (std::size_t i = 0; i < count; ++i)
                c.particles.push_back({vector(), vector()});
        if (one_in(2))
            c.torn = {0, 2};
        if (one_in(2))
            c.material = scene.materials[random_.next_index(3)].name;
        c.colour = colour();
        return c;
    }

    SpringDesc spring(const SceneDesc &scene) {
        SpringDesc s;
        s.name = unique();
        const ClothDesc &cloth = scene.cloths[random_.next_index(2)];
        s.a = one_in(2) ? scene.particles[random_.next_index(2)].name
                        : particle_name(cloth, random_.next_index(4));
        if (one_in(2)) {
            s.b = one_in(2) ? "" : scene.bodies[random_.next_index(8)].name;
            s.anchor_b_local = vector();
        } else {
            s.b = scene.particles[2].name;
        }
        if (one_in(2)) {
            std::swap(s.a, s.b);
            std::swap(s.anchor_a_local, s.anchor_b_local);
        }
        s.rest_length = positive();
        s.stiffness = positive();
        s.damping = one_in(2) ? 0 : positive();
        s.tear_strain = one_in(2) ? 0 : positive();
        s.torn = one_in(3);
        return s;
    }

    ExpectDesc expect(const SceneDesc &scene) {
        ExpectDesc e;
        e.name = unique();
        const QuantityInfo &quantity =
            quantities()[random_.next_index(static_cast<std::uint32_t>(quantities().size()))];
        e.quantity = quantity.name;
        if (quantity.needs_body())
            e.body = quantity.of_particles && one_in(2)
                         ? scene.particles[random_.next_index(3)].name
                         : scene.bodies[random_.next_index(8)].name;
        if (quantity.needs_spring())
            e.body = scene.springs[random_.next_index(3)].name;
        if (quantity.needs_joint()) {
            std::vector<std::string> able;
            for (const JointDesc &joint : scene.joints)
                if (has_quantity(joint.type, quantity))
                    able.push_back(joint.name);
            if (able.empty())
                return expect(scene); // another quantity
            e.body = able[random_.next_index(static_cast<std::uint32_t>(able.size()))];
        }
        const ReductionInfo &reduction =
            reductions()[random_.next_index(static_cast<std::uint32_t>(reductions().size()))];
        e.reduce = reduction.name;
        if (reduction.uses_level && one_in(2))
            e.level = number();
        e.from = random_.next_unit();
        e.to = e.from + positive();
        e.relation = static_cast<ExpectDesc::Relation>(random_.next_index(3));
        e.value = one_in(4) ? std::numeric_limits<double>::max() : number();
        if (e.relation == ExpectDesc::Relation::equals) {
            e.tolerance = positive();
            if (one_in(2))
                e.estimate = random_.next_unit() * 0.099 * e.tolerance;
            if (reduction.of_distance && one_in(2)) {
                e.value = 0;
                for (std::uint32_t count = 4 + random_.next_index(30); count > 0; --count)
                    e.curve.push_back(number());
            }
        }
        e.source = text();
        return e;
    }

    Random random_;
    int names_ = 0;
};

TEST(RoundTrip, KeepsEveryBitOfRandomScenes) {
    Scenes scenes(1);
    const int count = std::max(100, trials(500));
    for (int i = 0; i < count; ++i) {
        const SceneDesc scene = scenes.next();
        const std::string text = write_scene(scene);
        const SceneFileResult read = parse_scene(text, "s.toml");
        std::string messages;
        for (const SceneMessage &message : read.messages)
            if (message.severity == SceneMessage::Severity::error)
                messages += format_message("s.toml", message) + "\n";
        ASSERT_EQ(messages, "") << text;
        ASSERT_EQ(words(read.scene), words(scene)) << text;
        ASSERT_EQ(write_scene(read.scene), text);
    }
}

TEST(RoundTrip, DefaultSceneAndEmptyNames) {
    const SceneFileResult read = parse_scene(write_scene({}), "s.toml");
    EXPECT_TRUE(read.ok());
    EXPECT_TRUE(read.messages.empty());
    EXPECT_EQ(words(read.scene), words({}));
}

TEST(RoundTrip, RepeatsComeOutFlat) {
    const std::string text = "[[body]]\nname = \"x\"\nshape = \"sphere\"\nradius = 0.1\n"
                             "repeat = { kind = \"scatter\", count = 5, half_extents = [9, 9, 9], "
                             "min_distance = 1, random_rotation = true }\n";
    const SceneDesc scene = parse_scene(text, "s.toml").scene;
    const std::string flat = write_scene(scene);
    EXPECT_EQ(flat.find("repeat"), std::string::npos);
    EXPECT_NE(flat.find("name = \"x_4\""), std::string::npos);
    EXPECT_EQ(words(parse_scene(flat, "s.toml").scene), words(scene));
}

TEST(RoundTrip, TextReadsWell) {
    SceneDesc scene;
    scene.title = "One ball";
    scene.world.settings.give(&StepSettings::dt, 1.0 / 120);
    scene.camera.yaw = 30 * (3.14159265358979323846 / 180);
    BodyDesc &ball = scene.bodies.emplace_back();
    ball.name = "ball";
    ball.colliders.emplace_back().shape = SphereDesc{0.1};
    ball.mass = 2.5;
    ball.position = {0, 1, 0};
    const std::string text = write_scene(scene);
    EXPECT_NE(text.find("dt = \"1/120\"\n"), std::string::npos) << text;
    EXPECT_NE(text.find("yaw_deg = 30\n"), std::string::npos) << text;
    EXPECT_NE(text.find("[[body]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 0.1\nmass = 2.5\n"
                        "position = [0, 1, 0]\n"),
              std::string::npos)
        << text;
}

// A float world lets rotations drift this far from unit length; normalizing them would change how
// the run goes on.
TEST(RoundTrip, KeepsRotationsThatStrayedByRounding) {
    for (const double length : {1 - 6e-7, 1 - 4.9e-7, 1 + 4.9e-7, 1 + 6e-7}) {
        const std::string half = shortest(0.5 * length);
        const SceneFileResult read = parse_scene(
            "[[body]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 1\norientation = [" + half +
                ", " + half + ", " + half + ", " + half + "]\n",
            "strayed");
        ASSERT_TRUE(read.ok()) << format_message("strayed", read.messages.front());
        EXPECT_EQ(read.scene.bodies[0].orientation, 0.5 * length * glm::dquat(1, 1, 1, 1))
            << length;
    }
}

TEST(Shortest, ReadsBackToTheSameBits) {
    Random random(3);
    for (int i = 0; i < 200'000; ++i) {
        const double d = std::bit_cast<double>(random.next_u64());
        if (std::isfinite(d)) {
            // strtod rounds correctly in every C library in use.
            ASSERT_EQ(std::bit_cast<std::uint64_t>(std::strtod(shortest(d).c_str(), nullptr)),
                      std::bit_cast<std::uint64_t>(d));
        }
        const float f = std::bit_cast<float>(static_cast<std::uint32_t>(random.next_u64()));
        if (std::isfinite(f)) {
            ASSERT_EQ(std::bit_cast<std::uint32_t>(
                          static_cast<float>(std::strtod(shortest(f).c_str(), nullptr))),
                      std::bit_cast<std::uint32_t>(f));
        }
    }
    EXPECT_EQ(shortest(0.1), "0.1");
    EXPECT_EQ(shortest(5.0), "5");
    EXPECT_EQ(shortest(0.0), "0");
    EXPECT_EQ(shortest(-0.0), "-0.0");
    EXPECT_EQ(shortest(0.1F), "0.1");
}

} // namespace
} // namespace plumb

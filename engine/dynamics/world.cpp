#include "engine/dynamics/world.h"

#include "engine/core/check.h"
#include "engine/dynamics/motion.h"
#include "engine/geometry/mass.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// How far the broad phase's boxes reach beyond what a step needs (m): larger, and bodies move
// longer before the tree changes, but more pairs are looked at. No result depends on it.
constexpr Real tree_margin = Real(0.1);

void check_pose(const Transform &pose) {
    PLUMB_CHECK(is_finite(pose.position), "body position must be finite, got "
                                              << pose.position.x << ", " << pose.position.y << ", "
                                              << pose.position.z);
    PLUMB_CHECK(is_unit(glm::dot(pose.rotation, pose.rotation)),
                "body rotation must be of unit length, got " << glm::length(pose.rotation));
}

template <typename Item>
std::uint32_t take_slot(std::vector<Item> &items, std::vector<std::uint32_t> &free_slots) {
    if (free_slots.empty()) {
        items.emplace_back();
        return static_cast<std::uint32_t>(items.size() - 1);
    }
    const std::uint32_t slot = free_slots.back();
    free_slots.pop_back();
    return slot;
}

} // namespace

World::World(std::string_view method, const StepSettings &settings) : tree_(tree_margin) {
    set_method(method);
    set_settings(settings);
}

void World::set_method(std::string_view method) {
    const Method *found = find_method(method);
    PLUMB_CHECK(found != nullptr, "no method is called '" << method << "'");
    method_ = found;
}

void World::set_settings(const StepSettings &settings) {
    check_settings(settings);
    if (settings.dt != settings_.dt) {
        time_before_ = time();
        steps_before_ = step_count_;
    }
    settings_ = settings;
}

BodyId World::add_body(const BodyDef &def) {
    check_valid(def.shape);
    check_pose(def.pose);
    PLUMB_CHECK(is_finite(def.velocity) && is_finite(def.angular_velocity),
                "body velocity must be finite");
    PLUMB_CHECK(def.material.friction >= 0 && std::isfinite(def.material.friction),
                "friction must not be negative, got " << def.material.friction);
    PLUMB_CHECK(def.material.restitution >= 0 && def.material.restitution <= 1,
                "restitution must be 0 to 1, got " << def.material.restitution);
    const bool dynamic = def.kind == BodyKind::dynamic;
    const bool half_space = std::holds_alternative<HalfSpace>(def.shape);
    PLUMB_CHECK(!(dynamic && half_space), "a half-space cannot be dynamic");
    Vec3 inertia{Real(0)};
    if (dynamic) {
        PLUMB_CHECK(std::isfinite(def.mass) && def.mass > 0,
                    "mass must be positive, got " << def.mass);
        inertia = principal_inertia(def.shape, def.mass);
        PLUMB_CHECK(is_finite(Real(1) / inertia) && is_finite(inertia),
                    "a dynamic body needs an extent: its moments of inertia are "
                        << inertia.x << ", " << inertia.y << ", " << inertia.z);
    }

    const std::uint32_t slot = take_slot(bodies_, free_bodies_);
    motions_.resize(bodies_.size());
    Body &body = bodies_[slot];
    body.kind = def.kind;
    body.shape = def.shape;
    body.material = def.material;
    body.alive = true;
    Motion &motion = motions_[slot];
    motion = Motion{};
    if (dynamic) {
        body.mass = def.mass;
        body.inertia = inertia;
        body.inv_inertia = Real(1) / body.inertia;
        motion.inv_mass = Real(1) / def.mass;
    }
    if (half_space)
        half_spaces_.insert(std::ranges::lower_bound(half_spaces_, slot), slot);
    const BodyId id{slot, body.generation};
    set_motion(id, def.pose, def.kind == BodyKind::fixed ? Vec3{Real(0)} : def.velocity,
               def.kind == BodyKind::fixed ? Vec3{Real(0)} : def.angular_velocity);
    return id;
}

void World::remove_body(BodyId id) {
    PLUMB_CHECK(is_alive(id), "body " << id.index << " is not alive");
    Body &body = bodies_[id.index];
    if (body.leaf != DynamicTree::none)
        tree_.remove(body.leaf);
    std::erase(half_spaces_, id.index);
    const auto touches = [&](std::uint64_t key) {
        return key >> 32 == id.index || (key & 0xFFFFFFFFU) == id.index;
    };
    std::erase_if(fat_pairs_, touches);
    std::erase_if(contacts_, [&](const Contact &c) { return touches(c.key()); });
    for (std::uint32_t j = 0; j < joints_.size(); ++j)
        if (joints_[j].alive && (joints_[j].a == id.index || joints_[j].b == id.index))
            remove_joint({j, joints_[j].generation});
    const std::uint32_t next_generation = body.generation + 1;
    body = Body{};
    body.generation = next_generation;
    body.kind = BodyKind::fixed; // a hole is a static body that nothing touches
    motions_[id.index] = Motion{};
    free_bodies_.push_back(id.index);
}

bool World::is_alive(BodyId id) const {
    return id.index < bodies_.size() && bodies_[id.index].alive &&
           bodies_[id.index].generation == id.generation;
}

JointId World::add_joint(const JointDef &def) {
    const auto index_of = [&](BodyId id) {
        if (id == BodyId{})
            return Joint::world;
        PLUMB_CHECK(is_alive(id), "joint names body " << id.index << ", which is not alive");
        return id.index;
    };
    const std::uint32_t a = index_of(def.a);
    const std::uint32_t b = index_of(def.b);
    PLUMB_CHECK(a != b, "a joint needs two different bodies");
    PLUMB_CHECK(is_finite(def.anchor_a_local) && is_finite(def.anchor_b_local),
                "joint anchors must be finite");
    PLUMB_CHECK(def.type == JointType::ball || def.type == JointType::distance,
                "only ball and distance joints can be run, got type "
                    << static_cast<int>(def.type));
    PLUMB_CHECK(def.type != JointType::distance || (def.length > 0 && std::isfinite(def.length)),
                "a distance joint's length must be positive, got " << def.length);

    const std::uint32_t slot = take_slot(joints_, free_joints_);
    Joint &joint = joints_[slot];
    joint = Joint{.type = def.type,
                  .a = a,
                  .b = b,
                  .anchor_a_local = def.anchor_a_local,
                  .anchor_b_local = def.anchor_b_local,
                  .length = def.length,
                  .collide_connected = def.collide_connected,
                  .impulse = def.impulse,
                  .generation = joint.generation,
                  .alive = true};
    if (!def.collide_connected && a != Joint::world && b != Joint::world) {
        const std::uint64_t key = Contact::pair_key(a, b);
        joined_.insert(std::ranges::upper_bound(joined_, key), key);
    }
    return {slot, joint.generation};
}

void World::remove_joint(JointId id) {
    PLUMB_CHECK(is_alive(id), "joint " << id.index << " is not alive");
    Joint &joint = joints_[id.index];
    if (!joint.collide_connected && joint.a != Joint::world && joint.b != Joint::world) {
        const std::uint64_t key = Contact::pair_key(joint.a, joint.b);
        joined_.erase(std::ranges::lower_bound(joined_, key));
    }
    const std::uint32_t next_generation = joint.generation + 1;
    joint = Joint{};
    joint.generation = next_generation;
    free_joints_.push_back(id.index);
}

bool World::is_alive(JointId id) const {
    return id.index < joints_.size() && joints_[id.index].alive &&
           joints_[id.index].generation == id.generation;
}

void World::set_motion(BodyId id, const Transform &pose, const Vec3 &velocity,
                       const Vec3 &angular_velocity) {
    PLUMB_CHECK(is_alive(id), "body " << id.index << " is not alive");
    PLUMB_CHECK(is_finite(velocity) && is_finite(angular_velocity), "body velocity must be finite");
    check_pose(pose);
    Motion &motion = motions_[id.index];
    motion.position = pose.position;
    motion.rotation = pose.rotation;
    motion.velocity = velocity;
    motion.angular_velocity = angular_velocity;
    motion.inv_inertia = world_inverse_inertia(pose.rotation, bodies_[id.index].inv_inertia);
}

void World::apply_impulse(BodyId id, const Vec3 &impulse, const Vec3 &point) {
    PLUMB_CHECK(is_alive(id), "body " << id.index << " is not alive");
    PLUMB_CHECK(is_finite(impulse) && is_finite(point), "an impulse must be finite");
    Motion &motion = motions_[id.index];
    motion.apply_impulse(impulse, point - motion.position);
}

void World::set_step_count(std::uint64_t count) {
    step_count_ = count;
    time_before_ = 0;
    steps_before_ = 0;
}

void World::remember_contact(BodyId a, BodyId b, std::span<const std::uint32_t> features,
                             std::span<const Vec3> impulses) {
    PLUMB_CHECK(is_alive(a) && is_alive(b), "a remembered contact names a body that is not alive");
    PLUMB_CHECK(features.size() == impulses.size() && features.size() <= 4,
                "a contact has at most 4 points, got " << features.size());
    Contact contact;
    contact.a = std::min(a.index, b.index);
    contact.b = std::max(a.index, b.index);
    contact.manifold.count = static_cast<int>(features.size());
    for (std::size_t k = 0; k < features.size(); ++k) {
        contact.manifold.points[k].feature = features[k];
        contact.impulses[k] = impulses[k];
    }
    const auto place = std::ranges::lower_bound(contacts_, contact.key(), {}, &Contact::key);
    if (place != contacts_.end() && place->key() == contact.key())
        *place = contact;
    else
        contacts_.insert(place, contact);
}

std::optional<WorldHit> World::raycast(const Ray &ray) const {
    // Every body in turn: the tree's boxes belong to the start of the last step, and a click is
    // rare.
    std::optional<WorldHit> nearest;
    Ray shortened = ray;
    for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
        if (!bodies_[i].alive)
            continue;
        if (has_diverged(motions_[i]))
            continue; // it is nowhere
        const Transform pose{motions_[i].position, motions_[i].rotation};
        const std::optional<RayHit> hit = plumb::raycast(placed(bodies_[i].shape, pose), shortened);
        if (hit && (!nearest || hit->t < nearest->hit.t)) {
            nearest = WorldHit{body_id(i), *hit};
            shortened.max_t = hit->t;
        }
    }
    return nearest;
}

} // namespace plumb::inline PLUMB_PRECISION

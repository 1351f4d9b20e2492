// Edits of a world, and queries between steps.
#include "engine/dynamics/world.h"

#include "engine/core/check.h"
#include "engine/dynamics/bodies/mass_frame.h"
#include "engine/dynamics/bodies/solid.h"
#include "engine/dynamics/check_value.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

void check_pose(const Transform &pose) {
    PLUMB_CHECK(is_finite(pose.position), "body position must be finite, got "
                                              << pose.position.x << ", " << pose.position.y << ", "
                                              << pose.position.z);
    PLUMB_CHECK(is_unit(glm::dot(pose.rotation, pose.rotation)),
                "body rotation must have unit length, got " << glm::length(pose.rotation));
}

void check_velocity(const Vec3 &velocity, const Vec3 &angular_velocity) {
    PLUMB_CHECK(is_finite(velocity) && is_finite(angular_velocity), "body velocity must be finite");
}

void check_collider(const ColliderDef &collider) {
    if (!collider.surface)
        check_valid(collider.shape);
    check_not_negative("friction", collider.material.friction);
    PLUMB_CHECK(collider.material.restitution >= 0 && collider.material.restitution <= 1,
                "restitution must be 0 to 1, got " << collider.material.restitution);
    PLUMB_CHECK(collider.filter.layer < 32, "layer must be 0 to 31, got " << collider.filter.layer);
    check_not_negative("density", collider.density);
}

// Only what forces move can feel one.
void check_loads(const BodyDef &def) {
    const auto check = [&](const char *what, const Vec3 &load) {
        PLUMB_CHECK(std::isfinite(load.x + load.y + load.z),
                    "a body's " << what << " must be finite, got " << load.x << ' ' << load.y << ' '
                                << load.z);
        PLUMB_CHECK(def.kind == BodyKind::dynamic || load == Vec3{Real(0)},
                    "only a dynamic body has a " << what);
    };
    check("force", def.force);
    check("torque", def.torque);
}

// The inverse of a mass frame: from the body's frame into it.
Transform into(const Transform &frame) {
    const Quat back = glm::conjugate(frame.rotation);
    return {back * -frame.position, back};
}

bool is_identity(const Transform &frame) {
    return frame.position == Vec3{Real(0)} && frame.rotation == identity_rotation;
}

Real surface_extent(const TriangleSurface &surface, const Transform &pose) {
    const Vec3 reach = glm::max(glm::abs(surface.bounds().min), glm::abs(surface.bounds().max));
    return glm::length(pose.position) + glm::length(reach);
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

World::World(std::string_view method, const StepSettings &settings)
    : model_(std::make_shared<Model>()) {
    set_method(method);
    set_settings(settings);
}

void World::set_method(std::string_view method) {
    const Method *found = find_method(method);
    PLUMB_CHECK(found != nullptr, "there is no method '" << method << "'");
    wake_all();
    method_ = found;
}

void World::set_settings(const StepSettings &settings) {
    check_settings(settings);
    if (settings.dt != settings_.dt) {
        state_.clock.time_before = time();
        state_.clock.steps_before = state_.clock.step_count;
    }
    wake_all();
    use(settings);
}

// Resting bodies keep their swept boxes from step to step, and how far those reach is a setting.
void World::use(const StepSettings &settings) {
    if (settings.speculative_distance != settings_.speculative_distance)
        scratch_ = Scratch{};
    settings_ = settings;
}

Model &World::edit() {
    if (model_.use_count() > 1)
        model_ = std::make_shared<Model>(*model_);
    scratch_.contacts_are_current = false;
    return *model_;
}

void World::add_attractor(const Attractor &attractor) {
    const Vec3 &x = attractor.position;
    PLUMB_CHECK(std::isfinite(x.x + x.y + x.z),
                "an attractor's position must be finite, got " << x.x << ' ' << x.y << ' ' << x.z);
    PLUMB_CHECK(std::isfinite(attractor.gravitational_parameter),
                "gravitational_parameter must be finite, got "
                    << attractor.gravitational_parameter);
    wake_all();
    edit().attractors.push_back(attractor);
}

Vec3 World::pull_on(std::uint32_t body) const {
    Vec3 pull{settings_.gravity};
    if (!model_->attractors.empty())
        pull += attraction(model_->attractors, state_.motions[body].position);
    return plumb::pull_on(model_->bodies[body], pull);
}

Vec3 World::pull_on_particle(std::uint32_t particle) const {
    if (model_->particles[particle].inv_mass == Real(0))
        return Vec3{Real(0)};
    Vec3 pull{settings_.gravity};
    if (!model_->attractors.empty())
        pull += attraction(model_->attractors, state_.particles[particle].position);
    return pull;
}

BodyId World::add_body(const BodyDef &def) {
    PLUMB_CHECK(!def.colliders.empty(), "a body needs a collider");
    PLUMB_CHECK(def.colliders.size() <= UINT16_MAX,
                "a body has at most " << UINT16_MAX << " colliders, got " << def.colliders.size());
    for (const ColliderDef &collider : def.colliders)
        check_collider(collider);
    check_velocity(def.velocity, def.angular_velocity);
    check_not_negative("linear_damping", def.linear_damping);
    check_not_negative("angular_damping", def.angular_damping);
    PLUMB_CHECK(std::isfinite(def.gravity_scale),
                "gravity_scale must be finite, got " << def.gravity_scale);
    check_loads(def);
    check_pose(def.pose);
    if (def.mass_pose)
        check_pose(*def.mass_pose);
    const bool dynamic = def.kind == BodyKind::dynamic;
    const MassFrame mass = dynamic ? mass_frame(def) : MassFrame{};

    Model &model = edit();
    const std::uint32_t slot = take_slot(model.bodies, model.free_bodies);
    state_.motions.resize(model.bodies.size());
    state_.paces.resize(model.bodies.size());
    state_.paces[slot] = Pace{};
    Body &body = model.bodies[slot];
    body.kind = def.kind;
    body.alive = true;
    body.mass_frame = mass.frame;
    body.has_mass_frame = !is_identity(mass.frame);
    if (dynamic) {
        body.mass = mass.mass;
        body.inertia = mass.inertia;
        body.inv_inertia = Real(1) / mass.inertia;
        body.locked = def.locked;
        body.has_locks = std::ranges::find(def.locked, true) != def.locked.end();
        body.gravity_scale = def.gravity_scale;
        body.force = def.force;
        body.torque = def.torque;
        body.has_force = def.force != Vec3{Real(0)};
        body.has_torque = def.torque != Vec3{Real(0)};
        model.bodies_with_force += body.has_force ? 1 : 0;
        model.bodies_with_torque += body.has_torque ? 1 : 0;
        body.linear_damping = def.linear_damping;
        body.angular_damping = def.angular_damping;
        ++model.dynamic_bodies;
    }
    ++model.alive_bodies;
    add_colliders(def, body, slot);

    const BodyId id{slot, body.generation};
    set_motion(id, def.pose, def.velocity, def.angular_velocity);
    if (def.mass_pose) {
        state_.motions[slot].position = def.mass_pose->position;
        state_.motions[slot].rotation = def.mass_pose->rotation;
    }
    return id;
}

// A body's colliders are contiguous: in the holes that its slot's predecessor left, or at the end.
void World::add_colliders(const BodyDef &def, Body &body, std::uint32_t slot) {
    Model &model = *model_;
    const auto count = static_cast<std::uint32_t>(def.colliders.size());
    if (body.collider_room < count) {
        body.first_collider = static_cast<std::uint32_t>(model.colliders.size());
        body.collider_room = count;
        model.colliders.resize(model.colliders.size() + count);
    }
    body.collider_count = count;
    for (std::uint32_t i = 0; i < count; ++i) {
        const ColliderDef &from = def.colliders[i];
        Collider &to = model.colliders[body.first_collider + i];
        to = Collider{.shape = from.shape,
                      .hull = from.hull,
                      .surface = from.surface,
                      .surface_pose = from.surface_pose,
                      .material = from.material,
                      .filter = from.filter,
                      .sensor = from.sensor,
                      .rounding = from.surface ? Real(0) : rounding_of(from.shape),
                      .body = slot,
                      .child = static_cast<std::uint16_t>(i)};
        model.note_layers(from.filter);
        if (body.has_mass_frame)
            to.shape = with_unit_rotation(placed(from.shape, into(body.mass_frame)));
        to.extent =
            from.surface ? surface_extent(*from.surface, from.surface_pose) : core_extent(to.shape);
        to.half_width = from.surface ? std::numeric_limits<Real>::infinity() : half_width(to.shape);
        if (to.is_half_space())
            model.half_spaces.insert(
                std::ranges::lower_bound(model.half_spaces, body.first_collider + i),
                body.first_collider + i);
    }
}

void World::remove_body(BodyId id) {
    PLUMB_CHECK(is_alive(id), "body " << id.index << " is not alive");
    Model &model = edit();
    for (std::uint32_t j = 0; j < model.joints.size(); ++j)
        if (model.joints[j].alive &&
            (model.joints[j].a == id.index || model.joints[j].b == id.index))
            remove_joint({j, model.joints[j].generation});
    Body &body = model.bodies[id.index];
    wake(id.index);
    tear_springs_of(id.index);
    forget_places_of(body);
    forget_contacts_of(id.index);
    for (std::uint32_t i = 0; i < body.collider_count; ++i) {
        std::erase(model.half_spaces, body.first_collider + i);
        model.colliders[body.first_collider + i] = Collider{};
    }
    model.layers = model.heeded_layers = 0;
    for (const Collider &collider : model.colliders)
        if (collider.body != no_body)
            model.note_layers(collider.filter);
    if (state_.grab.body == id.index)
        release();
    --model.alive_bodies;
    if (body.kind == BodyKind::dynamic)
        --model.dynamic_bodies;
    model.bodies_with_force -= body.has_force ? 1 : 0;
    model.bodies_with_torque -= body.has_torque ? 1 : 0;
    const Body gone = body;
    body = Body{}; // a hole is a static body that nothing touches
    body.generation = gone.generation + 1;
    body.first_collider = gone.first_collider;
    body.collider_room = gone.collider_room;
    state_.motions[id.index] = Motion{};
    state_.paces[id.index] = Pace{};
    // The first hole is filled first, so that a new body's slot depends only on where the holes
    // are.
    model.free_bodies.insert(
        std::ranges::upper_bound(model.free_bodies, id.index, std::ranges::greater{}), id.index);
}

bool World::is_alive(BodyId id) const {
    return id.index < bodies().size() && bodies()[id.index].alive &&
           bodies()[id.index].generation == id.generation;
}

// Takes a body's colliders out of the broad phase; the next step places them again.
void World::forget_places_of(const Body &body) {
    Scratch &s = scratch_;
    bool any = false;
    for (std::uint32_t i = body.first_collider; i < body.first_collider + body.collider_count;
         ++i) {
        if (i >= s.leaves.size() || s.leaves[i] == DynamicTree::none)
            continue;
        s.tree.remove(s.leaves[i]);
        s.leaves[i] = DynamicTree::none;
        any = true;
    }
    if (any)
        std::erase_if(s.fat_pairs, [&](std::uint64_t key) {
            const auto is_its = [&](std::uint64_t collider) {
                return collider >= body.first_collider &&
                       collider < body.first_collider + body.collider_count;
            };
            return is_its(key >> 32) || is_its(key & 0xFFFFFFFFU);
        });
}

void World::forget_contacts_of(std::uint32_t body) {
    std::erase_if(state_.contacts, [&](const ContactMemory &memory) {
        return memory.key.a == body || memory.key.b == body;
    });
}

// The loads of diverged bodies are not finite, and the next step would begin with them.
void World::forget_lost_loads_of(std::uint32_t body) {
    const auto are_numbers = [](std::span<const Real> values) {
        return std::ranges::all_of(values, [](Real value) { return std::isfinite(value); });
    };
    std::erase_if(state_.contacts, [&](const ContactMemory &memory) {
        const auto points =
            std::span(state_.points).subspan(memory.first_point, memory.point_count);
        return (memory.key.a == body || memory.key.b == body) &&
               !std::ranges::all_of(
                   points, [](const Vec3 &v) { return is_finite(v); }, &PointMemory::impulse);
    });
    for (std::uint32_t j = 0; j < model_->joints.size(); ++j)
        if ((model_->joints[j].a == body || model_->joints[j].b == body) &&
            !are_numbers(state_.joints[j].impulses)) {
            state_.joints[j].impulses = {};
            remember_penalty(j, {});
        }
    if (state_.grab.body == body && !is_finite(state_.grab.impulse))
        state_.grab.impulse = Vec3{Real(0)};
}

JointId World::add_joint(const JointDef &def) {
    const auto index_of = [&](BodyId id) {
        if (id == BodyId{})
            return Joint::world;
        PLUMB_CHECK(is_alive(id), "joint refers to body " << id.index << ", which is not alive");
        return id.index;
    };
    const std::uint32_t a = index_of(def.a);
    const std::uint32_t b = index_of(def.b);
    PLUMB_CHECK(a != b, "a joint needs two different bodies");
    PLUMB_CHECK(is_finite(def.anchor_a_local) && is_finite(def.anchor_b_local),
                "joint anchors must be finite");
    for (const Quat &frame : {def.frame_a_local, def.frame_b_local})
        PLUMB_CHECK(is_unit(glm::dot(frame, frame)), "a joint's frames must have unit length");
    PLUMB_CHECK(def.type != JointType::distance ||
                    (def.max_length > 0 && std::isfinite(def.max_length) && def.min_length >= 0 &&
                     def.min_length <= def.max_length),
                "a distance joint's length must be positive, got " << def.min_length << " to "
                                                                   << def.max_length);
    check_not_negative("a joint's frequency", def.frequency);
    check_not_negative("a joint's damping_ratio", def.damping_ratio);
    check_not_negative("a joint's break_force", def.break_force);
    PLUMB_CHECK(std::ranges::all_of(def.memory.impulses, [](Real i) { return std::isfinite(i); }),
                "a joint's remembered impulses must be finite");
    if (def.limits)
        PLUMB_CHECK(std::isfinite(def.limits->lower) && std::isfinite(def.limits->upper) &&
                        def.limits->lower <= def.limits->upper,
                    "a joint's lower limit must not exceed its upper, got "
                        << def.limits->lower << " and " << def.limits->upper);
    if (def.motor) {
        PLUMB_CHECK(std::isfinite(def.motor->speed),
                    "a motor's speed must be finite, got " << def.motor->speed);
        check_not_negative("a motor's max_force", def.motor->max_force);
    }

    Model &model = edit();
    const std::uint32_t slot = take_slot(model.joints, model.free_joints);
    state_.joints.resize(model.joints.size());
    state_.joints[slot] = def.memory;
    remember_penalty(slot, def.penalty);
    Joint &joint = model.joints[slot];
    joint = Joint{.type = def.type,
                  .a = a,
                  .b = b,
                  .anchor_a_local = def.anchor_a_local,
                  .anchor_b_local = def.anchor_b_local,
                  .frame_a_local = def.frame_a_local,
                  .frame_b_local = def.frame_b_local,
                  .min_length = def.min_length,
                  .max_length = def.max_length,
                  .limits = def.limits,
                  .motor = def.motor,
                  .frequency = def.frequency,
                  .damping_ratio = def.damping_ratio,
                  .break_force = def.break_force,
                  .collide_connected = def.collide_connected,
                  .generation = joint.generation,
                  .alive = true};
    const auto into_mass_frame = [&](std::uint32_t index, Vec3 &anchor, Quat &frame) {
        if (index == Joint::world || !model.bodies[index].has_mass_frame)
            return;
        const Transform back = into(model.bodies[index].mass_frame);
        anchor = to_world_point(back, anchor);
        frame = back.rotation * frame;
    };
    into_mass_frame(a, joint.anchor_a_local, joint.frame_a_local);
    into_mass_frame(b, joint.anchor_b_local, joint.frame_b_local);
    for (const std::uint32_t body : {a, b})
        if (body != Joint::world) {
            ++model.bodies[body].joint_count;
            wake(body);
        }
    ++model.alive_joints;
    model.joined.add(joint, slot, model.bodies.size());
    return {slot, joint.generation};
}

void World::remove_joint(JointId id) {
    PLUMB_CHECK(is_alive(id), "joint " << id.index << " is not alive");
    Model &model = edit();
    Joint &joint = model.joints[id.index];
    for (const std::uint32_t body : {joint.a, joint.b})
        if (body != Joint::world) {
            --model.bodies[body].joint_count;
            wake(body);
        }
    model.joined.remove(model.joints, id.index);
    const std::uint32_t next_generation = joint.generation + 1;
    joint = Joint{};
    joint.generation = next_generation;
    --model.alive_joints;
    state_.joints[id.index] = JointMemory{};
    remember_penalty(id.index, {});
    model.free_joints.insert( // as for bodies: the first hole is filled first
        std::ranges::upper_bound(model.free_joints, id.index, std::ranges::greater{}), id.index);
}

bool World::is_alive(JointId id) const {
    return id.index < joints().size() && joints()[id.index].alive &&
           joints()[id.index].generation == id.generation;
}

Transform World::pose_of(std::uint32_t body) const {
    const Motion &motion = state_.motions[body];
    const Body &what = bodies()[body];
    if (!what.has_mass_frame)
        return mass_pose(motion);
    const Quat rotation = motion.rotation * glm::conjugate(what.mass_frame.rotation);
    return {motion.position - rotation * what.mass_frame.position, rotation};
}

void World::set_motion(BodyId id, const Transform &pose, const Vec3 &velocity,
                       const Vec3 &angular_velocity) {
    PLUMB_CHECK(is_alive(id), "body " << id.index << " is not alive");
    check_velocity(velocity, angular_velocity);
    check_pose(pose);
    const Body &body = bodies()[id.index];
    Motion &motion = state_.motions[id.index];
    forget_lost_loads_of(id.index);
    motion = {pose.position, pose.rotation, velocity, angular_velocity};
    if (body.kind == BodyKind::static_body)
        motion.velocity = motion.angular_velocity = Vec3{Real(0)};
    // Sleeping bodies are not tested against a body that does not move, so one put there wakes all.
    if (body.kind != BodyKind::dynamic && motion.velocity == Vec3{Real(0)} &&
        motion.angular_velocity == Vec3{Real(0)})
        wake_all();
    else
        wake(id.index);
    if (body.has_mass_frame) {
        motion.position += pose.rotation * body.mass_frame.position;
        motion.rotation = glm::normalize(pose.rotation * body.mass_frame.rotation);
    }
    for (int i = 0; i < 3 && body.has_locks; ++i) {
        if (body.locked[static_cast<std::size_t>(i)])
            motion.velocity[i] = Real(0);
        if (body.locked[static_cast<std::size_t>(i + 3)])
            motion.angular_velocity[i] = Real(0);
    }
    forget_places_of(body);
}

void World::apply_impulse(BodyId id, const Vec3 &impulse, const Vec3 &point) {
    PLUMB_CHECK(is_alive(id), "body " << id.index << " is not alive");
    PLUMB_CHECK(is_finite(impulse) && is_finite(point), "an impulse and its point must be finite");
    const Body &body = bodies()[id.index];
    if (body.kind != BodyKind::dynamic)
        return;
    wake(id.index);
    Motion &motion = state_.motions[id.index];
    Vec3 change = (Real(1) / body.mass) * impulse;
    for (int i = 0; i < 3 && body.has_locks; ++i)
        if (body.locked[static_cast<std::size_t>(i)])
            change[i] = Real(0);
    motion.velocity += change;
    motion.angular_velocity += solver_inverse_inertia(body, motion.rotation) *
                               glm::cross(point - motion.position, impulse);
}

void World::grab(BodyId id, const Vec3 &point_local, const Vec3 &target, Real max_force,
                 const GrabSpring &spring) {
    PLUMB_CHECK(is_alive(id), "body " << id.index << " is not alive");
    PLUMB_CHECK(is_finite(point_local), "a grab's point must be finite");
    const Grab grab = grab_of(target, max_force, spring);
    const Body &body = bodies()[id.index];
    if (body.kind != BodyKind::dynamic)
        return;
    wake(id.index);
    state_.grab = grab;
    state_.grab.body = id.index;
    state_.grab.point_local =
        body.has_mass_frame ? to_world_point(into(body.mass_frame), point_local) : point_local;
}

void World::move_grab(const Vec3 &target) {
    PLUMB_CHECK(is_finite(target), "a grab's target must be finite");
    if (state_.grab.is_holding() || state_.grab.holds_particle())
        state_.grab.target = target;
}

void World::release() {
    state_.grab = Grab{};
}

void World::set_pace(BodyId id, const Pace &pace) {
    PLUMB_CHECK(is_alive(id), "body " << id.index << " is not alive");
    state_.paces[id.index] = pace;
    const bool may_sleep = sleeps() && bodies()[id.index].kind == BodyKind::dynamic;
    if (pace.is_asleep() && !may_sleep)
        state_.paces[id.index].rested = 0;
}

void World::set_clock(const StateClock &clock) {
    PLUMB_CHECK(clock.steps_before <= clock.step_count, "dt was changed after "
                                                            << clock.steps_before << " of "
                                                            << clock.step_count << " steps");
    PLUMB_CHECK(std::isfinite(clock.time_before) && clock.time_before >= 0,
                "dt was changed at " << clock.time_before << " s");
    state_.clock = clock;
}

void World::hold(const Grab &grab) {
    PLUMB_CHECK(is_finite(grab.point_local) && is_finite(grab.impulse) &&
                    std::isfinite(grab.held_mass) && grab.held_mass >= Real(0),
                "a grab's point, impulse and held_mass must be finite, held_mass not negative");
    PLUMB_CHECK(!grab.is_holding() || (grab.body < bodies().size() && bodies()[grab.body].alive),
                "there is no body " << grab.body);
    PLUMB_CHECK(!grab.holds_particle() || grab.particle < model_->particles.size(),
                "there is no particle " << grab.particle);
    // Checks the rest.
    grab_of(grab.target, grab.max_force,
            {static_cast<double>(grab.frequency), static_cast<double>(grab.damping_ratio)});
    const bool can_hold =
        grab.is_holding()
            ? bodies()[grab.body].kind == BodyKind::dynamic
            : grab.holds_particle() && model_->particles[grab.particle].inv_mass > Real(0);
    if (can_hold)
        state_.grab = grab;
}

void World::remember_contact(const ContactKey &key, const ContactOrigin &origin,
                             std::span<const PointMemory> points,
                             std::span<const PointPenalty> penalties) {
    PLUMB_CHECK(key.a < key.b && key.b < bodies().size() && bodies()[key.a].alive &&
                    bodies()[key.b].alive,
                "a saved contact refers to a body that is not alive");
    PLUMB_CHECK(!points.empty() && points.size() <= 4,
                "a contact has 1 to 4 points, got " << points.size());
    const auto is_finite_memory = [](const PointMemory &point) {
        return is_finite(point.impulse) && is_finite(point.core_a) && is_finite(point.core_b);
    };
    PLUMB_CHECK(std::ranges::all_of(points, is_finite_memory) && is_finite(origin.normal) &&
                    is_finite(origin.offset),
                "a saved contact's impulses and places must be finite");
    const ContactMemory memory{key, static_cast<std::uint32_t>(state_.points.size()),
                               static_cast<std::uint32_t>(points.size()), origin};
    state_.points.insert(state_.points.end(), points.begin(), points.end());
    remember_penalties(penalties, points.size());
    const auto place = std::ranges::lower_bound(state_.contacts, key, {}, &ContactMemory::key);
    if (place != state_.contacts.end() && place->key == key)
        *place = memory;
    else
        state_.contacts.insert(place, memory);
    scratch_.contacts_are_current = false;
}

const std::vector<Contact> &World::contacts() const {
    if (!scratch_.contacts_are_current) {
        try {
            note_still(false);
            find_pairs();
            collide();
        } catch (...) {
            scratch_ = Scratch{}; // what was found is incomplete
            throw;
        }
        scratch_.contacts_are_current = true;
    }
    return scratch_.contacts;
}

std::optional<WorldHit> World::raycast(const Ray &ray) const {
    // Every collider in turn: the tree's boxes belong to the start of the last step, and a click is
    // rare.
    std::optional<WorldHit> nearest;
    Ray shortened = ray;
    const auto meet = [&](std::uint32_t body, const Collider &collider,
                          const std::optional<RayHit> &hit) {
        if (!hit || (nearest && hit->t >= nearest->hit.t))
            return;
        nearest = WorldHit{body_id(body), collider.child, *hit};
        shortened.max_t = hit->t;
    };
    for (std::uint32_t i = 0; i < bodies().size(); ++i) {
        const Motion &motion = state_.motions[i];
        const Transform pose = mass_pose(motion);
        const Body &body = bodies()[i];
        if (!body.alive || has_diverged(motion))
            continue; // it is nowhere
        for (std::uint32_t c = 0; c < body.collider_count; ++c) {
            const Collider &collider = model_->colliders[body.first_collider + c];
            if (collider.sensor)
                continue;
            if (!collider.surface) {
                meet(i, collider, plumb::raycast(placed(collider.shape, pose), shortened));
                continue;
            }
            const Transform frame = surface_pose(collider, motion);
            Ray local = shortened;
            local.origin = to_local_point(frame, ray.origin);
            local.direction = to_local_vector(frame, ray.direction);
            std::optional<RayHit> hit = plumb::raycast(*collider.surface, local);
            if (hit) {
                hit->point = to_world_point(frame, hit->point);
                hit->normal = to_world_vector(frame, hit->normal);
            }
            meet(i, collider, hit);
        }
    }
    return nearest;
}

} // namespace plumb::inline PLUMB_PRECISION

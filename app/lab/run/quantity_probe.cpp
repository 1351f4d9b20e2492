#include "app/lab/run/quantity_probe.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <variant>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

// A particle's state as a body's.
BodyState as_body(const ParticleState &particle) {
    BodyState body;
    body.position = particle.position;
    body.velocity = particle.velocity;
    return body;
}

BodyInertia mass_of(const BodyInfo &info) {
    return {info.mass, info.inertia, info.axes};
}

// Not a number once the joint has been removed.
double value_of_joint(const QuantityInfo &quantity, const Frame &frame, std::size_t joint) {
    const auto view = std::ranges::lower_bound(frame.joints, joint, {}, &JointView::joint);
    return view == frame.joints.end() || view->joint != joint
               ? std::numeric_limits<double>::quiet_NaN()
               : std::get<QuantityInfo::OfJoint>(quantity.value)(*view);
}

double value_of_body(const QuantityInfo &quantity, const BodyState &now, const BodyState &start,
                     const BodyInertia &mass) {
    if (const auto *of_mass = std::get_if<QuantityInfo::OfMass>(&quantity.value))
        return (*of_mass)(now, mass);
    return std::get<QuantityInfo::OfBody>(quantity.value)(now, start);
}

} // namespace

RunStart run_start(const Simulation &simulation) {
    RunStart start;
    simulation.read(start.frame, {});
    SceneStart &scene = start.scene;
    scene.measures = simulation.measure();
    for (std::size_t i = 0; i < simulation.body_count(); ++i) {
        const BodyInfo &info = simulation.body_info(i);
        if (!info.alive || info.kind != BodyKind::dynamic)
            continue;
        const BodyState &state = start.frame.bodies[i];
        const glm::dvec3 local_spin =
            glm::conjugate(state.orientation * info.axes) * state.angular_velocity;
        scene.momentum_scale += info.mass * glm::length(state.velocity);
        scene.angular_momentum_scale +=
            info.mass * glm::length(glm::cross(state.position, state.velocity)) +
            glm::length(info.inertia * local_spin);
    }
    for (std::size_t i = 0; i < start.frame.particles.size(); ++i) {
        const ParticleInfo &info = simulation.soft_parts().particles[i];
        const ParticleState &state = start.frame.particles[i];
        if (info.pinned)
            continue;
        scene.momentum_scale += info.mass * glm::length(state.velocity);
        scene.angular_momentum_scale +=
            info.mass * glm::length(glm::cross(state.position, state.velocity));
    }
    return start;
}

QuantityProbe::QuantityProbe(const Simulation &simulation, const std::vector<QuantityName> &names) {
    if (add(simulation, names, nullptr))
        start_ = run_start(simulation).scene;
}

QuantityProbe::QuantityProbe(const Simulation &simulation, const std::vector<QuantityName> &names,
                             const RunStart &start)
    : start_(start.scene) {
    add(simulation, names, &start);
}

// Returns whether any quantity belongs to the whole scene.
bool QuantityProbe::add(const Simulation &simulation, const std::vector<QuantityName> &names,
                        const RunStart *start) {
    simulation.read(frame_, {});
    for (const QuantityName &name : names) {
        const QuantityInfo *info = find_quantity(name.quantity);
        if (info == nullptr)
            throw std::invalid_argument("there is no quantity \"" + name.quantity + "\"");
        items_.push_back(item_of(simulation, *info, name.body, start));
        const bool of_scene = items_.back().of == Item::Of::scene;
        reads_ = reads_ || !of_scene;
        parts_.joints = parts_.joints || info->needs_joint();
        measures_ = measures_ || of_scene;
    }
    return measures_;
}

QuantityProbe::Item QuantityProbe::item_of(const Simulation &simulation,
                                           const QuantityInfo &quantity, const std::string &name,
                                           const RunStart *start) const {
    using Of = Item::Of;
    if (quantity.needs_spring()) {
        if (const auto spring = simulation.soft_parts().find_spring(name))
            return {&quantity, Of::spring, *spring, {}, {}};
        throw std::invalid_argument("there is no spring \"" + name + "\"");
    }
    if (quantity.needs_joint()) {
        if (const auto joint = simulation.find_joint(name))
            if (has_quantity(simulation.joint(*joint)->type, quantity))
                return {&quantity, Of::joint, *joint, {}, {}};
        throw std::invalid_argument("there is no joint \"" + name + "\" with a " +
                                    std::string(quantity.name));
    }
    if (!quantity.needs_body())
        return {&quantity, Of::scene, 0, {}, {}};
    if (const auto body = simulation.find_body(name)) {
        const bool is_old = start != nullptr && *body < start->frame.bodies.size();
        return {&quantity, Of::body, *body, (is_old ? start->frame : frame_).bodies[*body],
                mass_of(simulation.body_info(*body))};
    }
    const auto particle = simulation.soft_parts().find_particle(name);
    if (particle && quantity.of_particles) {
        const ParticleInfo &info = simulation.soft_parts().particles[*particle];
        return {&quantity,
                Of::particle,
                *particle,
                as_body((start != nullptr ? start->frame : frame_).particles[*particle]),
                {.mass = info.pinned ? 0 : info.mass}};
    }
    throw std::invalid_argument("there is no body \"" + name + "\"");
}

double QuantityProbe::value_of(const Item &item, const Simulation &simulation,
                               const Measures &now) const {
    switch (item.of) {
    case Item::Of::scene:
        break;
    case Item::Of::body:
        return value_of_body(*item.quantity, frame_.bodies[item.index], item.start, item.mass);
    case Item::Of::particle:
        return value_of_body(*item.quantity, as_body(frame_.particles[item.index]), item.start,
                             item.mass);
    case Item::Of::joint:
        return value_of_joint(*item.quantity, frame_, item.index);
    case Item::Of::spring: {
        const SpringInfo &spring = simulation.soft_parts().springs[item.index];
        return std::get<QuantityInfo::OfSpring>(item.quantity->value)(
            {glm::distance(place_of(spring.a, frame_.bodies, frame_.particles),
                           place_of(spring.b, frame_.bodies, frame_.particles)),
             spring.rest_length});
    }
    }
    return std::get<QuantityInfo::OfScene>(item.quantity->value)(now, start_);
}

std::vector<double> QuantityProbe::sample(const Simulation &simulation) {
    if (reads_)
        simulation.read(frame_, parts_);
    const Measures now = measures_ ? simulation.measure() : Measures{};
    std::vector<double> values;
    values.reserve(items_.size());
    for (const Item &item : items_)
        values.push_back(value_of(item, simulation, now));
    return values;
}

} // namespace plumb

#include "app/lab/quantity_probe.h"

#include "engine/scene/expect.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

// The angle between two directions, in [0, pi]. By atan2, which keeps its digits where acos loses
// half of them: near 0 and pi.
double angle_between(const glm::dvec3 &a, const glm::dvec3 &b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

double component(const glm::dvec3 &v, char axis) {
    return axis == 'x' ? v.x : axis == 'y' ? v.y : v.z;
}

double body_quantity(const std::string &quantity, const BodyState &state, const BodyState &start) {
    const auto dot = quantity.find('.');
    const std::string base = quantity.substr(0, dot);
    const char axis = dot == std::string::npos ? ' ' : quantity.back();
    if (base == "position")
        return component(state.position, axis);
    if (base == "velocity")
        return component(state.velocity, axis);
    if (base == "speed")
        return glm::length(state.velocity);
    if (base == "angular_velocity")
        return component(state.angular_velocity, axis);
    if (base == "angular_speed")
        return glm::length(state.angular_velocity);
    if (base == "angular_velocity_local")
        return component(glm::conjugate(state.orientation) * state.angular_velocity, axis);
    if (base == "displacement")
        return glm::length(state.position - start.position);
    if (base == "tilt") {
        const glm::dvec3 up(0, 1, 0);
        return angle_between(state.orientation * up, start.orientation * up);
    }
    throw std::invalid_argument("quantity \"" + quantity + "\" cannot be read from a body");
}

double world_quantity(const std::string &quantity, const Measures &now, const Measures &start,
                      double momentum_scale, double angular_momentum_scale) {
    if (quantity == "kinetic_energy")
        return now.kinetic_energy;
    if (quantity == "potential_energy")
        return now.potential_energy;
    if (quantity == "energy")
        return now.energy();
    if (quantity == "energy_error")
        return relative_change(now.energy() - start.energy(),
                               start.kinetic_energy + std::abs(start.potential_energy));
    if (quantity == "linear_momentum_error")
        return relative_change(glm::length(now.linear_momentum - start.linear_momentum),
                               momentum_scale);
    if (quantity == "angular_momentum_error")
        return relative_change(glm::length(now.angular_momentum - start.angular_momentum),
                               angular_momentum_scale);
    if (quantity == "penetration")
        return now.max_penetration;
    if (quantity == "mean_penetration")
        return now.mean_penetration;
    if (quantity == "joint_drift")
        return now.max_joint_drift;
    throw std::invalid_argument("quantity \"" + quantity + "\" cannot be read from a world");
}

} // namespace

QuantityProbe::QuantityProbe(const Simulation &simulation, const std::vector<QuantityName> &names) {
    for (const QuantityName &name : names) {
        const QuantityInfo *info = find_quantity(name.quantity);
        if (info == nullptr)
            throw std::invalid_argument("there is no quantity \"" + name.quantity + "\"");
        Item item{name.quantity, 0, {}};
        if (info->needs_body) {
            const auto body = simulation.find_body(name.body);
            if (!body)
                throw std::invalid_argument("there is no body \"" + name.body + "\"");
            item.body = *body;
            item.start = simulation.body_state(*body);
            (void)body_quantity(item.quantity, item.start, item.start);
        } else {
            measures_ = true;
            (void)world_quantity(item.quantity, start_, start_, 0, 0);
        }
        items_.push_back(std::move(item));
    }
    if (!measures_)
        return;
    start_ = simulation.measure();
    for (std::size_t i = 0; i < simulation.body_count(); ++i) {
        const BodyInfo &info = simulation.body_info(i);
        if (!info.alive || info.kind != BodyKind::dynamic)
            continue;
        const BodyState state = simulation.body_state(i);
        const glm::dvec3 local_spin = glm::conjugate(state.orientation) * state.angular_velocity;
        momentum_scale_ += info.mass * glm::length(state.velocity);
        angular_momentum_scale_ +=
            info.mass * glm::length(glm::cross(state.position, state.velocity)) +
            glm::length(info.inertia * local_spin);
    }
}

std::vector<double> QuantityProbe::sample(const Simulation &simulation) const {
    const Measures now = measures_ ? simulation.measure() : Measures{};
    std::vector<double> values;
    values.reserve(items_.size());
    for (const Item &item : items_) {
        if (find_quantity(item.quantity)->needs_body)
            values.push_back(
                body_quantity(item.quantity, simulation.body_state(item.body), item.start));
        else
            values.push_back(world_quantity(item.quantity, now, start_, momentum_scale_,
                                            angular_momentum_scale_));
    }
    return values;
}

} // namespace plumb

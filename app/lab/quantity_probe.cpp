#include "app/lab/quantity_probe.h"

#include <stdexcept>
#include <variant>

#include <glm/geometric.hpp>

namespace plumb {

QuantityProbe::QuantityProbe(const Simulation &simulation, const std::vector<QuantityName> &names) {
    simulation.read(frame_, {});
    for (const QuantityName &name : names) {
        const QuantityInfo *info = find_quantity(name.quantity);
        if (info == nullptr)
            throw std::invalid_argument("there is no quantity \"" + name.quantity + "\"");
        Item item{info, 0, {}};
        if (info->needs_body()) {
            const auto body = simulation.find_body(name.body);
            if (!body)
                throw std::invalid_argument("there is no body \"" + name.body + "\"");
            item.body = *body;
            item.start = frame_.bodies[*body];
            bodies_ = true;
        }
        measures_ = measures_ || !info->needs_body();
        items_.push_back(item);
    }
    if (!measures_)
        return;
    start_.measures = simulation.measure();
    for (std::size_t i = 0; i < simulation.body_count(); ++i) {
        const BodyInfo &info = simulation.body_info(i);
        if (!info.alive || info.kind != BodyKind::dynamic)
            continue;
        const BodyState &state = frame_.bodies[i];
        const glm::dvec3 local_spin = glm::conjugate(state.orientation) * state.angular_velocity;
        start_.momentum_scale += info.mass * glm::length(state.velocity);
        start_.angular_momentum_scale +=
            info.mass * glm::length(glm::cross(state.position, state.velocity)) +
            glm::length(info.inertia * local_spin);
    }
}

std::vector<double> QuantityProbe::sample(const Simulation &simulation) {
    if (bodies_)
        simulation.read(frame_, {});
    const Measures now = measures_ ? simulation.measure() : Measures{};
    std::vector<double> values;
    values.reserve(items_.size());
    for (const Item &item : items_) {
        if (const auto *of_body = std::get_if<QuantityInfo::OfBody>(&item.quantity->value))
            values.push_back((*of_body)(frame_.bodies[item.body], item.start));
        else
            values.push_back(std::get<QuantityInfo::OfScene>(item.quantity->value)(now, start_));
    }
    return values;
}

} // namespace plumb

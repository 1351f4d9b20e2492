#include "app/sandbox/session/run_trouble.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

template <typename... Values> std::string formatted(const char *format, Values... values) {
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

std::string place(const glm::dvec3 &p) {
    return formatted("(%.4g, %.4g, %.4g)", p.x, p.y, p.z);
}

std::string moment(const Simulation &simulation) {
    return formatted("step %llu (%.4g s)", static_cast<unsigned long long>(simulation.step_count()),
                     simulation.time());
}

// "; the fastest is body "ball", at (1, 2, 3)"; empty if nothing moves freely.
std::string fastest(const Simulation &simulation) {
    const Frame frame = simulation.read();
    const SoftParts &soft = simulation.soft_parts();
    double speed = -1;
    std::string what;
    const auto look = [&](double its_speed, const glm::dvec3 &at, const auto &name) {
        if (its_speed <= speed)
            return;
        speed = its_speed;
        what = "; the fastest is " + name() + ", at " + place(at);
    };
    for (std::size_t i = 0; i < frame.bodies.size(); ++i)
        if (simulation.body_info(i).alive && simulation.body_info(i).kind == BodyKind::dynamic)
            look(glm::length(frame.bodies[i].velocity), frame.bodies[i].position,
                 [&] { return "body \"" + simulation.body_info(i).name + '"'; });
    for (std::size_t i = 0; i < frame.particles.size(); ++i)
        if (!soft.particles[i].pinned)
            look(glm::length(frame.particles[i].velocity), frame.particles[i].position,
                 [&] { return "particle \"" + soft.particle_name(i) + '"'; });
    return what;
}

std::size_t pairs_to_follow(const SceneDesc &scene) {
    const auto count = [&](BodyKind kind) {
        return static_cast<std::size_t>(std::ranges::count(scene.bodies, kind, &BodyDesc::kind));
    };
    return count(BodyKind::dynamic) * count(BodyKind::static_body);
}

// The deepest contact: "; body "box" and body "ground", at (1, 0, 2)".
std::string deepest(const Simulation &simulation) {
    Frame frame;
    simulation.read(frame, {.contacts = true});
    const auto found = std::ranges::min_element(frame.contacts, {}, &ContactView::separation);
    if (found == frame.contacts.end())
        return {};
    return "; bodies \"" + simulation.body_info(found->body_a).name + "\" and \"" +
           simulation.body_info(found->body_b).name + "\", at " + place(found->position);
}

// The same for joints.
std::string worst_joint(const Simulation &simulation) {
    Frame frame;
    simulation.read(frame, {.joints = true});
    const auto found = std::ranges::max_element(frame.joints, {}, &JointView::drift);
    if (found == frame.joints.end())
        return {};
    return "; joint \"" + simulation.joint_name(found->joint) + "\", at " + place(found->anchor_a);
}

} // namespace

TroubleWatch::TroubleWatch(const SceneDesc &scene, const Simulation &simulation)
    : follows_energy_(!brings_energy_in(scene)), tolerated_(tolerated_depths(scene)) {
    const std::size_t pairs = pairs_to_follow(scene);
    follows_passages_ = pairs > 0 && pairs <= most_pairs;
    const Measures start = simulation.measure();
    start_energy_ = simulation.energy();
    energy_scale_ = start.kinetic_energy + std::abs(start.potential_energy);
}

double TroubleWatch::allowed_energy() const {
    const double brought = brought_.empty() ? 0 : brought_.back().energy;
    return start_energy_ + brought + tolerated_energy_gain * (energy_scale_ + std::abs(brought));
}

void TroubleWatch::look_at_energy(const Simulation &simulation) {
    const double energy = simulation.energy();
    if (!(energy > allowed_energy()))
        return;
    // For a scene that starts at rest near the origin, the energy scale at the start means little.
    const double excess = energy - allowed_energy();
    if (excess <= tolerated_energy_gain * simulation.measure().kinetic_energy)
        return;
    const double gain = excess + tolerated_energy_gain * energy_scale_;
    trouble_ = Trouble{Failing::energy_grew,
                       formatted("Energy grew by %.3g J, from %.4g J, by ", gain, energy - gain) +
                           moment(simulation) + fastest(simulation) + ".",
                       simulation.step_count()};
}

void TroubleWatch::look_at_depths(const Simulation &simulation) {
    const Measures now = simulation.measure();
    const std::uint64_t step = simulation.step_count();
    const auto lasts = [&](double depth, double tolerated, std::optional<std::uint64_t> &from) {
        if (!(depth > tolerated))
            from.reset();
        else if (!from)
            from = step;
        return from && step - *from >= lasting;
    };
    const bool is_deep = lasts(now.max_penetration, tolerated_.penetration, deep_from_);
    const bool is_adrift = lasts(now.max_joint_drift, tolerated_.drift, adrift_from_);
    if (is_deep)
        trouble_ = Trouble{Failing::penetration,
                           formatted("Penetration stays above %.3g m: %.3g m at ",
                                     tolerated_.penetration, now.max_penetration) +
                               moment(simulation) + deepest(simulation) + ".",
                           step};
    else if (is_adrift)
        trouble_ = Trouble{Failing::drift,
                           formatted("A joint stays more than %.3g m apart: %.3g m at ",
                                     tolerated_.drift, now.max_joint_drift) +
                               moment(simulation) + worst_joint(simulation) + ".",
                           step};
}

void TroubleWatch::begin_step(const SceneDesc &scene, const Simulation &simulation) {
    if (follows_passages_ && !passages_)
        passages_ = std::make_unique<PassageWatch>(scene, simulation);
}

void TroubleWatch::sample(const Simulation &simulation, const Frame &before, bool held) {
    if (!simulation.report().finite) {
        std::string text = describe(find_divergence(simulation, simulation.step_count(), &before));
        text[0] = 'N';
        divergence_ = Trouble{Failing::not_finite, text + ".", simulation.step_count()};
        return;
    }
    if (trouble_)
        return;
    if (passages_) {
        passages_->sample(simulation);
        if (!passages_->first().empty()) {
            trouble_ = Trouble{Failing::passed_through,
                               "Passed through: " + passages_->first() + ", at " +
                                   moment(simulation) + ".",
                               simulation.step_count()};
            return;
        }
    }
    if (follows_energy_)
        look_at_energy(simulation);
    if (held) {
        deep_from_.reset();
        adrift_from_.reset();
    } else if (!trouble_ && simulation.step_count() % steps_a_look == 0 &&
               simulation.report().moving_bodies > 0) {
        look_at_depths(simulation);
    }
}

void TroubleWatch::failed(const Simulation &simulation, const std::string &message) {
    Divergence divergence;
    divergence.step = simulation.step_count() + 1;
    divergence.time = simulation.time();
    divergence.message = message;
    std::string text = describe(divergence);
    text[0] = 'F';
    divergence_ = Trouble{Failing::not_finite, text, divergence.step};
}

void TroubleWatch::go_back(const Simulation &simulation) {
    const std::uint64_t now = simulation.step_count();
    while (!brought_.empty() && brought_.back().step > now)
        brought_.pop_back();
    for (std::optional<Trouble> *trouble : {&divergence_, &trouble_})
        if (*trouble && (*trouble)->step > now)
            trouble->reset();
    for (std::optional<std::uint64_t> *from : {&deep_from_, &adrift_from_})
        if (*from && **from > now)
            from->reset();
    if (passages_)
        passages_->begin_again(simulation);
}

void TroubleWatch::brought_in(const Simulation &simulation, double energy) {
    if (!std::isfinite(energy) || energy == 0)
        return;
    const double before = brought_.empty() ? 0 : brought_.back().energy;
    brought_.push_back({simulation.step_count(), before + energy});
}

} // namespace plumb

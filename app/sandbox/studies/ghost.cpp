#include "app/sandbox/studies/ghost.h"

#include "app/lab/run/accurate_run.h"

#include <chrono>
#include <exception>
#include <stdexcept>
#include <utility>
#include <variant>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

// A ghost with a shorter dt takes several steps per step of `beside`, but no more than this: it
// must not stall the sandbox.
constexpr int most_steps = 64;
constexpr double reference_allowance = 8e-3; // s, half a frame at 60 Hz

double reference_dt(const Simulation &beside) {
    return beside.settings().dt / 4;
}

} // namespace

Ghost::Ghost(const Simulation &beside, const std::string &method)
    : is_reference_(method == reference_ghost),
      allowance_(is_reference_ ? reference_allowance : 0) {
    const SceneDesc scene = beside.describe();
    RunOptions options;
    if (is_reference_)
        options = accurate_run(scene, {}, reference_dt(beside), 16);
    else
        options.method = method;
    simulation_ = Simulation::create(scene, options, nullptr);
    simulation_->read(present_, {});
    previous_ = present_;
}

void Ghost::begin_step() {
    history_.remember(*simulation_);
    ++steps_;
}

void Ghost::catch_up(const Simulation &beside) {
    std::swap(previous_, present_);
    step_towards(beside);
    simulation_->read(present_, {});
}

void Ghost::go_on(const Simulation &beside) {
    if (lag(beside) == 0)
        return;
    step_towards(beside);
    simulation_->read(present_, {});
    previous_ = present_;
}

double Ghost::lag(const Simulation &beside) const {
    const double behind = beside.time() - simulation_->time();
    return failure_.empty() && behind > 0.5 * simulation_->settings().dt ? behind : 0;
}

void Ghost::step_towards(const Simulation &beside) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    const auto is_late = [&] {
        return is_reference_ &&
               std::chrono::duration<double>(Clock::now() - start).count() >= allowance_;
    };
    try {
        for (int i = 0; i < most_steps && lag(beside) > 0 && !is_late(); ++i) {
            simulation_->step();
            if (!simulation_->report().finite)
                fail("no longer finite");
        }
    } catch (const std::exception &failure) {
        fail(failure.what());
    }
}

bool Ghost::go_back() {
    if (!history_.recall(*simulation_))
        return false;
    --steps_;
    if (steps_ < failed_from_)
        failure_.clear();
    simulation_->read(present_, {});
    previous_ = present_;
    return true;
}

void Ghost::apply(const Simulation &beside, const Command &command) {
    if (std::holds_alternative<SetMethod>(command))
        return;
    Command mine = command;
    if (auto *settings = std::get_if<SetSettings>(&mine)) {
        settings->settings.erase_if(
            [](const SettingRow &row) { return row.group != SettingGroup::world; });
        if (settings->settings.empty())
            return;
        if (is_reference_)
            settings->settings.give(&StepSettings::dt, reference_dt(beside));
    }
    if (is_reference_ && lag(beside) > 0)
        return fail("the scene was changed while the ghost lagged behind");
    try {
        simulation_->apply(mine);
        simulation_->read(present_, {});
        previous_ = present_;
    } catch (const std::invalid_argument &failure) {
        fail(failure.what());
    }
}

void Ghost::fail(const std::string &why) {
    if (!failure_.empty())
        return;
    failure_ = why;
    failed_from_ = steps_;
}

GhostDistance Ghost::farthest(const Simulation &beside, const Frame &frame) const {
    GhostDistance farthest;
    const auto look = [&](const glm::dvec3 &a, const glm::dvec3 &b, const auto &name) {
        const double distance = glm::distance(a, b);
        if (distance > farthest.metres)
            farthest = {distance, name()};
    };
    for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
        const BodyInfo &info = beside.body_info(i);
        if (!info.alive || info.kind == BodyKind::static_body)
            continue;
        const auto twin = simulation_->find_body(info.name);
        if (twin && *twin < present_.bodies.size())
            look(frame.bodies[i].position, present_.bodies[*twin].position,
                 [&] { return info.name; });
    }
    if (frame.particles.size() == present_.particles.size())
        for (std::size_t i = 0; i < frame.particles.size(); ++i)
            look(frame.particles[i].position, present_.particles[i].position,
                 [&] { return beside.soft_parts().particle_name(i); });
    return farthest;
}

} // namespace plumb

// A simulation with closed-form motion, to test the code that watches simulations.
#pragma once

#include "engine/core/check.h"
#include "engine/scene/simulation.h"

#include <functional>
#include <limits>
#include <stdexcept>

namespace plumb {

// One body, "ball", of 2 kg and inertia (1, 2, 3). Its state is state_at(time), its measures
// measures_at(time).
class FakeSimulation : public Simulation {
  public:
    explicit FakeSimulation(double dt) {
        settings_.dt = dt;
        info_.alive = true;
        info_.name = "ball";
        info_.mass = 2;
        info_.inertia = {1, 2, 3};
    }

    std::function<BodyState(double)> state_at = [](double) { return BodyState{}; };
    std::function<Measures(double)> measures_at = [](double) { return Measures{}; };
    std::uint64_t nan_from_step = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t throw_at_step = std::numeric_limits<std::uint64_t>::max();
    mutable int measure_calls = 0;

    using Simulation::read;
    using Simulation::save;
    using Simulation::step;
    void step(StepTimes *) override {
        PLUMB_CHECK(steps_ + 1 != throw_at_step, "told to fail");
        ++steps_;
        report_.finite = steps_ < nan_from_step;
        report_.contacts = 1;
        report_.body_passes = 2;
        report_.constraint_passes = 3;
    }
    std::uint64_t step_count() const override { return steps_; }
    double time() const override { return static_cast<double>(steps_) * settings_.dt; }
    const StepReport &report() const override { return report_; }
    double energy() const override { return static_cast<double>(step_count()); }
    Measures measure() const override {
        ++measure_calls;
        Measures measures = measures_at(time());
        measures.time = time();
        return measures;
    }
    std::uint64_t hash() const override { return steps_; }
    const MethodInfo &method() const override { return method_infos().front(); }
    const StepSettings &settings() const override { return settings_; }
    Precision precision() const override { return Precision::f64; }
    void apply(const Command &command) override {
        std::get<SetSettings>(command).settings.apply_to(settings_);
    }

    struct State : Saved {
        std::uint64_t steps = 0;
    };
    std::unique_ptr<Saved> save(std::unique_ptr<Saved>, const Saved *) const override {
        auto saved = std::make_unique<State>();
        saved->steps = steps_;
        return saved;
    }
    void restore(const Saved &saved) override { steps_ = dynamic_cast<const State &>(saved).steps; }
    SceneDesc describe() const override { return {}; }

    std::size_t body_count() const override { return 1; }
    const BodyInfo &body_info(std::size_t) const override { return info_; }
    void read(Frame &into, const FrameParts &) const override {
        into = {};
        into.step_count = steps_;
        into.time = time();
        BodyState &state = into.bodies.emplace_back(state_at(time()));
        if (steps_ >= nan_from_step)
            state.position.y = std::numeric_limits<double>::quiet_NaN();
    }
    std::optional<std::size_t> find_body(std::string_view name) const override {
        return name == info_.name ? std::optional<std::size_t>(0) : std::nullopt;
    }
    const std::string &joint_name(std::size_t) const override { return info_.name; }
    std::optional<Pick> pick(const glm::dvec3 &, const glm::dvec3 &) const override {
        return std::nullopt;
    }

  private:
    StepSettings settings_;
    StepReport report_;
    BodyInfo info_;
    std::uint64_t steps_ = 0;
};

} // namespace plumb

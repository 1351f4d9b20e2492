#include "app/lab/engines/engine_simulation.h"

#include "app/lab/engines/pose_measures.h"
#include "engine/core/hash.h"
#include "engine/scene/expect.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <variant>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

RunOptions given_of(const ResolvedRun &run) {
    RunOptions options; // the scene's own method, which only lists what exists; never stepped
    options.settings.give(&StepSettings::dt, run.settings.dt);
    options.settings.give(&StepSettings::gravity, run.settings.gravity);
    options.precision = Precision::f64;
    return options;
}

// What needs forces, which the engines do not report, is not a number; nor are joints' quantities.
Measures without_forces() {
    Measures m;
    m.signorini_residual = m.cone_residual = std::numeric_limits<double>::quiet_NaN();
    m.dissipation_residual = m.contact_power = std::numeric_limits<double>::quiet_NaN();
    return m;
}

bool needs_forces(std::string_view quantity) {
    const QuantityInfo *info = find_quantity(quantity);
    const auto *value =
        info == nullptr ? nullptr : std::get_if<QuantityInfo::OfScene>(&info->value);
    return (info != nullptr && info->needs_joint()) ||
           (value != nullptr && std::isnan((*value)(without_forces(), SceneStart{})));
}

class EngineSimulation final : public Simulation {
  public:
    EngineSimulation(const OtherEngine &kind, const SceneDesc &scene, const ResolvedRun &run)
        : kind_(kind), run_(run), start_(Simulation::create(scene, given_of(run), nullptr)),
          scene_(scene, given_of(run), run.settings.substeps, run.settings.iterations),
          measures_(scene_) {
        begin();
    }

    using Simulation::read;
    void step(StepTimes *) override {
        for (int i = 0; i < run_.settings.substeps; ++i)
            engine_->step();
        ++steps_;
        report_is_of_ = ~std::uint64_t{0};
    }
    std::uint64_t step_count() const override { return steps_; }
    double time() const override { return static_cast<double>(steps_) * run_.settings.dt; }
    // Made on request, so that it is not timed.
    const StepReport &report() const override {
        if (report_is_of_ != steps_) {
            const StepWork work = engine_->work();
            const auto substeps = static_cast<std::uint64_t>(run_.settings.substeps);
            report_ = {};
            report_.finite = is_finite(engine_->states());
            report_.contacts = static_cast<std::uint32_t>(work.contacts);
            report_.constraint_passes = substeps * work.passes;
            for (const BodyMass &mass : scene_.masses)
                report_.body_passes += mass.mass > 0 ? substeps : 0;
            report_is_of_ = steps_;
        }
        return report_;
    }

    Measures measure() const override {
        Measures m = without_forces();
        m.time = time();
        const std::vector<BodyState> states = engine_->states();
        for (std::size_t i = 0; i < states.size(); ++i) {
            const auto &[mass, inertia] = scene_.masses[i];
            if (mass == 0)
                continue;
            const BodyState &state = states[i];
            const glm::dvec3 spin = glm::conjugate(state.orientation) * state.angular_velocity;
            const glm::dvec3 turning = state.orientation * (inertia * spin);
            m.kinetic_energy += 0.5 * mass * glm::dot(state.velocity, state.velocity) +
                                0.5 * glm::dot(inertia * spin, spin);
            m.potential_energy -= mass * glm::dot(run_.settings.gravity, state.position);
            m.linear_momentum += mass * state.velocity;
            m.angular_momentum += glm::cross(state.position, mass * state.velocity) + turning;
        }
        if (!is_finite(states))
            return m;
        const Depth depth = measures_.depth(states);
        m.max_penetration = depth.deepest;
        m.mean_penetration = depth.mean;
        m.max_joint_drift = measures_.joint_drift(states);
        return m;
    }
    double energy() const override { return measure().energy(); }
    std::uint64_t hash() const override {
        StateHash hash;
        for (const BodyState &state : engine_->states())
            for (int axis = 0; axis < 3; ++axis) {
                hash.add(state.position[axis]);
                hash.add(state.velocity[axis]);
            }
        return hash.value();
    }

    const MethodInfo &method() const override { return kind_.info; }
    const StepSettings &settings() const override { return run_.settings; }
    Precision precision() const override { return kind_.precision; }
    void apply(const Command &) override {
        throw std::invalid_argument(std::string(kind_.info.title) + " does not support commands");
    }

    struct Place final : Saved {
        std::uint64_t steps = 0;
    };
    std::unique_ptr<Saved> save(std::unique_ptr<Saved>, const Saved *) const override {
        auto place = std::make_unique<Place>();
        place->steps = steps_;
        return place;
    }
    void restore(const Saved &saved) override {
        const std::uint64_t steps = dynamic_cast<const Place &>(saved).steps;
        begin();
        while (steps_ < steps)
            step(nullptr);
    }
    SceneDesc describe() const override { return scene_.desc; }

    std::size_t body_count() const override { return start_->body_count(); }
    const BodyInfo &body_info(std::size_t body) const override { return start_->body_info(body); }
    std::optional<std::size_t> find_body(std::string_view name) const override {
        return start_->find_body(name);
    }
    const std::string &joint_name(std::size_t joint) const override {
        return start_->joint_name(joint);
    }
    std::size_t joint_count() const override { return start_->joint_count(); }
    const JointDesc *joint(std::size_t joint) const override { return start_->joint(joint); }
    void read(Frame &into, const FrameParts &) const override {
        into = {};
        into.step_count = steps_;
        into.time = time();
        into.bodies = engine_->states();
    }
    void put(const SceneDesc &scene) {
        std::vector<BodyState> states;
        for (const BodyDesc &body : scene.bodies)
            states.push_back(
                {body.position, body.orientation, body.velocity, body.angular_velocity});
        engine_->put(states);
        report_is_of_ = ~std::uint64_t{0};
    }
    std::optional<Pick> pick(const glm::dvec3 &, const glm::dvec3 &) const override {
        return std::nullopt;
    }

  private:
    void begin() {
        engine_ = nullptr; // first: some engines allow only one at a time
        engine_ = kind_.create(scene_);
        if (!engine_)
            throw std::invalid_argument(why_not(kind_, scene_.desc));
        steps_ = 0;
        report_is_of_ = ~std::uint64_t{0};
    }

    const OtherEngine &kind_;
    ResolvedRun run_;
    std::unique_ptr<Simulation> start_;
    EngineScene scene_;
    PoseMeasures measures_;
    std::unique_ptr<Engine> engine_;
    std::uint64_t steps_ = 0;
    mutable StepReport report_;
    mutable std::uint64_t report_is_of_ = 0; // the step it describes
};

} // namespace

std::unique_ptr<Simulation> engine_simulation(const OtherEngine &engine, const SceneDesc &scene,
                                              const ResolvedRun &run) {
    return std::make_unique<EngineSimulation>(engine, scene, run);
}

void drop_unmeasured(std::vector<ExpectOutcome> &outcomes) {
    for (ExpectOutcome &outcome : outcomes)
        if (needs_forces(outcome.desc.quantity))
            outcome.verdict = Verdict::unseen;
}

void put(Simulation &of_engine, const SceneDesc &scene) {
    dynamic_cast<EngineSimulation &>(of_engine).put(scene);
}

} // namespace plumb

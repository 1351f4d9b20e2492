#include "engine/scene/probe_simulation.h"

#include "engine/core/check.h"
#include "engine/scene/probe.h"

#include <stdexcept>
#include <utility>

namespace plumb {

namespace {

class ProbeSimulation final : public Simulation {
  public:
    ProbeSimulation(SceneDesc scene, const ResolvedRun &run)
        : scene_(std::move(scene)), run_(run) {}

    bool has_world() const override { return false; }
    void step(StepTimes *) override {}
    std::uint64_t step_count() const override { return 0; }
    double time() const override { return 0; }
    const StepReport &report() const override { return report_; }
    Measures measure() const override { return {}; }
    double energy() const override { return 0; }
    // Nothing moves: only the probes' answers could differ.
    std::uint64_t hash() const override { return hash_of_answers(scene_.probes, run_.precision); }

    const MethodInfo &method() const override { return *run_.method; }
    const StepSettings &settings() const override { return run_.settings; }
    Precision precision() const override { return run_.precision; }
    void apply(const Command &command) override {
        if (const auto *method = std::get_if<SetMethod>(&command)) {
            RunOptions options;
            options.method = method->method;
            run_.method = resolve_run(scene_, options).method;
        } else if (const auto *changed = std::get_if<SetSettings>(&command)) {
            changed->settings.apply_to(run_.settings);
        } else {
            throw std::invalid_argument("this scene has only probes, no world for bodies");
        }
    }

    std::unique_ptr<Saved> save(std::unique_ptr<Saved>, const Saved *) const override {
        return std::make_unique<Saved>();
    }
    void restore(const Saved &) override {}

    SceneDesc describe() const override {
        SceneDesc out = scene_;
        set_run(out.world, *run_.method, run_.settings);
        out.world.precision = run_.precision;
        return out;
    }

    std::size_t body_count() const override { return 0; }
    const BodyInfo &body_info(std::size_t body) const override { no_body(body); }
    std::optional<std::size_t> find_body(std::string_view) const override { return {}; }
    const std::string &joint_name(std::size_t) const override {
        PLUMB_CHECK(false, "there is no joint, as there is no world");
    }
    void read(Frame &into, const FrameParts &) const override { into = {}; }
    std::optional<Pick> pick(const glm::dvec3 &, const glm::dvec3 &) const override { return {}; }

  private:
    [[noreturn]] static void no_body(std::size_t body) {
        PLUMB_CHECK(false, "there is no body " << body << ", as there is no world");
    }

    SceneDesc scene_;
    ResolvedRun run_;
    StepReport report_;
};

} // namespace

std::unique_ptr<Simulation> make_probe_simulation(const SceneDesc &scene, const ResolvedRun &run) {
    return std::make_unique<ProbeSimulation>(scene, run);
}

} // namespace plumb

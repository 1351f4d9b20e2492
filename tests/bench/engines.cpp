#include "tests/bench/engines.h"

namespace plumb {

namespace {

class PlumbEngine final : public Engine {
  public:
    PlumbEngine(const EngineScene &scene, TaskPool *tasks)
        : simulation_(Simulation::create(scene.desc, awake(), tasks)) {}

    void step() override {
        times_ = {};
        simulation_->step(&times_);
    }
    StepWork work() const override {
        const StepReport &report = simulation_->report();
        return {(times_.find_pairs + times_.collide) / times_.total(), report.contacts,
                report.constraint_passes};
    }
    std::vector<BodyState> states() const override { return simulation_->read().bodies; }

  private:
    static RunOptions awake() {
        RunOptions options;
        options.settings.give(&StepSettings::sleep_after, 0.0); // never
        return options;
    }

    std::unique_ptr<Simulation> simulation_;
    StepTimes times_;
};

} // namespace

std::unique_ptr<Engine> plumb_engine(const EngineScene &scene, TaskPool *tasks) {
    return std::make_unique<PlumbEngine>(scene, tasks);
}

std::vector<EngineKind> engines(TaskPool *tasks) {
    std::vector<EngineKind> kinds;
    kinds.push_back(
        {"Plumb", 1, [](const EngineScene &scene) { return plumb_engine(scene, nullptr); }});
    if (tasks != nullptr)
        kinds.push_back({"Plumb", tasks->threads(),
                         [tasks](const EngineScene &scene) { return plumb_engine(scene, tasks); }});
    kinds.push_back({"Bullet", 1, bullet_engine});
#ifdef PLUMB_WITH_ODE
    kinds.push_back({"ODE", 1, ode_engine});
#endif
    return kinds;
}

} // namespace plumb

#include "app/lab/run/accurate_run.h"

namespace plumb {

RunOptions accurate_run(const SceneDesc &scene, const RunOptions &base, double dt, int substeps) {
    RunOptions run = base;
    run.method = why_not(*find_method_info("rk4"), scene).empty() ? "rk4" : "soft_step";
    run.precision = Precision::f64;
    run.settings.give(&StepSettings::dt, dt);
    run.settings.give(&StepSettings::substeps, substeps);
    run.settings.give(&StepSettings::max_substeps, 1);
    run.settings.give(&StepSettings::sleep_after, 0.0);
    return run;
}

} // namespace plumb

// A scene with known errors, for tests of charts.
#pragma once

#include "app/lab/chart/chart.h"
#include "tests/lab/run/fake_simulation.h"

#include <memory>
#include <utility>

namespace plumb {

inline SceneDesc falling_scene() {
    SceneDesc scene;
    scene.name = "fall";
    scene.title = "Free fall";
    BodyDesc ball;
    ball.name = "ball";
    ball.colliders.emplace_back().shape = SphereDesc{0.5};
    scene.bodies.push_back(ball);
    ExpectDesc expect;
    expect.name = "x";
    expect.quantity = "position.x";
    expect.body = "ball";
    expect.to = 1;
    expect.value = 1;
    expect.tolerance = 0.3;
    scene.expects.push_back(expect);
    return scene;
}

// Ends at x = 1 + 1 / substeps; with `broken` substeps it diverges halfway.
inline MakeSimulation fakes(int broken = 0) {
    return [broken](const SceneDesc &scene, const RunOptions &options) {
        const ResolvedRun run = resolve_run(scene, options);
        auto fake = std::make_unique<FakeSimulation>(run.settings.dt);
        fake->state_at = [n = run.settings.substeps](double t) {
            BodyState state;
            state.position.x = t * (1 + 1.0 / n);
            return state;
        };
        if (run.settings.substeps == broken)
            fake->nan_from_step = 30;
        return std::unique_ptr<Simulation>(std::move(fake));
    };
}

inline ChartOptions quick(MakeSimulation make) {
    ChartOptions options;
    options.methods = {"soft_step"};
    options.sweep = {parse_sweep("substeps=1..8")};
    options.base.settings.give(&StepSettings::max_substeps, 1);
    options.repeats = 3;
    options.make = std::move(make);
    return options;
}

} // namespace plumb

// Runs a scene and holds it to what it expects of itself.
#pragma once

#include "engine/scene/simulation.h"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace plumb {

struct ExpectOutcome {
    ExpectDesc desc;
    std::string unit;    // of measured, error and limit; "1" where there is none
    bool judged = false; // the run reached the end of the window
    double measured = std::numeric_limits<double>::quiet_NaN();
    // How wrong, >= 0, infinite when nothing could be measured (a period that never came, say):
    //   equals    |measured - value|, and the limit is the tolerance
    //   at_most   a bound above zero: what was measured where that is positive, and the limit is
    //   the
    //             bound, so that a chart shows how much better than asked; else the excess over the
    //             bound, and the limit is 0
    //   at_least  what is lacking, and the limit is 0
    double error = std::numeric_limits<double>::infinity();
    double limit = 0;
    bool passed = false; // error <= limit, and judged
};

[[nodiscard]] ExpectOutcome judge(const ExpectDesc &desc, double measured);

// Where a run stopped making sense.
struct Divergence {
    std::uint64_t step = 0; // counted from the start of the scene
    double time = 0;        // s
    std::string body;       // the first whose state is not finite; empty when none is found
    std::optional<glm::dvec3> last_position; // of that body, a step before, where it is known
    std::string message;                     // what a failed check said; may be empty
};

// "not finite after step 41 (0.683 s): body "top", last at (0.1, 9.2, 0)"
[[nodiscard]] std::string describe(const Divergence &divergence);

// Looks for the first body whose state is not finite.
[[nodiscard]] Divergence find_divergence(const Simulation &simulation, std::uint64_t step);

struct JudgeOptions {
    // Whether to follow penetration, drift and energy too, at the price of a measure() each step.
    bool follow_errors = false;
    // For a scene without expectations: how long to run (s).
    double duration = 5;
    // Asked before each step; true ends the run early. May be empty.
    std::function<bool()> stop;
    // Called after each step, with the fraction done. May be empty.
    std::function<void(double)> progress;
    // Called once, before the step that begins at or after this time (s). May be empty.
    std::function<void()> at_time;
    double at_time_seconds = 0;
};

// What one run came to.
struct JudgedRun {
    std::vector<ExpectOutcome> outcomes; // in the scene's order; none judged after the run's end
    std::optional<Divergence> divergence;
    bool stopped = false;
    double time = 0;          // s, at the end of the run
    std::uint64_t steps = 0;  // that were done
    double step_cpu_time = 0; // s, CPU time of the calling thread in all steps together
    std::uint64_t unresolved_impacts = 0;
    bool had_contacts = false;
    // With follow_errors, the largest of the run:
    double max_penetration = 0;   // m
    double max_joint_drift = 0;   // m
    double max_energy_change = 0; // J, |E - E0|
    double max_energy_error = 0;  // |E - E0| / (K0 + |U0|)
    [[nodiscard]] bool all_passed() const;
};

// Runs to the end of the longest window (see duration) and judges. The simulation is at its start.
// Where a window's edge falls between two steps, the quantity there is interpolated linearly.
[[nodiscard]] JudgedRun judge_run(Simulation &simulation, const SceneDesc &scene,
                                  const JudgeOptions &options = {});

// The end of the longest window, or `duration` for a scene without expectations (s).
[[nodiscard]] double run_end(const SceneDesc &scene, double duration);

} // namespace plumb

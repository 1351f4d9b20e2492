// Runs a scene and judges it by its own expectations.
#pragma once

#include "app/lab/run/expectation.h"
#include "engine/scene/simulation.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace plumb {

// Where a run stopped making sense.
struct Divergence {
    std::uint64_t step = 0; // counted from the start of the scene
    double time = 0;        // s
    std::string body;       // the first whose state is not finite; empty if none is found
    std::optional<glm::dvec3> last_position; // of that body, a step before, if known
    std::string message;                     // of a failed check; may be empty
    bool is_particle = false;                // `body` names a particle
};

// "not finite after step 41 (0.683 s): body "top", last at (0.1, 9.2, 0)"
[[nodiscard]] std::string describe(const Divergence &divergence);

// Finds the first body, or else particle, whose state is not finite. `before` is the state a step
// before, if known.
[[nodiscard]] Divergence find_divergence(const Simulation &simulation, std::uint64_t step,
                                         const Frame *before = nullptr);

struct JudgeOptions {
    // Also follow penetration, drift and energy, at the cost of a measure() per step.
    bool follow_errors = false;
    // How long to run a scene without expectations (s).
    double duration = 5;
    // Time steps by wall clock: for runs on several threads.
    bool wall_clock = false;
    // End the run once an expectation is certain to be missed; checked only now and then.
    bool give_up = false;
    // Keep the history of each expectation's quantity.
    bool keep_courses = false;
    // Called before each step; true ends the run early. May be empty.
    std::function<bool()> stop;
    // Called after each step, with the fraction done. May be empty.
    std::function<void(double)> progress;
    // Called with the step_time so far, before the first step that begins at or after each of
    // `times_called` (s, ascending). May be empty.
    std::function<void(double)> at_time;
    std::vector<double> times_called;
};

// The result of one run.
struct JudgedRun {
    // In the scene's order; pending if the run ended before the window did.
    std::vector<ExpectOutcome> outcomes;
    std::optional<Divergence> divergence;
    bool stopped = false;
    double time = 0;         // s, at the end of the run
    std::uint64_t steps = 0; // completed
    // s, CPU time of the calling thread or wall clock: all steps together, and the slowest one.
    double step_time = 0, worst_step_time = 0;
    // Over all steps, as counted by StepReport.
    std::uint64_t body_passes = 0, constraint_passes = 0;
    std::uint64_t unresolved_impacts = 0;
    bool had_contacts = false;
    // With follow_errors, the largest during the run:
    double max_penetration = 0;   // m
    double max_joint_drift = 0;   // m
    double max_energy_change = 0; // J, |E - E0|
    double max_energy_error = 0;  // |E - E0| / (K0 + |U0|)
    // (E - E0) / (K0 + |U0|), at least 0; or / K where that is more: what starts at rest near the
    // origin has no energy to compare with.
    double max_energy_gain = 0;
    // With follow_errors, at the end of the run:
    double end_penetration = 0; // m
    double end_joint_drift = 0; // m
    // m, how much lower the body of each of the scene's own expectations ended than it started; 0
    // for those without a body.
    std::vector<double> drops;
    // With keep_courses, at the start and after each step: the time (s), and each outcome's
    // quantity.
    std::vector<double> times;
    std::vector<std::vector<double>> courses;
    // The run completed and missed no expectation.
    [[nodiscard]] bool all_met() const;
    // Whether anything was judged at all.
    [[nodiscard]] bool any_judged() const;
};

// Runs to the end of the longest window (see run_end) and judges. The simulation must be at its
// start.
[[nodiscard]] JudgedRun judge_run(Simulation &simulation, const SceneDesc &scene,
                                  const JudgeOptions &options = {});

// The end of the longest window, or `duration` for a scene without expectations (s).
[[nodiscard]] double run_end(const SceneDesc &scene, double duration);

// Everything a scene expects: its own expectations, then those of its probes, as "PROBE, VALUE".
[[nodiscard]] std::vector<ExpectDesc> everything_expected(const SceneDesc &scene);

// Evaluates the scene's probes and appends the outcome of each of their expectations.
void judge_probes(const SceneDesc &scene, Precision precision,
                  std::vector<ExpectOutcome> &outcomes);

} // namespace plumb

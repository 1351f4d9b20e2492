// Runs a scene and holds it to what it expects of itself.
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
    std::string body;       // the first whose state is not finite; empty when none is found
    std::optional<glm::dvec3> last_position; // of it, a step before, where it is known
    std::string message;                     // what a failed check said; may be empty
    bool is_particle = false;                // `body` names a particle
};

// "not finite after step 41 (0.683 s): body "top", last at (0.1, 9.2, 0)"
[[nodiscard]] std::string describe(const Divergence &divergence);

// Looks for the first body, or else particle, whose state is not finite; `before`, where it is
// known, is the state a step before.
[[nodiscard]] Divergence find_divergence(const Simulation &simulation, std::uint64_t step,
                                         const Frame *before = nullptr);

struct JudgeOptions {
    // Whether to follow penetration, drift and energy too, at the price of a measure() each step.
    bool follow_errors = false;
    // For a scene without expectations: how long to run (s).
    double duration = 5;
    // Steps are timed by the clock on the wall: for runs on several threads.
    bool wall_clock = false;
    // Ends the run once an expectation is missed whatever comes; it is looked at now and then.
    bool give_up = false;
    // Whether to keep the course of each expectation's quantity.
    bool keep_courses = false;
    // Asked before each step; true ends the run early. May be empty.
    std::function<bool()> stop;
    // Called after each step, with the fraction done. May be empty.
    std::function<void(double)> progress;
    // Called before the step that begins at or after each of these times (s), ascending, with the
    // step_time so far. May be empty.
    std::function<void(double)> at_time;
    std::vector<double> times_called;
};

// What one run came to.
struct JudgedRun {
    // In the scene's order; pending where the run ended before the window did.
    std::vector<ExpectOutcome> outcomes;
    std::optional<Divergence> divergence;
    bool stopped = false;
    double time = 0;         // s, at the end of the run
    std::uint64_t steps = 0; // that were done
    // s, CPU time of the calling thread, or by the clock on the wall: of all steps together, and of
    // the one that took longest.
    double step_time = 0, worst_step_time = 0;
    // Of all steps together, as StepReport counts them.
    std::uint64_t body_passes = 0, constraint_passes = 0;
    std::uint64_t unresolved_impacts = 0;
    bool had_contacts = false;
    // With follow_errors, the largest of the run:
    double max_penetration = 0;   // m
    double max_joint_drift = 0;   // m
    double max_energy_change = 0; // J, |E - E0|
    double max_energy_error = 0;  // |E - E0| / (K0 + |U0|)
    double max_energy_gain = 0;   // (E - E0) / (K0 + |U0|), of at least 0
    // With follow_errors, at the end of the run:
    double end_penetration = 0; // m
    double end_joint_drift = 0; // m
    // With keep_courses, at the start and after each step: the time (s), and of each outcome its
    // quantity.
    std::vector<double> times;
    std::vector<std::vector<double>> courses;
    // It came to its end, and nothing that the scene expects was missed.
    [[nodiscard]] bool all_met() const;
    // Whether anything was judged at all.
    [[nodiscard]] bool any_judged() const;
};

// Runs to the end of the longest window (see duration) and judges. The simulation is at its start.
[[nodiscard]] JudgedRun judge_run(Simulation &simulation, const SceneDesc &scene,
                                  const JudgeOptions &options = {});

// The end of the longest window, or `duration` for a scene without expectations (s).
[[nodiscard]] double run_end(const SceneDesc &scene, double duration);

// All that a scene is held to: its own expectations, then those of its probes, as "PROBE, VALUE".
[[nodiscard]] std::vector<ExpectDesc> everything_expected(const SceneDesc &scene);

// Asks the scene's probes, and adds what came of each of their expectations.
void judge_probes(const SceneDesc &scene, Precision precision,
                  std::vector<ExpectOutcome> &outcomes);

} // namespace plumb

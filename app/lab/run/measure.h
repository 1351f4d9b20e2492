// `plumb measure`: a scene's numbers, step by step.
#pragma once

#include "app/lab/exit_code.h"
#include "app/lab/run/judged_run.h"
#include "engine/scene/simulation.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <span>

namespace plumb {

class TaskPool;

struct MeasureOptions {
    std::uint64_t steps = 600;
    std::function<bool()> stop;           // called before each step; may be empty
    std::function<void(double)> progress; // fraction done; may be empty
};

struct MeasureSummary {
    std::uint64_t steps = 0;                              // done
    double simulated = 0;                                 // s
    double start_energy = 0, end_energy = 0;              // J
    double max_energy_change = 0;                         // J, |E - E0|
    double max_energy_error = 0;                          // |E - E0| / (K0 + |U0|)
    double max_penetration = 0, max_penetration_time = 0; // m, s
    double max_joint_drift = 0, max_joint_drift_time = 0; // m, s
    // Wall time (s) over all steps, as the steps report it.
    double find_pairs = 0, collide = 0, advance = 0, finish = 0;
    std::uint32_t most_contacts = 0, most_particle_contacts = 0;
    std::uint64_t impacts = 0, unresolved_impacts = 0;
    std::optional<Divergence> divergence;
    bool stopped = false;
};

// Steps and writes a table with a header and one row per step, the start first (its counts and
// times are zero). Ends early once the world is no longer finite, with that row the last.
[[nodiscard]] MeasureSummary measure_run(Simulation &simulation, const MeasureOptions &options,
                                         std::ostream &csv);

void print(std::ostream &out, const MeasureSummary &summary);

// A table of probe results: the probe, the value's name, the number (yes is 1, no 0).
void measure_probes(std::span<const ProbeDesc> probes, Precision precision, std::ostream &csv);

struct MeasureCommand {
    std::filesystem::path scene;
    RunOptions run;
    std::uint64_t steps = 600;
    std::filesystem::path out; // empty: the table goes to standard output, the summary to `err`
    TaskPool *tasks = nullptr;
};

// On Ctrl-C the rows so far stay in OUT.partial.
[[nodiscard]] ExitCode measure_scene(const MeasureCommand &command, std::ostream &out,
                                     std::ostream &err);

} // namespace plumb

// `plumb reference`: truths without a closed form, found by refinement.
#pragma once

#include "app/lab/exit_code.h"
#include "engine/scene/simulation.h"

#include <filesystem>
#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

namespace plumb {

struct RefinedTruth {
    ExpectDesc desc;
    std::string unit; // "1" where there is none
    double value = std::numeric_limits<double>::quiet_NaN();
    // If the file has a curve, `value` is the run's distance from it, and this is the run's own
    // curve: about the fewest values that stay within a twentieth of the tolerance at every step.
    // Empty if that would take more values than there were steps.
    std::vector<double> curve;
    // How much the last halving of dt changed it (a curve: its largest change at any step), rounded
    // up to two digits; infinite if that gave no number.
    double estimate = std::numeric_limits<double>::infinity();
    ResolvedRun run; // the last
    [[nodiscard]] bool settled() const { return estimate < desc.tolerance / 10; }
    // Whether the file's truth matches to a tenth of the tolerance; a curve is compared as reduced.
    [[nodiscard]] bool agrees() const;
};

struct RefineOptions {
    bool only_estimated =
        false;        // only expectations with an estimate in the file, found by refinement
    int halvings = 6; // of dt, at most
    std::function<bool()> stop; // called often; true ends early; may be empty
    std::function<void(double dt, double fraction)> progress; // during each run; may be empty
};

// The truth of each expectation that has one, by accurate_run with 16 substeps, starting at the
// scene's dt and halving it until all are settled or `halvings` is reached. Truths of a run that
// diverged have no number. Empty if ended early.
[[nodiscard]] std::vector<RefinedTruth> refine(const SceneDesc &scene,
                                               const RefineOptions &options = {});

struct ReferenceCommand {
    std::filesystem::path scene;
    bool write = false;
};

// Prints the truths to `out`, and everything else to `err`. Exit code 1 if a truth with an estimate
// in the file did not settle, or differs from the file and is not written.
[[nodiscard]] ExitCode refine_scene(const ReferenceCommand &command, std::ostream &out,
                                    std::ostream &err);

} // namespace plumb

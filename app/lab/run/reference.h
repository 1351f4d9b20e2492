// `plumb reference`: truths for which there is no closed form, by refinement.
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
    // Where the file has a curve, `value` is how far the run was from that, and this is the run's
    // own: about as few values as are off by less than a twentieth of the tolerance at any step.
    // Empty where it would take more values than there were steps.
    std::vector<double> curve;
    // By how much halving dt changed it last, of a curve at most at any step, rounded up to two
    // digits; infinite where that gave no number.
    double estimate = std::numeric_limits<double>::infinity();
    ResolvedRun run; // the last
    [[nodiscard]] bool settled() const { return estimate < desc.tolerance / 10; }
    // The file's is this, to a tenth of the tolerance; of a curve, as it is reduced.
    [[nodiscard]] bool agrees() const;
};

struct RefineOptions {
    bool only_estimated = false; // those that have an estimate in the file, which refinement found
    int halvings = 6;            // of dt, at most
    std::function<bool()> stop;  // asked often; true ends early; may be empty
    std::function<void(double dt, double fraction)> progress; // of each run; may be empty
};

// Of each expectation with a truth: by accurate_run with 16 substeps, from the scene's dt on, which
// is halved until each is settled, or as often as it may be. Those of a run that diverged have no
// number. Ended early it is empty.
[[nodiscard]] std::vector<RefinedTruth> refine(const SceneDesc &scene,
                                               const RefineOptions &options = {});

struct ReferenceCommand {
    std::filesystem::path scene;
    bool write = false;
};

// Prints the truths to `out`, and everything else to `err`. Exit code 1 when one that has an
// estimate in the file did not settle, or is another than in the file and is not written.
[[nodiscard]] ExitCode refine_scene(const ReferenceCommand &command, std::ostream &out,
                                    std::ostream &err);

} // namespace plumb

// Which combinations of settings are tried.
#pragma once

#include "app/lab/tune/trial.h"
#include "app/lab/tune/tune.h"

#include <functional>
#include <vector>

namespace plumb {

// All settings but the substeps.
struct TuneRow {
    RunOptions options;
    bool fixed_substeps = true; // else each island's own, from those given
};

// The fewest substeps of each row that meet the scene, as far as they may be the cheapest of all:
// of a method's first row by doubling them, of the others, which are seldom cheaper, beginning with
// the most that may be.
class SubstepSearch {
  public:
    // Adds to `runs`, of which some may be there already.
    SubstepSearch(const Trial &trial, std::vector<TunedRun> &runs, std::function<bool()> stopped,
                  Progress progress);

    void search(const TuneRow &row);

    // The run with these options, made unless it was before.
    std::size_t run(const RunOptions &options);

  private:
    struct Guess {
        double work, cost;
    };
    // What a row's work and cost will be with so many substeps, from the run of its method that is
    // most like it; never far above what it turns out to be.
    [[nodiscard]] std::optional<Guess> guess(const RunOptions &options) const;
    // Whether a setting that met the scene is sure to be cheaper, or very much so.
    [[nodiscard]] bool is_beaten(const ResolvedRun &run, const Guess &guess) const;
    [[nodiscard]] bool is_beaten(const RunOptions &options) const;
    [[nodiscard]] bool any_like(const ResolvedRun &run) const;
    [[nodiscard]] bool met(const TuneRow &row, int substeps);

    void ascend(const TuneRow &row);
    void descend(const TuneRow &row);
    void close_in(const TuneRow &row, int missed, int met);

    const Trial &trial_;
    std::vector<TunedRun> &runs_;
    std::function<bool()> stopped_;
    Progress progress_;
};

} // namespace plumb

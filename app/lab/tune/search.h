// Chooses the combinations of settings to try.
#pragma once

#include "app/lab/tune/trial.h"
#include "app/lab/tune/tune.h"

#include <functional>
#include <vector>

namespace plumb {

// All settings but the substeps.
struct TuneRow {
    RunOptions options;
    bool fixed_substeps = true; // else each island's own, starting from those given
};

// Finds the fewest substeps with which each row meets the scene, as long as the row can still be
// the cheapest: a method's first row by doubling, its later rows, which are seldom cheaper, from
// the highest count that could still win.
class SubstepSearch {
  public:
    // Appends to `runs`, which may already hold some.
    SubstepSearch(const Trial &trial, std::vector<TunedRun> &runs, std::function<bool()> stopped,
                  Progress progress);

    void search(const TuneRow &row);

    // Index of the run with these options; runs it if it is new.
    std::size_t run(const RunOptions &options);

  private:
    struct Guess {
        double work, cost;
    };
    // Predicts the work and cost of a run from the most similar run of its method; never far above
    // the actual values.
    [[nodiscard]] std::optional<Guess> guess(const RunOptions &options) const;
    // Whether some setting that met the scene is certainly cheaper, or far cheaper.
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

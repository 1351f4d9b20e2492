#include "app/lab/tune/search.h"

#include "app/lab/run/sweep.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb {

namespace {

// A run this many times as expensive as another method's is dearer, however noisy the machine.
constexpr double far_dearer = 4;

// For a method's later rows while nothing has met the scene: there is no cost to beat yet.
constexpr int most_without_bound = 64;

RunOptions with_substeps(RunOptions options, int substeps) {
    options.settings.give(&StepSettings::substeps, substeps);
    return options;
}

} // namespace

SubstepSearch::SubstepSearch(const Trial &trial, std::vector<TunedRun> &runs,
                             std::function<bool()> stopped, Progress progress)
    : trial_(trial), runs_(runs), stopped_(std::move(stopped)), progress_(std::move(progress)) {}

std::size_t SubstepSearch::run(const RunOptions &options) {
    const ResolvedRun resolved = resolve_run(trial_.scene(), options);
    const auto same = std::ranges::find_if(runs_, [&](const TunedRun &run) {
        return run.resolved.method == resolved.method &&
               run.resolved.precision == resolved.precision &&
               same_work(*resolved.method, run.resolved.settings, resolved.settings);
    });
    if (same != runs_.end())
        return static_cast<std::size_t>(same - runs_.begin());
    runs_.push_back(trial_.run(options, progress_));
    return runs_.size() - 1;
}

bool SubstepSearch::met(const TuneRow &row, int substeps) {
    return runs_[run(with_substeps(row.options, substeps))].verdict == TuneVerdict::met;
}

std::optional<SubstepSearch::Guess> SubstepSearch::guess(const RunOptions &options) const {
    const ResolvedRun wanted = resolve_run(trial_.scene(), options);
    const StepSettings &s = wanted.settings;
    std::optional<Guess> best;
    double least_difference = 0;
    for (const TunedRun &run : runs_) {
        const StepSettings &known = run.resolved.settings;
        if (run.resolved.method != wanted.method || run.starts == 0 || !(run.work > 0) ||
            known.max_substeps != s.max_substeps)
            continue;
        const double substeps = (s.substeps / s.dt) / (known.substeps / known.dt);
        // Loads that ask for more substeps than the minimum do so whatever the minimum is.
        // Otherwise work scales with the substeps, and at least half of it with the iterations.
        const bool own = s.max_substeps > s.substeps;
        const double share = (1.0 + s.iterations) / (1.0 + known.iterations);
        const double by = own ? std::min(1.0, substeps) : substeps * std::min(1.0, share);
        const double difference = std::abs(std::log(substeps)) + std::abs(std::log(share));
        if (best && difference >= least_difference)
            continue;
        least_difference = difference;
        best = {run.work * by, run.cost * by};
        if (!own && share > 1)
            best = {run.work * substeps * (1 + share) / 2, run.cost * substeps};
    }
    return best;
}

bool SubstepSearch::is_beaten(const ResolvedRun &run, const Guess &guess) const {
    return std::ranges::any_of(runs_, [&](const TunedRun &other) {
        if (other.verdict != TuneVerdict::met)
            return false;
        if (other.resolved.method != run.method)
            return guess.cost > far_dearer * other.cost;
        // Collision runs once per step, so coarser steps may make up for more substeps.
        const bool coarser = run.settings.dt > other.resolved.settings.dt;
        const double reach = coarser ? 1.25 : 1 - 1e-9; // equal work is beaten, too
        return other.resolved.precision <= run.precision && guess.work > reach * other.work;
    });
}

bool SubstepSearch::is_beaten(const RunOptions &options) const {
    const std::optional<Guess> known = guess(options);
    return known && is_beaten(resolve_run(trial_.scene(), options), *known);
}

bool SubstepSearch::any_like(const ResolvedRun &run) const {
    // The scene's own run says nothing about other substeps if it missed.
    return std::ranges::any_of(runs_, [&](const TunedRun &other) {
        return other.resolved.method == run.method &&
               other.resolved.settings.max_substeps == run.settings.max_substeps &&
               (&other != &runs_.front() || other.verdict == TuneVerdict::met);
    });
}

void SubstepSearch::search(const TuneRow &row) {
    const bool given = row.options.settings.has(*find_setting("substeps"));
    if (given && !is_beaten(row.options))
        (void)run(row.options);
    else if (given)
        return;
    else if (!row.fixed_substeps || !any_like(resolve_run(trial_.scene(), row.options)))
        ascend(row);
    else
        descend(row);
}

void SubstepSearch::ascend(const TuneRow &row) {
    int missed = 0;
    for (int substeps = 1; substeps <= most_substeps && !stopped_(); substeps *= 2) {
        if (is_beaten(with_substeps(row.options, substeps)))
            return;
        if (met(row, substeps)) {
            close_in(row, missed, substeps);
            return;
        }
        missed = substeps;
    }
}

void SubstepSearch::descend(const TuneRow &row) {
    const bool any_met = std::ranges::any_of(
        runs_, [](const TunedRun &run) { return run.verdict == TuneVerdict::met; });
    const int limit = any_met ? most_substeps : most_without_bound;
    int most = 0;
    for (int step = most_substeps; step > 0; step /= 2) // the most not beaten
        if (most + step <= limit && !is_beaten(with_substeps(row.options, most + step)))
            most += step;
    if (most > 0 && !stopped_() && met(row, most))
        close_in(row, 0, most);
}

void SubstepSearch::close_in(const TuneRow &row, int missed, int met_with) {
    while (met_with - missed > 1 && !stopped_()) {
        const int half = missed + (met_with - missed) / 2;
        (met(row, half) ? met_with : missed) = half;
    }
}

} // namespace plumb

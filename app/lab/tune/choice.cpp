#include "app/lab/tune/choice.h"

#include "app/lab/tune/trial.h"

#include <algorithm>
#include <optional>
#include <tuple>

namespace plumb {

namespace {

bool same_kind(const ResolvedRun &a, const ResolvedRun &b) {
    return a.method == b.method && a.precision == b.precision && a.settings.dt == b.settings.dt;
}

// Of the runs of `first`'s method that cost the same, the one with the least work.
std::size_t least_work(const Tuning &tuning, const std::vector<std::size_t> &choices,
                       std::size_t first) {
    std::size_t best = first;
    for (const std::size_t i : choices) {
        const TunedRun &run = tuning.runs[i], &other = tuning.runs[first];
        if (run.resolved.method == other.resolved.method && both_timed(run, other) &&
            !is_always_dearer(run, other) && run.work < tuning.runs[best].work)
            best = i;
    }
    return best;
}

} // namespace

bool is_less_work(const TunedRun &run, const TunedRun &other) {
    return same_kind(run.resolved, other.resolved) && run.work < other.work;
}

bool both_timed(const TunedRun &a, const TunedRun &b) {
    return !a.timings.empty() && !b.timings.empty();
}

void erase_needless(const Tuning &tuning, std::vector<std::size_t> &choices) {
    const std::vector<std::size_t> all = choices;
    std::erase_if(choices, [&](std::size_t i) {
        return std::ranges::any_of(all, [&](std::size_t other) {
            return is_less_work(tuning.runs[other], tuning.runs[i]);
        });
    });
}

std::size_t cheapest_choice(const Tuning &tuning, const std::vector<std::size_t> &choices) {
    const auto cost = [&](std::size_t i) {
        const TunedRun &run = tuning.runs[i];
        return std::tuple(run.timings.empty(), run.cost);
    };
    const std::size_t least = *std::ranges::min_element(choices, {}, cost);
    std::optional<std::size_t> best;
    for (const MethodInfo &method : method_infos()) {
        std::vector<std::size_t> own = choices;
        std::erase_if(own,
                      [&](std::size_t i) { return tuning.runs[i].resolved.method != &method; });
        if (own.empty())
            continue;
        const std::size_t first = *std::ranges::min_element(own, {}, cost);
        const TunedRun &run = tuning.runs[first], &other = tuning.runs[least];
        if (first != least && (!both_timed(run, other) || is_always_dearer(run, other)))
            continue;
        const std::size_t found = least_work(tuning, own, first);
        if (!best || tuning.runs[found].error < tuning.runs[*best].error)
            best = found;
    }
    return best.value_or(least);
}

} // namespace plumb

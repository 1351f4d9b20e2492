// Which of the runs that meet a scene to choose.
#pragma once

#include "app/lab/tune/tune.h"

#include <cstddef>
#include <vector>

namespace plumb {

// Whether `run` does less counted work than `other`, which is of the same method, precision and dt:
// between such runs the count decides, as it has no noise.
[[nodiscard]] bool is_less_work(const TunedRun &run, const TunedRun &other);

[[nodiscard]] bool both_timed(const TunedRun &a, const TunedRun &b);

// Leaves out what another choice does with less work. `choices` are indices into tuning.runs.
void erase_needless(const Tuning &tuning, std::vector<std::size_t> &choices);

// Of these runs, one or more: each method's cheapest, or what costs the same and does less work;
// then of those that cost the same as the cheapest of all, the most accurate, and on a tie the
// first in the list of methods. To cost the same is not to be dearer by same_cost in every round of
// timings, so noise of less than that does not change the choice. Runs without timings are chosen
// only if there are no others.
[[nodiscard]] std::size_t cheapest_choice(const Tuning &tuning,
                                          const std::vector<std::size_t> &choices);

} // namespace plumb

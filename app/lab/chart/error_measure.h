// Which error a chart shows.
#pragma once

#include "app/lab/run/judged_run.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

struct ErrorMeasure {
    enum class Kind { worst, expectation, penetration, joint_drift, energy, one_step };
    Kind kind = Kind::energy;
    std::size_t expectation = 0; // index into everything_expected, for Kind::expectation
    // Indices of those that Kind::worst is the worst of; empty: all.
    std::vector<std::size_t> among;
    std::string name;
    std::string unit;        // "1" if dimensionless or in units of tolerances
    std::string title;       // for the axis
    std::string explanation; // a sentence
    // Largest acceptable error. If only one of several expectations is shown, a run can be within
    // it and still miss another: see ChartStatus.
    std::optional<double> limit;
    std::string limit_label;
};

// The scene's worst expectation, in units of tolerances; if it has only one, or `expect` names one,
// that one in its own unit; if it has none, followed_measure. For `convergence` only expectations
// of a value at a given time count, if there are any: an extreme or a crossing, found between
// samples, is off by a power of dt of its own, and a bound is no true value. Those named in
// `outdated` do not count, as if the scene had no such expectations. Throws std::invalid_argument
// if none has that name, or if it is outdated.
[[nodiscard]] ErrorMeasure choose_measure(const SceneDesc &scene, std::string_view expect,
                                          bool convergence = false,
                                          const std::vector<std::string> &outdated = {});

// For scenes without expectations: the error that applies to the scene.
[[nodiscard]] ErrorMeasure followed_measure(const SceneDesc &scene, bool had_contacts);

// For one-step charts: steps of `frame` seconds from `instants` states.
[[nodiscard]] ErrorMeasure one_step_measure(double frame, std::size_t instants);

// The outcome with the largest error in units of its tolerance, of all or those at the indices
// `among`; none if no error is above 0.
[[nodiscard]] std::optional<std::size_t> worst_of(const std::vector<ExpectOutcome> &outcomes,
                                                  const std::vector<std::size_t> &among = {});

// The run's error by this measure, other than Kind::one_step; infinite if it could not be measured.
[[nodiscard]] double error_of(const ErrorMeasure &measure, const JudgedRun &run);

} // namespace plumb

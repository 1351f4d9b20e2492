// Which error a chart shows.
#pragma once

#include "app/lab/run/judged_run.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace plumb {

struct ErrorMeasure {
    enum class Kind { worst, expectation, penetration, joint_drift, energy, one_step };
    Kind kind = Kind::energy;
    std::size_t expectation = 0; // index into everything_expected, when of that kind
    std::string name;
    std::string unit;        // "1" where there is none, and in units of tolerances
    std::string title;       // for the axis
    std::string explanation; // a sentence
    // What the error may be. Whether a run is true enough is more than this where only one of
    // several expectations is shown: see ChartStatus.
    std::optional<double> limit;
    std::string limit_label;
};

// The worst of all that the scene expects, in units of their tolerances; where it expects but one
// thing, or one is named by `expect`, that one in its own unit; where it expects nothing, what
// followed_measure says. Throws std::invalid_argument when there is none of that name.
[[nodiscard]] ErrorMeasure choose_measure(const SceneDesc &scene, std::string_view expect);

// For scenes that expect nothing: the error that the scene can show.
[[nodiscard]] ErrorMeasure followed_measure(const SceneDesc &scene, bool had_contacts);

// Of a chart of single steps, each a frame of so many seconds, from so many states.
[[nodiscard]] ErrorMeasure one_step_measure(double frame, std::size_t instants);

// The outcome with the largest error in units of its tolerance; none when no error is above 0.
[[nodiscard]] std::optional<std::size_t> worst_of(const std::vector<ExpectOutcome> &outcomes);

// The run's error by this measure, which is not that of single steps; infinite when it could not be
// measured.
[[nodiscard]] double error_of(const ErrorMeasure &measure, const JudgedRun &run);

} // namespace plumb

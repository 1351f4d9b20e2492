// Runs and numbers as text.
#pragma once

#include "engine/scene/simulation.h"

#include <string>

namespace plumb {

[[nodiscard]] std::string_view precision_name(Precision precision); // "float", "double"

// "soft_step substeps=4 iterations=1 dt=1/60 s float"
[[nodiscard]] std::string run_text(const ResolvedRun &run);

// "4", or "4..64" if islands may take more substeps of their own.
[[nodiscard]] std::string substeps_text(const ResolvedRun &run);

[[nodiscard]] std::string with_digits(double value, int digits); // significant ones, at most 17
[[nodiscard]] std::string three_digits(double value);            // "0.123", "1.5e+06"

// Six significant digits and the unit; "1" as a unit is left out.
[[nodiscard]] std::string with_unit(double value, std::string_view unit);

} // namespace plumb

// The settings that a chart goes through.
#pragma once

#include "engine/dynamics/method_info.h"
#include "engine/dynamics/settings.h"

#include <string>
#include <string_view>
#include <vector>

namespace plumb {

enum class SweepSetting { substeps, iterations, dt };

[[nodiscard]] std::string_view sweep_setting_name(SweepSetting setting);

struct SweepAxis {
    SweepSetting setting = SweepSetting::substeps;
    std::vector<double> values; // ascending, distinct; whole numbers but for dt (s)
};

// "substeps=1..16" goes through the powers of two from 1 to 16 (its ends, when no power of two lies
// between them); "substeps=1,3,5" through these. "dt=1/240..1/30" doubles from the lower end.
// Throws std::invalid_argument that says what is wrong and what would be right.
[[nodiscard]] SweepAxis parse_sweep(std::string_view text);

// "0.01" or "1/60". Throws std::invalid_argument as above.
[[nodiscard]] double parse_fraction(std::string_view text);

// substeps=1..16
[[nodiscard]] SweepAxis default_sweep();

// One combination of the axes' values: an entry an axis.
using SweepPoint = std::vector<double>;

// All combinations, the first axis fastest. No axes: one empty combination. Throws
// std::invalid_argument when two axes have the same setting.
[[nodiscard]] std::vector<SweepPoint> sweep_points(const std::vector<SweepAxis> &axes);

// Overrides the swept settings.
void apply(const std::vector<SweepAxis> &axes, const SweepPoint &point, StepSettings &settings);

// Whether two combinations make the method do the same, by its declared work: iterations mean
// nothing to a method that has none.
[[nodiscard]] bool same_work(const MethodInfo &method, const StepSettings &a,
                             const StepSettings &b);

// "4", "4×2", "1/120 s", "4×2, 1/120 s": the swept settings' values, for a label.
[[nodiscard]] std::string sweep_label(const std::vector<SweepAxis> &axes, const SweepPoint &point);

// What such labels mean: "substeps × iterations".
[[nodiscard]] std::string sweep_label_meaning(const std::vector<SweepAxis> &axes);

// "1/60 s" where 1/dt is a whole number, else "0.0123 s".
[[nodiscard]] std::string format_dt(double dt);

} // namespace plumb

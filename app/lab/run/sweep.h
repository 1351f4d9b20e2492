// The settings that a chart sweeps over.
#pragma once

#include "engine/dynamics/method_info.h"
#include "engine/scene/given_settings.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace plumb {

struct SweepAxis {
    SettingNumber setting;
    std::vector<double> values; // ascending, distinct, in the setting's range
};

// Any setting, or one component of a vector: "gravity.y". "substeps=1,3,5" takes exactly these
// values. A range of whole numbers, "substeps=1..16", takes the powers of two in it (and 0), or its
// ends if it has none; "dt=1/240..1/30" doubles from the lower end; a range that does not start
// above 0, "gravity.y=-20..0", goes from end to end in four equal steps. Throws
// std::invalid_argument that says what is wrong and what would be right.
[[nodiscard]] SweepAxis parse_sweep(std::string_view text);

// substeps=1..16
[[nodiscard]] SweepAxis default_sweep();

// One combination of the axes' values: one entry per axis.
using SweepPoint = std::vector<double>;

// All combinations, the first axis fastest. No axes: one empty combination. Throws
// std::invalid_argument if two axes have the same setting.
[[nodiscard]] std::vector<SweepPoint> sweep_points(const std::vector<SweepAxis> &axes);

// The swept settings.
[[nodiscard]] GivenSettings given_by(const std::vector<SweepAxis> &axes, const SweepPoint &point);

// Throws std::invalid_argument if the swept setting is also given: the sweep would overrule it.
void refuse_given(SettingNumber swept, const GivenSettings &given);

// Whether the method does the same work with both: they agree in every setting it reads.
[[nodiscard]] bool same_work(const MethodInfo &method, const StepSettings &a,
                             const StepSettings &b);

// "4", "4×2", "1/120 s", "4×2, 1/120 s": the swept settings' values as a label, whole numbers
// first.
[[nodiscard]] std::string sweep_label(const std::vector<SweepAxis> &axes, const SweepPoint &point);

// What such labels mean: "substeps × iterations".
[[nodiscard]] std::string sweep_label_meaning(const std::vector<SweepAxis> &axes);

// "4", "0.02 m", "1/120 s"
[[nodiscard]] std::string setting_label(SettingNumber setting, double value);

// From pairs of name and value: "4", or "4 (soft_step), 1 (rk4)" if they differ, each value once.
[[nodiscard]] std::string
values_by_name(const std::vector<std::pair<std::string, std::string>> &values);

// "1/60 s" if 1/dt is a whole number above 1, else "0.0123 s".
[[nodiscard]] std::string format_dt(double dt);

} // namespace plumb

// The axes of a stability map: a setting, or any number of the scene file.
#pragma once

#include "engine/dynamics/settings.h"
#include "engine/scene/file/change.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// A number of the scene file that follows an axis: offset + factor * the axis's value.
struct AxisNumber {
    std::string path;
    double factor = 1, offset = 0;
};

struct MapAxis {
    std::string name; // "dt", "gravity.y", "body.ball.velocity.x", "speed"
    // Set if the name is a setting; otherwise it is a path into the scene file, or a name that
    // named_axis resolves.
    std::optional<SettingNumber> setting;
    std::vector<AxisNumber> numbers; // what a name that is neither stands for
    std::vector<double> values;      // ascending, distinct, at least two
    bool logarithmic = false;
    bool whole = false; // takes only whole numbers
};

// "NAME=FROM..TO", "NAME=FROM..TO:N", "NAME=FROM..TO:Nlog", "NAME=FROM..TOlog": N values (default
// 10) in equal steps or, with log, in equal ratios; or "NAME=1,2,8", exactly these. Numbers may be
// fractions. Throws std::invalid_argument that says what is wrong and what would be right. Whether
// the scene file has that number, and its range, is not checked here.
[[nodiscard]] MapAxis parse_map_axis(std::string_view text);

// The numbers of the scene file that the axis changes, as they are at this value; none for a
// setting.
[[nodiscard]] std::vector<ChangedNumber> changed_numbers(const MapAxis &axis, double value);

// The axis with its values rounded to whole numbers, each once. Throws std::invalid_argument if
// fewer than two are left.
[[nodiscard]] MapAxis in_whole_numbers(MapAxis axis);

// The midpoint on the axis's scale: by ratio on a logarithmic axis; rounded if it takes only whole
// numbers.
[[nodiscard]] double between(const MapAxis &axis, double low, double high);

// A value's position in cells: 0 at the centre of the first cell; values beyond the axis lie beyond
// its ends. On a logarithmic axis the value must not be negative.
[[nodiscard]] double cell_position(const MapAxis &axis, double value);

// "1/120", "0.5": without the unit, for the numbers along an axis.
[[nodiscard]] std::string value_label(const MapAxis &axis, double value);

// "dt (s), logarithmic"; "mass_ratio by body.ball.mass" where the name stands for other numbers.
[[nodiscard]] std::string axis_title(const MapAxis &axis);

} // namespace plumb

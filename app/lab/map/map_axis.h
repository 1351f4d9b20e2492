// The axes of a stability map: a setting, or any number of the scene file.
#pragma once

#include "engine/dynamics/settings.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

struct MapAxis {
    std::string name; // "dt", "gravity.y", "body.ball.velocity.x"
    // Set if the name is a setting; otherwise it is a path into the scene file, or a key.
    std::optional<SettingNumber> setting;
    std::vector<double> values; // ascending, distinct, at least two
    bool logarithmic = false;
    bool whole = false; // takes only whole numbers
};

// "NAME=FROM..TO", "NAME=FROM..TO:N", "NAME=FROM..TO:Nlog", "NAME=FROM..TOlog": N values (default
// 10) in equal steps or, with log, in equal ratios; or "NAME=1,2,8", exactly these. Numbers may be
// fractions. Throws std::invalid_argument that says what is wrong and what would be right. Whether
// the scene file has that number, and its range, is not checked here.
[[nodiscard]] MapAxis parse_map_axis(std::string_view text);

// Expands a bare last key such as "stiffness" to the path of the one number in this scene that it
// can mean. Throws std::invalid_argument if there is none, or several, which it names.
[[nodiscard]] MapAxis with_whole_path(MapAxis axis, std::string_view scene_text);

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

// "dt (s), logarithmic"
[[nodiscard]] std::string axis_title(const MapAxis &axis);

} // namespace plumb

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
    // When it is one; else a path into the scene file, or a key.
    std::optional<SettingNumber> setting;
    std::vector<double> values; // ascending, distinct, at least two
    bool logarithmic = false;
    bool whole = false; // it takes whole numbers alone
};

// "NAME=FROM..TO", "NAME=FROM..TO:N", "NAME=FROM..TO:Nlog", "NAME=FROM..TOlog": N values (10) in
// equal steps or, with log, in equal ratios; or "NAME=1,2,8", these. Numbers may be fractions.
// Throws std::invalid_argument that says what is wrong and what would be right. Whether a number of
// the scene file is there, and what it may be, only the scene can tell.
[[nodiscard]] MapAxis parse_map_axis(std::string_view text);

// A last key alone, such as "stiffness", as the path of the one number in this scene that it can
// stand for. Throws std::invalid_argument where there is none, or several, which it names.
[[nodiscard]] MapAxis with_whole_path(MapAxis axis, std::string_view scene_text);

// The axis with its values rounded to whole numbers, each once. Throws std::invalid_argument when
// fewer than two are left.
[[nodiscard]] MapAxis in_whole_numbers(MapAxis axis);

// Halfway, as the axis has it: by ratio on a logarithmic one; a whole number where it takes no
// others.
[[nodiscard]] double between(const MapAxis &axis, double low, double high);

// Where a value lies in units of cells: 0 at the centre of the first, beyond the ends where it is
// beyond the values. Not below zero on a logarithmic axis.
[[nodiscard]] double cell_position(const MapAxis &axis, double value);

// "1/120", "0.5": without the unit, for the numbers along an axis.
[[nodiscard]] std::string value_label(const MapAxis &axis, double value);

// "dt (s), logarithmic"
[[nodiscard]] std::string axis_title(const MapAxis &axis);

} // namespace plumb

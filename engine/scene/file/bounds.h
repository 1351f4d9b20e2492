// Allowed ranges of a scene file's numbers, and their wording.
#pragma once

#include "engine/scene/scene_desc.h"

#include <limits>
#include <string_view>

namespace plumb::scene_file {

struct Bounds {
    double min;
    double max;
    std::string_view text;
};
inline constexpr double huge = max_scene_magnitude;
inline constexpr Bounds finite{std::numeric_limits<double>::lowest(),
                               std::numeric_limits<double>::max(), "a finite number"};
inline constexpr Bounds moderate{-huge, huge, "a number between -1e9 and 1e9"};
inline constexpr Bounds positive{1 / huge, huge, "a positive number, from 1e-9 to 1e9"};
inline constexpr Bounds not_negative{0, huge, "a number from 0 to 1e9"};
inline constexpr Bounds fraction{0, 1, "a number from 0 to 1"};
inline constexpr Bounds above_zero{std::numeric_limits<double>::denorm_min(),
                                   std::numeric_limits<double>::max(), "a number above 0"};

} // namespace plumb::scene_file

// The look of the panels.
#pragma once

#include <imgui/imgui.h>

namespace plumb {

struct Fonts {
    ImFont *text = nullptr;  // 16 px at a scale of 1
    ImFont *small = nullptr; // 13 px: keys, units, axes
};

// ImVec4, but constexpr. sRGB, 0..1.
struct Colour {
    float red, green, blue, alpha;
    // NOLINTNEXTLINE(google-explicit-constructor): stands wherever ImGui wants its own type
    operator ImVec4() const { return {red, green, blue, alpha}; }
};

namespace theme {
inline constexpr Colour panel{0.125f, 0.145f, 0.170f, 0.95f};
inline constexpr Colour field{0.190f, 0.215f, 0.250f, 1.00f};
inline constexpr Colour hover{0.250f, 0.285f, 0.330f, 1.00f};
inline constexpr Colour active{0.290f, 0.380f, 0.470f, 1.00f};
inline constexpr Colour chosen{0.205f, 0.325f, 0.440f, 1.00f};
inline constexpr Colour line{0.255f, 0.285f, 0.325f, 1.00f};
inline constexpr Colour text{0.900f, 0.915f, 0.930f, 1.00f};
inline constexpr Colour dim{0.590f, 0.630f, 0.675f, 1.00f};
inline constexpr Colour accent{0.420f, 0.680f, 0.900f, 1.00f};
inline constexpr Colour good{0.480f, 0.760f, 0.560f, 1.00f};
inline constexpr Colour warning{0.940f, 0.760f, 0.380f, 1.00f};
inline constexpr Colour error{0.940f, 0.470f, 0.430f, 1.00f};
} // namespace theme

// Sets the style of the current ImGui context.
void apply_theme(float scale);

// Adds both fonts to the current context's atlas.
[[nodiscard]] Fonts load_fonts(float scale);

} // namespace plumb

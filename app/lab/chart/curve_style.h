// How the curves of a chart are told apart: colour, dashes and the shape of their marks.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace plumb {

// A style is a colour, style % series_colour_count, a shape, style % shape_count, and dashes,
// (style / series_colour_count) % dash_count: no two of style_count are alike, those of one colour
// differ in dashes and in shape, and the first series_colour_count are solid.
inline constexpr std::size_t series_colour_count = 8;
inline constexpr std::size_t shape_count = 5; // coprime to the number of colours
inline constexpr std::size_t dash_count = 5;
inline constexpr std::size_t style_count = series_colour_count * shape_count;

// Distinguishable with any common type of colour blindness (Okabe and Ito 2008), without the
// yellow, which is too light on white; instead a brown. 0xrrggbb.
inline constexpr std::array<unsigned, series_colour_count> series_colours{
    0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0xe69f00, 0x56b4e9, 0x4d4d4d, 0x7a4a1e};

// The corners of a style's mark about p, convex; all shapes have the same visual weight at the same
// `radius`, in pixels.
[[nodiscard]] std::vector<glm::vec2> mark_outline(std::size_t style, glm::vec2 p, float radius);

// The straight pieces in which a style's line through the points is drawn; dashes go on round
// corners. `scale`: 1 for a line 1.8 pixels wide. Empty for fewer than two points.
using LinePiece = std::array<glm::vec2, 2>;
[[nodiscard]] std::vector<LinePiece>
line_pieces(std::size_t style, std::span<const glm::vec2> points, float scale = 1);

} // namespace plumb

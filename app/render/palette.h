// The program's colours, sRGB 0..1.
#pragma once

#include <cstddef>

#include <glm/vec3.hpp>

namespace plumb {

// Muted body colours, distinct for neighbouring indices; repeats after palette_size.
inline constexpr std::size_t palette_size = 8;
[[nodiscard]] glm::vec3 palette_colour(std::size_t index);

// Linear colour, for shaders and blending; components beyond 0..1 are clamped.
[[nodiscard]] glm::vec3 linear_from_srgb(const glm::vec3 &srgb);

namespace colours {
inline constexpr glm::vec3 static_body{0.66f, 0.67f, 0.69f}; // bodies that never move
inline constexpr glm::vec3 kinematic{0.50f, 0.55f, 0.60f};   // bodies with prescribed motion
inline constexpr glm::vec3 rod{0.36f, 0.38f, 0.42f};         // massless rods between bodies
inline constexpr glm::vec3 selected{0.98f, 0.62f, 0.16f};
inline constexpr glm::vec3 contact{0.85f, 0.26f, 0.22f};
inline constexpr glm::vec3 impact{0.93f, 0.70f, 0.15f};
inline constexpr glm::vec3 joint{0.16f, 0.42f, 0.66f};
inline constexpr glm::vec3 bounds{0.40f, 0.62f, 0.45f};
inline constexpr glm::vec3 ghost{0.55f, 0.75f, 0.95f}; // another method's bodies
inline constexpr glm::vec3 grab{0.95f, 0.50f, 0.12f};
inline constexpr glm::vec3 probe_yes{0.24f, 0.62f, 0.45f};    // hit, inside, overlapping
inline constexpr glm::vec3 probe_partly{0.93f, 0.70f, 0.25f}; // across
inline constexpr glm::vec3 probe_no{0.62f, 0.64f, 0.67f};     // missed, outside
inline constexpr glm::vec3 probe_axis{0.50f, 0.34f, 0.68f};
inline constexpr glm::vec3 probe_edge{0.30f, 0.33f, 0.37f};
inline constexpr glm::vec3 probe_faint{0.52f, 0.56f, 0.60f};
inline constexpr glm::vec3 probe_handle{0.99f, 0.78f, 0.42f};
inline constexpr glm::vec3 ink{0.16f, 0.18f, 0.21f}; // text and axes on light ground
} // namespace colours

} // namespace plumb

#include "app/render/palette.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace plumb {

namespace {

float linear_from_srgb(float s) {
    s = std::clamp(s, 0.0f, 1.0f);
    return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

} // namespace

glm::vec3 palette_colour(std::size_t index) {
    // Similar in lightness, so shading rather than colour shows the form.
    static constexpr std::array<glm::vec3, palette_size> colour{{
        {0.42f, 0.61f, 0.77f}, // blue
        {0.91f, 0.67f, 0.48f}, // apricot
        {0.55f, 0.73f, 0.61f}, // sage
        {0.85f, 0.55f, 0.53f}, // coral
        {0.90f, 0.79f, 0.54f}, // straw
        {0.64f, 0.60f, 0.77f}, // lavender
        {0.50f, 0.74f, 0.74f}, // teal
        {0.82f, 0.64f, 0.70f}, // rose
    }};
    return colour[index % palette_size];
}

glm::vec3 linear_from_srgb(const glm::vec3 &srgb) {
    return {linear_from_srgb(srgb.x), linear_from_srgb(srgb.y), linear_from_srgb(srgb.z)};
}

} // namespace plumb

#include "app/render/palette.h"

#include <array>

namespace plumb {

glm::vec3 palette_colour(std::size_t index) {
    // Similar in lightness, so that shading and not the colour shows the form.
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

} // namespace plumb

// Pictures as plain values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace plumb {

// RGB, 8 bits each, sRGB; rows from the top, without padding.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels; // 3 * width * height

    Image() = default;
    Image(int width_, int height_, glm::u8vec3 fill = glm::u8vec3(0));

    [[nodiscard]] glm::u8vec3 at(int x, int y) const; // checked
    void set(int x, int y, glm::u8vec3 colour);       // checked
    [[nodiscard]] bool empty() const { return pixels.empty(); }
    friend bool operator==(const Image &, const Image &) = default;
};

} // namespace plumb

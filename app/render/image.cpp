#include "app/render/image.h"

#include "engine/core/check.h"

namespace plumb {

namespace {

std::size_t offset(const Image &image, int x, int y) {
    PLUMB_CHECK(x >= 0 && x < image.width && y >= 0 && y < image.height,
                "no pixel " << x << ", " << y << " in a picture of " << image.width << " x "
                            << image.height);
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                static_cast<std::size_t>(x));
}

} // namespace

Image::Image(int width_, int height_, glm::u8vec3 fill) : width(width_), height(height_) {
    PLUMB_CHECK(width >= 0 && height >= 0,
                "a picture cannot be " << width << " x " << height << " pixels");
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    pixels.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i)
        pixels.insert(pixels.end(), {fill.r, fill.g, fill.b});
}

glm::u8vec3 Image::at(int x, int y) const {
    const std::size_t i = offset(*this, x, y);
    return {pixels[i], pixels[i + 1], pixels[i + 2]};
}

void Image::set(int x, int y, glm::u8vec3 colour) {
    const std::size_t i = offset(*this, x, y);
    pixels[i] = colour.r;
    pixels[i + 1] = colour.g;
    pixels[i + 2] = colour.b;
}

} // namespace plumb

#include "app/render/png.h"

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>

#include "engine/core/check.h"

#define STBI_ONLY_PNG
#if !defined(__clang_analyzer__) // stb's code is not ours to analyse
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#endif
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wconversion"
#endif
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace plumb {

void write_png(const std::filesystem::path &path, const Image &image) {
    PLUMB_CHECK(image.width > 0 && image.height > 0,
                "cannot write a picture of " << image.width << " x " << image.height << " pixels");
    std::filesystem::path part = path;
    part += ".part";
    std::error_code error;
    std::ofstream file(part, std::ios::binary);
    const auto append = [](void *to, void *bytes, int count) {
        static_cast<std::ofstream *>(to)->write(static_cast<const char *>(bytes), count);
    };
    const int encoded = stbi_write_png_to_func(append, &file, image.width, image.height, 3,
                                               image.pixels.data(), 3 * image.width);
    file.close();
    if (encoded == 0 || !file) { // a full disk shows when the file is closed
        const std::string reason = std::strerror(errno);
        std::filesystem::remove(part, error);
        throw std::runtime_error(path.string() + ": cannot write the picture: " + reason);
    }
    std::filesystem::rename(part, path, error);
    if (error) {
        const std::string reason = error.message();
        std::filesystem::remove(part, error);
        throw std::runtime_error(path.string() + ": cannot write the picture: " + reason);
    }
}

Image read_png(const std::filesystem::path &path) {
    int width = 0;
    int height = 0;
    int channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void *)> data(
        stbi_load(path.c_str(), &width, &height, &channels, 3), stbi_image_free);
    if (!data)
        throw std::runtime_error(path.string() +
                                 ": cannot read the picture: " + stbi_failure_reason());
    Image image;
    image.width = width;
    image.height = height;
    image.pixels.assign(data.get(), data.get() + static_cast<std::ptrdiff_t>(3) * width * height);
    return image;
}

} // namespace plumb

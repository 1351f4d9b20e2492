#include "app/render/png.h"

#include <cstddef>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include "app/files/output_file.h"
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
    std::string bytes;
    const auto append = [](void *to, void *more, int count) {
        static_cast<std::string *>(to)->append(static_cast<const char *>(more),
                                               static_cast<std::size_t>(count));
    };
    if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.pixels.data(),
                               3 * image.width) == 0)
        throw std::bad_alloc(); // the only way it fails
    OutputFile file(path);
    file.stream() << bytes;
    file.finish();
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

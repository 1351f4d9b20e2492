// PNG files: the one place that knows stb_image.
#pragma once

#include <filesystem>

#include "app/render/image.h"

namespace plumb {

// Writes beside the file and renames, so that a reader sees the old picture or the whole new one.
// Creates no folders. Throws std::runtime_error with the path and the reason.
void write_png(const std::filesystem::path &path, const Image &image);

// Greyscale and alpha are converted to RGB (alpha is dropped). Throws std::runtime_error.
[[nodiscard]] Image read_png(const std::filesystem::path &path);

} // namespace plumb

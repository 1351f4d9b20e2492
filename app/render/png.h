// PNG files: the one place that knows stb_image.
#pragma once

#include <filesystem>

#include "app/render/image.h"

namespace plumb {

// Written as an OutputFile: readers see the old picture or the complete new one. Throws
// std::system_error.
void write_png(const std::filesystem::path &path, const Image &image);

// Greyscale and alpha are converted to RGB (alpha is dropped). Throws std::runtime_error.
[[nodiscard]] Image read_png(const std::filesystem::path &path);

} // namespace plumb

// The typeface of panels and charts.
#pragma once

#include <filesystem>

struct ImFont;
struct ImFontAtlas;

namespace plumb {

// Adds Roboto Regular, or the given TrueType file, at this height in pixels; if the file cannot be
// read, ImGui's built-in font at the nearest whole multiple of its 13 pixels. Includes the Latin
// and Greek letters and the signs that charts need. Never null.
ImFont *load_font(ImFontAtlas &atlas, float pixels, const std::filesystem::path &file = {});

} // namespace plumb

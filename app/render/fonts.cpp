#include "app/render/fonts.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>

#include <imgui/imgui.h>

namespace plumb {

namespace {

// ImGui keeps the pointer until the atlas is built. Pairs of first and last, zero-terminated.
constexpr ImWchar letters[] = {
    0x0020, 0x00ff, // Latin, with the degree sign, plus-minus, superscripts 1 to 3, times
    0x0370, 0x03ff, // Greek
    0x2010, 0x2027, // dashes, quotes, bullet, ellipsis
    0x2070, 0x209c, // superscripts and subscripts
    0x2190, 0x2193, // arrows
    0x2202, 0x2265, // mathematical signs
    0,
};

} // namespace

ImFont *load_font(ImFontAtlas &atlas, float pixels, const std::filesystem::path &file) {
    const std::filesystem::path path =
        file.empty() ? "/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf"
                     : file;
    // ImGui stops the program if it cannot open a file, so check first.
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error)) {
        ImFontConfig config;
        config.OversampleH = 2;
        config.OversampleV = 2;
        if (ImFont *font =
                atlas.AddFontFromFileTTF(path.string().c_str(), pixels, &config, letters))
            return font;
    }
    ImFontConfig config;
    config.SizePixels = 13 * std::max(1.0f, std::round(pixels / 13));
    return atlas.AddFontDefault(&config);
}

} // namespace plumb

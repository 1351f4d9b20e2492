#include "app/lab/chart/chart_canvas.h"

#include "app/render/fonts.h"

namespace plumb {

ChartFonts load_chart_fonts(ImFontAtlas &atlas) {
    ChartFonts fonts{};
    for (const Face face : all_faces)
        fonts[static_cast<std::size_t>(face)] = load_font(atlas, font_size(face) * supersampling);
    return fonts;
}

glm::vec2 text_size(const ChartFonts &fonts, std::string_view text, Face face, float scale) {
    const ImVec2 size = fonts[static_cast<std::size_t>(face)]->CalcTextSizeA(
        scale * font_size(face) * supersampling, 1e9f, 0, text.data(), text.data() + text.size());
    return {size.x / supersampling, size.y / supersampling};
}

} // namespace plumb

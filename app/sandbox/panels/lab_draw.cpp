#include "app/sandbox/panels/lab_draw.h"

#include "app/sandbox/panels/widgets.h"

#include <array>
#include <cmath>

#include <imgui/imgui.h>

namespace plumb {

namespace {

constexpr std::array<Colour, 8> curve_colours{{{0.42f, 0.68f, 0.90f, 1},
                                               {0.90f, 0.64f, 0.42f, 1},
                                               {0.50f, 0.76f, 0.58f, 1},
                                               {0.76f, 0.66f, 0.90f, 1},
                                               {0.94f, 0.82f, 0.45f, 1},
                                               {0.92f, 0.55f, 0.65f, 1},
                                               {0.45f, 0.82f, 0.84f, 1},
                                               {0.78f, 0.80f, 0.82f, 1}}};

} // namespace

Colour curve_colour(std::size_t curve) {
    return curve_colours.at(curve % curve_colours.size());
}

float small_width(const Fonts &fonts, const std::string &text) {
    return fonts.small->CalcTextSizeA(fonts.small->FontSize, 1e9f, 0, text.c_str()).x;
}

void small_at(const Fonts &fonts, float x, float y, const std::string &text) {
    ImGui::GetWindowDrawList()->AddText(fonts.small, fonts.small->FontSize,
                                        {std::round(x), std::round(y)}, packed(theme::dim),
                                        text.c_str());
}

Colour colour_of_code(unsigned code) {
    const auto part = [&](unsigned shift) {
        return static_cast<float>(code >> shift & 0xffU) / 255;
    };
    return {part(16), part(8), part(0), 1};
}

bool study_button(const char *start, bool running, float width) {
    return ImGui::Button(running ? "Stop" : start, {width, 0});
}

void study_state(const PanelContext &context, bool running, double done, const std::string &failure,
                 const std::string &hint) {
    ImGui::PushFont(context.fonts.small);
    ImGui::PushTextWrapPos(0);
    if (!failure.empty())
        ImGui::TextColored(theme::error, "%s", failure.c_str());
    else if (running)
        ImGui::TextDisabled("%.0f %%", std::floor(100 * done));
    else
        ImGui::TextDisabled("%s", hint.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopFont();
}

} // namespace plumb

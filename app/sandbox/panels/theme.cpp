#include "app/sandbox/panels/theme.h"

#include "app/render/fonts.h"

#include <cmath>

namespace plumb {

void apply_theme(float scale) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowPadding = {12, 10};
    style.FramePadding = {8, 4};
    style.ItemSpacing = {8, 6};
    style.ItemInnerSpacing = {6, 4};
    style.CellPadding = {4, 2};
    style.ScrollbarSize = 10;
    style.GrabMinSize = 10;
    style.WindowBorderSize = 0;
    style.PopupBorderSize = 1;
    style.FrameBorderSize = 0;
    style.WindowRounding = 6;
    style.PopupRounding = 4;
    style.FrameRounding = 4;
    style.GrabRounding = 3;
    style.ScrollbarRounding = 5;
    style.TabRounding = 4;
    style.IndentSpacing = 14;
    style.DisabledAlpha = 0.45f;

    const auto set = [&](ImGuiCol which, const ImVec4 &colour) { style.Colors[which] = colour; };
    set(ImGuiCol_Text, theme::text);
    set(ImGuiCol_TextDisabled, theme::dim);
    set(ImGuiCol_WindowBg, theme::panel);
    set(ImGuiCol_ChildBg, {0, 0, 0, 0});
    set(ImGuiCol_PopupBg, {0.150f, 0.170f, 0.200f, 0.98f});
    set(ImGuiCol_Border, theme::line);
    set(ImGuiCol_FrameBg, theme::field);
    set(ImGuiCol_FrameBgHovered, theme::hover);
    set(ImGuiCol_FrameBgActive, theme::hover);
    set(ImGuiCol_ScrollbarBg, {0, 0, 0, 0});
    set(ImGuiCol_ScrollbarGrab, theme::line);
    set(ImGuiCol_ScrollbarGrabHovered, theme::hover);
    set(ImGuiCol_ScrollbarGrabActive, theme::active);
    set(ImGuiCol_CheckMark, theme::accent);
    set(ImGuiCol_SliderGrab, theme::active);
    set(ImGuiCol_SliderGrabActive, theme::accent);
    set(ImGuiCol_Button, theme::field);
    set(ImGuiCol_ButtonHovered, theme::hover);
    set(ImGuiCol_ButtonActive, theme::active);
    set(ImGuiCol_Header, theme::chosen);
    set(ImGuiCol_HeaderHovered, theme::hover);
    set(ImGuiCol_HeaderActive, theme::active);
    set(ImGuiCol_Separator, theme::line);
    set(ImGuiCol_Tab, theme::panel);
    set(ImGuiCol_TabHovered, theme::hover);
    set(ImGuiCol_TabActive, theme::chosen);
    set(ImGuiCol_TextSelectedBg, theme::chosen);
    style.ScaleAllSizes(scale);
    ImGui::GetStyle() = style;
}

Fonts load_fonts(float scale) {
    ImFontAtlas &atlas = *ImGui::GetIO().Fonts;
    Fonts fonts;
    fonts.text = load_font(atlas, std::round(16 * scale));
    fonts.small = load_font(atlas, std::round(13 * scale));
    return fonts;
}

} // namespace plumb

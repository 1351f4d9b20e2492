#include "app/sandbox/panels/widgets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <imgui/imgui.h>

namespace plumb {

namespace {

const char *begin(std::string_view text) {
    return text.data();
}
const char *end(std::string_view text) {
    return text.data() + text.size();
}

ImVec2 size_of(std::string_view text) {
    return ImGui::CalcTextSize(begin(text), end(text));
}

ImVec2 size_of(const ImFont &font, std::string_view text) {
    return font.CalcTextSizeA(font.FontSize, 1e9f, 0, begin(text), end(text));
}

void draw_small(const Fonts &fonts, ImVec2 at, std::string_view text, ImU32 colour) {
    ImGui::GetWindowDrawList()->AddText(fonts.small, fonts.small->FontSize,
                                        {std::round(at.x), std::round(at.y)}, colour, begin(text),
                                        end(text));
}

void triangle(ImDrawList &list, ImVec2 centre, float half, bool right, ImU32 colour) {
    const float tip = right ? half * 0.9f : -half * 0.9f;
    const ImVec2 point(centre.x + tip, centre.y);
    const ImVec2 top(centre.x - tip, centre.y - half);
    const ImVec2 bottom(centre.x - tip, centre.y + half);
    if (right)
        list.AddTriangleFilled(top, point, bottom, colour);
    else
        list.AddTriangleFilled(bottom, point, top, colour);
}

void bar(ImDrawList &list, float x, float y, float half_width, float half_height, ImU32 colour) {
    list.AddRectFilled({x - half_width, y - half_height}, {x + half_width, y + half_height}, colour,
                       1);
}

// Width reserved for the arrow, in text heights.
constexpr float fold_width = 0.95f;

// Bright while the last item, which it belongs to, is hovered.
void draw_fold_sign(ImVec2 at, bool open) {
    const ImU32 colour = packed(ImGui::IsItemHovered() ? theme::text : theme::dim);
    const float side = ImGui::GetFontSize();
    const ImVec2 c(at.x + side * 0.32f, at.y + side * 0.5f);
    const float s = side * 0.26f;
    ImDrawList &list = *ImGui::GetWindowDrawList();
    if (open)
        list.AddTriangleFilled({c.x - s, c.y - 0.7f * s}, {c.x + s, c.y - 0.7f * s},
                               {c.x, c.y + 0.9f * s}, colour);
    else
        triangle(list, c, s, true, colour);
}

void draw_icon(ImDrawList &list, Icon icon, ImVec2 c, float s, ImU32 colour) {
    switch (icon) {
    case Icon::pause:
        bar(list, c.x - 0.45f * s, c.y, 0.22f * s, s, colour);
        bar(list, c.x + 0.45f * s, c.y, 0.22f * s, s, colour);
        return;
    case Icon::play:
        triangle(list, c, s, true, colour);
        return;
    case Icon::step:
        triangle(list, {c.x - 0.2f * s, c.y}, 0.8f * s, true, colour);
        bar(list, c.x + 0.85f * s, c.y, 0.16f * s, 0.8f * s, colour);
        return;
    case Icon::step_back:
        triangle(list, {c.x + 0.2f * s, c.y}, 0.8f * s, false, colour);
        bar(list, c.x - 0.85f * s, c.y, 0.16f * s, 0.8f * s, colour);
        return;
    case Icon::restart:
        bar(list, c.x - 1.25f * s, c.y, 0.16f * s, 0.8f * s, colour);
        triangle(list, {c.x - 0.35f * s, c.y}, 0.7f * s, false, colour);
        triangle(list, {c.x + 0.85f * s, c.y}, 0.7f * s, false, colour);
        return;
    case Icon::slower:
        bar(list, c.x, c.y, 0.7f * s, 0.14f * s, colour);
        return;
    case Icon::faster:
        bar(list, c.x, c.y, 0.7f * s, 0.14f * s, colour);
        bar(list, c.x, c.y, 0.14f * s, 0.7f * s, colour);
        return;
    }
}

constexpr std::string_view hard_space = "\u00a0";

std::string with_spaces(std::string_view text, std::string_view old, std::string_view wanted) {
    std::string result(text);
    for (std::size_t at = 0; (at = result.find(old, at)) != std::string::npos; at += wanted.size())
        result.replace(at, old.size(), wanted);
    return result;
}

// Breaks words into lines, one word at a time.
class Lines {
  public:
    explicit Lines(float width) : width_(width) {}

    void add(std::string_view word) {
        const std::string plain = with_spaces(word, hard_space, " ");
        const std::string longer = line_ ? *line_ + " " + plain : plain;
        const std::size_t hard = word.find(hard_space);
        if (size_of(longer).x <= width_) {
            line_ = longer;
        } else if (hard != std::string_view::npos && size_of(plain).x > width_) {
            add(word.substr(0, hard));
            add(word.substr(hard + hard_space.size()));
        } else {
            if (line_)
                end();
            line_ = plain;
        }
    }
    void end() {
        text_ += line_.value_or("") + "\n";
        line_.reset();
    }
    [[nodiscard]] std::string text() const { return text_ + line_.value_or(""); }

  private:
    float width_;
    std::string text_;
    std::optional<std::string> line_;
};

std::string broken(std::string_view text, float width) {
    Lines lines(width);
    while (!text.empty()) {
        const std::size_t at = text.find_first_of(" \n");
        lines.add(text.substr(0, at));
        if (at == std::string_view::npos)
            break;
        if (text[at] == '\n')
            lines.end();
        text.remove_prefix(at + 1);
    }
    return lines.text();
}

float check_box_side() {
    return std::round(ImGui::GetFrameHeight() * 0.62f);
}

} // namespace

void heading(const Fonts &fonts, std::string_view text, std::string_view key) {
    ImGui::PushStyleColor(ImGuiCol_Text, theme::accent);
    ImGui::TextUnformatted(begin(text), end(text));
    ImGui::PopStyleColor();
    if (!key.empty()) {
        const ImVec2 size = size_of(*fonts.small, key);
        const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
        draw_small(fonts, {right - size.x, ImGui::GetItemRectMax().y - size.y - 1}, key,
                   packed(theme::dim));
    }
}

bool fold_sign(const char *id, bool open) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float side = ImGui::GetFontSize();
    const bool pressed = ImGui::InvisibleButton(id, {side * fold_width, side});
    draw_fold_sign(at, open);
    return pressed;
}

bool fold_title(const Fonts &fonts, std::string_view text, std::string_view at_right, bool open) {
    const ImVec2 start = ImGui::GetCursorPos();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool pressed =
        ImGui::InvisibleButton(("##" + std::string(text)).c_str(),
                               {ImGui::GetContentRegionAvail().x, ImGui::GetTextLineHeight()});
    tooltip(open ? "Collapse" : "Expand");
    draw_fold_sign(at, open);
    ImGui::SetCursorPos({start.x + ImGui::GetFontSize() * fold_width, start.y});
    heading(fonts, text, at_right);
    return pressed;
}

void tooltip(std::string_view text) {
    const bool typed_in = ImGui::IsItemActive() && ImGui::GetIO().WantTextInput;
    if (typed_in || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        return;
    ImGui::BeginTooltip();
    ImGui::TextUnformatted(broken(text, ImGui::GetFontSize() * 22).c_str());
    ImGui::EndTooltip();
}

void wrapped(std::string_view text, std::optional<float> width) {
    const float room = width.value_or(ImGui::GetContentRegionAvail().x);
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + room); // for words too long for a line
    ImGui::TextUnformatted(broken(text, room).c_str());
    ImGui::PopTextWrapPos();
}

std::string unbroken(std::string_view text) {
    return with_spaces(text, " ", hard_space);
}

void action_tooltip(Action action) {
    const ActionInfo &row = info(action);
    tooltip(std::string(row.title) + " (" + shortcuts(row) + ")\n" + std::string(row.about));
}

bool icon_button(const Fonts &fonts, Icon icon, Action action, float width) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetFrameHeight() * 1.15f;
    const std::string id = "##" + std::string(info(action).title);
    ImGui::BeginGroup();
    const bool pressed = ImGui::Button(id.c_str(), {width, height});
    action_tooltip(action);
    draw_icon(*ImGui::GetWindowDrawList(), icon, {at.x + width / 2, at.y + height / 2},
              height * 0.24f, ImGui::GetColorU32(theme::text));
    // The small font would make a comma or full stop unreadable.
    const std::string key = shortcut(action);
    const ImFont &font = key.size() == 1 ? *fonts.text : *fonts.small;
    const ImVec2 size = size_of(font, key);
    ImGui::GetWindowDrawList()->AddText(
        &font, font.FontSize, {std::round(at.x + (width - size.x) / 2), at.y + height + 1},
        ImGui::GetColorU32(theme::dim), key.c_str());
    ImGui::Dummy({width, fonts.text->FontSize});
    ImGui::EndGroup();
    return pressed;
}

bool action_button(const Fonts &fonts, Action action, float width) {
    const ActionInfo &row = info(action);
    const std::string key = shortcut(action);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetFrameHeight();
    const bool pressed = ImGui::Button(("##" + std::string(row.title)).c_str(), {width, height});
    action_tooltip(action);
    const ImVec2 text = size_of(row.title);
    const ImVec2 small = size_of(*fonts.small, key);
    const float between = ImGui::GetStyle().ItemInnerSpacing.x;
    const bool has_room = text.x + between + small.x + between <= width;
    const float start = at.x + (width - text.x - (has_room ? between + small.x : 0)) / 2;
    ImGui::GetWindowDrawList()->AddText({std::round(start), at.y + (height - text.y) / 2},
                                        ImGui::GetColorU32(theme::text), begin(row.title),
                                        end(row.title));
    if (has_room)
        draw_small(fonts, {start + text.x + between, at.y + (height - small.y) / 2 + 1}, key,
                   ImGui::GetColorU32(theme::dim));
    return pressed;
}

float check_box_width(const Fonts &fonts, Action action, bool with_key) {
    const float between = ImGui::GetStyle().ItemInnerSpacing.x;
    return check_box_side() + between + size_of(info(action).title).x +
           (with_key ? between + size_of(*fonts.small, shortcut(action)).x : 0);
}

bool action_check_box(const Fonts &fonts, Action action, bool checked, float width, bool with_key) {
    const ActionInfo &row = info(action);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetFrameHeight();
    const bool pressed =
        ImGui::InvisibleButton(("##" + std::string(row.title)).c_str(), {width, height});
    action_tooltip(action);
    ImDrawList &list = *ImGui::GetWindowDrawList();
    const float side = check_box_side();
    const ImVec2 box(at.x, at.y + std::round((height - side) / 2));
    const Colour ground = checked                  ? theme::chosen
                          : ImGui::IsItemHovered() ? theme::hover
                                                   : theme::field;
    list.AddRectFilled(box, {box.x + side, box.y + side}, packed(ground), 3);
    if (checked) {
        const std::array<ImVec2, 3> tick{ImVec2(box.x + side * 0.22f, box.y + side * 0.52f),
                                         ImVec2(box.x + side * 0.43f, box.y + side * 0.73f),
                                         ImVec2(box.x + side * 0.80f, box.y + side * 0.29f)};
        list.AddPolyline(tick.data(), static_cast<int>(tick.size()), packed(theme::text), 0,
                         side * 0.13f);
    }
    const ImVec2 text = size_of(row.title);
    const float start = at.x + side + ImGui::GetStyle().ItemInnerSpacing.x;
    list.AddText({start, at.y + (height - text.y) / 2}, packed(theme::text), begin(row.title),
                 end(row.title));
    if (!with_key)
        return pressed;
    const std::string key = shortcut(action);
    const ImVec2 small = size_of(*fonts.small, key);
    draw_small(
        fonts,
        {start + text.x + ImGui::GetStyle().ItemInnerSpacing.x, at.y + (height - small.y) / 2 + 1},
        key, packed(theme::dim));
    return pressed;
}

void value_row(std::string_view what, const std::string &value) {
    value_row(what, value, theme::text);
}

void value_row(std::string_view what, const std::string &value, const Colour &colour) {
    const float left = ImGui::GetCursorPosX();
    const float right = left + ImGui::GetContentRegionAvail().x;
    ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
    ImGui::TextUnformatted(begin(what), end(what));
    ImGui::PopStyleColor();
    // Once a value did not fit beside its label at this width, it stays below it: rows must not
    // jump as digits change.
    const float value_left = right - size_of(value).x;
    const ImGuiID row = ImGui::GetID(begin(what), end(what)) + static_cast<ImGuiID>(right);
    bool &is_below = *ImGui::GetStateStorage()->GetBoolRef(row);
    is_below |= left + size_of(what).x + ImGui::GetStyle().ItemSpacing.x > value_left;
    if (!is_below)
        ImGui::SameLine();
    ImGui::SetCursorPosX(std::max(value_left, left));
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::TextUnformatted(value.data(), value.data() + value.size());
    ImGui::PopStyleColor();
}

void light(const Colour &colour) {
    const float side = ImGui::GetTextLineHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 centre(at.x + 0.4f * side, at.y + 0.5f * side);
    ImGui::GetWindowDrawList()->AddCircleFilled(centre, 0.42f * side, packed(colour, 0.3f));
    ImGui::GetWindowDrawList()->AddCircleFilled(centre, 0.28f * side, packed(colour));
    ImGui::Dummy({0.8f * side, side});
}

void small_text(const Fonts &fonts, std::string_view text) {
    ImGui::PushFont(fonts.small);
    ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
    ImGui::TextUnformatted(begin(text), end(text));
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

std::string number(double value, std::string_view unit, int digits) {
    if (!std::isfinite(value))
        return "-";
    std::array<char, 48> written{};
    std::snprintf(written.data(), written.size(), "%.*g", digits, value == 0 ? 0.0 : value);
    std::string text = written.data();
    if (!unit.empty())
        text += " " + std::string(unit);
    return text;
}

std::string duration(double seconds) {
    const double size = std::abs(seconds);
    return size >= 0.9995      ? number(seconds, "s", 3)
           : size >= 0.9995e-3 ? number(seconds * 1e3, "ms", 3)
           : size >= 0.9995e-6 ? number(seconds * 1e6, "µs", 3)
                               : number(seconds * 1e9, "ns", 3);
}

ImU32 packed(const Colour &colour, float alpha) {
    return ImGui::ColorConvertFloat4ToU32(
        {colour.red, colour.green, colour.blue, colour.alpha * alpha});
}

} // namespace plumb

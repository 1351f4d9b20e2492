// The probes' questions and answers, and their labels over the scene.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <imgui/imgui.h>

namespace plumb {

namespace {

std::string value_text(const ProbeValue &value) {
    switch (value.form) {
    case ProbeValue::Form::flag:
        return value.value != 0 ? "yes" : "no";
    case ProbeValue::Form::count:
        return number(value.value, {}, 9);
    case ProbeValue::Form::number:
    case ProbeValue::Form::entry:
        break;
    }
    return number(value.value, {}, 5);
}

// Green if all expectations on these values hold, red if not, plain if there are none.
Colour colour_of(const ProbeDesc &probe, std::span<const ProbeValue> values) {
    bool is_any_expected = false;
    for (const ProbeValue &value : values) {
        const auto expect = std::ranges::find(probe.expects, value.name, &ProbeExpectDesc::value);
        if (expect == probe.expects.end())
            continue;
        if (!(std::abs(value.value - expect->is) <= probe.tolerance))
            return theme::error;
        is_any_expected = true;
    }
    return is_any_expected ? theme::good : theme::text;
}

} // namespace

void probes_panel(PanelContext &context) {
    const Session &session = context.session;
    for (std::size_t i = 0; i < session.probes().size(); ++i) {
        const ProbeDesc &probe = session.probes()[i];
        const ProbeAnswer &found = session.answers()[i];
        const bool is_hovered =
            context.view.hovered_handle && context.view.hovered_handle->probe == i;
        ImGui::PushStyleColor(ImGuiCol_Text, is_hovered ? theme::accent : theme::text);
        ImGui::PushTextWrapPos(0);
        ImGui::TextUnformatted(probe.name.c_str());
        ImGui::PopTextWrapPos();
        ImGui::PopStyleColor();
        if (is_hovered && !ImGui::IsItemVisible())
            ImGui::SetScrollHereY();
        tooltip(probe_question(probe.question).about);
        ImGui::PushFont(context.fonts.small);
        if (!found.refusal.empty()) {
            ImGui::PushTextWrapPos(0);
            ImGui::TextColored(theme::warning, "%s", found.refusal.c_str());
            ImGui::PopTextWrapPos();
        }
        std::span<const ProbeValue> left = found.values;
        while (!left.empty()) {
            // Show a matrix row as one line, under the row's name: "minor_1" for "minor_11".
            const bool is_row = left.front().form == ProbeValue::Form::entry;
            const auto values = left.first(is_row ? 3 : 1);
            left = left.subspan(values.size());
            std::string name(
                values.front().name.substr(0, values.front().name.size() - (is_row ? 1 : 0)));
            std::ranges::replace(name, '_', ' ');
            std::string text;
            for (const ProbeValue &value : values)
                text += (text.empty() ? "" : "   ") + value_text(value);
            value_row(name, text, colour_of(probe, values));
        }
        ImGui::PopFont();
        ImGui::Spacing();
    }
}

void probe_labels(const PanelContext &context) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImDrawList &list = *ImGui::GetBackgroundDrawList();
    ImFont *font = context.fonts.small;
    for (const ProbeAnswer &found : context.session.answers())
        for (const ProbeLabel &label : found.labels) {
            if (label.text.empty())
                continue;
            const glm::vec3 seen =
                context.view.camera.project(glm::vec3(label.position), glm::vec2(size.x, size.y));
            if (!(seen.z >= 0 && seen.z <= 1))
                continue;
            const ImVec2 text = font->CalcTextSizeA(font->FontSize, 1e9f, 0, label.text.c_str());
            // Above and to the right of the point.
            const ImVec2 at(std::round(seen.x + 9), std::round(seen.y - text.y - 5));
            list.AddRectFilled({at.x - 4, at.y - 1}, {at.x + text.x + 4, at.y + text.y + 1},
                               packed(theme::text, 0.85f), 4);
            list.AddText(font, font->FontSize, at, packed(theme::panel), label.text.c_str());
        }
}

} // namespace plumb

// The scene's title, its description, and what it can be held to.
#include "app/sandbox/panel.h"
#include "app/sandbox/widgets.h"

#include "engine/scene/expect.h"

#include <imgui/imgui.h>

namespace plumb {

namespace {

void wrapped(const std::string &text) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
}

// "drift of energy, 0 to 5 s"
std::string measured(const ExpectDesc &expect) {
    std::string text = expect.reduce + " of " + expect.quantity;
    if (!expect.body.empty())
        text += " of " + expect.body;
    if (expect.from == expect.to)
        return text + " at " + number(expect.to, "s");
    return text + ", " + number(expect.from) + " to " + number(expect.to, "s");
}

// "= 1.4 ± 0.01 m". A period is in seconds and crossings are counted, whatever they are of.
std::string demanded(const ExpectDesc &expect) {
    const QuantityInfo *quantity = find_quantity(expect.quantity);
    const std::string_view unit = expect.reduce == "period"           ? "s"
                                  : expect.reduce == "crossings"      ? ""
                                  : quantity && quantity->unit != "1" ? quantity->unit
                                                                      : "";
    switch (expect.relation) {
    case ExpectDesc::Relation::equals:
        return "= " + number(expect.value) + " ± " + number(expect.tolerance, unit);
    case ExpectDesc::Relation::at_most:
        return "≤ " + number(expect.value, unit);
    case ExpectDesc::Relation::at_least:
        return "≥ " + number(expect.value, unit);
    }
    return "";
}

} // namespace

void expectations_panel(PanelContext &context) {
    if (!context.session.running()) {
        ImGui::TextDisabled("No scene is running.");
        return;
    }
    const SceneDesc &scene = context.session.scene();
    wrapped(scene.title.empty() ? scene.name : scene.title);
    if (!scene.description.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
        wrapped(scene.description);
        ImGui::PopStyleColor();
    }
    ImGui::Spacing();
    if (!scene.probes.empty()) {
        heading(context.fonts, "Probes");
        probes_panel(context);
    }
    if (!context.session.simulation()->has_world())
        return;
    heading(context.fonts, "Expected");
    if (scene.expects.empty())
        ImGui::TextDisabled("This scene states no truth.");
    for (const ExpectDesc &expect : scene.expects) {
        value_row(expect.name, demanded(expect));
        ImGui::PushFont(context.fonts.small);
        ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
        wrapped(measured(expect));
        if (!expect.source.empty())
            wrapped(expect.source);
        ImGui::PopStyleColor();
        ImGui::PopFont();
        ImGui::Spacing();
    }
}

} // namespace plumb

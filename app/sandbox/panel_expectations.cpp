// The scene's title, its description, what it can be held to, and whether it holds.
#include "app/sandbox/panel.h"
#include "app/sandbox/widgets.h"

#include <cmath>
#include <string>

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
    if (expect.reduce == "last" || expect.from == expect.to)
        return text + " at " + number(expect.to, "s");
    return text + ", " + number(expect.from) + " to " + number(expect.to, "s");
}

std::string_view unit_of(const ExpectOutcome &outcome) {
    return outcome.unit == "1" ? std::string_view() : std::string_view(outcome.unit);
}

// "= 1.4 ± 0.01 m"
std::string demanded(const ExpectOutcome &outcome) {
    const ExpectDesc &expect = outcome.desc;
    switch (expect.relation) {
    case ExpectDesc::Relation::equals:
        if (!expect.curve.empty())
            return "≤ " + number(expect.tolerance, unit_of(outcome)) + " off its curve";
        return "= " + number(expect.value) + " ± " + number(expect.tolerance, unit_of(outcome));
    case ExpectDesc::Relation::at_most:
        return "≤ " + number(expect.value, unit_of(outcome));
    case ExpectDesc::Relation::at_least:
        return "≥ " + number(expect.value, unit_of(outcome));
    }
    return "";
}

// "0.0031 m so far, expected ≤ 0.01 m"
std::string found_and_demanded(const ExpectOutcome &outcome) {
    std::string found = number(outcome.measured, unit_of(outcome));
    if (outcome.verdict == Verdict::unseen)
        found = "not judged, since the run goes on from a later state";
    else if (!std::isfinite(outcome.measured))
        found = outcome.verdict == Verdict::pending ? "nothing yet" : "nothing to measure";
    else if (outcome.verdict == Verdict::pending)
        found += " so far";
    return found + ", expected " + demanded(outcome);
}

Colour colour_of(Verdict verdict) {
    switch (verdict) {
    case Verdict::met:
        return theme::good;
    case Verdict::missed:
        return theme::error;
    case Verdict::pending:
    case Verdict::unseen:
        break;
    }
    return theme::dim;
}

// The name, wrapped beside the verdict at the right end. What was pending when the run stopped for
// good stays without a verdict.
void verdict_row(const ExpectOutcome &outcome, bool stopped) {
    const bool cut_short = stopped && outcome.verdict == Verdict::pending;
    const std::string verdict(cut_short ? "stopped" : verdict_name(outcome.verdict));
    const float right = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x;
    const float at = right - ImGui::CalcTextSize(verdict.c_str()).x;
    const ImVec2 start = ImGui::GetCursorPos();
    ImGui::SetCursorPosX(at);
    ImGui::TextColored(cut_short ? theme::error : colour_of(outcome.verdict), "%s",
                       verdict.c_str());
    ImGui::SetCursorPos(start);
    ImGui::PushTextWrapPos(at - ImGui::GetStyle().ItemSpacing.x);
    ImGui::TextUnformatted(outcome.desc.name.c_str());
    ImGui::PopTextWrapPos();
}

// A light and what it means.
void warn(const Fonts &fonts, const Colour &colour, const std::string &text) {
    light(colour);
    ImGui::SameLine();
    ImGui::PushFont(fonts.small);
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    wrapped(text);
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

// Red when the run has failed, amber when it is outside what the scene expects.
void lights(const PanelContext &context) {
    const Session &session = context.session;
    if (const std::optional<Trouble> trouble = session.trouble())
        warn(context.fonts, theme::error, trouble->text);
    const std::vector<ExpectDesc> &expects = session.scene().expects;
    std::string missed;
    for (std::size_t i = 0; i < expects.size(); ++i)
        if (const std::optional<double> since = session.missed_since(i))
            missed += (missed.empty() ? "Outside tolerance: " : "; ") + expects[i].name +
                      " since " + number(*since, "s");
    if (!missed.empty())
        warn(context.fonts, theme::warning, missed + ".");
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
    lights(context);
    if (scene.expects.empty())
        ImGui::TextDisabled("This scene expects nothing.");
    else if (context.session.disturbed()) {
        ImGui::PushFont(context.fonts.small);
        ImGui::PushStyleColor(ImGuiCol_Text, theme::warning);
        wrapped("Changed in mid-run: this is what happened, not what a check of the scene says.");
        ImGui::PopStyleColor();
        ImGui::PopFont();
    }
    for (const ExpectOutcome &outcome : context.session.expectations()) {
        verdict_row(outcome, context.session.stopped());
        ImGui::PushFont(context.fonts.small);
        wrapped(found_and_demanded(outcome));
        ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
        wrapped(measured(outcome.desc));
        if (!outcome.desc.source.empty())
            wrapped(outcome.desc.source);
        ImGui::PopStyleColor();
        ImGui::PopFont();
        ImGui::Spacing();
    }
}

} // namespace plumb

// The scene's title, description and expectations, and whether they hold.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"
#include "app/sandbox/session/run_light.h"
#include "engine/scene/expect.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <imgui/imgui.h>

namespace plumb {

namespace {

// "drift of energy error, 0 to 5 s", "largest |position.x| of bob, 0 to 5 s", "position.y of bob at
// 5 s"
std::string measured(const ExpectDesc &expect) {
    std::string quantity = expect.quantity;
    std::ranges::replace(quantity, '_', ' ');
    const std::string of = expect.body.empty() ? "" : " of " + expect.body;
    const std::string at = " at " + unbroken(number(expect.to, "s"));
    const std::string over = ", " + unbroken(number(expect.from) + " to " + number(expect.to, "s"));
    const ReductionInfo *reduction = find_reduction(expect.reduce);
    if (!reduction) // the scene was validated, so there is one
        return quantity + of;
    const bool is_mean = reduction->reduction == Reduction::mean;
    if (!expect.curve.empty())
        return (is_mean ? "mean" : "largest") + (" distance of " + quantity) + of +
               " from its curve" + over;
    switch (reduction->reduction) {
    case Reduction::last:
        return quantity + of + at;
    case Reduction::min:
        return "smallest " + quantity + of + over;
    case Reduction::max:
        return (quantity.starts_with("max ") ? "" : "largest ") + quantity + of + over;
    case Reduction::mean:
        return "mean " + quantity + of + over;
    case Reduction::max_abs:
        return "largest |" + quantity + "|" + of + over;
    case Reduction::drift:
        return "drift of " + quantity + of + over;
    case Reduction::period:
        return "period of " + quantity + of + over;
    case Reduction::crossings:
        return "crossings of " + quantity + of + over;
    case Reduction::first_crossing:
        return "first crossing of " + quantity + of + over;
    }
    return "";
}

std::string_view unit_of(const ExpectOutcome &outcome) {
    return outcome.unit == "1" ? std::string_view() : std::string_view(outcome.unit);
}

// "1.4 ± 0.01 m"
std::string demanded(const ExpectOutcome &outcome) {
    const ExpectDesc &expect = outcome.desc;
    switch (expect.relation) {
    case ExpectDesc::Relation::equals:
        if (!expect.curve.empty())
            return "≤ " + number(expect.tolerance, unit_of(outcome));
        return number(expect.value) + " ± " + number(expect.tolerance, unit_of(outcome));
    case ExpectDesc::Relation::at_most:
        return "≤ " + number(expect.value, unit_of(outcome));
    case ExpectDesc::Relation::at_least:
        return "≥ " + number(expect.value, unit_of(outcome));
    }
    return "";
}

// "0.0031 m so far, expected ≤ 0.01 m"
std::string found_and_demanded(const ExpectOutcome &outcome) {
    std::string found = unbroken(number(outcome.measured, unit_of(outcome)));
    if (outcome.verdict == Verdict::unseen)
        found = "not judged: the run started from a later state";
    else if (!std::isfinite(outcome.measured))
        found = outcome.verdict == Verdict::pending ? "nothing yet" : "nothing to measure";
    else if (outcome.verdict == Verdict::pending)
        found += " so far";
    return found + ", expected " + unbroken(demanded(outcome));
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

// The name, wrapped beside the verdict at the right end. Expectations still pending when the run
// stopped for good get no verdict.
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
    wrapped(outcome.desc.name, at - ImGui::GetStyle().ItemSpacing.x - start.x);
}

// A light with its meaning.
void warn(const Fonts &fonts, const Colour &colour, const std::string &text) {
    light(colour);
    ImGui::SameLine();
    ImGui::PushFont(fonts.small);
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    wrapped(text);
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

void lights(const PanelContext &context) {
    for (const RunLight &each : lights_of(context.session))
        warn(context.fonts, each.is_red ? theme::error : theme::warning, each.text);
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
        ImGui::TextDisabled("This scene has no expectations.");
    else if (context.session.disturbed()) {
        ImGui::PushFont(context.fonts.small);
        ImGui::PushStyleColor(ImGuiCol_Text, theme::warning);
        wrapped("Changed during the run: `plumb check` may disagree.");
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

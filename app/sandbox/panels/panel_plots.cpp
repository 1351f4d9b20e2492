// The choice of plotted quantities, and the plots.
#include "app/sandbox/panels/lab_draw.h"
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/plot_draw.h"
#include "app/sandbox/panels/widgets.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include <imgui/imgui.h>

namespace plumb {

namespace {

constexpr float least_plot = 5; // in text heights

void subject_box(PanelContext &context, float width) {
    ViewState &view = context.view;
    const Simulation &simulation = *context.session.simulation();
    // The user probably means the selection.
    if (view.offered_body != view.selected || view.offered_particle != view.selected_particle) {
        view.offered_body = view.selected;
        view.offered_particle = view.selected_particle;
        if (view.selected)
            view.plot_of = simulation.body_info(*view.selected).name;
        else if (view.selected_particle)
            view.plot_of = simulation.soft_parts().particle_name(*view.selected_particle);
    }
    if (quantities_of(simulation, view.plot_of).empty())
        view.plot_of.clear();
    ImGui::SetNextItemWidth(width);
    if (!ImGui::BeginCombo("##of", view.plot_of.empty() ? "whole scene" : view.plot_of.c_str())) {
        tooltip("Whose quantities to plot. Clicking something in the scene selects it here too.");
        return;
    }
    if (ImGui::Selectable("whole scene", view.plot_of.empty()))
        view.plot_of.clear();
    const std::vector<std::string> names = plot_subjects(simulation);
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(names.size()));
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const std::string &name = names[static_cast<std::size_t>(i)];
            if (ImGui::Selectable(name.c_str(), view.plot_of == name))
                view.plot_of = name;
        }
    ImGui::EndCombo();
}

void quantity_box(PanelContext &context, float width) {
    ImGui::SetNextItemWidth(width);
    if (!ImGui::BeginCombo("##quantity", "Plot …"))
        return;
    const Simulation &simulation = *context.session.simulation();
    for (const QuantityInfo *quantity : quantities_of(simulation, context.view.plot_of)) {
        const QuantityName name{std::string(quantity->name), context.view.plot_of};
        const auto curves = context.session.plots().curves();
        std::size_t curve = 0;
        while (curve < curves.size() && !(curves[curve].name == name))
            ++curve;
        const bool is_plotted = curve < curves.size();
        const std::string unit(shown_unit(*quantity));
        const std::string label = name.quantity + (unit.empty() ? "" : " (" + unit + ")");
        if (ImGui::Selectable(label.c_str(), is_plotted, ImGuiSelectableFlags_DontClosePopups)) {
            if (is_plotted)
                context.session.unplot(curve);
            else
                context.session.plot(name);
        }
        tooltip(quantity->description);
    }
    ImGui::EndCombo();
}

void span_box(ViewState &view, float width) {
    const auto text = [](const std::optional<double> &seconds) {
        return seconds ? "last " + number(*seconds, "s") : std::string("all");
    };
    ImGui::SetNextItemWidth(width);
    if (ImGui::BeginCombo("##span", text(view.plot_seconds).c_str())) {
        for (const double seconds : {0.0, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0}) {
            const auto span = seconds > 0 ? std::optional(seconds) : std::nullopt;
            if (ImGui::Selectable(text(span).c_str(), span == view.plot_seconds))
                view.plot_seconds = span;
        }
        ImGui::EndCombo();
    }
    tooltip("How far back the plots reach.");
}

// Per curve its name, current value and a cross to remove it; as many to a line as fit.
void legend(PanelContext &context) {
    const auto curves = context.session.plots().curves();
    const float em = ImGui::GetFontSize();
    const float right = ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x;
    std::optional<std::size_t> unwanted;
    ImGui::PushFont(context.fonts.small);
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const PlotCurve &curve = curves[i];
        const std::string text = title_of(curve.name) + "  " +
                                 (curve.samples.empty() ? "-"
                                                        : number(curve.samples.back().value,
                                                                 shown_unit(*curve.quantity), 5));
        const float side = 0.6f * em;
        const float width = side + 5 + ImGui::CalcTextSize(text.c_str()).x + 4 + em;
        if (i > 0 && ImGui::GetItemRectMax().x + em + width < right)
            ImGui::SameLine(0, em);
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float down = (ImGui::GetFontSize() - side) / 2;
        ImGui::GetWindowDrawList()->AddRectFilled(
            {at.x, at.y + down}, {at.x + side, at.y + down + side}, packed(curve_colour(i)), 2);
        ImGui::Dummy({side, ImGui::GetFontSize()});
        ImGui::SameLine(0, 5);
        ImGui::TextUnformatted(text.c_str());
        ImGui::SameLine(0, 4);
        ImGui::PushID(static_cast<int>(i));
        const ImVec2 cross = ImGui::GetCursorScreenPos();
        if (ImGui::InvisibleButton("##away", {em, ImGui::GetFontSize()}))
            unwanted = i;
        const ImU32 colour = packed(ImGui::IsItemHovered() ? theme::text : theme::dim);
        const float half = 0.22f * em;
        const ImVec2 c(cross.x + em / 2, cross.y + ImGui::GetFontSize() / 2);
        ImGui::GetWindowDrawList()->AddLine({c.x - half, c.y - half}, {c.x + half, c.y + half},
                                            colour, 1.5f);
        ImGui::GetWindowDrawList()->AddLine({c.x - half, c.y + half}, {c.x + half, c.y - half},
                                            colour, 1.5f);
        tooltip("Remove");
        ImGui::PopID();
    }
    ImGui::PopFont();
    if (unwanted)
        context.session.unplot(*unwanted);
}

} // namespace

void plots_tab(PanelContext &context) {
    const float em = ImGui::GetFontSize();
    const float spacing = ImGui::GetStyle().ItemSpacing.x;
    const float unit = (ImGui::GetContentRegionAvail().x - 3 * spacing) / 10;
    subject_box(context, 3 * unit);
    ImGui::SameLine();
    quantity_box(context, 2 * unit);
    ImGui::SameLine();
    span_box(context.view, 2.2f * unit);
    ImGui::SameLine();
    ImGui::BeginDisabled(context.session.plots().curves().empty());
    if (ImGui::Button("Save CSV", {-1, 0}))
        context.save_plots = true;
    ImGui::EndDisabled();
    if (const std::optional<std::uint64_t> first = context.session.plots().first_step())
        tooltip("Writes all curves, from step " + std::to_string(*first) +
                " to the current one. A curve begins at the step at which it was chosen.");
    if (context.session.plots().curves().empty()) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled("Choose the scene, a body, a particle, a spring or a joint, then the "
                            "quantities to plot. Those with the same unit share a plot.");
        ImGui::PopTextWrapPos();
        return;
    }
    legend(context);
    const auto count = static_cast<float>(plot_count(context.session.plots()));
    const ImVec2 room = ImGui::GetContentRegionAvail();
    draw_plots(context, {room.x, std::max(room.y, count * least_plot * em)});
}

} // namespace plumb

// Pause, step, step back, restart and speed.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"
#include "app/sandbox/session/run_light.h"

#include <array>
#include <cmath>
#include <cstdio>

#include <imgui/imgui.h>

namespace plumb {

namespace {

std::string speed_text(double speed) {
    std::array<char, 32> text{};
    if (speed >= 1)
        std::snprintf(text.data(), text.size(), "\xC3\x97%.4g", speed);
    else
        std::snprintf(text.data(), text.size(),
                      "\xC3\x97"
                      "1/%.4g",
                      1 / speed);
    return text.data();
}

void status(const PanelContext &context) {
    const Session &session = context.session;
    const char *state = session.stopped()        ? "stopped"
                        : context.clock.paused() ? "paused"
                                                 : "running";
    const Colour colour = session.stopped()        ? theme::error
                          : context.clock.paused() ? theme::warning
                                                   : theme::good;
    if (const std::vector<RunLight> lights = lights_of(session); !lights.empty()) {
        light(lights.front().is_red ? theme::error : theme::warning);
        tooltip(lights.front().text);
        ImGui::SameLine();
    }
    ImGui::TextColored(colour, "%s", state);
    ImGui::SameLine();
    ImGui::Text("%s", session.scene().name.c_str());
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "step %llu   %.3f s",
                  static_cast<unsigned long long>(session.simulation()->step_count()),
                  session.simulation()->time());
    const float width = ImGui::CalcTextSize(text.data()).x;
    ImGui::SameLine();
    const float right = ImGui::GetWindowContentRegionMax().x - width;
    if (right > ImGui::GetCursorPosX())
        ImGui::SetCursorPosX(right);
    ImGui::TextDisabled("%s", text.data());
}

// "×1 (actual ×0.2)" and "12 frames/s", while there is something to measure.
void pace_row(const PanelContext &context) {
    const Pace &pace = context.pace;
    std::string speed = speed_text(context.clock.speed());
    std::string frames;
    if (!context.frozen && pace.frames_per_second() > 0) {
        if (!context.clock.paused())
            speed += " (actual ×" + number(pace.of_real_time(), {}, 2) + ")";
        const double rate = pace.frames_per_second();
        frames = number(rate < 10 ? rate : std::round(rate), "frames/s", rate < 10 ? 2 : 6);
    }
    small_text(context.fonts, speed);
    ImGui::PushFont(context.fonts.small);
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(frames.c_str()).x);
    ImGui::TextDisabled("%s", frames.c_str());
    ImGui::PopFont();
}

} // namespace

void transport_panel(PanelContext &context) {
    const bool open = title_sign(context, PanelId::transport);
    ImGui::SameLine();
    status(context);
    if (!open)
        return;
    pace_row(context);
    const float spacing = ImGui::GetStyle().ItemSpacing.x;
    const float width = (ImGui::GetContentRegionAvail().x - 7 * spacing) / 8;
    const auto button = [&](Icon icon, Action action, bool enabled) {
        ImGui::BeginDisabled(!enabled);
        if (icon_button(context.fonts, icon, action, width))
            context.actions.push_back(action);
        ImGui::EndDisabled();
        ImGui::SameLine();
    };
    const bool can_step = !context.session.stopped();
    button(Icon::restart, Action::restart, true);
    button(Icon::step_back, Action::step_back, context.session.steps_remembered() > 0);
    button(context.clock.paused() ? Icon::play : Icon::pause, Action::pause, can_step);
    button(Icon::step, Action::step, can_step);
    ImGui::Dummy({width * 0.5f, 0});
    ImGui::SameLine();
    button(Icon::slower, Action::slower, can_step && context.clock.speed() > StepClock::min_speed);
    ImGui::BeginGroup();
    if (ImGui::Button((speed_text(context.clock.speed()) + "##speed").c_str(),
                      {width * 1.5f, ImGui::GetFrameHeight() * 1.15f}))
        context.speed = 1.0;
    tooltip("Simulated seconds per real second. Click for ×1.");
    const ImFont &small = *context.fonts.small;
    const float caption = small.CalcTextSizeA(small.FontSize, 1e9f, 0, "speed").x;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + (width * 1.5f - caption) / 2);
    small_text(context.fonts, "speed");
    ImGui::EndGroup();
    ImGui::SameLine();
    button(Icon::faster, Action::faster, can_step && context.clock.speed() < StepClock::max_speed);
    ImGui::NewLine();
}

} // namespace plumb

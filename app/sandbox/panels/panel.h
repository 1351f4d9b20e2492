// The data a panel is given, and parts several panels share. The panels themselves are in panels.h.
#pragma once

#include "app/sandbox/keys.h"
#include "app/sandbox/panels/panels.h"
#include "app/sandbox/panels/theme.h"
#include "app/sandbox/session/clock.h"
#include "app/sandbox/session/pace.h"
#include "app/sandbox/session/scene_catalog.h"
#include "app/sandbox/session/session.h"
#include "app/sandbox/studies/studies.h"
#include "app/sandbox/view_state.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace plumb {

struct PanelContext {
    Session &session;
    ViewState &view;
    const StepClock &clock;
    const Pace &pace;
    std::span<const SceneEntry> scenes;
    ChartStudy &chart;
    MapStudy &map;
    const Fonts &fonts;
    bool frozen = false; // leave out text and graphs that differ from run to run
    // How much higher the panel would be if nothing inside it scrolled, pixels.
    float scrolled_height = 0;
    // The user's requests.
    std::vector<Action> actions;
    std::optional<std::filesystem::path> open_scene;
    std::optional<double> speed;
    bool restart_as_written = false;
    bool save_plots = false;
    std::optional<RunChoice> run;
};

// A panel's title with a fold arrow, and some text at the right end. Returns whether the panel is
// open, and so shows more than its title.
[[nodiscard]] bool title_bar(PanelContext &context, PanelId panel, std::string_view title,
                             std::string_view at_right = {});
// The fold arrow alone; the caller continues on the same line.
[[nodiscard]] bool title_sign(PanelContext &context, PanelId panel);

// Parts of panels.
void inspector_panel(PanelContext &context);    // the selected body
void expectations_panel(PanelContext &context); // the scene's expectations, title and description
void probes_panel(PanelContext &context);
void probe_labels(const PanelContext &context); // drawn over the scene, under the panels
void measures_panel(PanelContext &context);     // the lower part of the diagnostics
// The lab's tabs.
void plots_tab(PanelContext &context);
void tradeoff_tab(PanelContext &context);
void map_tab(PanelContext &context);
void ghost_tab(PanelContext &context);

// Indices of the scenes whose path or title contains every word of `search`, ignoring case. Matches
// in the name alone come first, then matches in name and title.
[[nodiscard]] std::vector<std::size_t> matching(std::span<const SceneEntry> scenes,
                                                const std::string &search);

} // namespace plumb

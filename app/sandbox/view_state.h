// What is shown, and from where: everything but the world itself.
#pragma once

#include "app/render/camera.h"
#include "app/sandbox/panels/layout.h"
#include "engine/scene/probe.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace plumb {

// A point by which a probe can be dragged.
struct ProbeHandle {
    std::size_t probe = 0;
    std::size_t handle = 0;
    friend bool operator==(const ProbeHandle &, const ProbeHandle &) = default;
};

struct ViewState {
    Camera camera; // looks through the part the panels leave free
    // Aspect (width over height) of a picture that holds everything the scene shows at its start.
    float aspect = 1;
    // The camera follows what moves until the user moves it away; `followed` is how far it has
    // gone, m.
    bool follows = true;
    glm::vec3 followed{0};
    std::optional<std::size_t> selected;
    std::optional<std::size_t> hovered;
    // Either a body or a particle is selected, never both; the same goes for hovered.
    std::optional<std::size_t> selected_particle;
    std::optional<std::size_t> hovered_particle;
    std::optional<ProbeHandle> hovered_handle;
    std::optional<ProbePoint> pointed_at; // where the pointer's ray hits a picking probe's shapes
    bool contacts = false;
    bool joints = false;
    bool wireframe = false;
    bool bounds = false;
    bool velocities = false;
    bool panels = true;
    bool diagnostics = true;
    bool lab = false;
    bool help = false;
    // Open, or folded to the title; unset: folded until the window has had room for all.
    PerPanel<std::optional<bool>> opened;
    [[nodiscard]] bool is_open(PanelId panel) const { return opened[panel].value_or(false); }
    float ui_scale = 1;                       // times the monitor's scale
    std::optional<std::size_t> detailed_body; // that the details last showed, or
    std::optional<std::size_t> detailed_particle;
    std::string search;  // text in the scene list's search box
    std::string plot_of; // name whose quantities are offered; empty: the whole scene's
    std::optional<std::size_t> offered_body; // last body selected for that, or
    std::optional<std::size_t> offered_particle;
    std::string sweeps;                        // the chart's sweeps
    std::string sweep_mistake;                 // empty: none
    std::string map_x = "dt=1/240..1/15:7log"; // the map's axes
    std::string map_y = "substeps=1,2,4,8,16";
    std::string map_mistake;
    std::string ghost_method;             // last chosen
    std::optional<double> plot_seconds;   // the last seconds shown; unset: all
    bool focus_search = false;            // the search box takes the keyboard in the next frame
    std::filesystem::path scene_in_sight; // that the scene list last scrolled to
};

} // namespace plumb

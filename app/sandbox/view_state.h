// What is shown, and from where: all that is not the world itself.
#pragma once

#include "app/render/camera.h"
#include "app/sandbox/panels/layout.h"
#include "engine/scene/probe.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace plumb {

// One of the places by which a probe can be moved.
struct ProbeHandle {
    std::size_t probe = 0;
    std::size_t handle = 0;
    friend bool operator==(const ProbeHandle &, const ProbeHandle &) = default;
};

struct ViewState {
    Camera camera; // looks through what the panels leave free
    // Of a picture that holds all that the scene shows at its start, width over height.
    float aspect = 1;
    // While the person has not moved the camera away, it goes along with what moves; as far, m.
    bool follows = true;
    glm::vec3 followed{0};
    std::optional<std::size_t> selected;
    std::optional<std::size_t> hovered;
    // At most one of a body and a particle is selected, and likewise hovered.
    std::optional<std::size_t> selected_particle;
    std::optional<std::size_t> hovered_particle;
    std::optional<ProbeHandle> hovered_handle;
    std::optional<ProbePoint> pointed_at; // of a picking probe's shapes, by the pointer's ray
    bool contacts = false;
    bool joints = false;
    bool wireframe = false;
    bool bounds = false;
    bool velocities = false;
    bool panels = true;
    bool diagnostics = true;
    bool lab = false;
    bool help = false;
    PerPanel<std::optional<bool>> opened; // or closed to its title; as it likes until a person says
    bool is_roomy = true;                 // the window, in which a panel likes to be open
    [[nodiscard]] bool is_open(PanelId panel) const { return opened[panel].value_or(is_roomy); }
    float ui_scale = 1;                       // on top of the monitor's
    std::optional<std::size_t> detailed_body; // that the details were last about, or
    std::optional<std::size_t> detailed_particle;
    std::string search;                      // in the list of scenes
    std::string plot_of;                     // whose quantities are offered; empty: the scene's
    std::optional<std::size_t> offered_body; // that was last selected for that, or
    std::optional<std::size_t> offered_particle;
    std::string sweeps;                        // of the chart
    std::string sweep_mistake;                 // empty: none
    std::string map_x = "dt=1/240..1/15:7log"; // axes of the map
    std::string map_y = "substeps=1,2,4,8,16";
    std::string map_mistake;
    std::string ghost_method;             // that was last chosen
    std::optional<double> plot_seconds;   // shown, up to now; all without
    bool focus_search = false;            // the search box takes the keyboard in the next frame
    std::filesystem::path scene_in_sight; // to which the list of scenes was last scrolled
};

} // namespace plumb

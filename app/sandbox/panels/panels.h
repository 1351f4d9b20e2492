// The only list of panels. A panel is a row here and a function NAME_panel(PanelContext &) in its
// own file.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace plumb {

// Left: scenes, settings, view. Right: details of body or scene, diagnostics. The scene is in the
// middle, with the transport bar below it, the lab above that, messages at the top, and help over
// the scene; those have their own rules in lay_out.
enum class PanelSpot { left, right, by_itself };

// What must exist for the panel to show.
enum class PanelNeeds { nothing, scene, world, diagnostics, lab, messages, help };

// Name, spot, needs, and whether it is clicked: rows that are only read may be spaced closer than
// rows that are clicked. Panels on one side appear in this order from the top.
#define PLUMB_PANELS(PANEL)                                                                        \
    PANEL(scenes, left, nothing, true)                                                             \
    PANEL(settings, left, world, true)                                                             \
    PANEL(view, left, scene, true)                                                                 \
    PANEL(details, right, nothing, false)                                                          \
    PANEL(diagnostics, right, diagnostics, false)                                                  \
    PANEL(lab, by_itself, lab, true)                                                               \
    PANEL(transport, by_itself, world, true)                                                       \
    PANEL(messages, by_itself, messages, false)                                                    \
    PANEL(help, by_itself, help, false)

enum class PanelId : std::size_t {
#define PLUMB_PANEL_ID(name, spot, needs, is_clicked) name,
    PLUMB_PANELS(PLUMB_PANEL_ID)
#undef PLUMB_PANEL_ID
};

struct PanelContext;

struct PanelRow {
    PanelId id;
    const char *name;
    PanelSpot spot;
    PanelNeeds needs;
    bool is_clicked;
    void (*contents)(PanelContext &); // draws into the current ImGui window
};

#define PLUMB_PANEL_FUNCTION(name, spot, needs, is_clicked) void name##_panel(PanelContext &);
PLUMB_PANELS(PLUMB_PANEL_FUNCTION)
#undef PLUMB_PANEL_FUNCTION

inline constexpr std::array panel_rows{
#define PLUMB_PANEL_ROW(name, spot, needs, is_clicked)                                             \
    PanelRow{PanelId::name, #name, PanelSpot::spot, PanelNeeds::needs, is_clicked, name##_panel},
    PLUMB_PANELS(PLUMB_PANEL_ROW)
#undef PLUMB_PANEL_ROW
};
inline constexpr std::size_t panel_count = panel_rows.size();

// One value per panel, indexed by its id.
template <typename T> struct PerPanel : std::array<T, panel_count> {
    using std::array<T, panel_count>::operator[];
    T &operator[](PanelId panel) { return (*this)[static_cast<std::size_t>(panel)]; }
    const T &operator[](PanelId panel) const { return (*this)[static_cast<std::size_t>(panel)]; }
};

} // namespace plumb

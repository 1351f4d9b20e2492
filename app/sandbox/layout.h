// Where the panels stand: pure geometry, so that a test can see that nothing overlaps.
#pragma once

#include <glm/vec2.hpp>

namespace plumb {

struct Rect {
    glm::vec2 min{0};
    glm::vec2 size{0};
    [[nodiscard]] glm::vec2 max() const { return min + size; }
};

// Left: scenes, method, view. Right: details of body or scene, diagnostics. In the middle the
// scene, with the transport bar under it, messages above it, and help over it.
struct Layout {
    Rect scenes, settings, view;
    Rect details, diagnostics; // without diagnostics, details has the whole column
    Rect messages;             // its height is the most it may take
    Rect help;
    Rect transport;
};

struct LayoutWishes {
    bool diagnostics = true;
    float messages_height = 0; // what the messages take; 0: none
};

// Sizes in pixels; `scale` is 1 on an ordinary monitor. Below smallest_window the panels of a
// column get narrow, but still do not overlap.
inline constexpr glm::vec2 smallest_window{860, 600};
[[nodiscard]] Layout lay_out(glm::vec2 window, float scale, const LayoutWishes &wishes);

} // namespace plumb

// Where the panels stand: pure geometry, so that a test can see that nothing overlaps.
#pragma once

#include "app/sandbox/panels/panels.h"

#include <span>

#include <glm/vec2.hpp>

namespace plumb {

struct Rect {
    glm::vec2 min{0};
    glm::vec2 size{0};
    [[nodiscard]] glm::vec2 max() const { return min + size; }
};

// Pixels. `wished` is how high each panel's contents are, 0 where there is none; a panel that does
// not fit is lower, and scrolls. `scale` is 1 on an ordinary monitor. Nothing overlaps in windows
// of smallest_window and above, but for help and the lab in one that is not roomy: there help
// stands alone, and the lab with the transport bar.
inline constexpr glm::vec2 smallest_window{640, 400};
[[nodiscard]] PerPanel<Rect> lay_out(glm::vec2 window, float scale, const PerPanel<float> &wished);

// The scale of panels in a window where so large a one was asked for: above 1 no larger than leaves
// it as much room as smallest_window has at 1, in whole tenths, so that all of them are in reach.
[[nodiscard]] float scale_that_fits(float wished, glm::vec2 window);

// Whether all panels can be open and leave room for the scene. In other windows they are closed
// until somebody opens them.
[[nodiscard]] bool is_roomy(glm::vec2 window, float scale);

// The rectangle beside those given in which a picture of this aspect (width over height) is
// largest, and of those the largest rectangle; the whole window where hardly any is left.
[[nodiscard]] Rect free_part(glm::vec2 window, std::span<const Rect> taken, float aspect);

} // namespace plumb

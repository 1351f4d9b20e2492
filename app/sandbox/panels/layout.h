// Panel layout: pure geometry, so that a test can check that nothing overlaps.
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

// In pixels. `wished` is the height of each panel's contents, 0 for no panel; a panel that does not
// fit is made lower, and scrolls. The lab's height does not depend on its contents, so that its
// tabs stay in place. `scale` is 1 on an ordinary monitor. Nothing overlaps in windows of at least
// smallest_window, except help in a window that is not roomy: there it is shown alone.
inline constexpr glm::vec2 smallest_window{640, 400};
[[nodiscard]] PerPanel<Rect> lay_out(glm::vec2 window, float scale, const PerPanel<float> &wished);

// The panel scale for a window if `wished` was asked for. Above 1 it is limited, in whole tenths,
// so that the window has at least the room that smallest_window has at 1 and every panel stays
// reachable.
[[nodiscard]] float scale_that_fits(float wished, glm::vec2 window);

// Whether all panels can be open and leave room for the scene. In other windows they start closed.
[[nodiscard]] bool is_roomy(glm::vec2 window, float scale);

// The rectangle clear of `taken` in which a picture of this aspect (width over height) is largest;
// among equals, the largest rectangle. The whole window if hardly any room is left.
[[nodiscard]] Rect free_part(glm::vec2 window, std::span<const Rect> taken, float aspect);

} // namespace plumb

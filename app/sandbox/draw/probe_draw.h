// Probes and their answers as a draw list: shapes, rays, hit points, and handles to drag.
#pragma once

#include "app/render/draw_list.h"
#include "app/sandbox/draw/world_draw.h"
#include "app/sandbox/view_state.h"
#include "engine/scene/probe.h"

#include <optional>
#include <span>

#include <glm/vec2.hpp>

namespace plumb {

// Draws the probes' answers and handles, the hovered handle larger. `answers` has one entry per
// probe. `floor` adds the level grid y = 0 below them, unless everything lies in the xy plane.
void draw_probes(DrawList &list, std::span<const ProbeDesc> probes,
                 std::span<const ProbeAnswer> answers,
                 const std::optional<ProbeHandle> &hovered = {}, bool floor = false);

// One answer point, with its normal.
void draw_point(DrawList &list, const ProbePoint &point);

// The nearest handle drawn within `handle_reach` pixels of a pixel.
inline constexpr float handle_reach = 10;
[[nodiscard]] std::optional<ProbeHandle> handle_at(std::span<const ProbeDesc> probes,
                                                   const Camera &camera, const glm::vec2 &pixel,
                                                   const glm::vec2 &viewport);

// A sphere around everything the answers show.
[[nodiscard]] Around around(std::span<const ProbeAnswer> answers);

} // namespace plumb

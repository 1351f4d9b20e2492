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

// Adds what the probes are answered, and their handles, the hovered one larger. `answers` are those
// to the probes, one for each. With `floor`, the level grid y = 0 under them, unless all lies in
// the xy plane.
void draw_probes(DrawList &list, std::span<const ProbeDesc> probes,
                 std::span<const ProbeAnswer> answers,
                 const std::optional<ProbeHandle> &hovered = {}, bool floor = false);

// A point of an answer, with its normal.
void draw_point(DrawList &list, const ProbePoint &point);

// The handle that is drawn within `handle_reach` pixels of a pixel; the nearest to it.
inline constexpr float handle_reach = 10;
[[nodiscard]] std::optional<ProbeHandle> handle_at(std::span<const ProbeDesc> probes,
                                                   const Camera &camera, const glm::vec2 &pixel,
                                                   const glm::vec2 &viewport);

// A sphere around all that the answers show.
[[nodiscard]] Around around(std::span<const ProbeAnswer> answers);

} // namespace plumb

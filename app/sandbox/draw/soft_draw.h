// Draws particles, springs and cloth, and picks particles.
#pragma once

#include "app/render/draw_list.h"
#include "engine/scene/simulation.h"

#include <memory>
#include <optional>
#include <vector>

namespace plumb {

// All soft parts, as shown.
struct SoftView {
    const SoftParts &parts;
    const std::vector<BodyState> &bodies;
    const std::vector<ParticleState> &particles;
    const std::vector<std::uint8_t> &torn; // one flag per spring
};

// A cloth's triangles with a normal per corner: the area-weighted mean of the adjacent triangles'.
// Triangles with a torn side or a non-finite position are left out.
struct ClothSurface {
    std::shared_ptr<const Corners> corners, normals;
};
[[nodiscard]] ClothSurface cloth_surface(const ClothInfo &cloth, const SoftView &view);

// Draws particles as balls; springs as coils, or as wires if short compared with their particles;
// cloth as surfaces, with a ball for each particle that is pinned, selected or hovered.
void draw_soft_parts(DrawList &list, const SoftView &view,
                     const std::optional<std::size_t> &selected,
                     const std::optional<std::size_t> &hovered);

// The first particle a ray hits, either itself or as the nearest corner of the cloth triangle hit.
// Particles count as at least as large as `aperture` (rad) at their distance.
struct ParticlePick {
    std::size_t particle = 0;
    double t = 0;        // along the ray, whose direction has unit length
    glm::dvec3 point{0}; // the particle's position
};
[[nodiscard]] std::optional<ParticlePick> pick_particle(const SoftView &view,
                                                        const glm::dvec3 &origin,
                                                        const glm::dvec3 &direction,
                                                        double aperture);

} // namespace plumb

// Particles, springs and cloth as a draw list, and under the pointer.
#pragma once

#include "app/render/draw_list.h"
#include "engine/scene/simulation.h"

#include <memory>
#include <optional>
#include <vector>

namespace plumb {

// All that is soft, as it is shown.
struct SoftView {
    const SoftParts &parts;
    const std::vector<BodyState> &bodies;
    const std::vector<ParticleState> &particles;
    const std::vector<std::uint8_t> &torn; // of each spring
};

// A cloth's triangles with a normal for each corner: the mean of those around it, weighted by their
// areas. A triangle with a torn side is left out, and one without a finite place.
struct ClothSurface {
    std::shared_ptr<const Corners> corners, normals;
};
[[nodiscard]] ClothSurface cloth_surface(const ClothInfo &cloth, const SoftView &view);

// Particles as balls; springs as coils, and as wires where they are short beside their particles;
// cloth as surfaces, with a ball for each of its particles that is pinned, picked or pointed at.
void draw_soft_parts(DrawList &list, const SoftView &view,
                     const std::optional<std::size_t> &selected,
                     const std::optional<std::size_t> &hovered);

// The particle that a ray meets first, itself or by the cloth whose nearest corner it is. Particles
// are as large as they are or, farther away, as `aperture` (rad) sees them.
struct ParticlePick {
    std::size_t particle = 0;
    double t = 0;        // of the ray's direction, which is of unit length
    glm::dvec3 point{0}; // where the particle is
};
[[nodiscard]] std::optional<ParticlePick> pick_particle(const SoftView &view,
                                                        const glm::dvec3 &origin,
                                                        const glm::dvec3 &direction,
                                                        double aperture);

} // namespace plumb

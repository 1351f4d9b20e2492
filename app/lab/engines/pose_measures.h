// Measures computed from poses alone, in double, the same for every engine.
#pragma once

#include "app/lab/engines/engine.h"

#include <memory>
#include <span>
#include <vector>

namespace plumb {

[[nodiscard]] bool is_finite(std::span<const BodyState> states);

struct Depth {
    double deepest = 0; // m, over all contact points; 0 if nothing penetrates
    double mean = 0;    // m, over the penetrating points
};

// The scene must outlive this.
class PoseMeasures {
  public:
    explicit PoseMeasures(const EngineScene &scene);
    ~PoseMeasures();
    PoseMeasures(const PoseMeasures &) = delete;
    PoseMeasures &operator=(const PoseMeasures &) = delete;

    // Penetration by Plumb's own geometry, over all pairs that may collide. States must be finite.
    [[nodiscard]] Depth depth(std::span<const BodyState> states) const;
    // The largest distance between a joint's two anchors (m); 0 without joints.
    [[nodiscard]] double joint_drift(std::span<const BodyState> states) const;
    // Kinetic energy of all dynamic bodies (J) from two sets of poses `dt` apart: their actual
    // motion, whatever velocities the engine reports.
    [[nodiscard]] double kinetic_energy(std::span<const BodyState> before,
                                        std::span<const BodyState> after, double dt) const;
    // Distance of the initially highest dynamic body from its starting position (m).
    [[nodiscard]] double top_displacement(std::span<const BodyState> states) const;

  private:
    struct Colliders;
    const EngineScene &scene_;
    std::unique_ptr<Colliders> colliders_;
    std::size_t top_ = 0;
};

} // namespace plumb

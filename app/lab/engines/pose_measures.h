// What can be said of a run from its poses alone, the same for every engine, in double.
#pragma once

#include "app/lab/engines/engine.h"

#include <memory>
#include <span>
#include <vector>

namespace plumb {

[[nodiscard]] bool is_finite(std::span<const BodyState> states);

struct Depth {
    double deepest = 0; // m, over all points of contact; 0 when nothing penetrates
    double mean = 0;    // m, over those that penetrate
};

// The scene outlives it.
class PoseMeasures {
  public:
    explicit PoseMeasures(const EngineScene &scene);
    ~PoseMeasures();
    PoseMeasures(const PoseMeasures &) = delete;
    PoseMeasures &operator=(const PoseMeasures &) = delete;

    // By Plumb's own geometry, of all pairs that may collide. States are finite.
    [[nodiscard]] Depth depth(std::span<const BodyState> states) const;
    // The largest distance of a joint's two anchors (m); 0 without joints.
    [[nodiscard]] double joint_drift(std::span<const BodyState> states) const;
    // Of all dynamic bodies (J), from two poses that are `dt` apart: how they do move, whatever an
    // engine says of their velocities.
    [[nodiscard]] double kinetic_energy(std::span<const BodyState> before,
                                        std::span<const BodyState> after, double dt) const;
    // How far the body that was highest at the start is from where it was (m).
    [[nodiscard]] double top_displacement(std::span<const BodyState> states) const;

  private:
    struct Colliders;
    const EngineScene &scene_;
    std::unique_ptr<Colliders> colliders_;
    std::size_t top_ = 0;
};

} // namespace plumb

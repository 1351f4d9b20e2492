// Bodies that pass through static ones.
#pragma once

#include "engine/scene/simulation.h"

#include <memory>
#include <string>

namespace plumb {

// Follows the centres of mass of a running scene's dynamic bodies. One has passed through a static
// body when its centre went in on one side and came out facing another way, in one step or in many;
// through a plane, when its centre is below; through a mesh or a height field, when its centre
// crossed it, from the front where only that is solid. A body that is all sensors, or whose layers
// ignore each other, is let pass. Bodies that need not hold their centre (of several shapes, or
// with a given centre of mass) are not followed: a ring may go over a pole.
class PassageWatch {
  public:
    // At the start of the run.
    PassageWatch(const SceneDesc &scene, const Simulation &simulation);
    ~PassageWatch();
    PassageWatch(const PassageWatch &) = delete;
    PassageWatch &operator=(const PassageWatch &) = delete;

    // The simulation was restored to another state: whoever is in the middle of something is no
    // longer followed through it, and no passage has been.
    void begin_again(const Simulation &simulation);

    // After each step that ended in a finite state.
    void sample(const Simulation &simulation);

    // The first passage: "ball through wall"; empty when there was none.
    [[nodiscard]] const std::string &first() const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace plumb

// Detects bodies that pass through static ones.
#pragma once

#include "engine/scene/simulation.h"

#include <memory>
#include <string>

namespace plumb {

// Tracks the centres of mass of a running scene's dynamic bodies. A body has passed through a
// static body if its centre went in on one side and came out on an opposite one, in one step or
// many; through a plane, if its centre is below it; through a mesh or height field, if its centre
// crossed it, from the front if only that is solid. Sensors, and pairs whose layers ignore each
// other, may pass. Bodies that need not contain their centre (several shapes, or a given centre of
// mass) are not tracked: a ring may go over a pole.
class PassageWatch {
  public:
    // Create at the start of the run.
    PassageWatch(const SceneDesc &scene, const Simulation &simulation);
    ~PassageWatch();
    PassageWatch(const PassageWatch &) = delete;
    PassageWatch &operator=(const PassageWatch &) = delete;

    // The simulation was restored to another state: forgets bodies that are part way through an
    // obstacle, and any passage so far.
    void begin_again(const Simulation &simulation);

    // Call after each step that ended in a finite state.
    void sample(const Simulation &simulation);

    // The first passage: "ball through wall"; empty if there was none.
    [[nodiscard]] const std::string &first() const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace plumb

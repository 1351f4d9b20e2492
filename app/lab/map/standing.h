// Bodies that must stay where they are, by statics alone.
#pragma once

#include "engine/scene/simulation.h"

#include <cstddef>
#include <string>
#include <vector>

namespace plumb {

// Notices bodies that fall although nothing makes them: piles of bodies at rest, where every body
// rests on faces below it, with its centre of mass well within their outline and whatever it
// carries within it too. Then vertical forces alone keep all in balance, whatever the friction.
// Where this does not hold of all moving bodies, or anything else may push them (a joint, a spring,
// a body that moves), nothing is watched: whether they should fall is then no simple question.
class StandingWatch {
  public:
    // The simulation must be at its start; its method does not matter.
    StandingWatch(const SceneDesc &scene, const Simulation &simulation);

    [[nodiscard]] bool watches() const { return !standing_.empty(); }
    // The first body that is lower by more than half its smallest width than it was, compared with
    // what it stood on; empty if there is none.
    [[nodiscard]] std::string fallen(const Simulation &simulation) const;

  private:
    struct Standing {
        std::size_t body = 0;
        double width = 0;            // m
        std::vector<std::size_t> on; // bodies
    };
    std::vector<Standing> standing_;
    std::vector<double> heights_; // m, of all bodies at the start
};

} // namespace plumb

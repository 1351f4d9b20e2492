// Whether the run that is going on has failed, as a stability map would say.
#pragma once

#include "app/lab/map/failing.h"
#include "app/lab/map/passage.h"
#include "engine/scene/simulation.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace plumb {

struct Trouble {
    Failing failing = Failing::none;
    std::string text; // what, where and when, in a sentence
    std::uint64_t step = 0;
};

// Looks at each step for what can be seen at hardly any cost: a state that is not finite, energy
// that grew by more than tolerated_energy_gain, a body that passed through a static body; and
// now and then for contacts and joints beyond tolerated_depths that stay so.
class TroubleWatch {
  public:
    // Bodies are followed for passages only where so few pairs of one that moves and one that does
    // not are looked at each step.
    static constexpr std::size_t most_pairs = 4096;
    // After how many steps depths are looked at: that costs about as much as a part of a step. An
    // impact may be deep for once; what is no less deep two looks later stays so.
    static constexpr std::uint64_t steps_a_look = 16;
    static constexpr std::uint64_t lasting = 2 * steps_a_look;

    // At the start of the run.
    TroubleWatch(const SceneDesc &scene, const Simulation &simulation);

    // Before and after each step of that scene; `before`: the state before it; `held`: a person
    // pulls at a body, perhaps into another.
    void begin_step(const SceneDesc &scene, const Simulation &simulation);
    void sample(const Simulation &simulation, const Frame &before, bool held);
    // The step after the present state failed, saying so.
    void failed(const Simulation &simulation, const std::string &message);
    // The simulation was restored to an earlier state of this run.
    void go_back(const Simulation &simulation);
    // Energy that something other than the method has just brought in (J): a shot, a pull.
    void brought_in(const Simulation &simulation, double energy);

    // A state that is not finite, or else the first of the others; gone when the run is taken back
    // to before it.
    [[nodiscard]] const std::optional<Trouble> &trouble() const {
        return divergence_ ? divergence_ : trouble_;
    }

  private:
    void look_at_energy(const Simulation &simulation);
    void look_at_depths(const Simulation &simulation);
    [[nodiscard]] double allowed_energy() const;

    std::optional<Trouble> divergence_, trouble_;
    bool follows_energy_ = false, follows_passages_ = false;
    double start_energy_ = 0, energy_scale_ = 0; // J
    struct Brought {
        std::uint64_t step;
        double energy; // all since the start, J
    };
    std::vector<Brought> brought_;
    std::unique_ptr<PassageWatch> passages_;
    ToleratedDepths tolerated_;
    std::optional<std::uint64_t> deep_from_, adrift_from_; // steps at which that was seen first
};

} // namespace plumb

// Detects whether the current run has failed, by the criteria of a stability map.
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

// Checks each step for failures that are nearly free to detect (a non-finite state, energy growth
// beyond tolerated_energy_gain, a body that passed through a static body), and every few steps for
// contacts and joints that stay beyond tolerated_depths.
class TroubleWatch {
  public:
    // Passages are checked each step, and only if there are at most this many pairs of a moving and
    // a static body.
    static constexpr std::size_t most_pairs = 4096;
    // Steps between depth checks, each of which costs a fraction of a step. An impact may be deep
    // for a moment; a depth that is still there two checks later counts as lasting.
    static constexpr std::uint64_t steps_a_look = 16;
    static constexpr std::uint64_t lasting = 2 * steps_a_look;

    // Construct at the start of the run.
    TroubleWatch(const SceneDesc &scene, const Simulation &simulation);

    // Call before and after each step of that scene. `before`: the state before it. `held`: the
    // user is pulling a body, perhaps into another.
    void begin_step(const SceneDesc &scene, const Simulation &simulation);
    void sample(const Simulation &simulation, const Frame &before, bool held);
    // The step after the current state failed, with this message.
    void failed(const Simulation &simulation, const std::string &message);
    // The simulation was restored to an earlier state of this run.
    void go_back(const Simulation &simulation);
    // Energy (J) just added by something other than the method: a shot, a pull.
    void brought_in(const Simulation &simulation, double energy);

    // A non-finite state, else the first of the other failures; cleared when the run is taken back
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
        double energy; // total since the start, J
    };
    std::vector<Brought> brought_;
    std::unique_ptr<PassageWatch> passages_;
    ToleratedDepths tolerated_;
    std::optional<std::uint64_t> deep_from_, adrift_from_; // steps since which that has been so
};

} // namespace plumb

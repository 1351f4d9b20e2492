// Small problems with a known answer, run by each engine at its defaults, 60 Hz.
#pragma once

#include "app/lab/engines/pose_measures.h"
#include "tests/bench/engines.h"

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace plumb {

// Poses or velocities are no longer finite, the engine cannot run the scene, or the user
// interrupted.
struct Diverged : std::runtime_error {
    using std::runtime_error::runtime_error;
};
struct CannotRun : std::runtime_error {
    using std::runtime_error::runtime_error;
};
struct Interrupted : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// One scene run by one engine.
class Trial {
  public:
    // Throws CannotRun.
    Trial(const EngineKind &kind, SceneDesc desc);

    [[nodiscard]] const EngineScene &scene() const { return scene_; }
    [[nodiscard]] const PoseMeasures &measures() const { return measures_; }
    [[nodiscard]] double time() const { return static_cast<double>(steps_) * scene_.dt(); } // s
    [[nodiscard]] const std::vector<BodyState> &states() const { return states_; }
    [[nodiscard]] const BodyState &body(std::size_t index) const { return states_[index]; }
    // Energy of all dynamic bodies (J), from the velocities the engine reports.
    [[nodiscard]] double energy() const;
    [[nodiscard]] glm::dvec3 angular_momentum() const; // the same, about the origin

    // Runs for `seconds`, calling `each` after every step. Throws Diverged and Interrupted.
    void go(
        double seconds, const std::function<void()> &each = [] {});
    // Runs for `seconds`; returns the largest value of `measure` over the steps.
    [[nodiscard]] double worst(double seconds, const std::function<double()> &measure);

  private:
    EngineScene scene_;
    PoseMeasures measures_;
    std::unique_ptr<Engine> engine_;
    std::vector<BodyState> states_;
    std::size_t steps_ = 0;
};

struct Problem {
    std::string name;
    std::string what; // what is measured, against what
    std::string unit;
    double aim = 0; // at most
    std::function<double(const EngineKind &)> error;
};

[[nodiscard]] std::vector<Problem> motion_problems();  // free bodies and contacts
[[nodiscard]] std::vector<Problem> contact_problems(); // what bounces, rolls and rides on others
[[nodiscard]] std::vector<Problem> joint_problems();
[[nodiscard]] std::vector<Problem> standing_problems(); // stacks, pyramids, mass ratios
[[nodiscard]] std::vector<Problem> fast_problems();     // tunnelling and ghost collisions

[[nodiscard]] std::vector<Problem> all_problems(); // in the order of the table

} // namespace plumb

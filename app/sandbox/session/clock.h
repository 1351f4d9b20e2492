// When to step: real time in, whole steps out.
#pragma once

#include <cstdint>

namespace plumb {

// Turns the wall clock's nanoseconds into steps of a fixed length. Steps are counted from the total
// since the last change, never summed up in floating point, so they do not drift.
class StepClock {
  public:
    // More steps than this at once are dropped instead: the motion then falls behind the wall
    // clock, but a slow step cannot pile up ever more steps to catch up with.
    static constexpr int max_catch_up = 8;
    static constexpr double min_speed = 1.0 / 64;
    static constexpr double max_speed = 64;

    explicit StepClock(double dt); // s, > 0

    [[nodiscard]] double dt() const { return dt_; }
    void set_dt(double dt); // > 0
    // Simulated seconds to a real second; halved and doubled between the limits above.
    [[nodiscard]] double speed() const { return speed_; }
    void set_speed(double speed); // clamped
    [[nodiscard]] bool paused() const { return paused_; }
    void set_paused(bool paused);

    // Real time goes on. Returns how many steps are due, 0..cap(); the caller takes them all or
    // calls give_up. Negative durations count as none.
    [[nodiscard]] int advance(std::int64_t nanoseconds);
    // Forgets the fraction of a step as well: what could not be done in time stays undone.
    void give_up();
    // How many steps one call may return: max_catch_up at a speed of 1, more when faster.
    [[nodiscard]] int cap() const;

    // How far the present moment lies between the last step and the next, in [0, 1]: 1 when paused,
    // so that a paused world shows its very state.
    [[nodiscard]] double alpha() const;

  private:
    void rebase(); // counts from now on, keeping the fraction of a step

    double dt_;
    double speed_ = 1;
    bool paused_ = false;
    std::int64_t elapsed_ = 0; // ns of real time since the base
    std::int64_t done_ = 0;    // steps since the base
    double offset_ = 0;        // fraction of a step that had passed at the base
};

} // namespace plumb

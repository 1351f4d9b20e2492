// When to step: real time in, whole steps out.
#pragma once

#include <cstdint>

namespace plumb {

// Turns wall-clock nanoseconds into steps of a fixed length. Steps are counted from the total since
// the last change, never summed in floating point, so they do not drift.
class StepClock {
  public:
    // If more steps than this are due, the rest are dropped: the motion falls behind the wall
    // clock, but a slow step cannot trigger ever more catch-up steps.
    static constexpr int max_catch_up = 8;
    static constexpr double min_speed = 1.0 / 64;
    static constexpr double max_speed = 64;

    explicit StepClock(double dt); // s, > 0

    [[nodiscard]] double dt() const { return dt_; }
    void set_dt(double dt); // > 0
    // Simulated seconds per real second; clamped to the limits above.
    [[nodiscard]] double speed() const { return speed_; }
    void set_speed(double speed); // clamped
    [[nodiscard]] bool paused() const { return paused_; }
    void set_paused(bool paused);

    // Advances real time. Returns how many steps are due, 0..cap(); the caller takes them all or
    // calls give_up. Negative durations count as zero.
    [[nodiscard]] int advance(std::int64_t nanoseconds);
    // Drops the backlog, including the fraction of a step: what could not be done in time is
    // skipped.
    void give_up();
    // The most steps one call may return: max_catch_up at a speed of 1, more when faster.
    [[nodiscard]] int cap() const;

    // Where the current moment lies between the last step and the next, in [0, 1]; 1 when paused,
    // so that a paused world shows its exact state.
    [[nodiscard]] double alpha() const;

  private:
    void rebase(); // restarts the count, keeping the fraction of a step

    double dt_;
    double speed_ = 1;
    bool paused_ = false;
    std::int64_t elapsed_ = 0; // ns of real time since the base
    std::int64_t done_ = 0;    // steps since the base
    double offset_ = 0;        // fraction of a step already past at the base
};

} // namespace plumb

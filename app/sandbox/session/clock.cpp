#include "app/sandbox/session/clock.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>

namespace plumb {

StepClock::StepClock(double dt) : dt_(dt) {
    PLUMB_CHECK(dt > 0, "dt must be positive, got " << dt);
}

void StepClock::set_dt(double dt) {
    PLUMB_CHECK(dt > 0, "dt must be positive, got " << dt);
    if (dt == dt_)
        return;
    rebase();
    dt_ = dt;
}

void StepClock::set_speed(double speed) {
    const double clamped = std::clamp(speed, min_speed, max_speed);
    if (clamped == speed_)
        return;
    rebase();
    speed_ = clamped;
}

void StepClock::set_paused(bool paused) {
    if (paused == paused_)
        return;
    give_up(); // after resuming, the next step is a whole one away
    paused_ = paused;
}

int StepClock::cap() const {
    return static_cast<int>(std::ceil(max_catch_up * std::max(1.0, speed_)));
}

int StepClock::advance(std::int64_t nanoseconds) {
    if (paused_ || nanoseconds <= 0)
        return 0;
    elapsed_ += nanoseconds;
    const double position = offset_ + static_cast<double>(elapsed_) * 1e-9 * speed_ / dt_;
    const auto due = static_cast<std::int64_t>(std::floor(position)) - done_;
    if (due > cap()) {
        give_up();
        return cap();
    }
    done_ += due;
    return static_cast<int>(due);
}

void StepClock::give_up() {
    elapsed_ = 0;
    done_ = 0;
    offset_ = 0;
}

double StepClock::alpha() const {
    if (paused_)
        return 1;
    const double position = offset_ + static_cast<double>(elapsed_) * 1e-9 * speed_ / dt_;
    return std::clamp(position - static_cast<double>(done_), 0.0, 1.0);
}

void StepClock::rebase() {
    const double fraction =
        offset_ + static_cast<double>(elapsed_) * 1e-9 * speed_ / dt_ - static_cast<double>(done_);
    give_up();
    offset_ = std::clamp(fraction, 0.0, 1.0);
}

} // namespace plumb

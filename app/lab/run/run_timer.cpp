#include "app/lab/run/run_timer.h"

#include "app/lab/clocks.h"
#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb {

namespace {

// A timing lasts at least this long, so that the clock's own cost (below a microsecond) is lost in
// it; a shorter segment is timed several times over.
constexpr double shortest_timing = 0.01; // s
constexpr int most_rounds = 1000;        // in one timing

constexpr int most_parts = 8;

} // namespace

TimedParts timed_parts(double end, double timed) {
    if (!(timed < end))
        return {.starts = {0}, .each = end};
    TimedParts parts{.starts = {}, .each = timed / most_parts};
    for (int i = 0; i < most_parts; ++i)
        parts.starts.push_back((i + 0.5) * end / most_parts - 0.5 * parts.each);
    return parts;
}

RunTimer::RunTimer(std::unique_ptr<Simulation> simulation, Saves starts, double each, double cost,
                   bool wall_clock)
    : simulation_(std::move(simulation)), starts_(std::move(starts)), wall_clock_(wall_clock) {
    const double dt = simulation_->settings().dt;
    steps_ = std::max(1, static_cast<int>(std::lround(each / dt)));
    const double segment = cost * steps_ * dt * static_cast<double>(starts_.size());
    constexpr double patience = 0.05; // s
    asking_ = static_cast<int>(std::clamp(patience / std::max(cost * dt, 1e-9), 1.0, 1e6));
    rounds_ = segment > 0 ? static_cast<int>(std::clamp(std::ceil(shortest_timing / segment), 1.0,
                                                        static_cast<double>(most_rounds)))
                          : most_rounds;
}

std::optional<double> RunTimer::time(const std::function<bool()> &stop) const {
    const auto go = [&](int steps) {
        for (int i = 0; i < steps; ++i) {
            if (i % asking_ == 0 && stop && stop())
                return false;
            simulation_->step();
        }
        return true;
    };
    const auto now = [&] { return wall_clock_ ? wall_time() : thread_cpu_time(); };
    double used = 0;
    try {
        simulation_->restore(*starts_.front());
        // Brings code and data back into the caches after the other simulations' turn.
        if (!go(std::max(1, steps_ / 10)))
            return std::nullopt;
        for (int round = 0; round < rounds_; ++round)
            for (const std::unique_ptr<Simulation::Saved> &start : starts_) {
                simulation_->restore(*start);
                const double before = now();
                if (!go(steps_))
                    return std::nullopt;
                used += now() - before;
            }
    } catch (const CheckFailure &) {
        return std::nullopt;
    }
    return used /
           (rounds_ * steps_ * static_cast<double>(starts_.size()) * simulation_->settings().dt);
}

} // namespace plumb

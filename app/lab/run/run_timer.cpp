#include "app/lab/run/end_timer.h"

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

} // namespace

EndTimer::EndTimer(std::unique_ptr<Simulation> simulation, std::unique_ptr<Simulation::Saved> saved,
                   double timed, double cost, bool wall_clock)
    : simulation_(std::move(simulation)), saved_(std::move(saved)), wall_clock_(wall_clock) {
    const double dt = simulation_->settings().dt;
    steps_ = std::max(1, static_cast<int>(std::lround(timed / dt)));
    const double segment = cost * steps_ * dt;
    constexpr double patience = 0.05; // s
    asking_ = static_cast<int>(std::clamp(patience / std::max(cost * dt, 1e-9), 1.0, 1e6));
    rounds_ = segment > 0 ? static_cast<int>(std::clamp(std::ceil(shortest_timing / segment), 1.0,
                                                        static_cast<double>(most_rounds)))
                          : most_rounds;
}

std::optional<double> EndTimer::time(const std::function<bool()> &stop) const {
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
        simulation_->restore(*saved_);
        // Brings code and data back into the caches after the other simulations' turn.
        if (!go(std::max(1, steps_ / 10)))
            return std::nullopt;
        for (int round = 0; round < rounds_; ++round) {
            simulation_->restore(*saved_);
            const double before = now();
            if (!go(steps_))
                return std::nullopt;
            used += now() - before;
        }
    } catch (const CheckFailure &) {
        return std::nullopt;
    }
    return used / (rounds_ * steps_ * simulation_->settings().dt);
}

} // namespace plumb

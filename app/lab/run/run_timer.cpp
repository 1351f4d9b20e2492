#include "app/lab/run/run_timer.h"

#include "app/lab/clocks.h"
#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb {

namespace {

// The least duration of a timing, to make the clock's own cost (below a microsecond) negligible;
// shorter segments are repeated.
constexpr double shortest_timing = 0.01; // s
constexpr int most_rounds = 1000;        // in one timing

constexpr int noted = 32;            // states per run
constexpr double whole_parts = 8;    // equally long if the cost is steady
constexpr double unlike = 1.0 / 100; // of the run's time: how far a part's stretches may differ

} // namespace

RunRecord::RunRecord(double end, double timed) : each_(timed / whole_parts) {
    const int count = timed < end ? noted : 1;
    for (int i = 0; i < count; ++i)
        times_.push_back(end * i / count);
}

void RunRecord::note(const Simulation &simulation, double used) {
    const Simulation::Saved *before = notes_.empty() ? nullptr : notes_.back().state.get();
    if (before == nullptr || notes_.back().step < simulation.step_count())
        notes_.push_back({simulation.save(nullptr, before), simulation.step_count(), used});
}

std::vector<TimedPart> RunRecord::take_parts(const Simulation &simulation, double used) {
    notes_.push_back({nullptr, simulation.step_count(), used}); // end of the last stretch
    const auto steps_of = [&](std::size_t from, std::size_t to) {
        return static_cast<double>(notes_[to].step - notes_[from].step);
    };
    const auto took = [&](std::size_t from, std::size_t to) {
        return notes_[to].used - notes_[from].used;
    };
    const std::size_t last = notes_.size() - 1;
    const double all = std::max(took(0, last), 1e-300);
    const auto usual =
        static_cast<std::uint64_t>(std::max(1L, std::lround(each_ / simulation.settings().dt)));
    std::vector<TimedPart> parts;
    for (std::size_t from = 0, to = 0; from < last; from = to) {
        // Joins stretches of similar cost, up to a part's share of the time.
        for (to = from + 1; to < last && took(from, to + 1) <= 1.2 * all / whole_parts; ++to)
            if (std::abs(took(to, to + 1) - took(from, to) / static_cast<double>(to - from)) >
                unlike * all)
                break;
        const bool is_one = to - from == 1;
        const auto steps_from = [&](std::size_t note) {
            const std::uint64_t left = notes_[to].step - notes_[note].step;
            return is_one ? left : std::min(left, usual);
        };
        // Starts at the note that centres the part in them best.
        std::size_t start = from;
        const auto off_middle = [&](std::size_t note) {
            return std::abs(2 * steps_of(from, note) + static_cast<double>(steps_from(note)) -
                            steps_of(from, to));
        };
        for (std::size_t note = from; note < to; ++note)
            start = off_middle(note) < off_middle(start) ? note : start;
        if (steps_from(start) > 0)
            parts.push_back({std::move(notes_[start].state), steps_from(start),
                             steps_of(from, to) / steps_of(0, last)});
    }
    notes_.clear();
    return parts;
}

RunTimer::RunTimer(std::unique_ptr<Simulation> simulation, std::vector<TimedPart> parts,
                   double cost, bool wall_clock)
    : simulation_(std::move(simulation)), parts_(std::move(parts)), wall_clock_(wall_clock) {
    const double dt = simulation_->settings().dt;
    std::uint64_t steps = 0;
    for (const TimedPart &part : parts_)
        steps += part.steps;
    const double segment = cost * dt * static_cast<double>(steps);
    constexpr double patience = 0.05; // s
    asking_ =
        static_cast<std::uint64_t>(std::clamp(patience / std::max(cost * dt, 1e-9), 1.0, 1e6));
    rounds_ = segment > 0 ? static_cast<int>(std::clamp(std::ceil(shortest_timing / segment), 1.0,
                                                        static_cast<double>(most_rounds)))
                          : most_rounds;
}

std::optional<double> RunTimer::time(const std::function<bool()> &stop) const {
    const auto go = [&](std::uint64_t steps) {
        for (std::uint64_t i = 0; i < steps; ++i) {
            if (i % asking_ == 0 && stop && stop())
                return false;
            simulation_->step();
        }
        return true;
    };
    const auto now = [&] { return wall_clock_ ? wall_time() : thread_cpu_time(); };
    double a_step = 0; // s, averaged over the run
    try {
        simulation_->restore(*parts_.front().start);
        // Brings code and data back into the caches after the other simulations' turn.
        if (!go(std::max<std::uint64_t>(1, parts_.front().steps / 10)))
            return std::nullopt;
        for (int round = 0; round < rounds_; ++round)
            for (const TimedPart &part : parts_) {
                simulation_->restore(*part.start);
                const double before = now();
                if (!go(part.steps))
                    return std::nullopt;
                a_step += part.share * (now() - before) / static_cast<double>(part.steps);
            }
    } catch (const CheckFailure &) {
        return std::nullopt;
    }
    return a_step / (rounds_ * simulation_->settings().dt);
}

} // namespace plumb

// Holds a running simulation to what its scene expects, step by step.
#pragma once

#include "app/lab/run/expectation.h"
#include "app/lab/run/quantity_probe.h"
#include "engine/scene/expect.h"
#include "engine/scene/simulation.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace plumb {

class ExpectationWatch {
  public:
    // Begins at the simulation's present state, which counts as the start of the run: displacement
    // and the like are measured from it. Throws std::invalid_argument for a quantity or body that
    // there is not. `also`: further quantities to be read, see also_now().
    ExpectationWatch(const Simulation &simulation, std::vector<ExpectDesc> expects,
                     const std::vector<QuantityName> &also = {});

    // After each step that ended in a finite state. Nothing is kept from beyond the last window.
    void sample(const Simulation &simulation);
    // The simulation was restored to an earlier state of this run: forgets what came after it.
    void go_back(const Simulation &simulation);

    [[nodiscard]] std::size_t size() const { return expects_.size(); }
    // Judged once its window has ended, or before that if it can no longer be met. Where a window's
    // edge falls between two steps, the quantity there is interpolated linearly; a curve is
    // compared at the steps within the window.
    [[nodiscard]] ExpectOutcome outcome(std::size_t expectation) const {
        return outcome(expectation, times_.size());
    }
    // When one that is missed came to be so (s): at the end of its window, or when it could no
    // longer be met. Nothing of others.
    [[nodiscard]] std::optional<double> missed_since(std::size_t expectation) const;

    // At each sample: its time (s), and the quantity of that expectation.
    [[nodiscard]] std::span<const double> times() const { return times_; }
    [[nodiscard]] std::span<const double> course(std::size_t expectation) const {
        return courses_[expects_.at(expectation).course];
    }

    // The values of `also` at the last sample, in that order.
    [[nodiscard]] std::span<const double> also_now() const { return also_now_; }

  private:
    struct Followed {
        ExpectDesc desc;
        const QuantityInfo *quantity;
        const ReductionInfo *reduction;
        std::size_t course; // several expectations may share a quantity: it is read once
    };
    [[nodiscard]] bool unseen(const Followed &expect) const;
    // Of the first so many samples, at least one.
    [[nodiscard]] double measured(const Followed &expect, std::size_t samples) const;
    [[nodiscard]] ExpectOutcome outcome(std::size_t expectation, std::size_t samples) const;

    std::vector<Followed> expects_;
    QuantityProbe probe_;
    std::uint64_t first_step_ = 0;
    double end_ = 0;   // s, of the last window
    double slack_ = 0; // s: how near a sample must lie to a window's edge to count as on it
    std::vector<double> times_;
    std::vector<std::vector<double>> courses_; // of each quantity, as many values as times
    std::vector<double> also_now_;
};

} // namespace plumb

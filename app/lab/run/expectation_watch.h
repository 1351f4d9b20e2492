// Checks a running simulation against its scene's expectations, step by step.
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
    // The simulation's current state counts as the start of the run: displacement and the like are
    // measured from it. Throws std::invalid_argument for an unknown quantity or body. `also`:
    // further quantities to read, see also_now().
    ExpectationWatch(const Simulation &simulation, std::vector<ExpectDesc> expects,
                     const std::vector<QuantityName> &also = {});

    // Call after each step that ended in a finite state. Samples beyond the last window are not
    // kept.
    void sample(const Simulation &simulation);
    // The simulation was restored to an earlier state of this run: drops the samples after it.
    void go_back(const Simulation &simulation);

    [[nodiscard]] std::size_t size() const { return expects_.size(); }
    // Judged once its window has ended, or earlier if it can no longer be met. If a window's edge
    // falls between two steps, the quantity is interpolated linearly there; a curve is compared at
    // the steps within the window.
    [[nodiscard]] ExpectOutcome outcome(std::size_t expectation) const {
        return outcome(expectation, times_.size());
    }
    // When a missed expectation became so (s): at the end of its window, or when it could no longer
    // be met. nullopt if not missed.
    [[nodiscard]] std::optional<double> missed_since(std::size_t expectation) const;

    // At each sample: its time (s) and the expectation's quantity.
    [[nodiscard]] std::span<const double> times() const { return times_; }
    [[nodiscard]] std::span<const double> course(std::size_t expectation) const {
        return courses_[expects_.at(expectation).course];
    }

    // The values of `also` at the last sample, in the same order.
    [[nodiscard]] std::span<const double> also_now() const { return also_now_; }

  private:
    struct Followed {
        ExpectDesc desc;
        const QuantityInfo *quantity;
        const ReductionInfo *reduction;
        std::size_t course; // several expectations may share a quantity: it is read once
    };
    [[nodiscard]] bool unseen(const Followed &expect) const;
    // Over the first `samples` samples, at least one.
    [[nodiscard]] double measured(const Followed &expect, std::size_t samples) const;
    [[nodiscard]] ExpectOutcome outcome(std::size_t expectation, std::size_t samples) const;

    std::vector<Followed> expects_;
    QuantityProbe probe_;
    std::uint64_t first_step_ = 0;
    double end_ = 0;   // s, of the last window
    double slack_ = 0; // s: how near a sample must lie to a window's edge to count as on it
    std::vector<double> times_;
    std::vector<std::vector<double>> courses_; // one per quantity, each as long as times_
    std::vector<double> also_now_;
};

} // namespace plumb

// Quantities of the running scene over time, for the plots, read as the lab reads them.
#pragma once

#include "app/lab/run/quantity_probe.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

namespace plumb {

struct PlotSample {
    std::uint64_t step = 0;
    double time = 0; // s
    double value = 0;
};

struct PlotCurve {
    QuantityName name;
    const QuantityInfo *quantity = nullptr;
    std::deque<PlotSample> samples; // one per step, from when it was chosen or the run began
};

// The chosen quantities, sampled step by step.
class Plots {
  public:
    // Per curve; the oldest samples are dropped first. An hour at 60 steps a second.
    static constexpr std::size_t most_samples = 216'000;

    // A run begins, of the same scene or another: curves start over, and those of quantities that
    // no longer exist are dropped.
    void start(const Simulation &simulation);
    // Call after each step that ended in a finite state.
    void sample(const Simulation &simulation);
    // The simulation was restored to an earlier state of this run.
    void go_back(const Simulation &simulation);

    // Does nothing if the curve exists. Throws std::invalid_argument for an unknown quantity or
    // body.
    void add(const Simulation &simulation, const QuantityName &name);
    void remove(const Simulation &simulation, std::size_t curve);

    [[nodiscard]] std::span<const PlotCurve> curves() const { return curves_; }

    // The first that any curve has.
    [[nodiscard]] std::optional<std::uint64_t> first_step() const;
    // One row per step that any curve has, one column per curve; empty where a curve has no sample.
    void write_csv(std::ostream &out) const;

  private:
    void probe_anew(const Simulation &simulation);

    RunStart start_;
    std::vector<PlotCurve> curves_;
    std::optional<QuantityProbe> probe_; // reads all curves
};

// The quantities of the body, particle, spring or joint of this name; without a name, those of the
// whole scene.
[[nodiscard]] std::vector<const QuantityInfo *> quantities_of(const Simulation &simulation,
                                                              const std::string &name);

// All names quantities_of knows: bodies, then particles, springs and joints.
[[nodiscard]] std::vector<std::string> plot_subjects(const Simulation &simulation);

// "energy", "position.y of ball"
[[nodiscard]] std::string title_of(const QuantityName &name);

} // namespace plumb

// Quantities of the running scene over time, for the plots: as the lab reads them.
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
    std::deque<PlotSample> samples; // one a step, from when it was chosen or the run began
};

// The chosen quantities, sampled step by step.
class Plots {
  public:
    // Of a curve; its oldest samples are forgotten first. An hour at 60 steps a second.
    static constexpr std::size_t most_samples = 216'000;

    // A run begins, of the same scene or of another: curves begin anew, and those of what there is
    // not are gone.
    void start(const Simulation &simulation);
    // After each step that ended in a finite state.
    void sample(const Simulation &simulation);
    // The simulation was restored to an earlier state of this run.
    void go_back(const Simulation &simulation);

    // What is there already stays as it is. Throws std::invalid_argument for a quantity or body
    // that there is not.
    void add(const Simulation &simulation, const QuantityName &name);
    void remove(const Simulation &simulation, std::size_t curve);

    [[nodiscard]] std::span<const PlotCurve> curves() const { return curves_; }

    // A row for each step that any curve has, a column for each curve, empty where it has none.
    void write_csv(std::ostream &out) const;

  private:
    void probe_anew(const Simulation &simulation);

    RunStart start_;
    std::vector<PlotCurve> curves_;
    std::optional<QuantityProbe> probe_; // of all curves
};

// The quantities that something of this name has: a body, a particle, a spring; without a name,
// those of the whole scene.
[[nodiscard]] std::vector<const QuantityInfo *> quantities_of(const Simulation &simulation,
                                                              const std::string &name);

// All names that quantities_of knows, in the order of bodies, particles and springs.
[[nodiscard]] std::vector<std::string> plot_subjects(const Simulation &simulation);

// "energy", "position.y of ball"
[[nodiscard]] std::string title_of(const QuantityName &name);

} // namespace plumb

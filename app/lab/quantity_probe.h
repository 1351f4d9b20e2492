// Reads a scene's quantities (engine/scene/expect.h) from a running simulation.
#pragma once

#include "engine/scene/expect.h"
#include "engine/scene/simulation.h"

#include <cstddef>
#include <string>
#include <vector>

namespace plumb {

// One quantity, of one body where it needs one.
struct QuantityName {
    std::string quantity;
    std::string body;
    friend bool operator==(const QuantityName &, const QuantityName &) = default;
};

class QuantityProbe {
  public:
    // Made at t = 0: displacement, tilt and the relative errors count from then. Throws
    // std::invalid_argument for a quantity or body that there is not.
    QuantityProbe(const Simulation &simulation, const std::vector<QuantityName> &names);

    // One value a name, in the same order. Calls measure() once, and only when a quantity needs it.
    [[nodiscard]] std::vector<double> sample(const Simulation &simulation);

    // Whether sample() calls measure().
    [[nodiscard]] bool measures() const { return measures_; }

  private:
    struct Item {
        const QuantityInfo *quantity;
        std::size_t body = 0;
        BodyState start;
    };
    std::vector<Item> items_;
    bool measures_ = false;
    bool bodies_ = false; // whether sample() reads them
    Frame frame_;
    SceneStart start_;
};

} // namespace plumb

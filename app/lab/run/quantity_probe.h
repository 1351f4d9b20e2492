// Reads a scene's quantities (engine/scene/expect.h) from a running simulation.
#pragma once

#include "engine/scene/expect.h"
#include "engine/scene/simulation.h"

#include <cstddef>
#include <string>
#include <vector>

namespace plumb {

// A quantity, and the body, particle, spring or joint it belongs to, if it needs one.
struct QuantityName {
    std::string quantity;
    std::string body;
    friend bool operator==(const QuantityName &, const QuantityName &) = default;
};

// A run's start: the reference for displacement, tilt and the relative errors.
struct RunStart {
    Frame frame; // bodies and particles
    SceneStart scene;
};
[[nodiscard]] RunStart run_start(const Simulation &simulation);

class QuantityProbe {
  public:
    // The run starts now. Throws std::invalid_argument for an unknown quantity or body.
    QuantityProbe(const Simulation &simulation, const std::vector<QuantityName> &names);
    // The run started earlier. Anything added since then counts from now.
    QuantityProbe(const Simulation &simulation, const std::vector<QuantityName> &names,
                  const RunStart &start);

    // One value per name, in the same order. Calls measure() once, and only if a quantity needs it.
    [[nodiscard]] std::vector<double> sample(const Simulation &simulation);

    // Whether sample() calls measure().
    [[nodiscard]] bool measures() const { return measures_; }

  private:
    struct Item {
        const QuantityInfo *quantity;
        enum class Of { scene, body, particle, spring, joint } of = Of::scene;
        std::size_t index = 0; // of that body, particle, spring or joint
        BodyState start;       // of the body, or of the particle treated as one
        BodyInertia mass;      // the same
    };
    Item item_of(const Simulation &simulation, const QuantityInfo &quantity,
                 const std::string &name, const RunStart *start) const;
    bool add(const Simulation &simulation, const std::vector<QuantityName> &names,
             const RunStart *start);
    double value_of(const Item &item, const Simulation &simulation, const Measures &now) const;

    std::vector<Item> items_;
    bool measures_ = false;
    bool reads_ = false; // whether sample() needs a frame
    FrameParts parts_;   // of the frame
    Frame frame_;
    SceneStart start_;
};

} // namespace plumb

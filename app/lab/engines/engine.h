// Adapter for another engine that runs our scenes, judged by the same measures from its poses and
// velocities.
//
// To add one (an afternoon): a file here that derives from Engine (follow engine_bullet.cpp), a
// declaration of its factory below, a line in other_engines.cpp, and its library in
// app/CMakeLists.txt. It reports its state and the work of a step; its own error figures are
// ignored.
#pragma once

#include "engine/scene/simulation.h"

#include <cstddef>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace plumb {

struct BodyMass {
    double mass = 0;       // kg; 0 if not dynamic
    glm::dvec3 inertia{0}; // kg m^2, about the body's own axes, through its centre
};

// A scene and the values that every engine must be given alike. Each body's frame is at its centre
// of mass, along its principal axes; joints are balls or hinges. A pair's friction is the geometric
// mean, its restitution the larger, as in the scene file.
struct EngineScene {
    SceneDesc desc;
    std::vector<BodyMass> masses; // one per body

    // With `options`; each step is split into `substeps` engine steps, solved with `iterations` (0:
    // the engine's default).
    explicit EngineScene(SceneDesc scene, const RunOptions &options = {}, int substeps = 1,
                         int iterations = 0);
    [[nodiscard]] double dt() const { return dt_; } // s, of the engine's step
    [[nodiscard]] int iterations() const { return iterations_; }
    [[nodiscard]] const glm::dvec3 &gravity() const { return gravity_; } // m/s^2
    [[nodiscard]] const MaterialDesc &material(const BodyDesc &body) const;
    [[nodiscard]] std::size_t body(const std::string &name) const; // its index

  private:
    std::map<std::string, std::size_t> indices_; // of bodies, by name
    double dt_ = 0;
    int iterations_ = 0;
    glm::dvec3 gravity_{0};
};

// A feature of the scene that the adapters do not support: "particles", "a joint with a motor";
// empty if there is none.
[[nodiscard]] std::string beyond_engines(const SceneDesc &scene);

// Work of the last step.
struct StepWork {
    double collide = 0;       // share of the step's time spent finding pairs and contacts
    std::size_t contacts = 0; // body pairs that touch, or nearly
    // Contacts and joints solved, counted once per solve.
    std::size_t passes = 0;
};

class Engine {
  public:
    Engine() = default;
    virtual ~Engine() = default;
    Engine(const Engine &) = delete;
    Engine &operator=(const Engine &) = delete;

    virtual void step() = 0; // by the scene's dt
    // Called outside the timed section.
    [[nodiscard]] virtual StepWork work() const = 0;
    // In the order of the scene's bodies. Velocities of bodies that are not dynamic may be
    // anything.
    [[nodiscard]] virtual std::vector<BodyState> states() const = 0;
    // Sets the state of each dynamic body, in the scene's order; keeps the engine's memory of the
    // last step. Only single-step charts call it; throws std::invalid_argument if unsupported.
    virtual void put(const std::vector<BodyState> &) {
        throw std::invalid_argument("the engine cannot be set to a given state");
    }
};

// Bullet and ODE; null if the scene has features the adapters do not support. The scene must
// outlive the engine.
[[nodiscard]] std::unique_ptr<Engine> bullet_engine(const EngineScene &scene);
[[nodiscard]] std::unique_ptr<Engine> ode_engine(const EngineScene &scene);

} // namespace plumb

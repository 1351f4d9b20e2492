// Another engine that runs our scenes, judged by the same measures: from its poses and velocities.
//
// To add one (an afternoon): a file here that derives Engine (engine_bullet.cpp is the pattern), a
// declaration of its function below, a line in other_engines.cpp, and its library in
// app/CMakeLists.txt. What it is asked for is its state, and what it did in a step; nothing that it
// says of its own errors counts.
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
    double mass = 0;       // kg; 0 for what is not dynamic
    glm::dvec3 inertia{0}; // kg m^2, about the body's own axes, through its centre
};

// A scene with what every engine must be told alike. The body's frame lies at its centre of mass,
// along its principal axes; joints are balls or hinges. Friction of a pair is the geometric mean,
// restitution the larger, as in the scene's file.
struct EngineScene {
    SceneDesc desc;
    std::vector<BodyMass> masses; // as many as bodies

    // As the options have it; each of its steps in so many for the engine, which solves with so
    // many iterations (0: its own default).
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

// What adaptors are not told of and a scene has: "particles", "a joint with a motor"; empty when
// there is none.
[[nodiscard]] std::string beyond_engines(const SceneDesc &scene);

// Of the last step.
struct StepWork {
    double collide = 0;       // share of the step's time that went into finding pairs and contacts
    std::size_t contacts = 0; // pairs of bodies that touch, or nearly
    // Contacts and joints that were solved, each as often as it was.
    std::size_t passes = 0;
};

class Engine {
  public:
    Engine() = default;
    virtual ~Engine() = default;
    Engine(const Engine &) = delete;
    Engine &operator=(const Engine &) = delete;

    virtual void step() = 0; // by the scene's dt
    // Counted outside of what is timed.
    [[nodiscard]] virtual StepWork work() const = 0;
    // In the order of the scene's bodies. Velocities of bodies that are not dynamic may be
    // anything.
    [[nodiscard]] virtual std::vector<BodyState> states() const = 0;
    // Puts each dynamic body so, in the scene's order; what it remembers of the step before stays.
    // Only charts of single steps ask for it; throws std::invalid_argument where it cannot.
    virtual void put(const std::vector<BodyState> &) {
        throw std::invalid_argument("an engine that cannot be put anywhere");
    }
};

// Bullet and ODE; null where the scene has what they are not given. The scene outlives the engine.
[[nodiscard]] std::unique_ptr<Engine> bullet_engine(const EngineScene &scene);
[[nodiscard]] std::unique_ptr<Engine> ode_engine(const EngineScene &scene);

} // namespace plumb

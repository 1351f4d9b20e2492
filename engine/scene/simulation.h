// A running scene, in whichever precision it asks for: what the app and the lab work with.
//
// All values cross this boundary in double. Bodies are identified by an index below body_count(),
// stable for the body's lifetime.
#pragma once

#include "engine/core/task_pool.h"
#include "engine/dynamics/measures.h"
#include "engine/dynamics/method_info.h"
#include "engine/dynamics/settings.h"
#include "engine/dynamics/step_report.h"
#include "engine/scene/command.h"
#include "engine/scene/frame.h"
#include "engine/scene/scene_desc.h"
#include "engine/scene/soft_parts.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// Properties that are fixed for a body's lifetime.
struct BodyInfo {
    bool alive = false; // a removed body leaves a hole
    std::string name;
    BodyKind kind = BodyKind::dynamic;
    std::vector<ColliderDesc> colliders;
    double mass = 0;             // kg; 0 for static and kinematic
    glm::dvec3 inertia{0};       // kg m^2, principal
    glm::dquat axes{1, 0, 0, 0}; // the principal axes, in the body's frame
    glm::dvec3 force{0};         // N, constant, world
    glm::dvec3 torque{0};        // N m, constant, world
    std::string material;
    std::optional<glm::vec3> colour; // body's or material's
};

struct Pick {
    std::size_t body = 0;
    double t = 0;
    glm::dvec3 point{0};
    glm::dvec3 normal{0};
};

// How to run a scene, where that differs from the file.
struct RunOptions {
    std::string method; // empty: the scene's own
    GivenSettings settings;
    std::optional<Precision> precision;
};

// The method and settings that a scene runs with under these options. A method other than the
// scene's own uses the scene's settings for that method, else the method's defaults. Throws
// std::invalid_argument when the method is unknown or a number is out of range.
struct ResolvedRun {
    const MethodInfo *method = nullptr;
    StepSettings settings;
    Precision precision = Precision::f32;
};
ResolvedRun resolve_run(const SceneDesc &scene, const RunOptions &options);

// The complete settings that the scene specifies for a method.
StepSettings settings_of(const WorldDesc &world, const MethodInfo &method);

// Sets the world's method and settings; the previous method moves to other_methods.
void set_run(WorldDesc &world, const MethodInfo &method, const StepSettings &settings);

// Empty when the method can run the scene, else why not ("rk4 does not support contacts, and ...").
std::string why_not(const MethodInfo &method, const SceneDesc &scene);

class Simulation {
  public:
    virtual ~Simulation() = default;

    // Throws std::invalid_argument like resolve_run, or when why_not is not empty. `tasks` may be
    // null (one thread) and must outlive the simulation.
    static std::unique_ptr<Simulation> create(const SceneDesc &scene, const RunOptions &options,
                                              TaskPool *tasks);

    // False when the scene has only probes: steps then do nothing, and the step count stays 0.
    virtual bool has_world() const { return true; }

    // Adds the phases' times to `times` unless it is null.
    virtual void step(StepTimes *times) = 0;
    void step() { step(nullptr); }
    virtual std::uint64_t step_count() const = 0;
    virtual double time() const = 0;              // s, since the start of the scene
    virtual const StepReport &report() const = 0; // of the last step
    virtual Measures measure() const = 0;
    virtual double energy() const = 0; // kinetic and potential, J
    // Covers everything that decides the future: poses, velocities, accumulated impulses, settings.
    virtual std::uint64_t hash() const = 0;

    virtual const MethodInfo &method() const = 0;
    virtual const StepSettings &settings() const = 0;
    virtual Precision precision() const = 0;

    // The only way to change a simulation other than stepping. Throws std::invalid_argument and
    // changes nothing when the command is impossible: a missing body, a value out of range, a
    // method that cannot run the scene, adding a body under a method without contacts.
    virtual void apply(const Command &command) = 0;
    // Shorthands. Changes of method or settings take effect at the next step.
    void set_method(std::string_view name) { apply(SetMethod{std::string(name)}); }
    void set_settings(const StepSettings &settings) {
        apply(SetSettings{GivenSettings::differences(this->settings(), settings)});
    }
    std::size_t add_body(BodyDesc body); // under a free name; returns its index
    void remove_body(std::size_t body);

    // A complete copy of the state; after restoring it the run repeats bit for bit.
    class Saved {
      public:
        virtual ~Saved() = default;
        // Bytes not shared with another save of the same simulation (null: all bytes).
        virtual std::size_t bytes_beside(const Saved *) const { return 0; }
    };
    // Reuses the memory of `reuse`, an older save of this simulation, if given. Data unchanged
    // since `before`, another save of it, is shared with that save.
    virtual std::unique_ptr<Saved> save(std::unique_ptr<Saved> reuse,
                                        const Saved *before) const = 0;
    std::unique_ptr<Saved> save() const { return save(nullptr, nullptr); }
    virtual void restore(const Saved &saved) = 0; // saved by this simulation

    // The current state as a scene that loads to the same hash.
    virtual SceneDesc describe() const = 0;

    virtual std::size_t body_count() const = 0; // holes included
    virtual const BodyInfo &body_info(std::size_t body) const = 0;
    virtual std::optional<std::size_t> find_body(std::string_view name) const = 0;
    // The name, with a number appended if it is already taken.
    std::string free_name(const std::string &name) const;

    // Particles, springs and cloth, as they were at the start.
    virtual const SoftParts &soft_parts() const;
    virtual std::span<const AttractorDesc> attractors() const { return {}; }

    virtual const std::string &joint_name(std::size_t joint) const = 0; // a JointView's
    virtual std::size_t joint_count() const { return 0; }               // holes included
    // As in the scene or when it was added; null for a hole.
    virtual const JointDesc *joint(std::size_t) const { return nullptr; }
    std::optional<std::size_t> find_joint(std::string_view name) const;

    virtual std::optional<GrabView> grab() const { return {}; } // empty: nothing held

    // Reuses the frame's memory. Parts not asked for are left empty.
    virtual void read(Frame &into, const FrameParts &parts) const = 0;
    Frame read(const FrameParts &parts = {}) const {
        Frame frame;
        read(frame, parts);
        return frame;
    }

    // The nearest body on the ray origin + t * direction, t >= 0.
    virtual std::optional<Pick> pick(const glm::dvec3 &origin,
                                     const glm::dvec3 &direction) const = 0;
};

} // namespace plumb

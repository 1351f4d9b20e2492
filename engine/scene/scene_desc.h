// A scene as plain values, in double precision whatever the world runs in. SI units, radians.
#pragma once

#include "engine/dynamics/kinds.h"
#include "engine/scene/given_settings.h"
#include "engine/scene/joint_desc.h"
#include "engine/scene/particle_desc.h"
#include "engine/scene/probe_desc.h"
#include "engine/scene/shape_desc.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace plumb {

// Stated limits: beyond these a scene is refused.
inline constexpr std::size_t max_scene_bodies = 200'000;
inline constexpr std::size_t max_body_shapes = 1000;
inline constexpr std::size_t max_scene_joints = 200'000;
// Each length, speed, density, mass and so on of a scene is at most this in magnitude, and those
// that must be positive are at least 1 / this: their products then stay finite in float.
inline constexpr double max_scene_magnitude = 1e9;

struct MaterialDesc {
    std::string name;
    double density = 1000;           // kg/m^3
    double friction = 0.5;           // Coulomb; a pair uses the geometric mean
    double restitution = 0;          // Newton; a pair uses the larger
    std::optional<glm::vec3> colour; // sRGB, 0..1; by default the app's palette chooses
};

// Which pairs collide: all but those of which one ignores the other's layer.
struct FilterDesc {
    int layer = 0;             // below max_layers
    std::uint32_t ignores = 0; // bit i: layer i
};
inline constexpr int max_layers = 32;

// One shape of a body.
struct ColliderDesc {
    ShapeDesc shape;
    glm::dvec3 position{0}; // in the body's frame
    glm::dquat orientation{1, 0, 0, 0};
    std::string material{};        // a MaterialDesc's name; empty: the body's
    std::optional<double> density; // kg/m^3; see density_of
    FilterDesc filter;
    bool sensor = false; // reports what it touches, and lets it pass
};

// Where the centre of mass is in the world, and how the principal axes of inertia lie there.
struct MassPoseDesc {
    glm::dvec3 position{0};
    glm::dquat orientation{1, 0, 0, 0};
};

struct BodyDesc {
    std::string name; // unique
    BodyKind kind = BodyKind::dynamic;
    std::vector<ColliderDesc> colliders; // one or more
    std::string material;                // a MaterialDesc's name; empty: the default MaterialDesc
    std::optional<double> mass;          // kg; by default densities times volumes
    std::optional<double> density;       // kg/m^3; see density_of
    std::optional<glm::dvec3> center_of_mass; // in the body's frame; by default of its shapes
    // Moments of inertia about the body's axes, through the centre of mass (kg m^2); by default of
    // its shapes.
    std::optional<glm::dvec3> inertia;
    glm::dvec3 position{0}; // of the body's frame, which need not be its centre of mass
    glm::dquat orientation{1, 0, 0, 0};
    glm::dvec3 velocity{0};         // of the centre of mass, m/s, world
    glm::dvec3 angular_velocity{0}; // rad/s, world
    std::array<bool, 6> locked{};   // translations along the world's x, y, z, turns about them
    double gravity_scale = 1;
    double linear_damping = 0;  // 1/s: the rate at which the velocity falls
    double angular_damping = 0; // 1/s
    std::optional<glm::vec3> colour;
    // State: the centre of mass and the principal axes that a saved scene continues from, exactly.
    std::optional<MassPoseDesc> mass_pose;
    // State: the substeps that its island took in the last step, 0 for those of the settings;
    // those that its own loads ask for; and for how many steps it has been at rest, 65535 when it
    // sleeps.
    struct Pace {
        int substeps = 0;
        int wanted = 0;
        int rested = 0;
    };
    Pace pace;
};

struct CameraDesc {
    glm::dvec3 target{0, 1, 0};
    double distance = 10;
    double yaw = 0.6;    // radians about +y; 0 looks from +z
    double pitch = 0.35; // radians; positive looks down
    double fov = 0.8;    // radians, vertical
};

// What this scene can be held to. A quantity of the motion, boiled down over a time window to one
// number, compared with the truth or a bound.
struct ExpectDesc {
    enum class Relation { equals, at_most, at_least };
    std::string name;            // unique in the scene
    std::string quantity;        // see scene/expect.h for the list
    std::string body;            // body, particle or spring, for quantities of one
    std::string reduce = "last"; // see scene/expect.h for the list
    std::optional<double> level; // of a crossing; by default midway between min and max
    double from = 0;             // s
    double to = 0;               // s; the end of the window, and so of the run
    Relation relation = Relation::equals;
    double value = 0; // truth, or the bound; 0 beside a curve
    // The truth as a curve: at least least_curve values, evenly over [from, to]. What is reduced is
    // then how far the quantity is from it. Empty where the truth is one number.
    std::vector<double> curve;
    double tolerance =
        0; // absolute, in the quantity's unit; how far the truth may be missed. 0 for bounds
    // By how much halving the step changed a truth that was found by refinement; none of others.
    std::optional<double> estimate;
    std::string source;   // where the truth comes from
    std::size_t line = 0; // in the scene file
};

// What the solver remembers of one contact point from the last step.
struct ContactStateDesc {
    std::string body_a;
    std::string body_b;
    std::uint32_t child_a = 0; // which of the body's colliders
    std::uint32_t child_b = 0;
    std::optional<std::uint32_t> triangle; // of the one that is a mesh or a height field
    struct Point {
        std::uint32_t feature = 0;
        glm::dvec3 impulse{0}; // normal, two tangential (N s)
        glm::dvec3 core_a{0};  // where the point is on either body, in its mass frame (m)
        glm::dvec3 core_b{0};
        // Stiffness along and across (N/m), slip (m) along the two tangents: of a method that keeps
        // penalties.
        std::array<double, 4> penalty{};
    };
    // How the bodies lay when it was found.
    glm::dvec3 normal{0, 1, 0};
    glm::dvec3 offset{0}; // from a's centre of mass to b's (m)
    glm::dquat rotation_a{1, 0, 0, 0};
    glm::dquat rotation_b{1, 0, 0, 0};
    std::vector<Point> points;
};

// A held grab, of a body or of a particle: one of the two names is empty.
struct GrabStateDesc {
    std::string body;
    std::string particle;
    glm::dvec3 point_local{0}; // of a body: in its mass frame (m)
    glm::dvec3 target{0};      // m
    double max_force = 0;      // N
    double frequency = 0;      // of its spring (Hz)
    double damping_ratio = 0;
    glm::dvec3 impulse{0}; // of a body: what the solver remembers (N s)
    double held_mass = 0;  // of a particle: as if it bore so much (kg)
};

enum class Precision { f32, f64 }; // "float", "double" in files

struct WorldDesc {
    std::string method = "soft_step";
    // Where they differ from the method's defaults. Gravity and dt (SettingGroup::world) hold for
    // every method, the others for `method`.
    GivenSettings settings;
    // Settings with which the other methods meet this scene's tolerances, less those of the world.
    std::map<std::string, GivenSettings> other_methods;
    Precision precision = Precision::f32;
    std::uint64_t seed = 1;
};

struct SceneDesc {
    std::string name; // the file's stem
    std::string title;
    std::string description;
    WorldDesc world;
    std::vector<MaterialDesc> materials;
    std::vector<BodyDesc> bodies; // repeats expanded
    std::vector<JointDesc> joints;
    std::vector<AttractorDesc> attractors;
    std::vector<ParticleDesc> particles;
    std::vector<SpringDesc> springs;
    std::vector<ClothDesc> cloths;
    std::vector<ProbeDesc> probes;
    CameraDesc camera;
    std::vector<ExpectDesc> expects;
    // The state a saved scene continues from.
    std::uint64_t step_count = 0;
    // When dt was last changed: after so many steps, at that time (s).
    std::uint64_t dt_since_step = 0;
    double dt_since_time = 0;
    std::optional<GrabStateDesc> grab;
    std::vector<ContactStateDesc> contacts;
};

// Of a body's shape (kg/m^3): its own, else its material's, else the body's own, else the body's
// material's. A material that the scene does not have counts as the default one.
double density_of(const SceneDesc &scene, const BodyDesc &body, const ColliderDesc &collider);

// kg: the body's own, or else densities times volumes. Sensors weigh nothing.
double mass_of(const SceneDesc &scene, const BodyDesc &body);

// The smallest of the widths of the body's shapes (m).
double smallest_width(const BodyDesc &body);

// The axis-aligned box around all shapes of a body (m); infinite if one of them is a plane.
BoundsDesc bounds(const BodyDesc &body);

// Whether any of the body's shapes is a plane.
bool has_plane(const BodyDesc &body);

// Whether there is a world to step: a scene that has only probes has none.
inline bool has_world(const SceneDesc &scene) {
    return !scene.bodies.empty() || !scene.joints.empty() || !scene.particles.empty() ||
           !scene.cloths.empty() || scene.probes.empty();
}

inline bool has_soft_parts(const SceneDesc &scene) {
    return !scene.particles.empty() || !scene.springs.empty() || !scene.cloths.empty();
}

} // namespace plumb

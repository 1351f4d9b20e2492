// A scene as plain values, in double regardless of the world's precision. SI units, radians.
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

// A scene beyond these limits is refused.
inline constexpr std::size_t max_scene_bodies = 200'000;
inline constexpr std::size_t max_body_shapes = 1000;
inline constexpr std::size_t max_scene_joints = 200'000;
// Every length, speed, density, mass and so on is at most this in magnitude, and positive ones at
// least 1 / this, so that their products stay finite in float.
inline constexpr double max_scene_magnitude = 1e9;

struct MaterialDesc {
    std::string name;
    double density = 1000;           // kg/m^3
    double friction = 0.5;           // Coulomb; a pair uses the geometric mean
    double restitution = 0;          // Newton; a pair uses the larger
    std::optional<glm::vec3> colour; // sRGB, 0..1; by default the app's palette chooses
};

// Two colliders collide unless either ignores the other's layer.
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
    bool sensor = false; // reports contacts without pushing
};

// The centre of mass and the orientation of the principal axes of inertia, in the world.
struct MassPoseDesc {
    glm::dvec3 position{0};
    glm::dquat orientation{1, 0, 0, 0};
};

struct BodyDesc {
    std::string name; // unique
    BodyKind kind = BodyKind::dynamic;
    std::vector<ColliderDesc> colliders; // one or more
    std::string material;                // a MaterialDesc's name; empty: the default MaterialDesc
    std::optional<double> mass;          // kg; by default density times volume
    std::optional<double> density;       // kg/m^3; see density_of
    std::optional<glm::dvec3> center_of_mass; // in the body's frame; by default from its shapes
    // Moments of inertia about the body's axes, through the centre of mass (kg m^2); by default
    // from its shapes.
    std::optional<glm::dvec3> inertia;
    glm::dvec3 position{0}; // of the body's frame, which need not be its centre of mass
    glm::dquat orientation{1, 0, 0, 0};
    glm::dvec3 velocity{0};         // of the centre of mass, m/s, world
    glm::dvec3 angular_velocity{0}; // rad/s, world
    std::array<bool, 6> locked{};   // translation along world x, y, z; rotation about them
    double gravity_scale = 1;
    glm::dvec3 force{0};        // N, constant, at the centre of mass, world
    glm::dvec3 torque{0};       // N m, constant, world
    double linear_damping = 0;  // 1/s: the velocity's decay rate
    double angular_damping = 0; // 1/s
    std::optional<glm::vec3> colour;
    // State: the exact centre of mass and principal axes that a saved scene continues from.
    std::optional<MassPoseDesc> mass_pose;
    // State: its island's substeps in the last step (0: the settings' number), the substeps its own
    // loads call for, for how many steps it has been at rest (65535: asleep), and for how many it
    // has been struck.
    struct Pace {
        int substeps = 0;
        int wanted = 0;
        int rested = 0;
        int struck = 0;
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

// An expectation of the scene: a quantity of the motion, reduced over a time window to one number,
// compared with the truth or a bound.
struct ExpectDesc {
    enum class Relation { equals, at_most, at_least };
    std::string name;            // unique in the scene
    std::string quantity;        // see scene/expect.h for the list
    std::string body;            // body, particle or spring, for quantities that need one
    std::string reduce = "last"; // see scene/expect.h for the list
    std::optional<double> level; // of a crossing; by default midway between min and max
    double from = 0;             // s
    double to = 0;               // s; the end of the window, and so of the run
    Relation relation = Relation::equals;
    double value = 0; // truth, or the bound; 0 beside a curve
    // The truth as a curve: at least least_curve values, evenly spaced over [from, to]. The
    // quantity's distance from it is then reduced. Empty when the truth is one number.
    std::vector<double> curve;
    double tolerance =
        0; // absolute, in the quantity's unit: allowed error of the truth; 0 for bounds
    // How much halving the step changed a truth found by refinement; empty for other truths.
    std::optional<double> estimate;
    std::string source;   // where the truth comes from
    std::size_t line = 0; // in the scene file
};

// The solver's warm-start state of one contact from the last step.
struct ContactStateDesc {
    std::string body_a;
    std::string body_b;
    std::uint32_t child_a = 0; // which of the body's colliders
    std::uint32_t child_b = 0;
    std::optional<std::uint32_t> triangle; // in the mesh or height field, if either is one
    struct Point {
        std::uint32_t feature = 0;
        glm::dvec3 impulse{0}; // normal, two tangential (N s)
        glm::dvec3 core_a{0};  // the point on each body, in its mass frame (m)
        glm::dvec3 core_b{0};
        // For methods that keep penalties: normal and tangential stiffness (N/m), slip (m) along
        // both tangents.
        std::array<double, 4> penalty{};
    };
    // The bodies' relative pose when the contact was found.
    glm::dvec3 normal{0, 1, 0};
    glm::dvec3 offset{0}; // from a's centre of mass to b's (m)
    glm::dquat rotation_a{1, 0, 0, 0};
    glm::dquat rotation_b{1, 0, 0, 0};
    std::vector<Point> points;
};

// An active grab of a body or a particle; the other name is empty.
struct GrabStateDesc {
    std::string body;
    std::string particle;
    glm::dvec3 point_local{0}; // for a body: in its mass frame (m)
    glm::dvec3 target{0};      // m
    double max_force = 0;      // N
    double frequency = 0;      // of its spring (Hz)
    double damping_ratio = 0;
    glm::dvec3 impulse{0}; // for a body: accumulated impulse (N s)
    double held_mass = 0;  // for a particle: the mass its spring is tuned for (kg)
};

enum class Precision { f32, f64 }; // "float", "double" in files

struct WorldDesc {
    std::string method = "soft_step";
    // Only those that differ from the method's defaults. Gravity and dt (SettingGroup::world) apply
    // to every method, the rest to `method`.
    GivenSettings settings;
    // Settings with which other methods meet this scene's tolerances, without the world's.
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
    // State that a saved scene continues from.
    std::uint64_t step_count = 0;
    // When dt last changed: the step count and time (s).
    std::uint64_t dt_since_step = 0;
    double dt_since_time = 0;
    std::optional<GrabStateDesc> grab;
    std::vector<ContactStateDesc> contacts;
};

// A collider's density (kg/m^3): its own, else its material's, else the body's own, else the body's
// material's. A material missing from the scene counts as the default one.
double density_of(const SceneDesc &scene, const BodyDesc &body, const ColliderDesc &collider);

// kg: the body's own, or else density times volume. Sensors weigh nothing.
double mass_of(const SceneDesc &scene, const BodyDesc &body);

// The smallest width of any of the body's shapes (m).
double smallest_width(const BodyDesc &body);

// The axis-aligned box around all shapes of a body (m); infinite if one of them is a plane.
BoundsDesc bounds(const BodyDesc &body);

// Whether any of the body's shapes is a plane.
bool has_plane(const BodyDesc &body);

// Whether there is a world to step; a scene with only probes has none.
inline bool has_world(const SceneDesc &scene) {
    return !scene.bodies.empty() || !scene.joints.empty() || !scene.particles.empty() ||
           !scene.cloths.empty() || scene.probes.empty();
}

inline bool has_soft_parts(const SceneDesc &scene) {
    return !scene.particles.empty() || !scene.springs.empty() || !scene.cloths.empty();
}

} // namespace plumb

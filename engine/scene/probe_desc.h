// Probes: a scene's geometry queries, as plain values in double precision. For their answers see
// probe.h. SI units, radians.
#pragma once

#include "engine/scene/shape_desc.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace plumb {

// A scene beyond these limits is refused.
inline constexpr std::size_t max_scene_probes = 1000;
inline constexpr std::size_t max_probe_shapes = 1000;
inline constexpr std::size_t max_probe_points = 10'000;
inline constexpr int max_probe_items = 20'000; // scattered

// Shapes that can be queried besides those of bodies.

// A box along the world axes.
struct AabbDesc {
    glm::dvec3 half_extents{0.5};
};
// In world coordinates.
struct SegmentDesc {
    std::array<glm::dvec3, 2> points{};
};
struct TriangleDesc {
    std::array<glm::dvec3, 3> points{};
};
// The shapes from here on are in the xy plane.
struct FlatSegmentDesc {
    std::array<glm::dvec3, 2> points{};
};
struct CircleDesc {
    double radius = 0.5;
};
struct RectangleDesc {
    glm::dvec3 half_extents{0.5, 0.5, 0};
};
struct OrientedRectangleDesc {
    glm::dvec3 half_extents{0.5, 0.5, 0};
    double angle = 0; // counter-clockwise
};
using FlatPartShape = std::variant<CircleDesc, RectangleDesc, OrientedRectangleDesc>;
struct FlatPartDesc {
    FlatPartShape shape;
    glm::dvec3 position{0}; // relative to the compound's
};
struct FlatCompoundDesc {
    std::vector<FlatPartDesc> parts;
};

// In the order in which messages list them.
using ProbeShape =
    std::variant<SphereDesc, BoxDesc, AabbDesc, CapsuleDesc, CylinderDesc, PlaneDesc, SegmentDesc,
                 TriangleDesc, HullDesc, MeshDesc, HeightFieldDesc, FlatSegmentDesc, CircleDesc,
                 RectangleDesc, OrientedRectangleDesc, FlatCompoundDesc>;

struct ProbeShapeDesc {
    ProbeShape shape;
    glm::dvec3 position{0};             // the centre; for a plane, a point on it
    glm::dquat orientation{1, 0, 0, 0}; // identity for kinds without rotation
    std::string name{}, parent{};       // in "models": parents come before their children
};

// origin + t * direction, 0 <= t <= max_t; or, with an end, the segment from origin to end.
struct ProbeRayDesc {
    glm::dvec3 origin{0};
    glm::dvec3 direction{0, 0, -1}; // not read for a segment
    std::optional<double> max_t;    // not read for a segment
    std::optional<glm::dvec3> end;
};

// A second camera, which stays where it is.
struct ProbeCameraDesc {
    glm::dvec3 eye{0, 1, 5};
    glm::dvec3 target{0};
    double fov = 0.8;             // vertical
    std::optional<double> height; // of the view (m): orthographic; fov is not read
    double aspect = 16.0 / 9.0;
    double near = 0.5;
    double far = 20;
    std::optional<glm::dvec2> pixel; // to pick: from the top left of a picture 100 high
};

// Random items, uniform in a box, with a seed of their own: boxes for trees, points to enclose.
struct ProbeScatterDesc {
    int count = 0;
    glm::dvec3 center{0};
    glm::dvec3 half_extents{5};
    double size = 0.2; // half the side of the largest item; the smallest is a quarter of it
    std::uint64_t seed = 1;
};

// The kinds of query; probe_questions() lists what each needs and answers.
enum class ProbeQuestion {
    vectors,
    basis,
    transform,
    matrix,
    contains,
    closest,
    overlap,
    classify,
    planes,
    raycast,
    distance,
    penetration,
    collide,
    cast,
    enclose,
    tree,
    models,
    frustum,
    cull,
    pick,
};

enum class ProbeTree { quadtree, octree, bvh };

struct ProbeExpectDesc {
    std::string value; // one of the question's values
    double is = 0;     // 1 and 0 for true and false
};

struct ProbeDesc {
    std::string name; // unique in the scene
    ProbeQuestion question = ProbeQuestion::raycast;
    std::vector<ProbeShapeDesc> shapes;
    std::vector<glm::dvec3> points;
    std::optional<ProbeRayDesc> ray;
    std::optional<ProbeCameraDesc> camera;
    std::optional<ProbeScatterDesc> scatter;
    std::optional<ProbeTree> tree;
    int level = -1;       // tree level to draw; -1: all
    double margin = 0;    // collide, metres
    glm::dvec3 motion{0}; // cast, metres: by the first shape
    glm::dvec3 scale{1};  // transform
    std::vector<ProbeExpectDesc> expects;
    double tolerance = 0; // absolute; for expects other than yes or no
    std::string source;   // where the expected values come from
};

struct ProbeQuestionInfo {
    struct Range {
        std::size_t min = 0;
        std::size_t max = 0;
    };
    ProbeQuestion question;
    std::string_view name;
    std::string_view about;
    Range shapes;
    Range points;
    std::vector<std::string_view> takes;  // keys besides shapes and points
    std::vector<std::string_view> values; // that the answer can contain
    [[nodiscard]] bool does_take(std::string_view key) const;
};
const std::vector<ProbeQuestionInfo> &probe_questions(); // in the order of the enumeration
const ProbeQuestionInfo &probe_question(ProbeQuestion question);

std::string_view shape_name(const ProbeShape &shape); // in files
bool is_flat(const ProbeShape &shape);                // in the xy plane

// Whether the whole probe lies in the xy plane.
bool is_flat(const ProbeDesc &probe);

// What the user can drag: points, shapes, ends of rays, a camera's eye and target.
std::vector<glm::dvec3> probe_handles(const ProbeDesc &probe);
// Moves a handle, indexed as above. Handles in the xy plane stay in it; an end that would leave its
// ray without a direction does not move.
void move_probe_handle(ProbeDesc &probe, std::size_t handle, const glm::dvec3 &place);

} // namespace plumb

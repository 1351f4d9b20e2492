// The shapes of bodies as plain values, in double precision, and their measures. SI units.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace plumb {

// Each in a frame of its own.
struct SphereDesc {
    double radius = 0.5;
};
struct BoxDesc {
    glm::dvec3 half_extents{0.5};
};
// Along the y axis: a cylinder of 2 * half_height with a hemisphere on each end.
struct CapsuleDesc {
    double half_height = 0.5;
    double radius = 0.25;
};
// Along the y axis.
struct CylinderDesc {
    double half_height = 0.5;
    double radius = 0.5;
};
// The solid half-space y <= 0. Never dynamic.
struct PlaneDesc {};

// A file beside the scene that a shape was read from; its numbers times `scale` are metres.
struct ShapeFile {
    std::string name;
    double scale = 1;
};

// The convex hull of points.
struct HullDesc {
    std::shared_ptr<const std::vector<glm::dvec3>> points; // never null in a scene that was read
    std::optional<ShapeFile> file;                         // that the points are from
};

// Corners of a triangle are counter-clockwise from its front.
struct MeshData {
    std::vector<glm::dvec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles; // indices of vertices
};

// A mesh that Plumb makes.
struct MeshModel {
    enum class Kind { ball, torus, knot, bowl };
    Kind kind = Kind::ball;
    glm::dvec3 half_extents{0.5}; // of the whole
    int detail = 8;               // how finely it is cut
};

// A surface of triangles. Static only.
struct MeshDesc {
    std::shared_ptr<const MeshData> data;                        // never null likewise
    std::variant<std::monostate, ShapeFile, MeshModel> source{}; // of the data; else given as such
    bool both_sides = false; // else only the fronts of its triangles collide
};

// Hills that Plumb makes: two waves across each other.
struct HillsModel {
    glm::dvec3 half_extents{0.5}; // y: how high they are
    int detail = 8;               // squares along x
};

// Ground as a grid of heights, a surface seen from above, centred in x and z. Static only.
struct HeightFieldDesc {
    int rows = 2;    // of samples, along z
    int columns = 2; // along x
    double spacing = 1;
    std::shared_ptr<const std::vector<double>> heights; // never null likewise
    std::optional<HillsModel> hills;                    // that the heights are of
};

using ShapeDesc = std::variant<SphereDesc, BoxDesc, CapsuleDesc, CylinderDesc, HullDesc, PlaneDesc,
                               MeshDesc, HeightFieldDesc>;

// In the field's frame: ((column - (columns - 1) / 2) * spacing, heights[row * columns + column],
// (row - (rows - 1) / 2) * spacing).
glm::dvec3 sample_point(const HeightFieldDesc &field, int row, int column);

// The file that a shape of any variant is from; null when it is from none.
inline const ShapeFile *file_of(const HullDesc &hull) {
    return hull.file ? &*hull.file : nullptr;
}
inline const ShapeFile *file_of(const MeshDesc &mesh) {
    return std::get_if<ShapeFile>(&mesh.source);
}
template <typename... Kinds> const ShapeFile *shape_file(const std::variant<Kinds...> &shape) {
    return std::visit(
        [](const auto &of_kind) -> const ShapeFile * {
            if constexpr (requires { file_of(of_kind); })
                return file_of(of_kind);
            else
                return nullptr;
        },
        shape);
}

// m^3; infinite for a plane, 0 for what is a surface (meshes and height fields) and for points that
// have no solid hull.
double volume(const ShapeDesc &shape);

// The smallest distance between two parallel planes that hold the shape between them (m); infinite
// for a plane and for surfaces, which are unbounded; 0 for points without a solid hull.
double smallest_width(const ShapeDesc &shape);

// Its kind and size in a few words: "capsule, half height 0.5 m, radius 0.2 m".
std::string summary(const ShapeDesc &shape);

// The axis-aligned box around a shape that is turned and then moved to `position` (m); infinite for
// a plane.
struct BoundsDesc {
    glm::dvec3 min{0};
    glm::dvec3 max{0};
};
BoundsDesc bounds(const ShapeDesc &shape, const glm::dvec3 &position,
                  const glm::dquat &orientation);

} // namespace plumb

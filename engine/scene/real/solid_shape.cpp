#include "engine/scene/real/solid_shape.h"

#include "engine/geometry/quickhull.h"
#include "engine/scene/real/hull_measures.h"

#include <array>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

TriangleMesh mesh_of(const MeshData &data) {
    TriangleMesh mesh;
    for (const glm::dvec3 &vertex : data.vertices)
        mesh.vertices.emplace_back(vertex);
    mesh.triangles = data.triangles;
    return mesh;
}

Sides sides_of(MeshSides sides) {
    switch (sides) {
    case MeshSides::one:
        return Sides::front;
    case MeshSides::both:
        return Sides::both;
    case MeshSides::solid:
        break;
    }
    return Sides::solid;
}

std::shared_ptr<const TriangleSurface> make_surface(const MeshDesc &desc) {
    return std::make_shared<const TriangleSurface>(mesh_of(*desc.data), sides_of(desc.sides));
}

std::shared_ptr<const TriangleSurface> make_surface(const HeightFieldDesc &desc) {
    HeightField field;
    field.rows = desc.rows;
    field.columns = desc.columns;
    field.spacing = static_cast<Real>(desc.spacing);
    const double x = -0.5 * (desc.columns - 1) * desc.spacing;
    const double z = -0.5 * (desc.rows - 1) * desc.spacing;
    field.origin = Vec3{static_cast<Real>(x), Real(0), static_cast<Real>(z)};
    for (const double height : *desc.heights)
        field.heights.push_back(static_cast<Real>(height));
    return std::make_shared<const TriangleSurface>(std::move(field),
                                                   desc.is_solid ? Sides::solid : Sides::front);
}

template <typename Desc>
concept IsSurface = requires(const Desc &desc) {
    make_surface(desc);
};

struct MakeSolid {
    SolidShape operator()(const SphereDesc &s) const {
        return {Sphere{Vec3{Real(0)}, static_cast<Real>(s.radius)}, nullptr};
    }
    SolidShape operator()(const BoxDesc &b) const {
        return {Box{Vec3{Real(0)}, identity_rotation, Vec3{b.half_extents}}, nullptr};
    }
    SolidShape operator()(const CapsuleDesc &c) const {
        const auto half = static_cast<Real>(c.half_height);
        return {Capsule{Vec3{0, -half, 0}, Vec3{0, half, 0}, static_cast<Real>(c.radius)}, nullptr};
    }
    SolidShape operator()(const CylinderDesc &c) const {
        const auto half = static_cast<Real>(c.half_height);
        return {Cylinder{Vec3{0, -half, 0}, Vec3{0, half, 0}, static_cast<Real>(c.radius)},
                nullptr};
    }
    // No scene shape needs more vertices: a smooth hull with this many is round to 1 %.
    SolidShape operator()(const HullDesc &h) const {
        const std::vector<Vec3> points(h.points->begin(), h.points->end());
        HullResult result = convex_hull(points, max_hull_vertices);
        if (!result.mesh)
            return {};
        auto hull = std::make_shared<const HullMesh>(std::move(*result.mesh));
        const ConvexHull shape{hull.get(), Vec3{Real(0)}, identity_rotation};
        return {shape, std::move(hull)};
    }
    SolidShape operator()(const PlaneDesc &) const {
        return {HalfSpace{Vec3{Real(0), Real(1), Real(0)}, Real(0)}, nullptr};
    }
    SolidShape operator()(const IsSurface auto &) const { return {}; }
};

} // namespace

SolidShape solid_shape(const ShapeDesc &desc) {
    return std::visit(MakeSolid{}, desc);
}

bool encloses_space(const MeshData &data) {
    TriangleMesh mesh = mesh_of(data);
    const std::vector<std::uint32_t> place = same_places(mesh.vertices);
    double volume = 0;
    for (std::array<std::uint32_t, 3> &corners : mesh.triangles) {
        volume += glm::dot(data.vertices[corners[0]] - data.vertices.front(),
                           glm::cross(data.vertices[corners[1]] - data.vertices.front(),
                                      data.vertices[corners[2]] - data.vertices.front())) /
                  6;
        for (std::uint32_t &corner : corners)
            corner = place[corner];
    }
    return volume > 0 && is_closed(mesh);
}

std::shared_ptr<const TriangleSurface> triangle_surface(const ShapeDesc &desc) {
    return std::visit(
        [](const auto &shape) -> std::shared_ptr<const TriangleSurface> {
            if constexpr (requires { make_surface(shape); })
                return make_surface(shape);
            else
                return nullptr;
        },
        desc);
}

} // namespace plumb::inline PLUMB_PRECISION

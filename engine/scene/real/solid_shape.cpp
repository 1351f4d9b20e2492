#include "engine/scene/real/solid_shape.h"

#include "engine/geometry/quickhull.h"
#include "engine/scene/real/hull_measures.h"

#include <utility>
#include <variant>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

namespace {

std::shared_ptr<const TriangleSurface> make_surface(const MeshDesc &desc) {
    TriangleMesh mesh;
    for (const glm::dvec3 &vertex : desc.data->vertices)
        mesh.vertices.emplace_back(vertex);
    mesh.triangles = desc.data->triangles;
    return std::make_shared<const TriangleSurface>(std::move(mesh),
                                                   desc.both_sides ? Sides::both : Sides::front);
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
    return std::make_shared<const TriangleSurface>(std::move(field), Sides::front);
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

#include "app/sandbox/draw/shape_draw.h"

#include "engine/geometry/quickhull.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb {

namespace {

template <typename... Cases> struct Overloaded : Cases... { using Cases::operator()...; };
template <typename... Cases> Overloaded(Cases...) -> Overloaded<Cases...>;

using Surface = std::shared_ptr<const Corners>;

Corners corners_of(const HullDesc &hull) {
    const std::vector<f32::Vec3> points(hull.points->begin(), hull.points->end());
    const f32::HullResult made = f32::convex_hull(points, 256);
    Corners corners;
    if (!made.mesh)
        return corners;
    for (const f32::HullMesh::Face &face : made.mesh->faces)
        for (std::uint32_t i = 2; i < face.count; ++i)
            for (const std::uint32_t corner : {0U, i - 1, i})
                corners.push_back(
                    made.mesh->vertices[made.mesh->vertex_indices[face.first + corner]]);
    return corners;
}

Corners corners_of(const MeshDesc &mesh) {
    Corners corners;
    for (const auto &triangle : mesh.data->triangles)
        for (const std::uint32_t corner : triangle)
            corners.emplace_back(mesh.data->vertices[corner]);
    return corners;
}

// Each cell is split from its least row and column to its greatest, as in the geometry code.
Corners corners_of(const HeightFieldDesc &field) {
    Corners corners;
    for (int row = 0; row + 1 < field.rows; ++row)
        for (int column = 0; column + 1 < field.columns; ++column) {
            const glm::vec3 least(sample_point(field, row, column));
            const glm::vec3 right(sample_point(field, row, column + 1));
            const glm::vec3 front(sample_point(field, row + 1, column));
            const glm::vec3 greatest(sample_point(field, row + 1, column + 1));
            corners.insert(corners.end(), {least, front, greatest, least, greatest, right});
        }
    return corners;
}

// The cached triangles of all shapes made from `data`.
template <typename Shape> Surface surface_of(const Shape &shape, std::shared_ptr<const void> data) {
    struct Kept {
        std::weak_ptr<const void> data;
        Surface surface;
    };
    static std::map<const void *, Kept> all; // not thread-safe: only the drawing thread uses it
    const auto found = all.find(data.get());
    if (found != all.end() && found->second.data.lock() == data)
        return found->second.surface;
    std::erase_if(all, [](const auto &entry) { return entry.second.data.expired(); });
    const Surface made = std::make_shared<const Corners>(corners_of(shape));
    all[data.get()] = {data, made};
    return made;
}

float as_float(double value) {
    return static_cast<float>(value);
}

} // namespace

void draw_shape(DrawList &list, const ShapeDesc &shape, const glm::dvec3 &position,
                const glm::dquat &orientation, const ShapeStyle &style) {
    const auto solid = [&](DrawKind kind, const glm::vec3 &size) {
        DrawShape drawn;
        drawn.kind = kind;
        drawn.position = glm::vec3(position);
        drawn.rotation = glm::quat(orientation);
        drawn.size = size;
        drawn.colour = style.colour;
        drawn.selected = style.selected;
        drawn.highlighted = style.highlighted;
        drawn.glass = style.glass;
        list.shapes.push_back(drawn);
    };
    const auto surface = [&](Surface corners) {
        DrawMesh mesh;
        mesh.corners = std::move(corners);
        mesh.position = glm::vec3(position);
        mesh.rotation = glm::quat(orientation);
        mesh.colour = style.colour;
        mesh.highlighted = style.highlighted;
        mesh.glass = style.glass;
        list.meshes.push_back(std::move(mesh));
    };
    std::visit(
        Overloaded{
            [&](const SphereDesc &s) { solid(DrawKind::sphere, glm::vec3(as_float(s.radius))); },
            [&](const BoxDesc &b) { solid(DrawKind::box, glm::vec3(b.half_extents)); },
            [&](const CapsuleDesc &c) {
                solid(DrawKind::capsule, {as_float(c.radius), as_float(c.half_height), 0});
            },
            [&](const CylinderDesc &c) {
                solid(DrawKind::cylinder, {as_float(c.radius), as_float(c.half_height), 0});
            },
            [&](const HullDesc &h) { surface(surface_of(h, h.points)); },
            [&](const PlaneDesc &) {
                list.planes.push_back({glm::vec3(position), glm::quat(orientation)});
            },
            [&](const MeshDesc &m) { surface(surface_of(m, m.data)); },
            [&](const HeightFieldDesc &f) { surface(surface_of(f, f.heights)); }},
        shape);
}

double reach(const ShapeDesc &shape) {
    const auto of_box = [](const BoundsDesc &box) {
        return glm::length(glm::max(-box.min, box.max));
    };
    const glm::dquat upright(1, 0, 0, 0);
    return std::visit(
        Overloaded{
            [](const SphereDesc &s) { return s.radius; },
            [](const BoxDesc &b) { return glm::length(b.half_extents); },
            [](const CapsuleDesc &c) { return c.half_height + c.radius; },
            [](const CylinderDesc &c) { return c.half_height + c.radius; },
            [](const HullDesc &h) {
                double far = 0;
                for (const glm::dvec3 &point : *h.points)
                    far = std::max(far, glm::length(point));
                return far;
            },
            [](const PlaneDesc &) { return 0.0; },
            [&](const MeshDesc &m) { return of_box(bounds(m, glm::dvec3(0), upright)); },
            [&](const HeightFieldDesc &f) { return of_box(bounds(f, glm::dvec3(0), upright)); }},
        shape);
}

} // namespace plumb

#include "engine/scene/real/probe_shapes.h"

#include "engine/core/check.h"
#include "engine/geometry/quickhull.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int circle_sides = 64;

Real real(double value) {
    return static_cast<Real>(value);
}

// A grid of points over [0, 1] x [0, 1], as triangles; a direction that closes has its last row at
// its first. Points that coincide (the poles of a ball) are one vertex.
template <typename Place>
TriangleMesh grid(int rows, int columns, bool closes_u, bool closes_v, const Place &place) {
    TriangleMesh mesh;
    const int points_u = closes_u ? rows : rows + 1;
    const int points_v = closes_v ? columns : columns + 1;
    std::vector<std::uint32_t> vertex;
    for (int u = 0; u < points_u; ++u)
        for (int v = 0; v < points_v; ++v) {
            const Vec3 point{
                place(static_cast<double>(u) / rows, static_cast<double>(v) / columns)};
            // Only neighbours in a row can coincide.
            const bool is_new = v == 0 || mesh.vertices.back() != point;
            if (is_new)
                mesh.vertices.push_back(point);
            vertex.push_back(static_cast<std::uint32_t>(mesh.vertices.size() - 1));
        }
    const auto at = [&](int u, int v) {
        return vertex[static_cast<std::size_t>((u % points_u) * points_v + v % points_v)];
    };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (a != b && b != c && c != a)
            mesh.triangles.push_back({a, b, c});
    };
    for (int u = 0; u < rows; ++u)
        for (int v = 0; v < columns; ++v) {
            add(at(u, v), at(u + 1, v), at(u + 1, v + 1));
            add(at(u, v), at(u + 1, v + 1), at(u, v + 1));
        }
    return mesh;
}

// Within [-1, 1] on each axis; fronts outside.
TriangleMesh unit_model(const std::string &model, int detail) {
    const auto on_ball = [](double u, double v) {
        // The poles are exact, so that their copies are one.
        const double ring = u == 0 || u == 1 ? 0 : std::sin(pi * u);
        return glm::dvec3(ring * std::sin(2 * pi * v), u == 1 ? -1 : std::cos(pi * u),
                          ring * std::cos(2 * pi * v));
    };
    if (model == "ball")
        return grid(detail, 2 * detail, false, true, on_ball);
    if (model == "bowl")
        return grid(detail, 2 * detail, false, true, [&](double u, double v) {
            return -on_ball(0.5 * u, v) * glm::dvec3(1, 1, -1);
        });
    if (model == "torus")
        return grid(2 * detail, detail, true, true, [](double u, double v) {
            const double ring = 0.7 + 0.3 * std::cos(2 * pi * v);
            return glm::dvec3(ring * std::sin(2 * pi * u), std::sin(2 * pi * v),
                              ring * std::cos(2 * pi * u));
        });
    // A tube around a trefoil.
    const auto on_knot = [](double u) {
        const double t = 2 * pi * u;
        return glm::dvec3(std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t),
                          -std::sin(3 * t)) /
               3.0;
    };
    return grid(8 * detail, detail, true, true, [&](double u, double v) {
        const glm::dvec3 along = glm::normalize(on_knot(u + 1e-4) - on_knot(u - 1e-4));
        const glm::dvec3 side = glm::normalize(glm::cross(along, glm::dvec3(0, 0, 1)));
        const glm::dvec3 up = glm::cross(side, along);
        return 0.85 * on_knot(u) + 0.14 * (std::cos(2 * pi * v) * side + std::sin(2 * pi * v) * up);
    });
}

TriangleMesh make_mesh(const ProbeShapeDesc &desc) {
    if (desc.file_mesh) {
        TriangleMesh mesh;
        mesh.triangles = desc.file_mesh->triangles;
        for (const glm::dvec3 &vertex : desc.file_mesh->vertices)
            mesh.vertices.emplace_back(desc.position + desc.orientation * (desc.scale * vertex));
        return mesh;
    }
    TriangleMesh mesh = unit_model(desc.model, desc.detail);
    for (Vec3 &vertex : mesh.vertices)
        vertex = Vec3{desc.position + desc.orientation * (glm::dvec3{vertex} * desc.half_extents)};
    return mesh;
}

// Two waves across each other.
HeightField make_hills(const ProbeShapeDesc &desc) {
    HeightField field;
    const double spacing = 2 * desc.half_extents.x / desc.detail;
    field.columns = desc.detail + 1;
    field.rows = std::max(2, static_cast<int>(std::round(2 * desc.half_extents.z / spacing)) + 1);
    field.spacing = real(spacing);
    field.origin =
        Vec3{desc.position - glm::dvec3(desc.half_extents.x, 0, 0.5 * spacing * (field.rows - 1))};
    for (int row = 0; row < field.rows; ++row)
        for (int column = 0; column < field.columns; ++column) {
            const double x = column * spacing - desc.half_extents.x;
            const double z = row * spacing - desc.half_extents.z;
            field.heights.push_back(
                real(desc.half_extents.y * (0.7 * std::sin(0.9 * x + 0.4 * z) * std::cos(0.8 * z) +
                                            0.3 * std::sin(1.7 * z - 0.6 * x))));
        }
    return field;
}

void add_triangle(ProbeSurface &surface, const glm::dvec3 &a, const glm::dvec3 &b,
                  const glm::dvec3 &c) {
    surface.corners.insert(surface.corners.end(), {a, b, c});
}

// Filled, with its border.
void draw_polygon(ProbeAnswer &answer, const std::vector<glm::dvec3> &corners, ProbeTone tone,
                  std::size_t number) {
    ProbeSurface surface{{}, tone, number};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (i >= 2)
            add_triangle(surface, corners[0], corners[i - 1], corners[i]);
        answer.lines.push_back({corners[i], corners[(i + 1) % corners.size()], ProbeTone::edge});
    }
    answer.surfaces.push_back(std::move(surface));
}

void draw_quad(ProbeAnswer &answer, const glm::dvec3 &center, const glm::dvec3 &u,
               const glm::dvec3 &v, ProbeTone tone, std::size_t number) {
    draw_polygon(answer, {center - u - v, center + u - v, center + u + v, center - u + v}, tone,
                 number);
}

// The shapes that the app has no solid of its own for.
class Drawing {
  public:
    Drawing(ProbeAnswer &answer, const ProbeShapeDesc &desc, ProbeTone tone, std::size_t number)
        : answer_(answer), desc_(desc), tone_(tone), number_(number) {}

    void operator()(const Plane &plane) const {
        // A patch of it, with a level side.
        constexpr double half = 1.5;
        const glm::dvec3 normal = wide(plane.normal);
        const glm::dvec3 level = std::abs(normal.y) < 0.99
                                     ? glm::normalize(glm::cross(normal, glm::dvec3(0, 1, 0)))
                                     : glm::dvec3(1, 0, 0);
        draw_quad(answer_, desc_.position, half * level, half * glm::cross(level, normal), tone_,
                  number_);
        answer_.lines.push_back(
            {desc_.position, desc_.position + 0.8 * normal, ProbeTone::normal, true});
    }
    void operator()(const Segment &segment) const { line(wide(segment.a), wide(segment.b)); }
    void operator()(const Segment2 &segment) const { line(wide(segment.a), wide(segment.b)); }
    void operator()(const Triangle &t) const {
        draw_polygon(answer_, {wide(t.a), wide(t.b), wide(t.c)}, tone_, number_);
    }
    void operator()(const ConvexHull &hull) const {
        const auto place = [&](std::uint32_t vertex) {
            return wide(hull.position + rotated(hull.rotation, hull.mesh->vertices[vertex]));
        };
        ProbeSurface surface{{}, tone_, number_};
        for (const HullMesh::Face &face : hull.mesh->faces)
            for (std::uint32_t i = 2; i < face.count; ++i)
                add_triangle(surface, place(hull.mesh->vertex_indices[face.first]),
                             place(hull.mesh->vertex_indices[face.first + i - 1]),
                             place(hull.mesh->vertex_indices[face.first + i]));
        answer_.surfaces.push_back(std::move(surface));
        for (const HullMesh::Edge &edge : hull.mesh->edges)
            answer_.lines.push_back({place(edge.a), place(edge.b), ProbeTone::edge});
    }
    void operator()(const MeshTree &tree) const {
        ProbeSurface surface{{}, tone_, number_, true};
        for (std::size_t i = 0; i < tree.mesh().triangles.size(); ++i)
            add(surface, triangle(tree.mesh(), i));
        answer_.surfaces.push_back(std::move(surface));
    }
    void operator()(const HeightField &field) const {
        ProbeSurface surface{{}, tone_, number_, true};
        for (std::uint32_t i = 0; i < triangle_count(field); ++i)
            add(surface, triangle(field, i));
        answer_.surfaces.push_back(std::move(surface));
    }
    void operator()(const Circle &circle) const {
        std::vector<glm::dvec3> corners;
        for (int i = 0; i < circle_sides; ++i) {
            const double angle = 2 * pi * i / circle_sides;
            corners.push_back(wide(circle.center) +
                              static_cast<double>(circle.radius) *
                                  glm::dvec3(std::cos(angle), std::sin(angle), 0));
        }
        draw_polygon(answer_, corners, tone_, number_);
    }
    void operator()(const Rectangle &r) const {
        const Vec2 half = Real(0.5) * (r.max - r.min);
        draw_quad(answer_, wide(r.min + half), {static_cast<double>(half.x), 0, 0},
                  {0, static_cast<double>(half.y), 0}, tone_, number_);
    }
    void operator()(const OrientedRectangle &r) const {
        draw_quad(answer_, wide(r.center), wide(r.half_extents.x * r.axis),
                  wide(r.half_extents.y * perpendicular(r.axis)), tone_, number_);
    }
    void operator()(const Compound2 &compound) const {
        for (const Part2 &part : compound.parts())
            std::visit(*this, part);
    }
    // Sphere, Box, Aabb, Capsule, Cylinder
    template <typename Solid> void operator()(const Solid &) const {
        answer_.solids.push_back({desc_, tone_, number_});
    }

  private:
    static void add(ProbeSurface &surface, const Triangle &t) {
        add_triangle(surface, wide(t.a), wide(t.b), wide(t.c));
    }
    void line(const glm::dvec3 &a, const glm::dvec3 &b) const {
        answer_.lines.push_back(
            {a, b, tone_ == ProbeTone::plain ? ProbeTone::query : tone_, false, true});
    }

    ProbeAnswer &answer_;
    const ProbeShapeDesc &desc_;
    ProbeTone tone_;
    std::size_t number_;
};

Compound2 make_compound(const ProbeShapeDesc &desc) {
    std::vector<Part2> parts;
    for (const ProbeShapeDesc &part : desc.parts) {
        ProbeShapeDesc placed = part;
        placed.position += desc.position;
        const AskedShape made = make_shape(placed).shape;
        if (const auto *circle = std::get_if<Circle>(&made))
            parts.emplace_back(*circle);
        else if (const auto *rectangle = std::get_if<Rectangle>(&made))
            parts.emplace_back(*rectangle);
        else if (const auto *turned = std::get_if<OrientedRectangle>(&made))
            parts.emplace_back(*turned);
        else
            PLUMB_CHECK(false, "a " << probe_shape_name(part.kind) << " is no part of a compound");
    }
    return Compound2(std::move(parts));
}

AskedShape make(const ProbeShapeDesc &desc, std::unique_ptr<HullMesh> &hull) {
    using Kind = ProbeShapeKind;
    const Vec3 position{desc.position};
    const Vec3 half{desc.half_extents};
    const Quat rotation = unit(Quat{desc.orientation});
    const Vec3 up = rotated(rotation, Vec3{Real(0), real(desc.half_height), Real(0)});
    switch (desc.kind) {
    case Kind::sphere:
        return Sphere{position, real(desc.radius)};
    case Kind::box:
        return Box{position, rotation, half};
    case Kind::aabb:
        return Aabb{position - half, position + half};
    case Kind::capsule:
        return Capsule{position - up, position + up, real(desc.radius)};
    case Kind::cylinder:
        return Cylinder{position - up, position + up, real(desc.radius)};
    case Kind::plane: {
        const Vec3 normal = rotated(rotation, Vec3{Real(0), Real(1), Real(0)});
        return Plane{normal, glm::dot(normal, position)};
    }
    case Kind::flat_segment:
        return Segment2{flattened(desc.points[0]), flattened(desc.points[1])};
    case Kind::segment:
        return Segment{Vec3{desc.points[0]}, Vec3{desc.points[1]}};
    case Kind::triangle:
        return Triangle{Vec3{desc.points[0]}, Vec3{desc.points[1]}, Vec3{desc.points[2]}};
    case Kind::hull: {
        std::vector<Vec3> points;
        for (const glm::dvec3 &point : desc.points)
            points.emplace_back(point);
        HullResult found = convex_hull(points, 256);
        PLUMB_CHECK(found.mesh.has_value(),
                    "these " << points.size() << " points have no solid hull");
        hull = std::make_unique<HullMesh>(std::move(*found.mesh));
        return ConvexHull{hull.get(), position, rotation};
    }
    case Kind::mesh:
        return MeshTree(make_mesh(desc));
    case Kind::height_field:
        return make_hills(desc);
    case Kind::circle:
        return Circle{flattened(desc.position), real(desc.radius)};
    case Kind::rectangle:
        return Rectangle{flattened(desc.position - desc.half_extents),
                         flattened(desc.position + desc.half_extents)};
    case Kind::oriented_rectangle:
        return oriented_rectangle(flattened(desc.position), real(desc.angle),
                                  flattened(desc.half_extents));
    case Kind::compound:
        return make_compound(desc);
    }
    PLUMB_CHECK(false, "unknown kind of shape " << static_cast<int>(desc.kind));
}

} // namespace

MadeShape make_shape(const ProbeShapeDesc &desc) {
    std::unique_ptr<HullMesh> hull;
    AskedShape shape = make(desc, hull);
    return {std::move(shape), std::move(hull)};
}

void draw_shape(ProbeAnswer &answer, const ProbeShapeDesc &desc, const MadeShape &made,
                ProbeTone tone, std::size_t number) {
    std::visit(Drawing(answer, desc, tone, number), made.shape);
}

void draw_edges(ProbeAnswer &answer, const Aabb &box, ProbeTone tone) {
    for (int axis = 0; axis < 3; ++axis)
        for (int corner = 0; corner < 4; ++corner) {
            const int u = (axis + 1) % 3;
            const int v = (axis + 2) % 3;
            Vec3 a = box.min;
            a[u] = (corner & 1) != 0 ? box.max[u] : box.min[u];
            a[v] = (corner & 2) != 0 ? box.max[v] : box.min[v];
            Vec3 b = a;
            b[axis] = box.max[axis];
            if (a != b) // a flat box has no edges across
                answer.lines.push_back({wide(a), wide(b), tone});
        }
}

} // namespace plumb::inline PLUMB_PRECISION

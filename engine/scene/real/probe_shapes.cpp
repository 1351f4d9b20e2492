#include "engine/scene/real/probe_shapes.h"

#include "engine/core/check.h"
#include "engine/geometry/quickhull.h"
#include "engine/scene/real/hull_measures.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr int circle_sides = 64;

Real real(double value) {
    return static_cast<Real>(value);
}

TriangleMesh as_mesh(const MeshDesc &mesh, const ProbeShapeDesc &placed) {
    TriangleMesh result;
    result.triangles = mesh.data->triangles;
    for (const glm::dvec3 &vertex : mesh.data->vertices)
        result.vertices.emplace_back(placed.position + placed.orientation * vertex);
    return result;
}

HeightField as_field(const HeightFieldDesc &desc, const glm::dvec3 &position) {
    HeightField field;
    field.columns = desc.columns;
    field.rows = desc.rows;
    field.spacing = real(desc.spacing);
    field.origin =
        Vec3{position - 0.5 * desc.spacing * glm::dvec3(desc.columns - 1, 0, desc.rows - 1)};
    for (const double height : *desc.heights)
        field.heights.push_back(real(height));
    return field;
}

void add_triangle(ProbeSurface &surface, const glm::dvec3 &a, const glm::dvec3 &b,
                  const glm::dvec3 &c) {
    surface.corners.insert(surface.corners.end(), {a, b, c});
}

// Draws it filled, with its border.
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

// Draws shapes that the app has no solid for.
class Drawing {
  public:
    Drawing(ProbeAnswer &answer, const ProbeShapeDesc &desc, ProbeTone tone, std::size_t number)
        : answer_(answer), desc_(desc), tone_(tone), number_(number) {}

    void operator()(const Plane &plane) const {
        // A patch of the plane, with a level side.
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
            const double angle = 2 * std::numbers::pi * i / circle_sides;
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
    void operator()(const Sphere &) const { solid(std::get<SphereDesc>(desc_.shape)); }
    void operator()(const Box &) const { solid(std::get<BoxDesc>(desc_.shape)); }
    void operator()(const Aabb &) const {
        solid(BoxDesc{std::get<AabbDesc>(desc_.shape).half_extents});
    }
    void operator()(const Capsule &) const { solid(std::get<CapsuleDesc>(desc_.shape)); }
    void operator()(const Cylinder &) const { solid(std::get<CylinderDesc>(desc_.shape)); }

  private:
    void solid(const SolidDesc &shape) const {
        answer_.solids.push_back({shape, desc_.position, desc_.orientation, tone_, number_});
    }
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

// Builds the placed shape in Real.
class Maker {
  public:
    Maker(const ProbeShapeDesc &desc, std::unique_ptr<HullMesh> &hull)
        : desc_(desc), position_(desc.position), rotation_(unit(Quat{desc.orientation})),
          hull_(hull) {}

    AskedShape operator()(const SphereDesc &s) const { return Sphere{position_, real(s.radius)}; }
    AskedShape operator()(const BoxDesc &b) const {
        return Box{position_, rotation_, Vec3{b.half_extents}};
    }
    AskedShape operator()(const AabbDesc &b) const {
        const Vec3 half{b.half_extents};
        return Aabb{position_ - half, position_ + half};
    }
    AskedShape operator()(const CapsuleDesc &c) const {
        const Vec3 up = along_y(c.half_height);
        return Capsule{position_ - up, position_ + up, real(c.radius)};
    }
    AskedShape operator()(const CylinderDesc &c) const {
        const Vec3 up = along_y(c.half_height);
        return Cylinder{position_ - up, position_ + up, real(c.radius)};
    }
    AskedShape operator()(const PlaneDesc &) const {
        const Vec3 normal = rotated(rotation_, Vec3{Real(0), Real(1), Real(0)});
        return Plane{normal, glm::dot(normal, position_)};
    }
    AskedShape operator()(const SegmentDesc &s) const {
        return Segment{Vec3{s.points[0]}, Vec3{s.points[1]}};
    }
    AskedShape operator()(const TriangleDesc &t) const {
        return Triangle{Vec3{t.points[0]}, Vec3{t.points[1]}, Vec3{t.points[2]}};
    }
    AskedShape operator()(const HullDesc &h) const {
        const std::vector<Vec3> points(h.points->begin(), h.points->end());
        HullResult found = convex_hull(points, max_hull_vertices);
        PLUMB_CHECK(found.mesh.has_value(),
                    "these " << points.size() << " points have no solid hull");
        hull_ = std::make_unique<HullMesh>(std::move(*found.mesh));
        return ConvexHull{hull_.get(), position_, rotation_};
    }
    AskedShape operator()(const MeshDesc &m) const { return MeshTree(as_mesh(m, desc_)); }
    AskedShape operator()(const HeightFieldDesc &f) const { return as_field(f, desc_.position); }
    AskedShape operator()(const FlatSegmentDesc &s) const {
        return Segment2{flattened(s.points[0]), flattened(s.points[1])};
    }
    AskedShape operator()(const FlatCompoundDesc &c) const {
        std::vector<Part2> parts;
        for (const FlatPartDesc &part : c.parts)
            std::visit(
                [&](const auto &shape) {
                    parts.emplace_back(flat(shape, part.position + desc_.position));
                },
                part.shape);
        return Compound2(std::move(parts));
    }
    // CircleDesc, RectangleDesc, OrientedRectangleDesc
    template <typename Flat> AskedShape operator()(const Flat &f) const {
        return flat(f, desc_.position);
    }

  private:
    static Circle flat(const CircleDesc &c, const glm::dvec3 &at) {
        return Circle{flattened(at), real(c.radius)};
    }
    static Rectangle flat(const RectangleDesc &r, const glm::dvec3 &at) {
        return Rectangle{flattened(at - r.half_extents), flattened(at + r.half_extents)};
    }
    static OrientedRectangle flat(const OrientedRectangleDesc &r, const glm::dvec3 &at) {
        return oriented_rectangle(flattened(at), real(r.angle), flattened(r.half_extents));
    }
    Vec3 along_y(double height) const {
        return rotated(rotation_, Vec3{Real(0), real(height), Real(0)});
    }

    const ProbeShapeDesc &desc_;
    Vec3 position_;
    Quat rotation_;
    std::unique_ptr<HullMesh> &hull_;
};

} // namespace

MadeShape make_shape(const ProbeShapeDesc &desc) {
    std::unique_ptr<HullMesh> hull;
    AskedShape shape = std::visit(Maker(desc, hull), desc.shape);
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

// What is asked of single shapes, pairs of shapes, vectors and transforms. Crowds of shapes are
// probe_crowds.cpp's.
#include "engine/scene/real/probe_answer.h"

#include "engine/core/check.h"
#include "engine/geometry/closest_point.h"
#include "engine/geometry/closest_point_2d.h"
#include "engine/geometry/contains.h"
#include "engine/geometry/contains_2d.h"
#include "engine/geometry/enclosing_2d.h"
#include "engine/geometry/epa.h"
#include "engine/geometry/gjk.h"
#include "engine/geometry/manifold.h"
#include "engine/geometry/manifold_convex.h"
#include "engine/geometry/overlap.h"
#include "engine/geometry/overlap_2d.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/shape_cast.h"
#include "engine/geometry/triangle.h"
#include "engine/geometry/triangle_overlap.h"
#include "engine/math/matrices.h"
#include "engine/math/rigid.h"
#include "engine/math/vectors.h"
#include "engine/scene/real/probe_asking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr double in_degrees = 180 / std::numbers::pi;

std::string_view kind_name(const ProbeShapeDesc &shape) {
    return probe_shape_name(shape.kind);
}

// The half-space behind a plane and the box that an Aabb is, for the question about contacts.
template <typename Asked> const Asked &as_solid(const Asked &shape) {
    return shape;
}
HalfSpace as_solid(const Plane &plane) {
    return {plane.normal, plane.offset};
}
Box as_solid(const Aabb &box) {
    return {Real(0.5) * (box.min + box.max), identity_rotation, Real(0.5) * (box.max - box.min)};
}

// ---- vectors and transforms ----

// The name stands at the head; that of a thin one in the middle.
void arrow(ProbeAnswer &answer, const Vec3 &from, const Vec3 &vector, ProbeTone tone,
           const std::string &name, bool is_thick = true) {
    if (vector == Vec3{Real(0)})
        return;
    answer.lines.push_back({wide(from), wide(from + vector), tone, true, is_thick});
    if (!name.empty())
        answer.labels.push_back({wide(from + (is_thick ? Real(1) : Real(0.5)) * vector), name});
}

void answer_vectors(Asking &ask) {
    const Vec3 at{ask.probe.points[0]};
    const Vec3 a = Vec3{ask.probe.points[1]} - at;
    const Vec3 b = Vec3{ask.probe.points[2]} - at;
    const Vec3 along = projection<3>(a, b);
    const Vec3 off = rejection(a, b);
    const Vec3 mirrored = reflection<3>(a, b);
    const Vec3 across = accurate_cross(a, b);
    arrow(ask.answer, at, a, ProbeTone::query, "a");
    arrow(ask.answer, at, b, ProbeTone::axis, "b");
    arrow(ask.answer, at, along, ProbeTone::result, "projection", false);
    arrow(ask.answer, at + along, off, ProbeTone::yes, "rejection", false);
    arrow(ask.answer, at, mirrored, ProbeTone::normal, "reflection", false);
    const Real size = glm::length(across);
    if (size > Real(0))
        arrow(ask.answer, at, across / std::sqrt(size), ProbeTone::no, "a x b");
    ask.answer.lines.push_back({wide(at + a), wide(at + mirrored), ProbeTone::faint});
    ask.number("dot", glm::dot(a, b));
    ask.number("angle_deg", angle_between(a, b) * in_degrees);
    ask.number("projection", glm::length(along));
    ask.number("rejection", glm::length(off));
    ask.number("cross", size);
    // A mirror image is as long as what is mirrored.
    ask.number("reflection_error", glm::length(mirrored) - glm::length(a));
}

void answer_basis(Asking &ask) {
    const Vec3 at{ask.probe.points[0]};
    Mat3 given{Real(0)};
    for (int i = 0; i < 3; ++i) {
        given[i] = Vec3{ask.probe.points[static_cast<std::size_t>(i) + 1]} - at;
        arrow(ask.answer, at, given[i], ProbeTone::query, std::to_string(i + 1), false);
    }
    ask.number("determinant", glm::determinant(given));
    const std::optional<Mat3> made = orthonormalized(given);
    ask.flag("independent", made.has_value());
    if (!made)
        return;
    constexpr std::array tones{ProbeTone::result, ProbeTone::yes, ProbeTone::normal};
    for (int i = 0; i < 3; ++i)
        arrow(ask.answer, at, Real(1.5) * (*made)[i], tones[static_cast<std::size_t>(i)],
              std::to_string(i + 1) + "'");
    ask.number("orthonormal_determinant", glm::determinant(*made));
}

void answer_transform(Asking &ask) {
    const ProbeShapeDesc &shape = ask.probe.shapes.front();
    PLUMB_CHECK(shape.kind == ProbeShapeKind::box,
                "a transform is shown on a box, not a " << kind_name(shape));
    const ScaledTransform made{Vec3{shape.position}, Quat{shape.orientation},
                               Vec3{ask.probe.scale}};
    const Mat4 matrix = to_matrix(made);
    const Vec3 local{ask.probe.points.front()};
    const auto through = [](const Mat4 &m, const Vec3 &p) { return Vec3{m * Vec4{p, Real(1)}}; };
    const Vec3 world = through(matrix, local);
    // The shape's frame, and where its corners go.
    constexpr std::array tones{ProbeTone::result, ProbeTone::yes, ProbeTone::normal};
    constexpr std::array names{"x", "y", "z"};
    for (int i = 0; i < 3; ++i) {
        Vec3 axis{Real(0)};
        axis[i] = Real(1);
        const auto index = static_cast<std::size_t>(i);
        arrow(ask.answer, Vec3{Real(0)}, axis, tones[index], "", false);
        arrow(ask.answer, made.position, through(matrix, axis) - made.position, tones[index],
              names[index]);
    }
    const Vec3 half{shape.half_extents};
    const std::size_t first = ask.answer.lines.size();
    draw_edges(ask.answer, {-half, half}, ProbeTone::edge);
    for (std::size_t i = first, end = ask.answer.lines.size(); i < end; ++i) {
        ProbeLine line = ask.answer.lines[i];
        line.a = wide(through(matrix, Vec3{line.a}));
        line.b = wide(through(matrix, Vec3{line.b}));
        line.tone = ProbeTone::axis;
        ask.answer.lines.push_back(line);
    }
    ask.answer.points.push_back({wide(local), ProbeTone::query});
    ask.answer.points.push_back({wide(world), ProbeTone::axis});
    ask.answer.lines.push_back({wide(local), wide(world), ProbeTone::faint, true});
    ask.vector(wide(world));
    ask.number("determinant", glm::determinant(Mat3{matrix}));
    if (const std::optional<Mat4> back = try_inverse(matrix))
        ask.number("there_and_back", glm::distance(through(*back, world), local));
    if (const std::optional<ScaledTransform> parts = decompose(matrix)) {
        const EulerAngles angles = euler_angles(parts->rotation);
        ask.number("yaw_deg", angles.yaw * in_degrees);
        ask.number("pitch_deg", angles.pitch * in_degrees);
        ask.number("roll_deg", angles.roll * in_degrees);
        ask.number("scale_x", parts->scale.x);
        ask.number("scale_y", parts->scale.y);
        ask.number("scale_z", parts->scale.z);
    }
}

// One of a matrix's tables: its rows as values, and as labels from a place on.
void show_entries(Asking &ask, const std::string &name, std::size_t first, const Mat3 &entries,
                  const glm::dvec3 &at) {
    constexpr double column_width = 0.62;
    constexpr double row_height = 0.4;
    ask.answer.labels.push_back({at, name});
    const std::vector<std::string_view> &names = probe_question(ProbeQuestion::matrix).values;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            // A zero whose sign was turned is shown as zero.
            const double entry = static_cast<double>(entries[column][row]) + 0.0;
            ask.answer.values.push_back({names[first + static_cast<std::size_t>(3 * row + column)],
                                         entry, ProbeValue::Form::entry});
            ask.label(at + glm::dvec3(column_width * column, -row_height * (row + 1), 0), entry);
        }
}

void answer_matrix(Asking &ask) {
    const Vec3 at{ask.probe.points[0]};
    Mat3 given{Real(0)};
    constexpr std::array tones{ProbeTone::result, ProbeTone::yes, ProbeTone::normal};
    for (std::size_t i = 0; i < 3; ++i) {
        const int column = static_cast<int>(i);
        given[column] = Vec3{ask.probe.points[i + 1]} - at;
        arrow(ask.answer, at, given[column], tones[i], std::to_string(i + 1));
    }
    // Where the unit cube goes: its volume is the determinant's magnitude.
    const std::size_t first = ask.answer.lines.size();
    draw_edges(ask.answer, {Vec3{Real(0)}, Vec3{Real(1)}}, ProbeTone::edge);
    double right = ask.probe.points[0].x;
    for (std::size_t i = first; i < ask.answer.lines.size(); ++i) {
        ProbeLine &line = ask.answer.lines[i];
        line.a = wide(at + given * Vec3{line.a});
        line.b = wide(at + given * Vec3{line.b});
        right = std::max({right, line.a.x, line.b.x});
    }
    const std::optional<Mat3> inverse = try_inverse(given);
    ask.number("determinant", glm::determinant(given));
    ask.flag("invertible", inverse.has_value());
    // The tables stand to the right of the picture, in a row.
    const auto table_at = [&](int table) {
        return glm::dvec3(right + 0.5 + 2.3 * table, ask.probe.points[0].y + 1.2,
                          ask.probe.points[0].z);
    };
    show_entries(ask, "minors", 2, minors(given), table_at(0));
    show_entries(ask, "cofactors", 11, cofactors(given), table_at(1));
    show_entries(ask, "adjugate", 20, adjugate(given), table_at(2));
    if (inverse)
        show_entries(ask, "inverse", 29, *inverse, table_at(3));
    else
        ask.answer.labels.push_back({table_at(3), "singular: no inverse"});
}

// ---- points ----

template <typename Asked> bool holds(const Asked &shape, const glm::dvec3 &point) {
    if constexpr (requires { contains(shape, flattened(point)); })
        return contains(shape, flattened(point));
    else if constexpr (requires { contains(shape, Vec3{point}); })
        return contains(shape, Vec3{point});
    else
        PLUMB_CHECK(false, "this kind of shape is not asked what it contains");
}

void answer_contains(Asking &ask) {
    std::vector<bool> any(ask.probe.points.size(), false);
    for (std::size_t s = 0; s < ask.shapes.size(); ++s) {
        ask.draw(s, ProbeTone::plain);
        for (std::size_t p = 0; p < ask.probe.points.size(); ++p)
            any[p] =
                any[p] ||
                std::visit([&](const auto &shape) { return holds(shape, ask.probe.points[p]); },
                           ask.shapes[s].shape);
    }
    std::size_t inside = 0;
    for (std::size_t p = 0; p < any.size(); ++p) {
        inside += any[p] ? 1 : 0;
        ask.answer.points.push_back({ask.probe.points[p], any[p] ? ProbeTone::yes : ProbeTone::no});
    }
    ask.count("inside", inside);
}

template <typename Asked> glm::dvec3 nearest(const Asked &shape, const glm::dvec3 &point) {
    if constexpr (requires { closest_point(shape, flattened(point)); })
        return wide(closest_point(shape, flattened(point)));
    else if constexpr (requires { closest_point(shape, Vec3{point}); })
        return wide(closest_point(shape, Vec3{point}));
    else
        PLUMB_CHECK(false, "this kind of shape is not asked for its closest point");
}

void answer_closest(Asking &ask) {
    double least = std::numeric_limits<double>::infinity();
    glm::dvec3 best{0};
    for (std::size_t s = 0; s < ask.shapes.size(); ++s) {
        ask.draw(s, ProbeTone::plain);
        for (const glm::dvec3 &point : ask.probe.points) {
            const glm::dvec3 found = std::visit(
                [&](const auto &shape) { return nearest(shape, point); }, ask.shapes[s].shape);
            const double away = glm::distance(found, point);
            ask.answer.lines.push_back({point, found, ProbeTone::result});
            ask.answer.points.push_back({found, ProbeTone::result});
            if (away > 0)
                ask.label(0.5 * (point + found), away);
            if (away < least) {
                least = away;
                best = found;
            }
        }
    }
    for (const glm::dvec3 &point : ask.probe.points)
        ask.answer.points.push_back({point, ProbeTone::query});
    ask.number("distance", least);
    ask.vector(best);
}

// ---- pairs ----

template <typename A, typename B> std::optional<bool> common(const A &a, const B &b) {
    if constexpr (requires { overlaps(a, b); })
        return overlaps(a, b);
    else if constexpr (requires { overlaps(b, a); })
        return overlaps(b, a);
    else
        return std::nullopt;
}

void draw_axis(ProbeAnswer &answer, const glm::dvec3 &a, const glm::dvec3 &b,
               const glm::dvec3 &normal, double separation, const std::string &text) {
    // Both shapes as they lie along the axis are apart by the separation, about the middle.
    const glm::dvec3 middle = 0.5 * (a + b);
    answer.lines.push_back({middle - 2.5 * normal, middle + 2.5 * normal, ProbeTone::axis});
    answer.lines.push_back({middle - 0.5 * separation * normal, middle + 0.5 * separation * normal,
                            ProbeTone::result, separation > 0, true});
    answer.labels.push_back({middle + 2.5 * normal, text});
}

void answer_overlap(Asking &ask) {
    const std::size_t count = ask.shapes.size();
    std::vector<bool> touched(count, false);
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = i + 1; j < count; ++j) {
            const std::optional<bool> found =
                std::visit([](const auto &a, const auto &b) { return common(a, b); },
                           ask.shapes[i].shape, ask.shapes[j].shape);
            PLUMB_CHECK(found.has_value(), "there is no test of "
                                               << kind_name(ask.probe.shapes[i]) << " with "
                                               << kind_name(ask.probe.shapes[j]));
            if (*found) {
                touched[i] = touched[j] = true;
                ++pairs;
            }
        }
    for (std::size_t i = 0; i < count; ++i)
        ask.draw(i, touched[i] ? ProbeTone::yes : ProbeTone::plain);
    ask.flag("overlap", pairs > 0);
    ask.count("pairs", pairs);
    if (count != 2)
        return;
    const glm::dvec3 &at_a = ask.probe.shapes[0].position;
    const glm::dvec3 &at_b = ask.probe.shapes[1].position;
    const AskedShape &a = ask.shapes[0].shape;
    const AskedShape &b = ask.shapes[1].shape;
    constexpr std::array names{"a face of A", "a face of B", "two edges"};
    if (const auto *box_a = std::get_if<Box>(&a), *box_b = std::get_if<Box>(&b); box_a && box_b) {
        const SatResult sat = separating_axis(*box_a, *box_b);
        ask.number("separation", sat.separation);
        draw_axis(ask.answer, at_a, at_b, wide(sat.normal), static_cast<double>(sat.separation),
                  std::string("axis of ") + names[static_cast<std::size_t>(sat.axis)]);
    }
    const auto *flat_a = std::get_if<OrientedRectangle>(&a);
    const auto *flat_b = std::get_if<OrientedRectangle>(&b);
    if (flat_a && flat_b) {
        const SatResult2 sat = separating_axis(*flat_a, *flat_b);
        ask.number("separation", sat.separation);
        draw_axis(ask.answer, at_a, at_b, wide(sat.normal), static_cast<double>(sat.separation),
                  sat.axis < 2 ? "axis of A" : "axis of B");
    }
}

const Plane &plane_of(const Asking &ask, std::size_t index) {
    const auto *plane = std::get_if<Plane>(&ask.shapes[index].shape);
    PLUMB_CHECK(plane,
                "a " << kind_name(ask.probe.shapes[index]) << " stands where a plane is due");
    return *plane;
}

void answer_classify(Asking &ask) {
    const Plane &plane = plane_of(ask, 0);
    ask.draw(0, ProbeTone::axis);
    std::array<std::size_t, 3> sides{};
    double last = 0;
    for (std::size_t s = 1; s < ask.shapes.size(); ++s) {
        const PlaneTest test = std::visit(
            [&](const auto &shape) -> PlaneTest {
                if constexpr (requires { classify(plane, shape); })
                    return classify(plane, shape);
                else
                    PLUMB_CHECK(false, "there is no classifying of this kind of shape");
            },
            ask.shapes[s].shape);
        constexpr std::array tones{ProbeTone::no, ProbeTone::partly, ProbeTone::yes};
        constexpr std::array words{"behind ", "across", "in front "};
        const auto side = static_cast<std::size_t>(test.side);
        ++sides[side];
        ask.draw(s, tones[side]);
        last = static_cast<double>(test.distance);
        const ProbeShapeDesc &desc = ask.probe.shapes[s];
        glm::dvec3 at = desc.position;
        if (!desc.points.empty()) {
            at = glm::dvec3(0);
            for (const glm::dvec3 &point : desc.points)
                at += point / static_cast<double>(desc.points.size());
        }
        ask.answer.labels.push_back(
            {at, words[side] + (test.side == PlaneSide::across ? "" : short_number(last))});
    }
    ask.count("in_front", sides[2]);
    ask.count("across", sides[1]);
    ask.count("behind", sides[0]);
    ask.number("distance", last);
}

void answer_planes(Asking &ask) {
    for (std::size_t s = 0; s < ask.shapes.size(); ++s)
        ask.draw(s, ProbeTone::plain);
    const auto draw_line = [&](const std::optional<Line> &line, bool is_answer) {
        if (!line)
            return;
        // The part about the planes' own middle.
        glm::dvec3 middle{0};
        for (const ProbeShapeDesc &shape : ask.probe.shapes)
            middle += shape.position / static_cast<double>(ask.probe.shapes.size());
        const glm::dvec3 along = wide(line->direction);
        const glm::dvec3 from = wide(line->point);
        const glm::dvec3 foot = from + glm::dot(middle - from, along) * along;
        ask.answer.lines.push_back({foot - 3.0 * along, foot + 3.0 * along,
                                    is_answer ? ProbeTone::result : ProbeTone::axis, false, true});
    };
    if (ask.shapes.size() == 2) {
        const std::optional<Line> line = intersection(plane_of(ask, 0), plane_of(ask, 1));
        draw_line(line, true);
        ask.flag("meet", line.has_value());
        if (line)
            ask.vector(wide(line->point));
        return;
    }
    for (std::size_t i = 0; i < 3; ++i)
        draw_line(intersection(plane_of(ask, i), plane_of(ask, (i + 1) % 3)), false);
    const std::optional<Vec3> point =
        intersection(plane_of(ask, 0), plane_of(ask, 1), plane_of(ask, 2));
    ask.flag("meet", point.has_value());
    if (!point)
        return;
    ask.answer.points.push_back({wide(*point), ProbeTone::result});
    ask.vector(wide(*point));
}

// ---- rays ----

void answer_raycast(Asking &ask) {
    const ProbeRayDesc &ray = *ask.probe.ray;
    const glm::dvec3 direction = ray.end ? *ray.end - ray.origin : ray.direction;
    const double max_t =
        ray.end ? 1.0 : ray.max_t.value_or(std::numeric_limits<double>::infinity());
    std::optional<RayFound> first;
    std::size_t hits = 0;
    double farthest = 0;
    for (std::size_t s = 0; s < ask.shapes.size(); ++s) {
        const std::optional<RayFound> found = ray_into(ask.shapes[s].shape, ray);
        ask.draw(s, found ? ProbeTone::plain : ProbeTone::no);
        if (!found)
            continue;
        ++hits;
        const auto place = [&](double t) { return ray.origin + t * direction; };
        farthest = std::max(farthest, found->t_exit.value_or(found->t));
        if (found->t_exit && *found->t_exit > found->t) {
            ask.answer.lines.push_back(
                {place(found->t), place(*found->t_exit), ProbeTone::result, false, true});
            ask.answer.points.push_back({place(*found->t_exit), ProbeTone::result});
        }
        ask.answer.points.push_back({found->point, ProbeTone::result, found->normal});
        if (!first || found->t < first->t)
            first = found;
    }
    const double length = glm::length(direction);
    const double shown = std::isfinite(max_t) ? max_t
                         : hits > 0           ? farthest + 1.5 / length
                                              : std::max(1.0, 8.0 / length);
    const glm::dvec3 end = ray.origin + shown * direction;
    ask.answer.lines.push_back(
        {ray.origin, end, first ? ProbeTone::query : ProbeTone::no, !ray.end});
    if (first)
        ask.answer.labels.push_back({first->point, "t " + short_number(first->t)});
    ask.flag("hit", first.has_value());
    ask.count("hits", hits);
    if (!first)
        return;
    ask.number("t", first->t);
    if (first->t_exit)
        ask.number("t_exit", *first->t_exit);
    ask.flag("starts_inside", first->starts_inside);
    ask.vector(first->point);
    ask.normal(first->normal);
}

// ---- convex pairs ----

void answer_distance(Asking &ask) {
    const ClosestPoints found = std::visit(
        [](const auto &a, const auto &b) -> ClosestPoints {
            if constexpr (requires { distance(a, b).on_a; })
                return distance(a, b);
            else
                PLUMB_CHECK(false, "both shapes must be convex, and of space");
        },
        ask.shapes[0].shape, ask.shapes[1].shape);
    const bool overlap = found.distance == Real(0);
    for (std::size_t s = 0; s < 2; ++s)
        ask.draw(s, overlap ? ProbeTone::yes : ProbeTone::plain);
    ask.number("distance", found.distance);
    ask.flag("overlap", overlap);
    ask.count("iterations", static_cast<std::size_t>(found.iterations));
    ask.answer.points.push_back({wide(found.on_a), ProbeTone::result});
    ask.answer.points.push_back({wide(found.on_b), ProbeTone::result});
    ask.answer.lines.push_back(
        {wide(found.on_a), wide(found.on_b), ProbeTone::result, false, true});
    if (!overlap)
        ask.label(0.5 * wide(found.on_a + found.on_b), static_cast<double>(found.distance));
}

void answer_penetration(Asking &ask) {
    const auto found = std::visit(
        [](const auto &a, const auto &b) -> std::optional<Penetration> {
            if constexpr (requires { penetration(a, b); })
                return penetration(a, b);
            else
                PLUMB_CHECK(false, "both shapes must be convex, and of space");
        },
        ask.shapes[0].shape, ask.shapes[1].shape);
    ask.flag("overlap", found.has_value());
    for (std::size_t s = 0; s < 2; ++s)
        ask.draw(s, found ? ProbeTone::yes : ProbeTone::plain);
    if (!found)
        return;
    ask.number("depth", found->depth);
    ask.normal(wide(found->normal));
    ask.answer.points.push_back({wide(found->on_a), ProbeTone::result});
    ask.answer.points.push_back({wide(found->on_b), ProbeTone::result});
    ask.answer.lines.push_back(
        {wide(found->on_a), wide(found->on_b), ProbeTone::result, false, true});
    // Where B would have to be to touch only.
    const glm::dvec3 at = ask.probe.shapes[1].position;
    const glm::dvec3 out = wide(found->depth * found->normal);
    ask.answer.lines.push_back({at, at + out, ProbeTone::normal, true, true});
    ask.label(at + out, static_cast<double>(found->depth));
}

// Contact points joined around their middle.
void draw_outline(ProbeAnswer &answer, std::vector<glm::dvec3> points, const glm::dvec3 &normal) {
    if (points.size() < 2)
        return;
    glm::dvec3 middle{0};
    for (const glm::dvec3 &point : points)
        middle += point / static_cast<double>(points.size());
    const glm::dvec3 first = points.front() - middle;
    const glm::dvec3 across = glm::cross(normal, first);
    const auto angle = [&](const glm::dvec3 &point) {
        return std::atan2(glm::dot(point - middle, across), glm::dot(point - middle, first));
    };
    std::ranges::stable_sort(points, {}, angle);
    for (std::size_t i = 0; i < points.size(); ++i)
        answer.lines.push_back(
            {points[i], points[(i + 1) % points.size()], ProbeTone::result, false, true});
}

void answer_collide(Asking &ask) {
    const Real margin = static_cast<Real>(ask.probe.margin);
    const Manifold manifold = std::visit(
        [&](const auto &a, const auto &b) -> Manifold {
            const auto &solid_a = as_solid(a);
            const auto &solid_b = as_solid(b);
            if constexpr (requires { collide(solid_a, solid_b, margin); })
                return collide(solid_a, solid_b, margin);
            else if constexpr (requires { collide_pair(solid_a, solid_b, margin); })
                return collide_pair(solid_a, solid_b, margin);
            else if constexpr (requires { collide_pair(solid_b, solid_a, margin); })
                return mirrored(collide_pair(solid_b, solid_a, margin));
            else
                PLUMB_CHECK(false, "there are no contact points of these two kinds of shapes");
        },
        ask.shapes[0].shape, ask.shapes[1].shape);
    Real deepest = std::numeric_limits<Real>::infinity();
    std::vector<glm::dvec3> outline;
    for (int i = 0; i < manifold.count; ++i) {
        const ManifoldPoint &point = manifold.points[static_cast<std::size_t>(i)];
        deepest = std::min(deepest, point.separation);
        const glm::dvec3 at = wide(point.position);
        outline.push_back(at);
        ask.answer.points.push_back({at, ProbeTone::result, 0.6 * wide(manifold.normal)});
    }
    draw_outline(ask.answer, std::move(outline), wide(manifold.normal));
    for (std::size_t s = 0; s < 2; ++s)
        ask.draw(s, manifold.count > 0 && deepest <= Real(0) ? ProbeTone::yes : ProbeTone::plain);
    ask.count("points", static_cast<std::size_t>(manifold.count));
    if (manifold.count == 0)
        return;
    ask.number("depth", -deepest);
    ask.normal(wide(manifold.normal));
}

void answer_cast(Asking &ask) {
    const Vec3 motion{ask.probe.motion};
    const std::optional<CastHit> hit = std::visit(
        [&](const auto &a, const auto &b) -> std::optional<CastHit> {
            if constexpr (requires { cast(a, motion, b).has_value(); })
                return cast(a, motion, b);
            else
                PLUMB_CHECK(false, "both shapes must be convex, and of space");
        },
        ask.shapes[0].shape, ask.shapes[1].shape);
    // Where it starts, and where it gets.
    const ProbeShapeDesc &from = ask.probe.shapes[0];
    const double t = hit ? static_cast<double>(hit->t) : 1;
    ProbeShapeDesc there = from;
    there.position += t * ask.probe.motion;
    for (glm::dvec3 &point : there.points)
        if (from.kind != ProbeShapeKind::hull)
            point += t * ask.probe.motion;
    ask.draw(0, ProbeTone::no);
    draw_shape(ask.answer, there, make_shape(there), hit ? ProbeTone::yes : ProbeTone::plain, 0);
    ask.draw(1, ProbeTone::plain);
    ask.answer.lines.push_back(
        {from.position, from.position + ask.probe.motion, ProbeTone::query, true});
    ask.flag("hit", hit.has_value());
    if (!hit)
        return;
    ask.number("t", t);
    ask.normal(wide(hit->normal));
    ask.answer.points.push_back({wide(hit->point), ProbeTone::result, wide(hit->normal)});
    ask.answer.labels.push_back({there.position, "t " + short_number(t)});
}

// ---- enclosing ----

void answer_enclose(Asking &ask) {
    std::vector<Vec2> points;
    for (const glm::dvec3 &point : ask.probe.points)
        points.push_back(flattened(point));
    if (ask.probe.scatter)
        for (const glm::dvec3 &point : scattered_points(*ask.probe.scatter))
            points.push_back(flattened(point));
    const Circle circle = containing_circle(points);
    const Rectangle rectangle = containing_rectangle(points);
    ProbeShapeDesc round;
    round.kind = ProbeShapeKind::circle;
    draw_shape(ask.answer, round, {circle, nullptr}, ProbeTone::yes, 0);
    draw_shape(ask.answer, round, {rectangle, nullptr}, ProbeTone::plain, 0);
    for (const Vec2 &point : points)
        ask.answer.points.push_back({wide(point), ProbeTone::query, {}, true});
    ask.answer.points.push_back({wide(circle.center), ProbeTone::result});
    ask.number("radius", circle.radius);
    ask.number("x", circle.center.x);
    ask.number("y", circle.center.y);
    ask.number("width", rectangle.max.x - rectangle.min.x);
    ask.number("height", rectangle.max.y - rectangle.min.y);
}

} // namespace

ProbeAnswer answer_probe(const ProbeDesc &probe) {
    Asking ask(probe);
    switch (probe.question) {
    case ProbeQuestion::vectors:
        answer_vectors(ask);
        break;
    case ProbeQuestion::basis:
        answer_basis(ask);
        break;
    case ProbeQuestion::transform:
        answer_transform(ask);
        break;
    case ProbeQuestion::matrix:
        answer_matrix(ask);
        break;
    case ProbeQuestion::contains:
        answer_contains(ask);
        break;
    case ProbeQuestion::closest:
        answer_closest(ask);
        break;
    case ProbeQuestion::overlap:
        answer_overlap(ask);
        break;
    case ProbeQuestion::classify:
        answer_classify(ask);
        break;
    case ProbeQuestion::planes:
        answer_planes(ask);
        break;
    case ProbeQuestion::raycast:
        answer_raycast(ask);
        break;
    case ProbeQuestion::distance:
        answer_distance(ask);
        break;
    case ProbeQuestion::penetration:
        answer_penetration(ask);
        break;
    case ProbeQuestion::collide:
        answer_collide(ask);
        break;
    case ProbeQuestion::cast:
        answer_cast(ask);
        break;
    case ProbeQuestion::enclose:
        answer_enclose(ask);
        break;
    case ProbeQuestion::tree:
        answer_tree(ask);
        break;
    case ProbeQuestion::models:
        answer_models(ask);
        break;
    case ProbeQuestion::frustum:
        answer_frustum(ask);
        break;
    case ProbeQuestion::cull:
        answer_cull(ask);
        break;
    case ProbeQuestion::pick:
        answer_pick(ask);
        break;
    }
    return std::move(ask.answer);
}

} // namespace plumb::inline PLUMB_PRECISION

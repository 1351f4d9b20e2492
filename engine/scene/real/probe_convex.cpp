// Probes of two convex shapes: distance, penetration, contacts, and the time of impact of a moving
// one.
#include "engine/scene/real/probe_asking.h"

#include "engine/core/check.h"
#include "engine/geometry/epa.h"
#include "engine/geometry/gjk.h"
#include "engine/geometry/manifold.h"
#include "engine/geometry/shape_cast.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// A plane as its half-space and an Aabb as a box, for contact queries.
template <typename Asked> const Asked &as_solid(const Asked &shape) {
    return shape;
}
HalfSpace as_solid(const Plane &plane) {
    return {plane.normal, plane.offset};
}
Box as_solid(const Aabb &box) {
    return {Real(0.5) * (box.min + box.max), identity_rotation, Real(0.5) * (box.max - box.min)};
}

// Connects contact points in order around their middle.
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

} // namespace

void answer_distance(Asking &ask) {
    const ClosestPoints found = std::visit(
        [](const auto &a, const auto &b) -> ClosestPoints {
            if constexpr (requires { distance(a, b).on_a; })
                return distance(a, b);
            else
                PLUMB_CHECK(false, "both shapes must be convex and 3D");
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
                PLUMB_CHECK(false, "both shapes must be convex and 3D");
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
    // Where B would only just touch.
    const glm::dvec3 at = ask.probe.shapes[1].position;
    const glm::dvec3 out = wide(found->depth * found->normal);
    ask.answer.lines.push_back({at, at + out, ProbeTone::normal, true, true});
    ask.label(at + out, static_cast<double>(found->depth));
}

void answer_collide(Asking &ask) {
    const Real margin = static_cast<Real>(ask.probe.margin);
    const Manifold manifold = std::visit(
        [&](const auto &a, const auto &b) -> Manifold {
            const auto &solid_a = as_solid(a);
            const auto &solid_b = as_solid(b);
            if constexpr (requires { collide(solid_a, solid_b, margin); })
                return collide(solid_a, solid_b, margin);
            else
                PLUMB_CHECK(false, "these two kinds of shapes have no contact points");
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
                PLUMB_CHECK(false, "both shapes must be convex and 3D");
        },
        ask.shapes[0].shape, ask.shapes[1].shape);
    // Its start and where it ends up.
    const ProbeShapeDesc &from = ask.probe.shapes[0];
    const double t = hit ? static_cast<double>(hit->t) : 1;
    ProbeShapeDesc there = from;
    there.position += t * ask.probe.motion;
    std::visit(
        [&](auto &shape) { // shapes placed by their points
            if constexpr (requires { shape.points.size(); })
                for (glm::dvec3 &point : shape.points)
                    point += t * ask.probe.motion;
        },
        there.shape);
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

} // namespace plumb::inline PLUMB_PRECISION

// Point probes: containment in shapes, closest points on shapes, enclosing volumes.
#include "engine/scene/real/probe_asking.h"

#include "engine/core/check.h"
#include "engine/geometry/closest_point.h"
#include "engine/geometry/closest_point_2d.h"
#include "engine/geometry/contains.h"
#include "engine/geometry/contains_2d.h"
#include "engine/geometry/enclosing_2d.h"
#include "engine/geometry/height_field.h"
#include "engine/geometry/hull_queries.h"
#include "engine/geometry/triangle.h"
#include "engine/space/mesh_tree.h"

#include <limits>

namespace plumb::inline PLUMB_PRECISION {

namespace {

template <typename Asked> bool holds(const Asked &shape, const glm::dvec3 &point) {
    if constexpr (requires { contains(shape, flattened(point)); })
        return contains(shape, flattened(point));
    else if constexpr (requires { contains(shape, Vec3{point}); })
        return contains(shape, Vec3{point});
    else
        PLUMB_CHECK(false, "this kind of shape has no containment test");
}

template <typename Asked> glm::dvec3 nearest(const Asked &shape, const glm::dvec3 &point) {
    if constexpr (requires { closest_point(shape, flattened(point)); })
        return wide(closest_point(shape, flattened(point)));
    else if constexpr (requires { closest_point(shape, Vec3{point}); })
        return wide(closest_point(shape, Vec3{point}));
    else
        PLUMB_CHECK(false, "this kind of shape has no closest point");
}

} // namespace

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
    round.shape = CircleDesc{};
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

} // namespace plumb::inline PLUMB_PRECISION

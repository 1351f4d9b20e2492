// Ray and segment probes.
#include "engine/scene/real/probe_asking.h"

#include "engine/core/check.h"
#include "engine/geometry/height_field.h"
#include "engine/geometry/hull_queries.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/raycast_2d.h"
#include "engine/space/mesh_tree.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Casts the ray as the kind a shape needs: in space, or in the plane.
class RayInto {
  public:
    explicit RayInto(const ProbeRayDesc &ray)
        : origin_(ray.origin), end_(ray.end),
          direction_(ray.end ? *ray.end - ray.origin : ray.direction),
          max_t_(ray.end     ? Real(1)
                 : ray.max_t ? static_cast<Real>(*ray.max_t)
                             : std::numeric_limits<Real>::infinity()) {}

    template <typename Asked> std::optional<RayFound> operator()(const Asked &shape) const {
        // A zero-length segment is a point: the segment test handles it, rays do not.
        if (end_ && *end_ == origin_)
            return point_into(shape);
        const Ray ray{Vec3{origin_}, Vec3{direction_}, max_t_};
        if constexpr (std::same_as<Asked, MeshTree>) {
            const std::optional<MeshHit> hit = raycast(shape, ray);
            return hit ? std::optional(RayFound{static_cast<double>(hit->t),
                                                {},
                                                wide(hit->point),
                                                wide(hit->normal),
                                                false})
                       : std::nullopt;
        } else if constexpr (std::same_as<Asked, Plane> || std::same_as<Asked, Triangle> ||
                             std::same_as<Asked, HeightField>) {
            return from_hit(raycast(shape, ray));
        } else if constexpr (std::same_as<Asked, Segment2> || std::same_as<Asked, Compound2>) {
            return from_hit(raycast(shape, flat_ray()));
        } else if constexpr (requires { ray_interval(shape, ray); }) {
            return from_interval(ray_interval(shape, ray));
        } else if constexpr (requires { ray_interval(shape, flat_ray()); }) {
            return from_interval(ray_interval(shape, flat_ray()));
        } else {
            PLUMB_CHECK(false, "this kind of shape has no raycast");
        }
    }

  private:
    Ray2 flat_ray() const { return {flattened(origin_), flattened(direction_), max_t_}; }

    template <typename Asked> std::optional<RayFound> point_into(const Asked &shape) const {
        bool is_in = false;
        if constexpr (requires { linetest(shape, Vec3{origin_}, Vec3{origin_}); })
            is_in = linetest(shape, Vec3{origin_}, Vec3{origin_});
        else if constexpr (requires { linetest(shape, flattened(origin_), flattened(origin_)); })
            is_in = linetest(shape, flattened(origin_), flattened(origin_));
        else
            PLUMB_CHECK(false, "this kind of shape has no segment test");
        return is_in ? std::optional(RayFound{0, {}, origin_, {}, true}) : std::nullopt;
    }

    template <typename Hit> std::optional<RayFound> from_hit(const std::optional<Hit> &hit) const {
        if (!hit)
            return std::nullopt;
        return RayFound{static_cast<double>(hit->t),
                        {},
                        wide(hit->point),
                        wide(hit->normal),
                        hit->starts_inside};
    }
    template <typename Interval>
    std::optional<RayFound> from_interval(const std::optional<Interval> &inside) const {
        if (!inside)
            return std::nullopt;
        const auto t = static_cast<double>(inside->t_enter);
        const glm::dvec3 normal = wide(inside->enter_normal);
        return RayFound{t, static_cast<double>(inside->t_exit), origin_ + t * direction_, normal,
                        normal == glm::dvec3(0)};
    }

    glm::dvec3 origin_;
    std::optional<glm::dvec3> end_;
    glm::dvec3 direction_;
    Real max_t_;
};

} // namespace

std::optional<RayFound> ray_into(const AskedShape &shape, const ProbeRayDesc &ray) {
    return std::visit(RayInto(ray), shape);
}

Ray ray_of(const ProbeRayDesc &ray) {
    if (ray.end)
        return {Vec3{ray.origin}, Vec3{*ray.end - ray.origin}, Real(1)};
    return {Vec3{ray.origin}, Vec3{ray.direction},
            ray.max_t ? static_cast<Real>(*ray.max_t) : std::numeric_limits<Real>::infinity()};
}

void draw_ray(Asking &ask, const ProbeRayDesc &ray, std::optional<double> hit_t) {
    const glm::dvec3 direction = ray.end ? *ray.end - ray.origin : ray.direction;
    const double length = glm::length(direction);
    const double shown = ray.end ? 1.0
                         : hit_t ? *hit_t + 1 / length
                                 : ray.max_t.value_or(12 / length);
    ask.answer.lines.push_back({ray.origin, ray.origin + shown * direction,
                                hit_t ? ProbeTone::query : ProbeTone::no, !ray.end, true});
}

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

} // namespace plumb::inline PLUMB_PRECISION

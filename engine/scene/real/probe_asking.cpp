#include "engine/scene/real/probe_asking.h"

#include "engine/core/check.h"
#include "engine/core/random.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/raycast_2d.h"

#include <array>
#include <concepts>
#include <cstdio>
#include <limits>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The ray as the shape's own kind of ray: in space, or in the plane.
class RayInto {
  public:
    explicit RayInto(const ProbeRayDesc &ray)
        : origin_(ray.origin), end_(ray.end),
          direction_(ray.end ? *ray.end - ray.origin : ray.direction),
          max_t_(ray.end     ? Real(1)
                 : ray.max_t ? static_cast<Real>(*ray.max_t)
                             : std::numeric_limits<Real>::infinity()) {}

    template <typename Asked> std::optional<RayFound> operator()(const Asked &shape) const {
        // A segment of no length is a point: the test for segments knows it, rays do not.
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
            PLUMB_CHECK(false, "there is no ray against this kind of shape");
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
            PLUMB_CHECK(false, "there is no segment test of this kind of shape");
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

Asking::Asking(const ProbeDesc &asked) : probe(asked), flat(is_flat(asked)) {
    for (const ProbeShapeDesc &shape : asked.shapes)
        shapes.push_back(make_shape(shape));
}

void Asking::count(std::string_view name, std::size_t value) {
    answer.values.push_back({name, static_cast<double>(value), ProbeValue::Form::count});
}

void Asking::flag(std::string_view name, bool value) {
    answer.values.push_back({name, value ? 1.0 : 0.0, ProbeValue::Form::flag});
}

void Asking::vector(const glm::dvec3 &v) {
    number("x", v.x);
    number("y", v.y);
    number("z", v.z);
}

void Asking::normal(const glm::dvec3 &v) {
    number("normal_x", v.x);
    number("normal_y", v.y);
    number("normal_z", v.z);
}

void Asking::draw(std::size_t shape, ProbeTone tone) {
    draw_shape(answer, probe.shapes[shape], shapes[shape], tone, shape);
}

void Asking::label(const glm::dvec3 &at, double value) {
    answer.labels.push_back({at, short_number(value)});
}

std::string short_number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3g", value);
    return text.data();
}

std::optional<RayFound> ray_into(const AskedShape &shape, const ProbeRayDesc &ray) {
    return std::visit(RayInto(ray), shape);
}

std::vector<glm::dvec3> scattered_points(const ProbeScatterDesc &scatter) {
    Random random(scatter.seed);
    std::vector<glm::dvec3> points;
    for (int i = 0; i < scatter.count; ++i) {
        glm::dvec3 point = scatter.center;
        for (int axis = 0; axis < 3; ++axis)
            point[axis] += random.next_in(-1, 1) * scatter.half_extents[axis];
        points.push_back(point);
    }
    return points;
}

std::vector<Aabb> scattered_boxes(const ProbeScatterDesc &scatter) {
    Random random(scatter.seed + 1);
    std::vector<Aabb> boxes;
    for (const glm::dvec3 &point : scattered_points(scatter)) {
        glm::dvec3 half{0};
        for (int axis = 0; axis < 3; ++axis)
            if (scatter.half_extents[axis] > 0)
                half[axis] = scatter.size * random.next_in(0.25, 1);
        boxes.push_back({Vec3{point - half}, Vec3{point + half}});
    }
    return boxes;
}

} // namespace plumb::inline PLUMB_PRECISION

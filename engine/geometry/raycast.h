// Rays and segments against solids and surfaces.
#pragma once

#include "engine/geometry/shapes.h"
#include "engine/geometry/slab.h"

#include <limits>
#include <optional>

namespace plumb::inline PLUMB_PRECISION {

// The closed interval of the ray's parameter inside a solid, clipped to [0, max_t].
struct RayInterval {
    Real t_enter = Real(0);
    Real t_exit = Real(0);
    Vec3 enter_normal{Real(0)}; // outward unit normal at t_enter; zero when the ray starts inside
};

// Empty when the ray misses the solid. A ray that touches in one point gives t_enter == t_exit.
// Starting inside (or on the surface, going in) gives t_enter == 0. A zero or non-finite direction,
// or a NaN anywhere, fails a check. For the range of the bounds below see shapes.h.
//
// A ray that truly hits a face, edge or corner of an Aabb or of an unrotated Box (whose faces are
// at center -+ half_extents, as rounded) never misses it; false hits happen only for rays that pass
// an edge within 8 epsilon times the distance from the origin. For a HalfSpace, and for a Sphere
// with an infinite ray, it is exact whether there is an interval and whether the ray starts inside:
// a tangent touches, and a ray that passes at a distance does not, whatever their size and
// position. All other answers are exact for a solid and a ray moved by at most 16 epsilon times
// their largest coordinate or size, and exact as given for integers of at most 7 (Cylinders: only
// those along an axis).
std::optional<RayInterval> ray_interval(const Sphere &sphere, const Ray &ray);
std::optional<RayInterval> ray_interval(const Box &box, const Ray &ray);
std::optional<RayInterval> ray_interval(const Aabb &box, const Ray &ray);
std::optional<RayInterval> ray_interval(const Capsule &capsule, const Ray &ray);
std::optional<RayInterval> ray_interval(const Cylinder &cylinder, const Ray &ray);
std::optional<RayInterval> ray_interval(const HalfSpace &half_space, const Ray &ray);
std::optional<RayInterval> ray_interval(const Shape &shape, const Ray &ray);

// A ray for testing many boxes: checked, and its reciprocals computed, once. Accuracy as above.
class PreparedRay {
  public:
    explicit PreparedRay(const Ray &ray);
    const SlabRay &slabs() const { return slabs_; }

  private:
    SlabRay slabs_;
};
inline std::optional<RayInterval> ray_interval(const Aabb &box, const PreparedRay &ray) {
    check_valid(box);
    RayInterval interval;
    int axis = -1;
    const bool is_empty = box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z;
    if (is_empty || !slab_interval(box, ray.slabs(), interval.t_enter, interval.t_exit, axis) ||
        interval.t_enter == std::numeric_limits<Real>::infinity())
        return std::nullopt;
    if (axis >= 0)
        interval.enter_normal[axis] =
            ray.slabs().ray.direction[axis] > Real(0) ? Real(-1) : Real(1);
    return interval;
}

struct RayHit {
    Real t = Real(0);
    Vec3 point{Real(0)};
    Vec3 normal{Real(0)};       // zero when started inside
    bool starts_inside = false; // then t == 0 and point == origin
};

// The first hit of the ray on the solid.
template <typename Solid> std::optional<RayHit> raycast(const Solid &solid, const Ray &ray) {
    const std::optional<RayInterval> inside = ray_interval(solid, ray);
    if (!inside)
        return std::nullopt;
    return RayHit{inside->t_enter, ray.origin + inside->t_enter * ray.direction,
                  inside->enter_normal, inside->enter_normal == Vec3{Real(0)}};
}

// The first hit on a surface, from either side. `normal` is on the side the ray comes from; it is
// zero, and `starts_inside` set, when the origin is on the surface.
//
// Which side of the plane the ray starts on, and whether it approaches, are exact. t is off by at
// most 8 epsilon times the largest coordinate (including the hit point's) over the speed along the
// normal; its comparison with max_t is rounded.
std::optional<RayHit> raycast(const Plane &plane, const Ray &ray);

// Watertight (Woop, Benthin, Wald 2013): whether the ray's line passes through the triangle is
// decided by exact signs, one per edge, so a ray between triangles that share an edge or corner
// hits at least one of them. Which side the ray starts on, and whether it approaches, are exact
// too. A ray in the triangle's plane, or one that meets a flat triangle, hits the first common
// point; the normal is then the triangle's front normal or, for a flat triangle, points against the
// ray. t is off by at most 8 epsilon times the largest coordinate over the speed |direction| and
// the sine of the angle between ray and plane (in the plane: ray and edge). Its comparison with
// max_t is rounded.
std::optional<RayHit> raycast(const Triangle &triangle, const Ray &ray);

// Whether the segment from a to b has a point in the shape. A segment wholly inside does. a == b
// tests that point. The ends are tested directly, as by `contains`.
bool linetest(const Sphere &sphere, const Vec3 &a, const Vec3 &b); // exact
bool linetest(const Box &box, const Vec3 &a, const Vec3 &b);       // exact without rotation
bool linetest(const Aabb &box, const Vec3 &a, const Vec3 &b);      // exact
bool linetest(const Capsule &capsule, const Vec3 &a, const Vec3 &b);
bool linetest(const Cylinder &cylinder, const Vec3 &a, const Vec3 &b);
bool linetest(const HalfSpace &half_space, const Vec3 &a, const Vec3 &b); // exact
bool linetest(const Plane &plane, const Vec3 &a, const Vec3 &b);          // exact
bool linetest(const Triangle &triangle, const Vec3 &a, const Vec3 &b);    // exact
bool linetest(const Shape &shape, const Vec3 &a, const Vec3 &b);

} // namespace plumb::inline PLUMB_PRECISION

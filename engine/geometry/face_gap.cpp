#include "engine/geometry/face_gap.h"

#include "engine/geometry/hull_queries.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The face of a core whose normal is closest to a direction.
struct BoxFace {
    const BoxCore &box;
    int axis = 0;
    Real sign = Real(1);

    BoxFace(const BoxCore &of, const Vec3 &direction) : box(of) {
        const Vec3 along = direction * box.axes;
        for (int i = 1; i < 3; ++i)
            if (std::abs(along[i]) > std::abs(along[axis]))
                axis = i;
        sign = std::copysign(Real(1), along[axis]);
    }
    bool is_flat() const {
        return !(box.half_extents.x > Real(0) && box.half_extents.y > Real(0) &&
                 box.half_extents.z > Real(0));
    }
    Vec3 normal() const { return sign * box.axes[axis]; }
    Vec3 inside(const Vec3 &point) const { return (point - box.center) * box.axes; }
    // Below, points are in the core's own frame.
    Real height(const Vec3 &local) const { return sign * local[axis] - box.half_extents[axis]; }
    bool is_under(const Vec3 &local) const {
        for (int i = 0; i < 3; ++i)
            if (i != axis && !(std::abs(local[i]) <= box.half_extents[i]))
                return false;
        return true;
    }
    bool is_nearest(const Vec3 &local, Real height) const {
        for (int i = 0; i < 3; ++i) // including the opposite face
            if (!(std::abs(local[i]) - box.half_extents[i] <= height))
                return false;
        return true;
    }
};

struct HullFace {
    const HullCore &hull;
    std::uint32_t index;

    HullFace(const HullCore &of, const Vec3 &direction)
        : hull(of), index(supporting_face(*of.mesh, direction * of.rotation)) {}
    bool is_flat() const { return false; }
    Vec3 normal() const { return glm::normalize(hull.rotation * hull.mesh->planes[index].normal); }
    Vec3 inside(const Vec3 &point) const { return (point - hull.position) * hull.rotation; }
    const Vec3 &corner(std::uint32_t i) const {
        return hull.mesh->vertices[hull.mesh->vertex_indices[hull.mesh->faces[index].first + i]];
    }
    Real height(const Vec3 &local) const {
        return glm::dot(local - corner(0), hull.mesh->planes[index].normal);
    }
    bool is_under(const Vec3 &local) const {
        const std::uint32_t count = hull.mesh->faces[index].count;
        for (std::uint32_t i = 0; i < count; ++i) {
            const Vec3 side = corner(i + 1 < count ? i + 1 : 0) - corner(i);
            const Vec3 outward = glm::cross(side, hull.mesh->planes[index].normal);
            if (glm::dot(local - corner(i), outward) > Real(0))
                return false;
        }
        return true;
    }
    bool is_nearest(const Vec3 &local, Real height) const {
        return is_nearest_face(*hull.mesh, index, local, height);
    }
};

BoxFace face_of(const BoxCore &box, const Vec3 &direction) {
    return {box, direction};
}
HullFace face_of(const HullCore &hull, const Vec3 &direction) {
    return {hull, direction};
}

// The result with a face of `owner`, from `owner` to `other`.
template <typename Owner, typename Other>
std::optional<Proximity> above(const Owner &owner, const Other &other, const Vec3 &guess,
                               Real far) {
    const auto face = face_of(owner, guess);
    if (face.is_flat())
        return std::nullopt;
    const Vec3 normal = face.normal();
    const Vec3 corner = other.support(-normal);
    const Vec3 local = face.inside(corner);
    const Real height = face.height(local);
    const bool is_beyond = height > far;
    if (!is_beyond && !(height > Real(0) ? face.is_under(local) : face.is_nearest(local, height)))
        return std::nullopt;
    return Proximity{.separation = height,
                     .normal = normal,
                     .on_a = corner - height * normal,
                     .on_b = corner,
                     .is_beyond = is_beyond};
}

} // namespace

template <HasFaceGap A, HasFaceGap B>
std::optional<Proximity> face_gap(const A &a, const B &b, const Vec3 &guess, Real far) {
    if (const auto found = above(a, b, guess, far))
        return found;
    auto found = above(b, a, -guess, far);
    if (found) {
        found->normal = -found->normal;
        std::swap(found->on_a, found->on_b);
    }
    return found;
}

template std::optional<Proximity> face_gap(const BoxCore &, const BoxCore &, const Vec3 &, Real);
template std::optional<Proximity> face_gap(const HullCore &, const HullCore &, const Vec3 &, Real);
template std::optional<Proximity> face_gap(const BoxCore &, const HullCore &, const Vec3 &, Real);
template std::optional<Proximity> face_gap(const HullCore &, const BoxCore &, const Vec3 &, Real);

} // namespace plumb::inline PLUMB_PRECISION

// Searches over all vertices or faces of a hull, several at once with vector instructions. Compiled
// once per instruction set, by including itself.
#include "engine/geometry/hull_queries.h"

#include "engine/core/check.h"
#include "engine/math/printed.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/geometry/hull_kernels.cpp"
// Vectors of unknown size cannot be struct members.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
// After foreach_target.h, which must choose the target first.
#include <hwy/highway.h>

#include "engine/math/wide_vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::inline PLUMB_PRECISION {
namespace kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<Real, 16>;
using IndexTag = hn::RebindToSigned<Tag>;
using Lanes = hn::Vec<Tag>;
using Vector = wide::HWY_NAMESPACE::Vector<Lanes>;

constexpr Tag tag{};
constexpr IndexTag index_tag{};
using Index = hn::TFromD<IndexTag>;

const Vec3 &direction_of(const Vec3 &vertex) {
    return vertex;
}
const Vec3 &direction_of(const Plane &plane) {
    return plane.normal;
}

HWY_INLINE Vector load(const Vec3 *vertices) {
    Vector out;
    hn::LoadInterleaved3(tag, &vertices->x, out.x, out.y, out.z);
    return out;
}
struct Planes {
    Vector normal;
    Lanes offset;
};
HWY_INLINE Planes load_planes(const Plane *planes) {
    static_assert(sizeof(Plane) == 4 * sizeof(Real) && offsetof(Plane, offset) == 3 * sizeof(Real));
    Planes out;
    hn::LoadInterleaved4(tag, &planes->normal.x, out.normal.x, out.normal.y, out.normal.z,
                         out.offset);
    return out;
}
HWY_INLINE Vector load(const Plane *planes) {
    return load_planes(planes).normal;
}

// Lane k looks at elements k, k + n, k + 2 n, ...; the last vector ends at the last element and
// revisits some. The first of equals wins, so the answer is the same at any width.
template <typename Element>
std::size_t farthest_of_many(const Element *elements, std::size_t count, const Vec3 &direction) {
    const std::size_t lanes = hn::Lanes(tag);
    const Vector along{hn::Set(tag, direction.x), hn::Set(tag, direction.y),
                       hn::Set(tag, direction.z)};
    auto greatest = hn::Set(tag, -std::numeric_limits<Real>::infinity());
    auto best = hn::Zero(index_tag);
    for (std::size_t i = 0; i < count; i += lanes) {
        const std::size_t first = std::min(i, count - lanes);
        const Lanes reach = wide::HWY_NAMESPACE::dot(load(&elements[first]), along);
        const auto is_farther = hn::Gt(reach, greatest);
        greatest = hn::IfThenElse(is_farther, reach, greatest);
        best = hn::IfThenElse(hn::RebindMask(index_tag, is_farther),
                              hn::Iota(index_tag, static_cast<Index>(first)), best);
    }
    const auto is_greatest = hn::Eq(greatest, hn::MaxOfLanes(tag, greatest));
    const auto none = hn::Set(index_tag, std::numeric_limits<Index>::max());
    const auto found = hn::IfThenElse(hn::RebindMask(index_tag, is_greatest), best, none);
    const auto least = static_cast<std::size_t>(hn::GetLane(hn::MinOfLanes(index_tag, found)));
    return least < count ? least : 0; // if the direction is NaN, no lane is the greatest
}

template <typename Element>
std::size_t farthest(const Element *elements, std::size_t count, const Vec3 &direction) {
    if (count >= hn::Lanes(tag))
        return farthest_of_many(elements, count, direction);
    std::size_t best = 0;
    Real greatest = glm::dot(direction_of(elements[0]), direction);
    for (std::size_t i = 1; i < count; ++i) {
        const Real reach = glm::dot(direction_of(elements[i]), direction);
        if (reach > greatest) {
            greatest = reach;
            best = i;
        }
    }
    return best;
}

} // namespace

std::size_t farthest_vertex(const Vec3 *vertices, std::size_t count, const Vec3 &direction) {
    return farthest(vertices, count, direction);
}
std::size_t farthest_face(const Plane *planes, std::size_t count, const Vec3 &direction) {
    return farthest(planes, count, direction);
}

// The least and greatest coordinates of the vertices along three axes.
Aabb extent(const Vec3 *vertices, std::size_t count, const Mat3 &axes) {
    const std::size_t lanes = hn::Lanes(tag);
    Aabb out;
    if (count < lanes) {
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 at = vertices[i] * axes;
            out.min = glm::min(out.min, at);
            out.max = glm::max(out.max, at);
        }
        return out;
    }
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 &direction = axes[axis];
        const Vector along{hn::Set(tag, direction.x), hn::Set(tag, direction.y),
                           hn::Set(tag, direction.z)};
        Lanes least = hn::Set(tag, std::numeric_limits<Real>::infinity());
        Lanes greatest = hn::Neg(least);
        for (std::size_t i = 0; i < count; i += lanes) {
            const Lanes at =
                wide::HWY_NAMESPACE::dot(load(&vertices[std::min(i, count - lanes)]), along);
            least = hn::Min(least, at);
            greatest = hn::Max(greatest, at);
        }
        out.min[axis] = hn::GetLane(hn::MinOfLanes(tag, least));
        out.max[axis] = hn::GetLane(hn::MaxOfLanes(tag, greatest));
    }
    return out;
}

bool any_above(const Plane *planes, std::size_t count, std::size_t but, const Vec3 &point,
               Real height) {
    const std::size_t lanes = hn::Lanes(tag);
    if (count < lanes) {
        for (std::size_t i = 0; i < count; ++i)
            if (i != but && !(glm::dot(planes[i].normal, point) - planes[i].offset <= height))
                return true;
        return false;
    }
    const Vector at{hn::Set(tag, point.x), hn::Set(tag, point.y), hn::Set(tag, point.z)};
    const Lanes most = hn::Set(tag, height);
    for (std::size_t i = 0; i < count; i += lanes) {
        const std::size_t first = std::min(i, count - lanes);
        const Planes plane = load_planes(&planes[first]);
        const Lanes above = hn::Sub(wide::HWY_NAMESPACE::dot(plane.normal, at), plane.offset);
        const auto is_other = hn::Ne(hn::Iota(index_tag, static_cast<Index>(first)),
                                     hn::Set(index_tag, static_cast<Index>(but)));
        if (!hn::AllFalse(tag, hn::AndNot(hn::Le(above, most), hn::RebindMask(tag, is_other))))
            return true;
    }
    return false;
}

} // namespace kernels::HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumb::inline PLUMB_PRECISION {
namespace kernels {

HWY_EXPORT(farthest_vertex);
HWY_EXPORT(farthest_face);
HWY_EXPORT(extent);
HWY_EXPORT(any_above);

namespace {
std::size_t vertex_along(const HullMesh &mesh, const Vec3 &direction) {
    return HWY_DYNAMIC_DISPATCH(farthest_vertex)(mesh.vertices.data(), mesh.vertices.size(),
                                                 direction);
}
std::size_t face_along(const HullMesh &mesh, const Vec3 &direction) {
    return HWY_DYNAMIC_DISPATCH(farthest_face)(mesh.planes.data(), mesh.planes.size(), direction);
}
bool any_face_below(const HullMesh &mesh, std::size_t but, const Vec3 &point, Real height) {
    return HWY_DYNAMIC_DISPATCH(any_above)(mesh.planes.data(), mesh.planes.size(), but, point,
                                           height);
}
Aabb extent_along(const HullMesh &mesh, const Mat3 &axes) {
    return HWY_DYNAMIC_DISPATCH(extent)(mesh.vertices.data(), mesh.vertices.size(), axes);
}
} // namespace

} // namespace kernels

Aabb bounds(const ConvexHull &hull) {
    check_valid(hull);
    // The world's axes in the mesh's frame.
    const Mat3 axes = glm::transpose(glm::mat3_cast(hull.rotation));
    const Aabb around = kernels::extent_along(*hull.mesh, axes);
    return {hull.position + around.min, hull.position + around.max};
}

std::uint32_t support_vertex(const HullMesh &mesh, const Vec3 &direction) {
    PLUMB_DEBUG_CHECK(is_finite(direction), "direction must be finite, got " << Printed{direction});
    return static_cast<std::uint32_t>(kernels::vertex_along(mesh, direction));
}
std::uint32_t supporting_face(const HullMesh &mesh, const Vec3 &direction) {
    PLUMB_DEBUG_CHECK(is_finite(direction), "direction must be finite, got " << Printed{direction});
    return static_cast<std::uint32_t>(kernels::face_along(mesh, direction));
}
bool is_nearest_face(const HullMesh &mesh, std::uint32_t face, const Vec3 &point, Real height) {
    return !kernels::any_face_below(mesh, face, point, height);
}

} // namespace plumb::inline PLUMB_PRECISION
#endif

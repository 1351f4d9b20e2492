// The vertex of a hull that is farthest along a direction: all vertices are looked at, as many at
// once as the processor works on. Compiled once for each instruction set, by including itself.
#include "engine/geometry/hull_queries.h"

#include "engine/core/check.h"
#include "engine/math/printed.h"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/geometry/support_vertex.cpp"
// Vectors of unknown size cannot stand in structs.
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

// Lane k looks at the vertices k, k + n, k + 2 n, ...; the last vector of them ends with the last
// vertex, and sees some again. Of equals the first counts, so the answer is the same at any width.
std::size_t farthest(const Vec3 *vertices, std::size_t count, const Vec3 &direction) {
    constexpr Tag tag{};
    constexpr IndexTag index_tag{};
    using Index = hn::TFromD<IndexTag>;
    const std::size_t lanes = hn::Lanes(tag);
    const Vector along{hn::Set(tag, direction.x), hn::Set(tag, direction.y),
                       hn::Set(tag, direction.z)};
    auto greatest = hn::Set(tag, -std::numeric_limits<Real>::infinity());
    auto best = hn::Zero(index_tag);
    for (std::size_t i = 0; i < count; i += lanes) {
        const std::size_t first = std::min(i, count - lanes);
        Vector vertex;
        hn::LoadInterleaved3(tag, &vertices[first].x, vertex.x, vertex.y, vertex.z);
        const Lanes reach = wide::HWY_NAMESPACE::dot(vertex, along);
        const auto is_farther = hn::Gt(reach, greatest);
        greatest = hn::IfThenElse(is_farther, reach, greatest);
        best = hn::IfThenElse(hn::RebindMask(index_tag, is_farther),
                              hn::Iota(index_tag, static_cast<Index>(first)), best);
    }
    const auto is_greatest = hn::Eq(greatest, hn::MaxOfLanes(tag, greatest));
    const auto none = hn::Set(index_tag, std::numeric_limits<Index>::max());
    const auto found = hn::IfThenElse(hn::RebindMask(index_tag, is_greatest), best, none);
    const auto least = static_cast<std::size_t>(hn::GetLane(hn::MinOfLanes(index_tag, found)));
    return least < count ? least : 0; // no lane is the greatest where the direction is not a number
}

std::size_t lane_count() {
    return hn::Lanes(Tag{});
}

} // namespace

std::size_t farthest_vertex(const Vec3 *vertices, std::size_t count, const Vec3 &direction) {
    if (count >= lane_count())
        return farthest(vertices, count, direction);
    std::size_t best = 0;
    Real greatest = glm::dot(vertices[0], direction);
    for (std::size_t i = 1; i < count; ++i) {
        const Real reach = glm::dot(vertices[i], direction);
        if (reach > greatest) {
            greatest = reach;
            best = i;
        }
    }
    return best;
}

} // namespace kernels::HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumb::inline PLUMB_PRECISION {
namespace kernels {

HWY_EXPORT(farthest_vertex);

namespace {
std::size_t farthest(const HullMesh &mesh, const Vec3 &direction) {
    return HWY_DYNAMIC_DISPATCH(farthest_vertex)(mesh.vertices.data(), mesh.vertices.size(),
                                                 direction);
}
} // namespace

} // namespace kernels

std::uint32_t support_vertex(const HullMesh &mesh, const Vec3 &direction) {
    PLUMB_DEBUG_CHECK(is_finite(direction), "direction must be finite, got " << Printed{direction});
    return static_cast<std::uint32_t>(kernels::farthest(mesh, direction));
}

} // namespace plumb::inline PLUMB_PRECISION
#endif

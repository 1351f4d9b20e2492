// A face of a box clipped against a face of another. Included by files that Highway compiles once
// for each instruction set, and compiled as often.
#if defined(PLUMB_GEOMETRY_CLIP_FACE) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_GEOMETRY_CLIP_FACE
#undef PLUMB_GEOMETRY_CLIP_FACE
#else
#define PLUMB_GEOMETRY_CLIP_FACE
#endif

#include "engine/geometry/manifold_pairs.h"
#include "engine/geometry/set_bits.h"
#include "engine/math/four-inl.h"

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace plumb::inline PLUMB_PRECISION {
namespace kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Coordinates along a reference face, u and v, and out of it.
using InFace = std::array<Real, 3>;

// A face of another box, from its middle to its sides. The reference face is at height `height`
// along its normal, which is `up` times the third coordinate axis, and extends to `limits`.
struct FacePair {
    InFace middle, side_j, side_k;
    Real up, height;
    std::array<Real, 2> limits; // of u and v
};

// The corners of the polygon that is left, up to eight of them. Names are 0..3 for a corner of the
// incident face, else 4 + 4 * label of the polygon side + clip plane. Sides are labelled 0..3 for
// the incident face, 4..7 for clip planes.
struct Clipped {
    static constexpr std::size_t most = 8;
    std::array<Real, most> u, v, height, name;
    std::size_t count;
    Real lowest;
};

// --- Corner by corner ----------------------------------------------------------------------------

// Each corner is a row: u, v, height. A label holds the name of a corner and, above it, the label
// of the side from this corner to the next.
struct FacePolygon {
    // What one more plane may add fits, too.
    std::array<std::array<Real, 4>, 2 * Clipped::most + 1> corners;
    std::array<std::uint32_t, 2 * Clipped::most + 1> labels;
    std::size_t count;
};
inline constexpr std::uint32_t name_mask = 0xff;
inline constexpr int side_shift = 8;

// How far each corner of a polygon is beyond a plane, and the first again at the end. Within
// feature_tolerance a corner counts as on the plane.
using Beyond = std::array<Real, Clipped::most + 1>;

// One plane of Sutherland and Hodgman 1974, "Reentrant polygon clipping". Corners on the plane keep
// their names. Each corner and each crossing is written to the next free place, and stays if it
// counts: which ones do is hard to foresee, so that branches would cost more.
HWY_INLINE void clip(FacePolygon &in, const Beyond &beyond, std::uint32_t plane, FacePolygon &out) {
    using namespace wide::HWY_NAMESPACE;
    in.corners[in.count] = in.corners[0];
    const std::uint32_t along_plane = (4 + plane) << side_shift;
    std::size_t n = 0;
    for (std::size_t i = 0; i < in.count; ++i) {
        const Real d0 = beyond[i], d1 = beyond[i + 1];
        const Four here = load(in.corners[i].data()), next = load(in.corners[i + 1].data());
        const std::uint32_t label = in.labels[i];
        const std::uint32_t side = label >> side_shift;
        store(here, out.corners[n].data());
        out.labels[n] = label;
        if (d0 == Real(0)) [[unlikely]] // the polygon continues along the plane
            out.labels[n] = d1 > Real(0) ? (label & name_mask) | along_plane : label;
        n += d0 <= Real(0) ? 1 : 0;
        store(here + all(d0 / (d0 - d1)) * (next - here), out.corners[n].data());
        out.labels[n] = (4 + 4 * side + plane) | (d0 < Real(0) ? along_plane : side << side_shift);
        n += d0 * d1 < Real(0) ? 1 : 0; // on both sides of the plane, and neither within tolerance
    }
    out.count = std::min(n, Clipped::most);
}

HWY_INLINE void clip_by_corner(const FacePair &faces, Real highest, Clipped &clipped) {
    using namespace wide::HWY_NAMESPACE;
    const auto in_face = [](const InFace &a) HWY_ATTR { return four(a[0], a[1], a[2], Real(0)); };
    const Four middle = in_face(faces.middle);
    const Four side_j = in_face(faces.side_j), side_k = in_face(faces.side_k);
    // The third coordinate becomes the height above the face.
    const Four up = four(Real(1), Real(1), faces.up, Real(0));
    const Four base = four(Real(0), Real(0), faces.height, Real(0));
    std::array<FacePolygon, 2> polygons;
    FacePolygon *polygon = polygons.data(), *other = polygons.data() + 1;
    store((middle - side_j - side_k) * up - base, polygon->corners[0].data());
    store((middle + side_j - side_k) * up - base, polygon->corners[1].data());
    store((middle + side_j + side_k) * up - base, polygon->corners[2].data());
    store((middle - side_j + side_k) * up - base, polygon->corners[3].data());
    for (std::uint32_t c = 0; c < 4; ++c)
        polygon->labels[c] = c | c << side_shift;
    polygon->count = 4;
    for (std::uint32_t plane = 0; plane < 4; ++plane) {
        const Real way = plane % 2 == 0 ? Real(-1) : Real(1);
        Beyond beyond;
        Real most = Real(0);
        for (std::size_t c = 0; c < polygon->count; ++c) {
            const Real distance = way * polygon->corners[c][plane / 2] - faces.limits[plane / 2];
            beyond[c] = std::abs(distance) <= feature_tolerance ? Real(0) : distance;
            most = std::max(most, distance);
        }
        if (most > feature_tolerance) {
            beyond[polygon->count] = beyond[0];
            clip(*polygon, beyond, plane, *other);
            std::swap(polygon, other);
        }
    }
    std::size_t n = 0;
    Real lowest = std::numeric_limits<Real>::infinity();
    for (std::size_t c = 0; c < polygon->count; ++c) {
        const auto &corner = polygon->corners[c];
        if (corner[2] > highest)
            continue;
        clipped.u[n] = corner[0];
        clipped.v[n] = corner[1];
        clipped.height[n] = corner[2];
        clipped.name[n] = static_cast<Real>(polygon->labels[c] & name_mask);
        lowest = std::min(lowest, corner[2]);
        ++n;
    }
    clipped.count = n;
    clipped.lowest = lowest;
}

// --- All corners at once -------------------------------------------------------------------------

using EightTag = hn::CappedTag<Real, 8>;
inline constexpr bool has_eight_lanes = hn::MaxLanes(EightTag{}) == 8;

template <typename Tag> HWY_INLINE auto unpacked(Tag /*tag*/, std::uint64_t bytes) {
    const hn::Rebind<std::uint8_t, Tag> byte_tag;
    const hn::Rebind<std::int32_t, Tag> int_tag;
    std::array<std::uint8_t, 8> places;
    hwy::CopyBytes<8>(&bytes, places.data());
    const auto numbers = hn::PromoteTo(int_tag, hn::LoadU(byte_tag, places.data()));
    if constexpr (sizeof(Real) == sizeof(std::int32_t))
        return numbers;
    else
        return hn::PromoteTo(hn::RebindToSigned<Tag>{}, numbers);
}
template <typename Tag, typename Mask> HWY_INLINE unsigned bits_of(Tag tag, Mask mask) {
    std::array<std::uint8_t, 8> bits{};
    hn::StoreMaskBits(tag, mask, bits.data());
    return bits[0];
}

// The same with a corner in each of eight lanes: what clip does for one corner, for all.
template <typename Tag>
HWY_INLINE void clip_at_once(Tag tag, const FacePair &faces, Real highest, Clipped &clipped) {
    using Lanes = hn::Vec<Tag>;
    const hn::RebindToSigned<Tag> index_tag;
    const Lanes zero = hn::Zero(tag);
    alignas(64) static constexpr std::array<Real, 8> sides_j = {-1, 1, 1, -1};
    alignas(64) static constexpr std::array<Real, 8> sides_k = {-1, -1, 1, 1};
    const Lanes way_j = hn::Load(tag, sides_j.data()), way_k = hn::Load(tag, sides_k.data());
    const auto corners = [&](std::size_t i) HWY_ATTR {
        return hn::Add(
            hn::Add(hn::Set(tag, faces.middle[i]), hn::Mul(hn::Set(tag, faces.side_j[i]), way_j)),
            hn::Mul(hn::Set(tag, faces.side_k[i]), way_k));
    };
    Lanes u = corners(0), v = corners(1);
    Lanes height = hn::Sub(hn::Mul(hn::Set(tag, faces.up), corners(2)), hn::Set(tag, faces.height));
    Lanes name = hn::Iota(tag, 0), side = name;
    std::size_t n = 4;
    for (int plane = 0; plane < 4; ++plane) {
        const Lanes coordinate = plane < 2 ? u : v;
        const Lanes distance =
            hn::Sub(plane % 2 == 0 ? hn::Neg(coordinate) : coordinate,
                    hn::Set(tag, faces.limits[static_cast<std::size_t>(plane / 2)]));
        const Lanes beyond = hn::IfThenZeroElse(
            hn::Le(hn::Abs(distance), hn::Set(tag, feature_tolerance)), distance);
        const auto is_there = hn::FirstN(tag, n);
        if (hn::AllFalse(tag, hn::And(hn::Gt(beyond, zero), is_there)))
            continue;
        const auto next = hn::IndicesFromVec(tag, unpacked(tag, next_lanes[n]));
        const Lanes beyond_next = hn::TableLookupLanes(beyond, next);
        const auto is_kept = hn::And(hn::Le(beyond, zero), is_there);
        const auto is_crossed = hn::And(hn::Lt(hn::Mul(beyond, beyond_next), zero), is_there);

        // The corners and crossings that stay, two bits for each corner, in their order.
        const unsigned stays = spread_bits[bits_of(tag, is_kept)] |
                               static_cast<unsigned>(spread_bits[bits_of(tag, is_crossed)]) << 1;
        const unsigned low = stays & 0xff, high = stays >> 8;
        const int half_shift = 4 * std::popcount(low); // shifting by 64 at once is undefined
        const auto from =
            unpacked(tag, places_of_bits[low] | (places_of_bits[high] + 0x0808080808080808)
                                                    << half_shift << half_shift);
        n = std::min(static_cast<std::size_t>(std::popcount(stays)), Clipped::most);
        const auto source = hn::IndicesFromVec(tag, hn::ShiftRight<1>(from));
        const auto is_crossing = hn::RebindMask(tag, hn::TestBit(from, hn::Set(index_tag, 1)));
        const auto chosen = [&](Lanes corner, Lanes crossing) HWY_ATTR {
            return hn::IfThenElse(is_crossing, hn::TableLookupLanes(crossing, source),
                                  hn::TableLookupLanes(corner, source));
        };
        const Lanes s = hn::Div(beyond, hn::Sub(beyond, beyond_next));
        const auto clip_row = [&](Lanes &row) HWY_ATTR {
            const Lanes across = hn::Sub(hn::TableLookupLanes(row, next), row);
            row = chosen(row, hn::Add(row, hn::Mul(s, across)));
        };
        clip_row(u);
        clip_row(v);
        clip_row(height);
        const Lanes plane_side = hn::Set(tag, static_cast<Real>(4 + plane));
        name = chosen(name, hn::Add(hn::Mul(side, hn::Set(tag, Real(4))), plane_side));
        const auto turns = hn::And(hn::Eq(beyond, zero), hn::Gt(beyond_next, zero));
        side = chosen(hn::IfThenElse(turns, plane_side, side),
                      hn::IfThenElse(hn::Lt(beyond, zero), plane_side, side));
    }
    const auto is_low = hn::And(hn::Le(height, hn::Set(tag, highest)), hn::FirstN(tag, n));
    const unsigned low = bits_of(tag, is_low);
    const auto source = hn::IndicesFromVec(tag, unpacked(tag, places_of_bits[low]));
    hn::StoreU(hn::TableLookupLanes(u, source), tag, clipped.u.data());
    hn::StoreU(hn::TableLookupLanes(v, source), tag, clipped.v.data());
    hn::StoreU(hn::TableLookupLanes(height, source), tag, clipped.height.data());
    hn::StoreU(hn::TableLookupLanes(name, source), tag, clipped.name.data());
    clipped.count = static_cast<std::size_t>(std::popcount(low));
    const Lanes none = hn::Set(tag, std::numeric_limits<Real>::infinity());
    clipped.lowest = hn::GetLane(hn::MinOfLanes(tag, hn::IfThenElse(is_low, height, none)));
}

// The corners of the clipped face that are not above `highest`.
HWY_INLINE void clip_face(const FacePair &faces, Real highest, Clipped &clipped) {
    if constexpr (has_eight_lanes)
        clip_at_once(EightTag{}, faces, highest, clipped);
    else
        clip_by_corner(faces, highest, clipped);
}

} // namespace kernels::HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#endif

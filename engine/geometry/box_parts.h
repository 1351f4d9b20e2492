// The parts of a box in its own frame, and their numbers: shared by the contacts of boxes.
#pragma once

#include "engine/math/types.h"

#include <array>
#include <cstdint>

namespace plumb::inline PLUMB_PRECISION {

// Feature ids. The lowest bits name the part, these the kind of contact, so that no two kinds share
// an id.
inline constexpr std::uint32_t kind_face = 1U << 24;
inline constexpr std::uint32_t kind_edges = 2U << 24;
inline constexpr std::uint32_t kind_closest = 3U << 24;

inline std::uint32_t bits(int value) {
    return static_cast<std::uint32_t>(value);
}

// Faces are numbered 2 * axis, plus 1 on the positive side.
inline int face_number(int axis, Real sign) {
    return 2 * axis + (sign > Real(0) ? 1 : 0);
}

inline Vec3 corner(const Vec3 &half_extents, int index) {
    return {(index & 1) != 0 ? half_extents.x : -half_extents.x,
            (index & 2) != 0 ? half_extents.y : -half_extents.y,
            (index & 4) != 0 ? half_extents.z : -half_extents.z};
}

// A vector whose coordinates are picked by number: GLM's come from a switch, whose branches are
// hard to foresee.
using Numbered = std::array<Real, 3>;
inline Numbered numbered(const Vec3 &v) {
    return {v.x, v.y, v.z};
}

// The outward normals of the faces, by number.
inline constexpr std::array<Vec3, 6> face_normals = {
    Vec3{Real(-1), Real(0), Real(0)}, Vec3{Real(1), Real(0), Real(0)},
    Vec3{Real(0), Real(-1), Real(0)}, Vec3{Real(0), Real(1), Real(0)},
    Vec3{Real(0), Real(0), Real(-1)}, Vec3{Real(0), Real(0), Real(1)}};

// Edges are numbered 4 * direction, plus 1 if the next coordinate is positive, plus 2 if the one
// after it is.
struct Edge {
    Vec3 start{Real(0)};
    Vec3 along{Real(0)};
};

// As multiples of the half extents.
inline constexpr std::array<Vec3, 12> edge_starts = [] {
    std::array<Vec3, 12> starts{};
    constexpr Real low = Real(-1);
    for (std::size_t n = 0; n < 4; ++n) {
        const Real next = n % 2 != 0 ? Real(1) : low, after = n / 2 != 0 ? Real(1) : low;
        starts[n] = {low, next, after};
        starts[4 + n] = {after, low, next};
        starts[8 + n] = {next, after, low};
    }
    return starts;
}();
inline constexpr std::array<Vec3, 3> edge_directions = {Vec3{Real(2), Real(0), Real(0)},
                                                        Vec3{Real(0), Real(2), Real(0)},
                                                        Vec3{Real(0), Real(0), Real(2)}};

inline Edge edge(const Vec3 &half_extents, int number) {
    return {edge_starts[static_cast<std::size_t>(number)] * half_extents,
            edge_directions[static_cast<std::size_t>(number / 4)] * half_extents};
}

// The edge along axis i that contains the support point for `direction`.
inline int supporting_edge(int i, const Vec3 &direction) {
    const Numbered towards = numbered(direction);
    const auto j = static_cast<std::size_t>((i + 1) % 3);
    const auto k = static_cast<std::size_t>((i + 2) % 3);
    return 4 * i + (towards[j] > Real(0) ? 1 : 0) + (towards[k] > Real(0) ? 2 : 0);
}

} // namespace plumb::inline PLUMB_PRECISION

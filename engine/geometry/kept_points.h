// Which points of a contact a manifold keeps, as it has room for four.
#pragma once

#include "engine/geometry/manifold.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace plumb::inline PLUMB_PRECISION {

// A contact point before reduction to four.
struct CandidatePoint {
    Vec3 position{Real(0)};
    Real separation = Real(0);
    std::uint32_t feature = 0;
};
struct CandidatePoints {
    static constexpr int most = 33; // two faces of 16 corners, and the deepest point
    std::array<CandidatePoint, std::size_t{most}> points;
    int count = 0;

    void add(const Vec3 &position, Real separation, std::uint32_t feature) {
        if (count < most)
            points[static_cast<std::size_t>(count++)] = {position, separation, feature};
    }
    Real deepest() const {
        Real least = std::numeric_limits<Real>::infinity();
        for (int i = 0; i < count; ++i)
            least = std::min(least, points[static_cast<std::size_t>(i)].separation);
        return least;
    }
};

// Which of the candidates a manifold keeps.
struct KeptPoints {
    std::array<int, 4> points{};
    int count = 0;
};

// The deepest point and the three that span the largest area with it, seen along `normal`.
KeptPoints best_four(const CandidatePoints &all, const Vec3 &normal);

// Those that leave the most room around the load: from the best four, one exchange after another.
KeptPoints best_under(const CandidatePoints &all, const Vec3 &normal, const Vec3 &load);

} // namespace plumb::inline PLUMB_PRECISION

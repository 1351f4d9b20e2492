#include "engine/geometry/kept_points.h"

#include "engine/geometry/manifold_pairs.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr std::size_t slot(int i) {
    return static_cast<std::size_t>(i);
}

// How far `place` is inside the polygon that the points span, seen along `normal`: its distance
// from the nearest side; negative outside. The points come in any order.
template <typename At>
Real room_between(int count, const At &at, const Vec3 &normal, const Vec3 &place) {
    constexpr Real none = std::numeric_limits<Real>::infinity();
    Real room = none;
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < i; ++j) {
            // It is a side if all others are on the same side of it.
            const Vec3 across = glm::cross(at(j) - at(i), normal);
            const Real length = glm::length(across);
            Real least = Real(0);
            Real most = Real(0);
            for (int k = 0; k < count; ++k) {
                const Real off = k == i || k == j ? Real(0) : glm::dot(at(k) - at(i), across);
                least = std::min(least, off);
                most = std::max(most, off);
            }
            if (!(length > Real(0)) || (least < Real(0)) == (most > Real(0)))
                continue;
            const Real off = glm::dot(place - at(i), across) / length;
            room = std::min(room, most > Real(0) ? off : -off);
        }
    return room < none ? room : -none;
}

} // namespace

KeptPoints best_four(const CandidatePoints &all, const Vec3 &normal) {
    KeptPoints kept;
    if (all.count <= 4) {
        for (; kept.count < all.count; ++kept.count)
            kept.points[slot(kept.count)] = kept.count;
        return kept;
    }
    // A later point replaces an earlier one only if clearly better, so that equally good points do
    // not alternate.
    constexpr Real clearly = Real(1.01);
    std::array<bool, std::size_t{CandidatePoints::most}> is_taken{};
    const auto keep = [&](int i) {
        kept.points[slot(kept.count++)] = i;
        is_taken[slot(i)] = true;
    };
    const auto keep_most = [&](const auto &score) {
        int best = -1;
        Real most = Real(0);
        for (int i = 0; i < all.count; ++i) {
            if (is_taken[slot(i)])
                continue;
            const Real value = score(all.points[slot(i)].position);
            if (best < 0 || value > most * clearly) {
                best = i;
                most = value;
            }
        }
        keep(best);
    };
    const Real deepest = all.deepest();
    int first = 0;
    while (all.points[slot(first)].separation > deepest + Real(0.1) * feature_tolerance)
        ++first;
    keep(first);
    const Vec3 p = all.points[slot(first)].position;
    keep_most([&](const Vec3 &v) {
        const Vec3 flat = glm::cross(v - p, normal);
        return glm::dot(flat, flat);
    });
    const Vec3 q = all.points[slot(kept.points[1])].position;
    keep_most([&](const Vec3 &v) { return std::abs(glm::dot(glm::cross(q - p, v - p), normal)); });
    const Vec3 r = all.points[slot(kept.points[2])].position;
    const Real turn = glm::dot(glm::cross(q - p, r - p), normal) < Real(0) ? Real(-1) : Real(1);
    // The fourth adds the most area outside the triangle, beyond one of its sides.
    keep_most([&](const Vec3 &v) {
        const auto beyond = [&](const Vec3 &from, const Vec3 &to) {
            return -turn * glm::dot(glm::cross(to - from, v - from), normal);
        };
        return std::max({beyond(p, q), beyond(q, r), beyond(r, p), Real(0)});
    });
    std::sort(kept.points.begin(), kept.points.end());
    return kept;
}

KeptPoints best_under(const CandidatePoints &all, const Vec3 &normal, const Vec3 &load) {
    constexpr Real clearly = Real(1e-4); // of their distance
    constexpr int most_exchanges = 8;
    KeptPoints kept = best_four(all, normal);
    if (all.count <= 4)
        return kept;
    const auto room_of = [&](const KeptPoints &some) {
        const auto at = [&](int k) -> const Vec3 & {
            return all.points[slot(some.points[slot(k)])].position;
        };
        return room_between(some.count, at, normal, load);
    };
    const Vec3 &first = all.points[slot(kept.points[0])].position;
    Real size = Real(0);
    for (const int i : kept.points)
        size = std::max(size, glm::distance(all.points[slot(i)].position, first));
    Real room = room_of(kept);
    for (int exchange = 0; exchange < most_exchanges; ++exchange) {
        KeptPoints best = kept;
        Real most = room + clearly * size;
        for (std::size_t k = 0; k < kept.points.size(); ++k)
            for (int i = 0; i < all.count; ++i) {
                if (std::ranges::find(kept.points, i) != kept.points.end())
                    continue;
                KeptPoints tried = kept;
                tried.points[k] = i;
                if (const Real left = room_of(tried); left > most) {
                    most = left;
                    best = tried;
                }
            }
        if (best.points == kept.points)
            break;
        kept = best;
        room = most;
    }
    std::ranges::sort(kept.points);
    return kept;
}

Real room_around(const Manifold &manifold, const Vec3 &place) {
    const auto at = [&](int k) -> const Vec3 & { return manifold.points[slot(k)].position; };
    return room_between(manifold.count, at, manifold.normal, place);
}

} // namespace plumb::inline PLUMB_PRECISION

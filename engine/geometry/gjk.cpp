#include "engine/geometry/gjk.h"

#include <algorithm>

namespace plumb::inline PLUMB_PRECISION {

namespace {

const Vec3 &at(const Simplex &simplex, int i) {
    return simplex.vertices[static_cast<std::size_t>(i)].w;
}

SimplexPart vertex_part(const Simplex &simplex, int i) {
    const Vec3 &w = at(simplex, i);
    return {w, glm::dot(w, w), {Real(1)}, {i}, 1};
}

SimplexPart edge_part(const Simplex &simplex, int i, int j) {
    const Vec3 &p = at(simplex, i);
    const Vec3 &q = at(simplex, j);
    const Vec3 along = q - p;
    const Real squared = glm::dot(along, along);
    const Real from_p = -glm::dot(p, along);
    const Real from_q = glm::dot(q, along);
    if (!(from_p > Real(0)))
        return vertex_part(simplex, i);
    if (!(from_q > Real(0)))
        return vertex_part(simplex, j);
    const Real s = from_p / squared;
    // Make it perpendicular to the edge again: rounding leaves eps |p| along the edge, which can
    // exceed the distance, and the next search direction is only as good as this vector.
    Vec3 closest = from_p < from_q ? p + s * along : q - (from_q / squared) * along;
    closest -= along * (glm::dot(closest, along) / squared);
    return {closest, glm::dot(closest, closest), {Real(1) - s, s}, {i, j}, 2};
}

void keep_closer(SimplexPart &best, const SimplexPart &other) {
    if (other.squared_distance < best.squared_distance)
        best = other;
}

// Whether the origin's projection is on the inner side of the edge from `start` along `side`, given
// the (signed, scaled) area they span. A positive slack allows it to be outside by that many
// roundings of the area.
bool is_inner(Real area, const Vec3 &start, const Vec3 &side, Real squared_normal, Real slack) {
    if (area > Real(0))
        return true;
    // Compare lengths: squared areas would overflow.
    return slack > Real(0) &&
           -area <= slack * std::sqrt(squared_normal) * glm::length(start) * glm::length(side);
}

Vec3 normal_of(const Simplex &simplex, int i, int j, int k) {
    const Vec3 &p = at(simplex, i);
    const Vec3 &q = at(simplex, j);
    const Vec3 &r = at(simplex, k);
    return triangle_normal(q - p, r - p, r - q);
}

// `normal` is the triangle's normal_of.
SimplexPart triangle_part(const Simplex &simplex, int i, int j, int k, const Vec3 &normal,
                          Real slack) {
    const Vec3 &p = at(simplex, i);
    const Vec3 &q = at(simplex, j);
    const Vec3 &r = at(simplex, k);
    const Vec3 pq = q - p;
    const Vec3 pr = r - p;
    const Vec3 qr = r - q;
    const Real squared = glm::dot(normal, normal);
    // The area each edge spans with the origin's projection, scaled by the normal's length. As p x
    // (q - p), not p x q: the error is then proportional to the edge's length.
    const Real area_p = glm::dot(glm::cross(q, qr), normal);
    const Real area_q = glm::dot(glm::cross(pr, r), normal);
    const Real area_r = glm::dot(glm::cross(p, pq), normal);
    const bool in_p = is_inner(area_p, q, qr, squared, slack);
    const bool in_q = is_inner(area_q, r, pr, squared, slack);
    const bool in_r = is_inner(area_r, p, pq, squared, slack);
    const Real sum =
        std::max(area_p, Real(0)) + std::max(area_q, Real(0)) + std::max(area_r, Real(0));
    if (in_p && in_q && in_r && sum > Real(0)) {
        // Along the normal, so its direction is as good as the plane's, however short it is.
        const Vec3 closest = normal * (glm::dot(p, normal) / squared);
        return {closest,
                glm::dot(closest, closest),
                {std::max(area_p, Real(0)) / sum, std::max(area_q, Real(0)) / sum,
                 std::max(area_r, Real(0)) / sum},
                {i, j, k},
                3};
    }
    // The closest point is on an edge that the projection is beyond.
    SimplexPart best;
    if (!(area_p > Real(0)))
        keep_closer(best, edge_part(simplex, j, k));
    if (!(area_q > Real(0)))
        keep_closer(best, edge_part(simplex, i, k));
    if (!(area_r > Real(0)))
        keep_closer(best, edge_part(simplex, i, j));
    return best;
}

constexpr int newest = 3;

// The faces of a tetrahedron at the newest vertex: face i also has vertices i and i + 1; vertex i +
// 2 is opposite (indices mod 3).
struct NewFaces {
    std::array<Vec3, 3> normals{};
    std::array<Real, 3> heights{}; // of the opposite vertex, scaled like the normal
};
NewFaces new_faces(const Simplex &simplex) {
    NewFaces faces;
    for (int i = 0; i < 3; ++i) {
        const auto f = static_cast<std::size_t>(i);
        faces.normals[f] = normal_of(simplex, newest, i, (i + 1) % 3);
        faces.heights[f] =
            glm::dot(at(simplex, (i + 2) % 3) - at(simplex, newest), faces.normals[f]);
    }
    return faces;
}

SimplexPart tetrahedron_part(const Simplex &simplex, const Vec3 &size, Real slack) {
    const Vec3 &p = at(simplex, newest);
    const NewFaces faces = new_faces(simplex);
    std::array<bool, 3> is_outside{};
    bool is_flat = false;
    for (std::size_t f = 0; f < 3; ++f) {
        is_flat = is_flat || std::abs(faces.heights[f]) <= rounding_along(faces.normals[f], size);
        is_outside[f] = !(-glm::dot(p, faces.normals[f]) * faces.heights[f] > Real(0));
    }
    SimplexPart best;
    if (is_flat || is_outside[0] || is_outside[1] || is_outside[2]) {
        for (int i = 0; i < 3; ++i) {
            const auto f = static_cast<std::size_t>(i);
            if (is_flat || is_outside[f])
                keep_closer(
                    best, triangle_part(simplex, newest, i, (i + 1) % 3, faces.normals[f], slack));
        }
        return best;
    }
    best.squared_distance = Real(0);
    best.count = 4;
    return best;
}

// Vertex weights of a tetrahedron around the origin: the origin's height above the opposite face
// over the vertex's height above it. Repeated to refine what rounding left, which is most for thin
// tetrahedra.
std::array<Real, 4> inner_weights(const Simplex &simplex, const Vec3 &size) {
    const NewFaces faces = new_faces(simplex);
    std::array<Real, 4> weights{};
    Vec3 off = at(simplex, newest);
    const auto weighted_sum = [&] {
        Vec3 sum{Real(0)};
        for (std::size_t i = 0; i < 4; ++i)
            sum += weights[i] * simplex.vertices[i].w;
        return sum;
    };
    weights[newest] = Real(1);
    const Real settled = std::numeric_limits<Real>::epsilon() * glm::length(size);
    for (int pass = 0; pass < 4 && glm::dot(off, off) > settled * settled; ++pass) {
        for (std::size_t f = 0; f < 3; ++f) {
            const Real change = glm::dot(off, faces.normals[f]) / faces.heights[f];
            weights[(f + 2) % 3] -= change;
            weights[newest] += change;
        }
        off = weighted_sum();
    }
    for (Real &weight : weights)
        weight = std::max(weight, Real(0));
    off = weighted_sum();
    constexpr Real nothing = Real(8) * std::numeric_limits<Real>::epsilon();
    if (glm::dot(off, off) > nothing * nothing * glm::dot(size, size)) {
        // So thin that the volumes are mostly rounding: the closest face does as well.
        SimplexPart face = triangle_part(simplex, 0, 1, 2, normal_of(simplex, 0, 1, 2), Real(0));
        for (int i = 0; i < 3; ++i)
            keep_closer(face, triangle_part(simplex, newest, i, (i + 1) % 3,
                                            faces.normals[static_cast<std::size_t>(i)], Real(0)));
        if (face.squared_distance < glm::dot(off, off)) {
            weights = {};
            for (std::size_t i = 0; i < static_cast<std::size_t>(face.count); ++i)
                weights[static_cast<std::size_t>(face.indices[i])] = face.weights[i];
        }
    }
    return weights;
}

} // namespace

Vec3 triangle_normal(const Vec3 &pq, const Vec3 &pr, const Vec3 &qr) {
    const Real squared_pq = glm::dot(pq, pq);
    const Real squared_pr = glm::dot(pr, pr);
    const Real squared_qr = glm::dot(qr, qr);
    // Which side is the longest is hard to foresee: chosen without branches.
    const bool is_qr = (squared_qr >= squared_pq) & (squared_qr >= squared_pr);
    const bool is_pq = !is_qr & !(squared_pr >= squared_pq);
    const Vec3 &one = is_pq ? pr : pq;
    const Vec3 &other = is_qr ? pr : qr;
    const Vec3 &longest = is_qr ? qr : is_pq ? pq : pr;
    const Vec3 normal = glm::cross(one, other);
    const Real squared = glm::dot(longest, longest);
    return squared > Real(0) ? normal - longest * (glm::dot(normal, longest) / squared) : normal;
}

SimplexPart closest_part(const Simplex &simplex, const Vec3 &size, Real slack) {
    switch (simplex.count) {
    case 1:
        return vertex_part(simplex, 0);
    case 2:
        return edge_part(simplex, 1, 0);
    case 3:
        return triangle_part(simplex, 2, 0, 1, normal_of(simplex, 2, 0, 1), slack);
    default:
        return tetrahedron_part(simplex, size, slack);
    }
}

void reduce(Simplex &simplex, const SimplexPart &part) {
    std::array<SimplexVertex, 4> kept;
    for (std::size_t i = 0; i < static_cast<std::size_t>(part.count); ++i)
        kept[i] = simplex.vertices[static_cast<std::size_t>(part.indices[i])];
    for (std::size_t i = 0; i < static_cast<std::size_t>(part.count); ++i)
        simplex.vertices[i] = kept[i];
    simplex.weights = part.weights;
    simplex.count = part.count;
}

namespace {

// For a needle, areas locate a point well across it but badly along it. Corrects the weights along
// the longest edge so that they sum to the known closest point.
void settle_along_longest(Simplex &simplex, const Vec3 &closest) {
    const auto count = static_cast<std::size_t>(simplex.count);
    const auto difference = [&](std::size_t i) {
        return simplex.vertices[i].b - simplex.vertices[i].a;
    };
    Vec3 off = closest;
    Vec3 longest{Real(0)};
    Real squared = Real(0);
    std::size_t from = 0;
    std::size_t to = 0;
    for (std::size_t i = 0; i < count; ++i) {
        off -= simplex.weights[i] * difference(i);
        for (std::size_t j = 0; j < i; ++j) {
            const Vec3 side = difference(i) - difference(j);
            const Real squared_side = glm::dot(side, side);
            if (squared_side > squared) {
                squared = squared_side;
                longest = side;
                from = j;
                to = i;
            }
        }
    }
    if (!(squared > Real(0)))
        return;
    const Real change =
        std::clamp(glm::dot(off, longest) / squared, -simplex.weights[to], simplex.weights[from]);
    simplex.weights[from] -= change;
    simplex.weights[to] += change;
}

} // namespace

Witnesses witnesses(const GjkResult &result) {
    Simplex simplex = result.simplex;
    if (simplex.count == 3)
        settle_along_longest(simplex, result.difference);
    if (simplex.count == 4)
        simplex.weights = inner_weights(simplex, result.size);
    Vec3 on_a{Real(0)};
    Vec3 on_b{Real(0)};
    Real spread_a = Real(0);
    Real spread_b = Real(0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i) {
        const SimplexVertex &vertex = simplex.vertices[i];
        on_a += simplex.weights[i] * vertex.a;
        on_b += simplex.weights[i] * vertex.b;
        const Vec3 from_a = magnitudes(vertex.a - simplex.vertices[0].a);
        const Vec3 from_b = magnitudes(vertex.b - simplex.vertices[0].b);
        spread_a = std::max(spread_a, from_a.x + from_a.y + from_a.z);
        spread_b = std::max(spread_b, from_b.x + from_b.y + from_b.z);
    }
    // Errors in the weights move the point on the smaller simplex less.
    if (spread_a <= spread_b)
        on_b = on_a + result.difference;
    else
        on_a = on_b - result.difference;
    return {on_a, on_b};
}

ClosestPoints closest_points(const NearestPoints &found, Real radius_a, Real radius_b,
                             const Vec3 &origin) {
    ClosestPoints result;
    result.iterations = found.iterations;
    const Real radii = radius_a + radius_b;
    const Real between = std::sqrt(found.squared_distance);
    if (found.is_overlapping || between <= radii) {
        // Any point between the two surfaces is common to both shapes.
        const Real share = radii > Real(0) ? radius_a / radii : Real(0);
        result.on_a = result.on_b = origin + (found.on_a + share * (found.on_b - found.on_a));
        return result;
    }
    result.distance = between - radii;
    result.normal = found.difference / between;
    result.on_a = origin + (found.on_a + radius_a * result.normal);
    result.on_b = origin + (found.on_b - radius_b * result.normal);
    return result;
}

ClosestPoints closest_points(const GjkResult &found, Real radius_a, Real radius_b,
                             const Vec3 &origin) {
    const Witnesses on = witnesses(found);
    return closest_points(NearestPoints{on.on_a, on.on_b, found.difference, found.squared_distance,
                                        found.is_overlapping, found.iterations},
                          radius_a, radius_b, origin);
}

} // namespace plumb::inline PLUMB_PRECISION

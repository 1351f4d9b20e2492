#include "engine/geometry/epa.h"

#include "engine/geometry/gauss_map.h"

#include <algorithm>
#include <span>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr std::size_t slot(int i) {
    return static_cast<std::size_t>(i);
}

constexpr std::uint8_t small(int i) {
    return static_cast<std::uint8_t>(i);
}

} // namespace

// The vertices and faces are filled in as they come into use.
// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
Polytope::Polytope(const Simplex &simplex) : vertex_count_(4) {
    for (std::size_t i = 0; i < 4; ++i)
        vertices_[i] = simplex.vertices[i];
    const Vec3 &p = vertices_[0].w;
    const Vec3 volume = glm::cross(vertices_[1].w - p, vertices_[2].w - p);
    if (glm::dot(volume, vertices_[3].w - p) > Real(0))
        std::swap(vertices_[1], vertices_[2]);
    // Now 0, 1, 2 is counter-clockwise from outside.
    add_face(0, 1, 2);
    add_face(0, 3, 1);
    add_face(1, 3, 2);
    add_face(2, 3, 0);
    join(0, 0, 1, 2);
    join(0, 1, 2, 2);
    join(0, 2, 3, 2);
    join(1, 1, 2, 0);
    join(2, 1, 3, 0);
    join(3, 1, 1, 0);
}

int Polytope::add_face(int p, int q, int r) {
    int f = first_free_;
    while (f < face_end_ && faces_[slot(f)].is_used)
        ++f;
    first_free_ = f + 1;
    if (f == face_end_)
        ++face_end_;
    Face &face = faces_[slot(f)];
    face.vertices = {small(p), small(q), small(r)};
    face.is_used = true;
    face.is_visible = false;
    const Vec3 &at_p = vertices_[slot(p)].w;
    const Vec3 &at_q = vertices_[slot(q)].w;
    const Vec3 &at_r = vertices_[slot(r)].w;
    const Vec3 normal = triangle_normal(at_q - at_p, at_r - at_p, at_r - at_q);
    const Real squared = glm::dot(normal, normal);
    if (squared >= std::numeric_limits<Real>::min()) {
        face.normal = normal / std::sqrt(squared);
        face.height = std::max({glm::dot(face.normal, at_p), glm::dot(face.normal, at_q),
                                glm::dot(face.normal, at_r)});
    } else {
        // A sliver without a normal: never the nearest, and seen by no point.
        face.normal = Vec3{Real(0)};
        face.height = std::numeric_limits<Real>::infinity();
    }
    face.distance = face.height;
    face.is_measured = false;
    return f;
}

void Polytope::join(int f, int side, int g, int other_side) {
    faces_[slot(f)].neighbors[slot(side)] = small(g);
    faces_[slot(f)].neighbor_sides[slot(side)] = small(other_side);
    faces_[slot(g)].neighbors[slot(other_side)] = small(f);
    faces_[slot(g)].neighbor_sides[slot(other_side)] = small(side);
}

void Polytope::measure(Face &face, const Vec3 &size) const {
    face.is_measured = true;
    const Vec3 &p = vertices_[face.vertices[0]].w;
    const Vec3 &q = vertices_[face.vertices[1]].w;
    const Vec3 &r = vertices_[face.vertices[2]].w;
    // If the origin's projection is in the triangle, the height is the distance.
    if (glm::dot(glm::cross(p, q - p), face.normal) >= Real(0) &&
        glm::dot(glm::cross(q, r - q), face.normal) >= Real(0) &&
        glm::dot(glm::cross(r, p - r), face.normal) >= Real(0))
        return;
    Simplex triangle;
    triangle.count = 3;
    for (std::size_t i = 0; i < 3; ++i)
        triangle.vertices[i] = vertices_[face.vertices[i]];
    face.distance = std::max(face.height, std::sqrt(closest_part(triangle, size).squared_distance));
}

int Polytope::nearest(const Vec3 &size) {
    for (;;) {
        int best = -1;
        for (int f = 0; f < face_end_; ++f)
            if (faces_[slot(f)].is_used &&
                (best < 0 || faces_[slot(f)].distance < faces_[slot(best)].distance))
                best = f;
        Face &face = faces_[slot(best)];
        if (face.is_measured)
            return best;
        measure(face, size);
        if (face.distance == face.height)
            return best;
    }
}

void Polytope::finish(int i, Real height) {
    Face &face = faces_[slot(i)];
    face.height = height;
    face.distance = std::max(face.distance, height);
}

bool Polytope::grow(int i, const SimplexVertex &point, const Vec3 &size) {
    struct Side {
        std::uint8_t face, side;
    };
    constexpr std::size_t most = 2 * face_limit + 2;
    std::array<Side, most> open;   // a stack of edges still to be crossed
    std::array<Side, most> border; // the horizon: edges of faces that stay, in order
    std::array<std::uint8_t, slot(face_limit)> removed;
    std::size_t open_count = 0;
    std::size_t border_count = 0;
    std::size_t removed_count = 0;
    const auto remove = [&](int f, int first_side, int sides) {
        Face &face = faces_[slot(f)];
        face.is_visible = true;
        removed[removed_count++] = small(f);
        for (int k = sides - 1; k >= 0; --k) {
            const std::size_t side = slot((first_side + k) % 3);
            open[open_count++] = {face.neighbors[side], face.neighbor_sides[side]};
        }
    };
    const auto put_back = [&] {
        for (std::size_t k = 0; k < removed_count; ++k)
            faces_[removed[k]].is_visible = false;
        return false;
    };

    remove(i, 0, 3);
    while (open_count > 0) {
        const Side at = open[--open_count];
        const Face &face = faces_[at.face];
        if (face.is_visible)
            continue;
        if (glm::dot(face.normal, point.w) - face.height > rounding_along(face.normal, size))
            remove(at.face, at.side + 1, 2);
        else
            border[border_count++] = at;
    }
    // The horizon must be one loop: each edge ends where the next begins (they run backwards as
    // seen from the faces that stay), and each vertex is passed once.
    const auto from = [&](std::size_t k) {
        return faces_[border[k].face].vertices[(border[k].side + 1U) % 3];
    };
    const auto to = [&](std::size_t k) { return faces_[border[k].face].vertices[border[k].side]; };
    if (border_count < 3 ||
        face_end_ - static_cast<int>(removed_count) + static_cast<int>(border_count) > face_limit)
        return put_back();
    std::array<bool, slot(vertex_limit)> is_passed{};
    for (std::size_t k = 0; k < border_count; ++k) {
        if (to(k) != from((k + 1) % border_count) || is_passed[from(k)])
            return put_back();
        is_passed[from(k)] = true;
    }
    for (int f = 0; f < vertex_count_; ++f)
        if (vertices_[slot(f)].w == point.w)
            return put_back();

    for (std::size_t k = 0; k < removed_count; ++k)
        faces_[removed[k]].is_used = false;
    first_free_ = std::min<int>(
        first_free_, *std::min_element(removed.begin(), removed.begin() + removed_count));
    const int added = vertex_count_++;
    vertices_[slot(added)] = point;
    int first = 0;
    int last = 0;
    for (std::size_t k = 0; k < border_count; ++k) {
        const int f = add_face(from(k), to(k), added);
        join(f, 0, border[k].face, border[k].side);
        if (k == 0)
            first = f;
        else
            join(last, 1, f, 2);
        last = f;
    }
    join(last, 1, first, 2);
    return true;
}

Witnesses Polytope::nearest_points(const Vec3 &normal, Real height, const Vec3 &size) const {
    const Vec3 target = height * normal;
    GjkResult best;
    Simplex triangle;
    Real least = std::numeric_limits<Real>::infinity();
    for (int f = 0; f < face_end_; ++f) {
        const Face &face = faces_[slot(f)];
        if (!face.is_used || !(glm::dot(face.normal, normal) > Real(0.9)))
            continue;
        triangle.count = 3;
        for (std::size_t i = 0; i < 3; ++i) {
            triangle.vertices[i] = vertices_[face.vertices[i]];
            triangle.vertices[i].w -= target;
        }
        const SimplexPart part = closest_part(triangle, size);
        if (part.squared_distance < least) {
            least = part.squared_distance;
            best.simplex = triangle;
            reduce(best.simplex, part);
        }
    }
    best.difference = target;
    return witnesses(best);
}

void keep_independent(Simplex &simplex, const Vec3 &size) {
    const Real tolerance = Real(2) * rounding_of(size);
    const auto at = [&](int i) -> const Vec3 & { return simplex.vertices[slot(i)].w; };
    if (simplex.count == 4) {
        const Vec3 normal = triangle_normal(at(1) - at(0), at(2) - at(0), at(2) - at(1));
        if (std::abs(glm::dot(at(3) - at(0), normal)) <= Real(2) * rounding_along(normal, size))
            simplex.count = 3;
    }
    if (simplex.count == 3) {
        // Of three collinear vertices keep the outer two.
        const std::array<Real, 3> sides = {glm::distance(at(1), at(2)), glm::distance(at(2), at(0)),
                                           glm::distance(at(0), at(1))};
        const auto longest = std::max_element(sides.begin(), sides.end());
        const Vec3 normal = triangle_normal(at(1) - at(0), at(2) - at(0), at(2) - at(1));
        if (glm::length(normal) <= tolerance * *longest) {
            simplex.vertices[static_cast<std::size_t>(longest - sides.begin())] =
                simplex.vertices[2];
            simplex.count = 2;
        }
    }
    if (simplex.count == 2 && glm::distance(at(0), at(1)) <= tolerance)
        simplex.count = 1;
}

namespace {

// When the polytope has too many faces for EPA, try every possible face normal. Then move the
// shapes apart by a little more than the depth and let GJK find the closest points.
[[gnu::cold]] Penetration across_the_nearest_face(const CorePair &cores, Vec3 out, Real least,
                                                  const Vec3 &size) {
    Penetration result;
    const auto [map_a, map_b] = cores.gauss_maps();
    for_each_face_normal(map_a, map_b, [&](const Vec3 &normal) {
        const Real height = glm::dot(cores.support(normal).w, normal);
        ++result.iterations;
        if (height < least) {
            least = height;
            out = normal;
        }
    });
    result.depth = std::max(least, Real(0));
    result.normal = -out;
    const Real gap = Real(1e-2) * result.depth + Real(16) * rounding_of(size);
    const Vec3 apart = (result.depth + gap) * result.normal;
    const GjkResult found = cores.search_moved(apart);
    const Witnesses on = witnesses(found);
    result.on_a = on.on_a;
    result.on_b = on.on_b - apart;
    return result;
}

} // namespace

Penetration core_penetration(const CorePair &cores, const GjkResult &overlap) {
    // A curved surface needs more vertices the closer it is approximated, and around an axis of
    // symmetry it needs them all around: this tolerance takes 64 on each rim.
    constexpr Real of_polytopes = sizeof(Real) == 4 ? Real(1e-5) : Real(1e-10);
    const Real relative = cores.is_curved() ? Real(4e-3) : of_polytopes;
    Simplex simplex = overlap.simplex;
    Vec3 size = overlap.size;
    Penetration result;
    const auto support = [&](const Vec3 &direction) {
        const SimplexVertex vertex = cores.support(direction);
        size = glm::max(size, magnitudes(vertex.a) + magnitudes(vertex.b));
        ++result.iterations;
        return vertex;
    };
    // Of the support points along the directions and their opposites, adds the one farthest from
    // the simplex; false if none is off it by more than rounding.
    const auto widen = [&](std::span<const Vec3> directions, const auto &off) {
        Real most = Real(0);
        SimplexVertex farthest;
        for (const Vec3 &along : directions) {
            for (const Vec3 &direction : {along, -along}) {
                const SimplexVertex vertex = support(direction);
                const Real distance_off = off(vertex.w);
                if (distance_off > most) {
                    most = distance_off;
                    farthest = vertex;
                }
            }
        }
        // For a plane only the rounding along its normal counts, so large thin shapes are not flat.
        const Real rounding = Real(2) * (simplex.count == 3 ? rounding_along(directions[0], size)
                                                            : rounding_of(size));
        if (!(most > rounding))
            return false;
        simplex.vertices[static_cast<std::size_t>(simplex.count++)] = farthest;
        return true;
    };

    const auto flat = [&](const Vec3 &normal) {
        const Witnesses on = witnesses(overlap);
        const bool is_backward = glm::dot(normal, cores.between_middles()) < Real(0);
        result.normal = is_backward ? -normal : normal;
        result.on_a = result.on_b = Real(0.5) * (on.on_a + on.on_b);
        return result;
    };
    keep_independent(simplex, size);
    const Vec3 &w0 = simplex.vertices[0].w;
    if (simplex.count == 1) {
        const std::array<Vec3, 3> axes = {Vec3{Real(1), Real(0), Real(0)},
                                          Vec3{Real(0), Real(1), Real(0)},
                                          Vec3{Real(0), Real(0), Real(1)}};
        if (!widen(axes, [&](const Vec3 &w) { return glm::length(w - w0); }))
            return flat(axes[1]);
    }
    if (simplex.count == 2) {
        const Vec3 along = glm::normalize(simplex.vertices[1].w - w0);
        const Vec3 across = any_perpendicular(along);
        const std::array<Vec3, 2> directions = {across, glm::cross(along, across)};
        if (!widen(directions,
                   [&](const Vec3 &w) { return glm::length(glm::cross(w - w0, along)); }))
            return flat(across);
    }
    if (simplex.count == 3) {
        const Vec3 &w1 = simplex.vertices[1].w;
        const Vec3 &w2 = simplex.vertices[2].w;
        const std::array<Vec3, 1> normal = {
            glm::normalize(triangle_normal(w1 - w0, w2 - w0, w2 - w1))};
        if (!widen(normal, [&](const Vec3 &w) { return std::abs(glm::dot(w - w0, normal[0])); }))
            return flat(normal[0]);
    }

    Polytope polytope(simplex);
    Vec3 best_normal = polytope.face(0).normal;
    Real least = std::numeric_limits<Real>::infinity();
    Real bound = -least;
    for (;;) {
        const int nearest = polytope.nearest(size);
        const Polytope::Face &face = polytope.face(nearest);
        const SimplexVertex vertex = support(face.normal);
        const Real height = glm::dot(vertex.w, face.normal);
        if (height < least) {
            least = height;
            best_normal = face.normal;
        }
        // The polytope is inside the Minkowski difference, so the distance to its surface is a
        // lower bound on the depth; up to rounding it only grows. A plane with the whole difference
        // behind it gives an upper bound. If the shapes touch only within rounding, both bounds can
        // be negative.
        bound = std::max(bound, face.distance);
        if (least - bound <= relative * std::abs(least) + rounding_along(face.normal, size))
            break;
        // A face that cannot grow is finished, and the loop ends when it is the nearest again. The
        // iteration limit is for coordinates so large that products overflow.
        if (polytope.is_full() || result.iterations > 2 * Polytope::vertex_limit) {
            (void)PLUMB_RARELY("epa: vertex limit", true);
            if (!cores.is_curved())
                return across_the_nearest_face(cores, best_normal, least, size);
            result.excess = std::max(least, Real(0)) - std::max(bound, Real(0));
            break;
        }
        if (!polytope.grow(nearest, vertex, size))
            polytope.finish(nearest, height);
    }
    const Witnesses on = polytope.nearest_points(best_normal, least, size);
    result.depth = std::max(least, Real(0));
    result.normal = -best_normal;
    result.on_a = on.on_a;
    result.on_b = on.on_b;
    return result;
}

namespace {

// Converts the cores' closest points to those of the shapes.
Proximity apart(const CorePair &cores, const Vec3 &difference, Real between, const Vec3 &on_a,
                const Vec3 &on_b) {
    Proximity result;
    result.separation = between - (cores.radius_a() + cores.radius_b());
    result.normal = difference / between;
    result.on_a = on_a + cores.radius_a() * result.normal;
    result.on_b = on_b - cores.radius_b() * result.normal;
    return result;
}

} // namespace

Proximity proximity(const CorePair &cores, Real far, const Vec3 &guess) {
    const Real radii = cores.radius_a() + cores.radius_b();
    // If there is a closed form, it decides whether the cores overlap, as in `overlaps`.
    const bool is_decided = cores.has_closed_form();
    if (is_decided) {
        const NearestPoints found = cores.closed_form();
        const Real between = std::sqrt(found.squared_distance);
        if (!found.is_overlapping) {
            Proximity result = apart(cores, found.difference, between, found.on_a, found.on_b);
            result.is_beyond = result.separation > far;
            return result;
        }
    }
    const GjkResult found =
        cores.search(guess == Vec3{Real(0)} ? cores.between_middles() : guess,
                     is_decided ? std::numeric_limits<Real>::infinity() : far + radii);
    Proximity result;
    if (found.is_beyond) {
        result.is_beyond = true;
    } else if (found.is_overlapping) {
        const Penetration deep = core_penetration(cores, found);
        result.separation = -deep.depth - radii;
        result.normal = deep.normal;
        result.on_a = deep.on_a + cores.radius_a() * deep.normal;
        result.on_b = deep.on_b - cores.radius_b() * deep.normal;
        result.excess = deep.excess;
        result.iterations = deep.iterations;
    } else {
        const Witnesses on = witnesses(found);
        result =
            apart(cores, found.difference, std::sqrt(found.squared_distance), on.on_a, on.on_b);
        if (is_decided) // apart by rounding only
            result.separation = -radii;
    }
    result.iterations += found.iterations;
    return result;
}

} // namespace plumb::inline PLUMB_PRECISION

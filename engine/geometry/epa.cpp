#include "engine/geometry/epa.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr std::size_t index(int i) {
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
    int f = 0;
    while (f < face_end_ && faces_[index(f)].is_used)
        ++f;
    if (f == face_end_)
        ++face_end_;
    Face &face = faces_[index(f)];
    face.vertices = {small(p), small(q), small(r)};
    face.is_used = true;
    face.is_visible = false;
    const Vec3 &at_p = vertices_[index(p)].w;
    const Vec3 &at_q = vertices_[index(q)].w;
    const Vec3 &at_r = vertices_[index(r)].w;
    const Vec3 normal = triangle_normal(at_q - at_p, at_r - at_p, at_r - at_q);
    const Real squared = glm::dot(normal, normal);
    if (squared >= std::numeric_limits<Real>::min()) {
        face.normal = normal / std::sqrt(squared);
        face.height = std::max({glm::dot(face.normal, at_p), glm::dot(face.normal, at_q),
                                glm::dot(face.normal, at_r)});
    } else {
        // A sliver without a normal: neither near nor in sight of anything.
        face.normal = Vec3{Real(0)};
        face.height = std::numeric_limits<Real>::infinity();
    }
    return f;
}

void Polytope::join(int f, int side, int g, int other_side) {
    faces_[index(f)].neighbors[index(side)] = small(g);
    faces_[index(f)].neighbor_sides[index(side)] = small(other_side);
    faces_[index(g)].neighbors[index(other_side)] = small(f);
    faces_[index(g)].neighbor_sides[index(other_side)] = small(side);
}

int Polytope::nearest() const {
    int best = -1;
    for (int f = 0; f < face_end_; ++f)
        if (faces_[index(f)].is_used &&
            (best < 0 || faces_[index(f)].height < faces_[index(best)].height))
            best = f;
    return best;
}

bool Polytope::grow(int i, const SimplexVertex &point, const Vec3 &size) {
    struct Side {
        std::uint8_t face, side;
    };
    constexpr std::size_t most = 2 * face_limit + 2;
    std::array<Side, most> open;   // sides still to be looked across, the last one first
    std::array<Side, most> border; // of faces that stay, in order around those that do not
    std::array<std::uint8_t, index(face_limit)> removed;
    std::size_t open_count = 0;
    std::size_t border_count = 0;
    std::size_t removed_count = 0;
    const auto remove = [&](int f, int first_side, int sides) {
        Face &face = faces_[index(f)];
        face.is_visible = true;
        removed[removed_count++] = small(f);
        for (int k = sides - 1; k >= 0; --k) {
            const std::size_t side = index((first_side + k) % 3);
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
    // One loop: each side of the border ends where the next begins (they run backwards, seen from
    // the faces that stay), and a vertex is passed once.
    const auto from = [&](std::size_t k) {
        return faces_[border[k].face].vertices[(border[k].side + 1U) % 3];
    };
    const auto to = [&](std::size_t k) { return faces_[border[k].face].vertices[border[k].side]; };
    if (border_count < 3 ||
        face_end_ - static_cast<int>(removed_count) + static_cast<int>(border_count) > face_limit)
        return put_back();
    std::array<bool, index(vertex_limit)> is_passed{};
    for (std::size_t k = 0; k < border_count; ++k) {
        if (to(k) != from((k + 1) % border_count) || is_passed[from(k)])
            return put_back();
        is_passed[from(k)] = true;
    }
    for (int f = 0; f < vertex_count_; ++f)
        if (vertices_[index(f)].w == point.w)
            return put_back();

    for (std::size_t k = 0; k < removed_count; ++k)
        faces_[removed[k]].is_used = false;
    const int added = vertex_count_++;
    vertices_[index(added)] = point;
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
        const Face &face = faces_[index(f)];
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
    const auto at = [&](int i) -> const Vec3 & { return simplex.vertices[index(i)].w; };
    if (simplex.count == 4) {
        const Vec3 normal = triangle_normal(at(1) - at(0), at(2) - at(0), at(2) - at(1));
        if (std::abs(glm::dot(at(3) - at(0), normal)) <= Real(2) * rounding_along(normal, size))
            simplex.count = 3;
    }
    if (simplex.count == 3) {
        // Of three on a line the two outer ones.
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

} // namespace plumb::inline PLUMB_PRECISION

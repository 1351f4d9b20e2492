#include "engine/geometry/quickhull.h"

#include "engine/core/check.h"
#include "engine/geometry/mass.h"
#include "engine/math/constants.h"
#include "engine/math/predicates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

using Wide = glm::dvec3;
using Index = std::uint32_t;
constexpr Index no_index = ~Index(0);

Wide wide(const Vec3 &v) {
    return {double(v.x), double(v.y), double(v.z)};
}

// Twice the area of a triangle, along its normal. For a needle the products nearly cancel, so this
// uses the widest type available.
Wide area_vector(const Vec3 &a, const Vec3 &b, const Vec3 &c) {
    using Widest = glm::vec<3, long double, glm::defaultp>;
    const Widest u = Widest(b) - Widest(a);
    const Widest v = Widest(c) - Widest(a);
    return Wide(glm::cross(u, v));
}

Wide unit(const Wide &v) {
    // + 0.0 turns -0 into 0.
    return v / glm::length(v) + 0.0;
}

// --- Quickhull (Barber, Dobkin, Huhdanpaa 1996, "The quickhull algorithm for convex hulls") ---
//
// The surface is a closed triangle mesh that is exactly convex at all times: which triangles a
// point sees is decided by exact signs, and a point in a triangle's plane does not see it. So the
// visible triangles always form a disc, and no new triangle is flat. Which points are worth adding,
// on the other hand, depends on rounded heights and the tolerance.

struct Facet {
    std::array<Index, 3> corners{}; // counter-clockwise from outside
    std::array<Index, 3> across{};  // the facet beyond the edge from corner i to corner i + 1
    Wide normal{0.0};               // outward unit normal
    Index first_outside = no_index; // head of the list of points in front of it
    bool is_gone = false;
};

class Surface {
  public:
    // Grows the hull of the points up to the vertex limit.
    Surface(std::vector<Vec3> points, double tolerance, std::size_t max_vertices)
        : points_(std::move(points)), tolerance_(tolerance), max_vertices_(max_vertices),
          next_outside_(points_.size(), no_index), fan_at_(points_.size(), no_index) {
        problem_ = start();
        if (problem_ == HullProblem::none)
            grow();
    }

    HullProblem problem() const { return problem_; }
    const std::vector<Vec3> &points() const { return points_; }
    std::vector<Facet> facets() const;
    // The points that are in front of a facet.
    std::vector<Vec3> left_over() const;

  private:
    // A point to be added and the facet it is in front of, ordered by height.
    struct Candidate {
        double height;
        Index facet;
        Index point;
        bool operator<(const Candidate &other) const {
            return height != other.height ? height < other.height : facet > other.facet;
        }
    };

    HullProblem start();
    void grow();
    void add(const Candidate &eye);
    void gather_seen(Index point, Index first);
    bool bring_back();
    void assign(Index point, Index first_facet, Index end_facet);
    void propose(Index facet);
    Index make_facet(Index a, Index b, Index c);
    bool sees(Index point, const Facet &facet) const {
        const auto &[a, b, c] = facet.corners;
        return orient3d(points_[a], points_[b], points_[c], points_[point]) > 0;
    }
    double height(Index point, const Facet &facet) const {
        return glm::dot(facet.normal, wide(points_[point]) - wide(points_[facet.corners[0]]));
    }
    // The point with the greatest measure(point); ties (within the tolerance) go to the point
    // farthest from the centre. Points of a face or an edge tie, and the farthest of them from
    // anywhere is a corner.
    template <typename Measure> Index farthest(Measure &&measure, double &greatest) const;

    std::vector<Vec3> points_;
    double tolerance_ = 0.0;
    std::size_t max_vertices_ = 0;
    std::size_t vertex_count_ = 0;
    HullProblem problem_ = HullProblem::none;
    Wide center_{0.0};
    std::vector<Facet> facets_;
    std::vector<Index> next_outside_; // per point: the next in its list
    std::vector<Index> fan_at_;       // per horizon point: the new facet that starts there
    std::vector<Index> seen_;
    std::priority_queue<Candidate> candidates_;
};

template <typename Measure> Index Surface::farthest(Measure &&measure, double &greatest) const {
    greatest = 0.0;
    for (Index i = 0; i < points_.size(); ++i)
        greatest = std::max(greatest, measure(wide(points_[i])));
    Index best = no_index;
    double best_squared = -1.0;
    for (Index i = 0; i < points_.size(); ++i) {
        const Wide from_center = wide(points_[i]) - center_;
        const double squared = glm::dot(from_center, from_center);
        if (squared > best_squared && measure(wide(points_[i])) >= greatest - tolerance_) {
            best = i;
            best_squared = squared;
        }
    }
    return best;
}

HullProblem Surface::start() {
    if (points_.size() < 4)
        return HullProblem::too_few_points;
    for (const Vec3 &point : points_)
        center_ += wide(point) / double(points_.size());

    // The first tetrahedron, with corners far apart.
    double reach = 0.0;
    Index a = farthest([&](const Wide &p) { return glm::length(p - center_); }, reach);
    Index b = farthest([&](const Wide &p) { return glm::length(p - wide(points_[a])); }, reach);
    if (!(reach > tolerance_))
        return HullProblem::all_in_one_point;
    const Wide along = (wide(points_[b]) - wide(points_[a])) / reach;
    const Index c = farthest(
        [&](const Wide &p) { return glm::length(glm::cross(along, p - wide(points_[a]))); }, reach);
    if (!(reach > tolerance_))
        return HullProblem::all_on_one_line;
    const Wide normal = unit(area_vector(points_[a], points_[b], points_[c]));
    const Index d = farthest(
        [&](const Wide &p) { return std::abs(glm::dot(normal, p - wide(points_[a]))); }, reach);
    const int side = orient3d(points_[a], points_[b], points_[c], points_[d]);
    if (!(reach > tolerance_) || side == 0)
        return HullProblem::all_in_one_plane;
    if (side > 0)
        std::swap(a, b);

    vertex_count_ = 4;
    make_facet(a, b, c);
    make_facet(b, a, d);
    make_facet(c, b, d);
    make_facet(a, c, d);
    facets_[0].across = {1, 2, 3};
    facets_[1].across = {0, 3, 2};
    facets_[2].across = {0, 1, 3};
    facets_[3].across = {0, 2, 1};
    for (Index i = 0; i < points_.size(); ++i)
        if (i != a && i != b && i != c && i != d)
            assign(i, 0, 4);
    for (Index facet = 0; facet < 4; ++facet)
        propose(facet);
    return HullProblem::none;
}

Index Surface::make_facet(Index a, Index b, Index c) {
    Facet facet;
    facet.corners = {a, b, c};
    facet.normal = unit(area_vector(points_[a], points_[b], points_[c]));
    facets_.push_back(facet);
    return static_cast<Index>(facets_.size() - 1);
}

// Adds a point to the list of the facet it is highest above, or to none if it sees none of them. A
// point that is outside the new hull and was in front of a removed facet sees a new one (Barber et
// al. 1996, section 2).
void Surface::assign(Index point, Index first_facet, Index end_facet) {
    Index best = no_index;
    double best_height = -std::numeric_limits<double>::infinity();
    for (Index i = first_facet; i < end_facet; ++i) {
        const double above = height(point, facets_[i]);
        if (above > best_height && sees(point, facets_[i])) {
            best = i;
            best_height = above;
        }
    }
    if (best == no_index)
        return;
    next_outside_[point] = facets_[best].first_outside;
    facets_[best].first_outside = point;
}

void Surface::propose(Index facet) {
    double greatest = 0.0;
    const Facet &here = facets_[facet];
    for (Index i = here.first_outside; i != no_index; i = next_outside_[i])
        greatest = std::max(greatest, height(i, here));
    if (!(greatest > tolerance_))
        return;
    Index best = no_index;
    double best_squared = -1.0;
    for (Index i = here.first_outside; i != no_index; i = next_outside_[i]) {
        const Wide from_center = wide(points_[i]) - center_;
        const double squared = glm::dot(from_center, from_center);
        // Of duplicates take the first in the input.
        if (height(i, here) >= greatest - tolerance_ &&
            (squared > best_squared || (squared == best_squared && i < best))) {
            best = i;
            best_squared = squared;
        }
    }
    candidates_.push({greatest, facet, best});
}

void Surface::grow() {
    do {
        while (!candidates_.empty() && vertex_count_ < max_vertices_) {
            const Candidate eye = candidates_.top();
            candidates_.pop();
            if (!facets_[eye.facet].is_gone)
                add(eye);
        }
    } while (vertex_count_ < max_vertices_ && bring_back());
}

// Flood-fills the facets that a point sees, starting from one of them. They are connected.
void Surface::gather_seen(Index point, Index first) {
    seen_.assign(1, first);
    facets_[first].is_gone = true; // marks those in seen_
    for (std::size_t i = 0; i < seen_.size(); ++i)
        for (const Index next : facets_[seen_[i]].across)
            if (!facets_[next].is_gone && sees(point, facets_[next])) {
                facets_[next].is_gone = true;
                seen_.push_back(next);
            }
}

void Surface::add(const Candidate &eye) {
    ++vertex_count_;
    gather_seen(eye.point, eye.facet);

    // A fan of new facets connects the hole's border, the horizon, to the point.
    const Index first_new = static_cast<Index>(facets_.size());
    for (const Index gone : seen_)
        for (std::size_t i = 0; i < 3; ++i) {
            const Index beyond = facets_[gone].across[i];
            if (facets_[beyond].is_gone)
                continue;
            const Index from = facets_[gone].corners[i];
            const Index to = facets_[gone].corners[(i + 1) % 3];
            const Index fresh = make_facet(from, to, eye.point);
            facets_[fresh].across[0] = beyond;
            for (std::size_t j = 0; j < 3; ++j)
                if (facets_[beyond].corners[j] == to && facets_[beyond].across[j] == gone)
                    facets_[beyond].across[j] = fresh;
            fan_at_[from] = fresh;
        }
    const Index end_new = static_cast<Index>(facets_.size());
    for (Index fresh = first_new; fresh < end_new; ++fresh) {
        const Index next = fan_at_[facets_[fresh].corners[1]];
        facets_[fresh].across[1] = next;
        facets_[next].across[2] = fresh;
    }

    for (const Index gone : seen_) {
        Index point = std::exchange(facets_[gone].first_outside, no_index);
        while (point != no_index) {
            const Index next = next_outside_[point];
            if (point != eye.point)
                assign(point, first_new, end_new);
            point = next;
        }
    }
    for (Index fresh = first_new; fresh < end_new; ++fresh)
        propose(fresh);
}

// A point that was left over because it is barely above its own facet may be higher above another
// facet it sees. Returns whether there are any such points.
bool Surface::bring_back() {
    const Index count = static_cast<Index>(facets_.size());
    for (Index i = 0; i < count; ++i) {
        if (facets_[i].is_gone)
            continue;
        for (Index p = facets_[i].first_outside; p != no_index; p = next_outside_[p]) {
            gather_seen(p, i);
            Index best = i;
            for (const Index facet : seen_) {
                facets_[facet].is_gone = false;
                if (height(p, facets_[facet]) > height(p, facets_[best]))
                    best = facet;
            }
            if (height(p, facets_[best]) > tolerance_)
                candidates_.push({height(p, facets_[best]), best, p});
        }
    }
    return !candidates_.empty();
}

std::vector<Facet> Surface::facets() const {
    std::vector<Index> new_index(facets_.size(), no_index);
    Index count = 0;
    for (std::size_t i = 0; i < facets_.size(); ++i)
        if (!facets_[i].is_gone)
            new_index[i] = count++;
    std::vector<Facet> result;
    result.reserve(count);
    for (const Facet &facet : facets_)
        if (!facet.is_gone) {
            result.push_back(facet);
            for (Index &across : result.back().across)
                across = new_index[across];
        }
    return result;
}

std::vector<Vec3> Surface::left_over() const {
    std::vector<Vec3> result;
    for (const Facet &facet : facets_)
        if (!facet.is_gone)
            for (Index i = facet.first_outside; i != no_index; i = next_outside_[i])
                result.push_back(points_[i]);
    return result;
}

// --- Faces ---

// The facets joined into faces.
struct Faces {
    std::vector<Index> face_of; // per facet
    std::vector<Index> seeds;   // per face: the largest facet, whose plane the others are in
};

// Grows faces outwards from the largest facets, over facets whose corners are all in the seed's
// plane within the tolerance. A facet joins only if the face stays a disc: it shares one edge and
// its third corner is new to the face, or it shares two.
Faces join(const std::vector<Facet> &facets, const std::vector<Vec3> &points, double tolerance) {
    std::vector<double> areas;
    std::vector<Index> order;
    areas.reserve(facets.size());
    for (const Facet &facet : facets) {
        const auto &[a, b, c] = facet.corners;
        areas.push_back(glm::length(area_vector(points[a], points[b], points[c])));
        order.push_back(static_cast<Index>(order.size()));
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](Index i, Index j) { return areas[i] > areas[j]; });

    Faces faces;
    faces.face_of.assign(facets.size(), no_index);
    std::vector<Index> corner_of(points.size(), no_index); // the last face that took the point
    std::vector<Index> grown;
    for (const Index seed : order) {
        if (faces.face_of[seed] != no_index)
            continue;
        const Index face = static_cast<Index>(faces.seeds.size());
        faces.seeds.push_back(seed);
        const Wide base = wide(points[facets[seed].corners[0]]);
        const auto take = [&](Index facet) {
            faces.face_of[facet] = face;
            for (const Index corner : facets[facet].corners)
                corner_of[corner] = face;
            grown.push_back(facet);
        };
        const auto is_in_plane = [&](Index corner) {
            const auto &[a, b, c] = facets[seed].corners;
            return std::abs(glm::dot(facets[seed].normal, wide(points[corner]) - base)) <=
                       tolerance ||
                   orient3d(points[a], points[b], points[c], points[corner]) == 0;
        };
        const auto keeps_disc = [&](const Facet &facet) {
            int shared = 0;
            Index third = no_index;
            for (std::size_t i = 0; i < 3; ++i)
                if (faces.face_of[facet.across[i]] == face) {
                    ++shared;
                    third = facet.corners[(i + 2) % 3];
                }
            return shared == 2 || (shared == 1 && corner_of[third] != face);
        };
        grown.clear();
        take(seed);
        for (std::size_t i = 0; i < grown.size(); ++i)
            for (const Index next : facets[grown[i]].across)
                if (faces.face_of[next] == no_index &&
                    std::all_of(facets[next].corners.begin(), facets[next].corners.end(),
                                is_in_plane) &&
                    keeps_disc(facets[next]))
                    take(next);
    }
    return faces;
}

// The points where at least three faces meet, ascending, and all other facet corners.
struct Corners {
    std::vector<Index> kept;
    std::vector<Index> dropped;
};

Corners corners_of(const std::vector<Facet> &facets, const Faces &faces) {
    std::vector<std::pair<Index, Index>> uses; // point, face
    for (std::size_t i = 0; i < facets.size(); ++i)
        for (const Index corner : facets[i].corners)
            uses.emplace_back(corner, faces.face_of[i]);
    std::sort(uses.begin(), uses.end());
    uses.erase(std::unique(uses.begin(), uses.end()), uses.end());
    Corners corners;
    for (std::size_t i = 0; i < uses.size();) {
        std::size_t end = i;
        while (end < uses.size() && uses[end].first == uses[i].first)
            ++end;
        (end - i >= 3 ? corners.kept : corners.dropped).push_back(uses[i].first);
        i = end;
    }
    return corners;
}

// --- The mesh ---

// Adds vertices, faces as vertex loops, and edges. Vertex k is point kept[k].
void add_topology(HullMesh &mesh, const std::vector<Facet> &facets, const Faces &faces,
                  const std::vector<Vec3> &points, const std::vector<Index> &kept) {
    std::vector<Index> vertex_of(points.size(), no_index);
    for (const Index point : kept) {
        vertex_of[point] = static_cast<Index>(mesh.vertices.size());
        mesh.vertices.push_back(points[point]);
    }

    std::vector<std::vector<Index>> facets_of(faces.seeds.size());
    for (Index i = 0; i < facets.size(); ++i)
        facets_of[faces.face_of[i]].push_back(i);
    std::vector<Index> next_at(points.size(), no_index); // along the border of the current face
    for (Index face = 0; face < faces.seeds.size(); ++face) {
        Index first = no_index;
        for (const Index i : facets_of[face])
            for (std::size_t k = 0; k < 3; ++k) {
                const Index beyond = faces.face_of[facets[i].across[k]];
                if (beyond == face)
                    continue;
                const Index from = facets[i].corners[k];
                const Index to = facets[i].corners[(k + 1) % 3];
                next_at[from] = to;
                first = first == no_index ? from : first;
                if (face < beyond)
                    mesh.edges.push_back({vertex_of[from], vertex_of[to], face, beyond});
            }
        HullMesh::Face loop;
        loop.first = static_cast<Index>(mesh.vertex_indices.size());
        Index point = first;
        do {
            mesh.vertex_indices.push_back(vertex_of[point]);
            point = next_at[point];
            ++loop.count;
        } while (point != first);
        mesh.faces.push_back(loop);
        mesh.most_corners = std::max(mesh.most_corners, loop.count);
        const auto &[a, b, c] = facets[faces.seeds[face]].corners;
        mesh.face_corners.push_back({vertex_of[a], vertex_of[b], vertex_of[c]});
    }

    mesh.first_neighbor.assign(mesh.vertices.size() + 1, 0);
    for (const HullMesh::Edge &edge : mesh.edges) {
        ++mesh.first_neighbor[edge.a + 1];
        ++mesh.first_neighbor[edge.b + 1];
    }
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        mesh.first_neighbor[i + 1] += mesh.first_neighbor[i];
    mesh.neighbors.resize(2 * mesh.edges.size());
    std::vector<Index> end(mesh.first_neighbor.begin(), mesh.first_neighbor.end() - 1);
    for (const HullMesh::Edge &edge : mesh.edges) {
        mesh.neighbors[end[edge.a]++] = edge.b;
        mesh.neighbors[end[edge.b]++] = edge.a;
    }
}

// Adds the slack and the planes, each moved out until no vertex is in front of it by exact signs.
void add_planes(HullMesh &mesh, const std::vector<Facet> &facets, const Faces &faces,
                const std::vector<Vec3> &points) {
    std::vector<Wide> normals(faces.seeds.size(), Wide{0.0});
    for (std::size_t i = 0; i < facets.size(); ++i) {
        const auto &[a, b, c] = facets[i].corners;
        normals[faces.face_of[i]] += area_vector(points[a], points[b], points[c]);
    }
    for (const Wide &normal : normals)
        mesh.planes.push_back({Vec3(unit(normal)), Real(0)});
    for (const Vec3 &vertex : mesh.vertices) {
        mesh.box.min = glm::min(mesh.box.min, vertex);
        mesh.box.max = glm::max(mesh.box.max, vertex);
    }
    const Vec3 far = glm::max(glm::abs(mesh.box.min), glm::abs(mesh.box.max));
    const Real reach = far.x + far.y + far.z;
    double tilt = 0.0;
    for (std::size_t face = 0; face < faces.seeds.size(); ++face) {
        Plane &plane = mesh.planes[face];
        double offset = -std::numeric_limits<double>::infinity();
        for (const Vec3 &vertex : mesh.vertices)
            offset = std::max(offset, glm::dot(wide(plane.normal), wide(vertex)));
        plane.offset = Real(offset);
        const auto is_in_front = [&](const Vec3 &vertex) {
            return plane_sign(plane.normal, plane.offset, vertex) > 0;
        };
        // For subnormal coordinates the product may be 0, and the loop would never end.
        Real step = std::max(epsilon * std::max(std::abs(plane.offset), epsilon * reach),
                             std::numeric_limits<Real>::denorm_min());
        while (std::any_of(mesh.vertices.begin(), mesh.vertices.end(), is_in_front)) {
            plane.offset += step;
            step *= Real(2);
        }

        // Two heights that are linear in the point differ most at a corner of the box.
        const Facet &seed = facets[faces.seeds[face]];
        const Wide base = wide(points[seed.corners[0]]);
        for (int corner = 0; corner < 8; ++corner) {
            const Wide p{double((corner & 1) != 0 ? mesh.box.max.x : mesh.box.min.x),
                         double((corner & 2) != 0 ? mesh.box.max.y : mesh.box.min.y),
                         double((corner & 4) != 0 ? mesh.box.max.z : mesh.box.min.z)};
            const double rounded = glm::dot(wide(plane.normal), p) - double(plane.offset);
            tilt = std::max(tilt, std::abs(rounded - glm::dot(seed.normal, p - base)));
        }
        const auto &[a, b, c] = mesh.face_corners[face];
        const HullMesh::Face &loop = mesh.faces[face];
        for (Index i = loop.first; i < loop.first + loop.count; ++i)
            mesh.has_flat_faces = mesh.has_flat_faces &&
                                  orient3d(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c],
                                           mesh.vertices[mesh.vertex_indices[i]]) == 0;
    }
    // A height is three products and three sums of terms that add up to at most twice the reach,
    // each off by half an epsilon: 4 epsilon * reach. The same again for the rounding of this
    // computation.
    mesh.slack = Real(tilt) + Real(8) * epsilon * reach;
}

HullProblem add_mass(HullMesh &mesh, const std::vector<Facet> &facets,
                     const std::vector<Vec3> &points) {
    std::vector<Triangle> surface;
    surface.reserve(facets.size());
    for (const Facet &facet : facets) {
        const auto &[a, b, c] = facet.corners;
        surface.push_back({points[a], points[b], points[c]});
    }
    const MassProperties mass = mass_properties(surface);
    mesh.volume = mass.volume;
    mesh.center = mass.center;
    mesh.inertia = mass.inertia;
    bool is_in_range = mass.volume > Real(0) && std::isfinite(mass.volume);
    for (int i = 0; i < 3; ++i)
        is_in_range =
            is_in_range && mass.inertia[i][i] > Real(0) && std::isfinite(mass.inertia[i][i]);
    return is_in_range ? HullProblem::none : HullProblem::out_of_range;
}

double left_out(const HullMesh &mesh, const std::vector<Vec3> &points) {
    double greatest = 0.0;
    for (const Vec3 &point : points)
        for (const Plane &plane : mesh.planes)
            greatest = std::max(greatest,
                                glm::dot(wide(plane.normal), wide(point)) - double(plane.offset));
    return greatest;
}

// A mesh, and points not in it that may be in front of it.
struct Built {
    HullMesh mesh;
    HullProblem problem = HullProblem::none;
    std::vector<Vec3> left_over; // never were vertices
    std::vector<Vec3> dropped;   // was
};

// A vertex with fewer than three faces became flat when facets were joined. Removing such vertices
// may create others, so the hull is rebuilt from the remaining points.
Built build(std::vector<Vec3> candidates, double tolerance, double join_tolerance,
            int max_vertices) {
    Built built;
    for (;;) {
        const Surface surface(std::move(candidates), tolerance,
                              static_cast<std::size_t>(max_vertices));
        built.problem = surface.problem();
        if (built.problem != HullProblem::none)
            return built;
        const std::vector<Vec3> &points = surface.points();
        const std::vector<Facet> facets = surface.facets();
        const Faces faces = join(facets, points, join_tolerance);
        const Corners corners = corners_of(facets, faces);
        const std::vector<Vec3> left_over = surface.left_over();
        built.left_over.insert(built.left_over.end(), left_over.begin(), left_over.end());
        if (corners.dropped.empty()) {
            add_topology(built.mesh, facets, faces, points, corners.kept);
            add_planes(built.mesh, facets, faces, points);
            built.problem = add_mass(built.mesh, facets, points);
            return built;
        }
        candidates.clear();
        for (const Index point : corners.kept)
            candidates.push_back(points[point]);
        for (const Index point : corners.dropped)
            built.dropped.push_back(points[point]);
        if (candidates.size() < 4) {
            built.problem = HullProblem::all_in_one_plane;
            return built;
        }
    }
}

HullResult failed(HullProblem problem, double tolerance) {
    HullResult result;
    result.problem = problem;
    result.tolerance = Real(tolerance);
    return result;
}

} // namespace

HullResult convex_hull(std::span<const Vec3> points, int max_vertices) {
    PLUMB_CHECK(max_vertices >= 4, "a hull needs four vertices, got a limit of " << max_vertices);
    if (points.size() < 4)
        return failed(HullProblem::too_few_points, 0.0);
    Wide far{0.0};
    for (const Vec3 &point : points) {
        if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z))
            return failed(HullProblem::not_finite, 0.0);
        far = glm::max(far, glm::abs(wide(point)));
    }
    const double tolerance =
        3.0 * double(std::numeric_limits<Real>::epsilon()) * (far.x + far.y + far.z);
    // Inertia (fifth power) overflows a double beyond this; the exact signs are good well past it.
    constexpr double greatest = 1e60;
    if (!(far.x + far.y + far.z < greatest))
        return failed(HullProblem::out_of_range, tolerance);

    // A component below 1e-80 would underflow in the exact signs; it is far below any relevant
    // tolerance.
    std::vector<Vec3> candidates(points.begin(), points.end());
    if constexpr (sizeof(Real) == sizeof(double))
        for (Vec3 &point : candidates)
            for (int i = 0; i < 3; ++i)
                if (std::abs(double(point[i])) < 1e-80)
                    point[i] = Real(0);

    // Joining facets may lose more than the tolerance if the point set is hardly larger than it;
    // then join less. Exactly coplanar facets lose nothing.
    for (double join_tolerance = tolerance;;) {
        Built built = build(candidates, tolerance, join_tolerance, max_vertices);
        if (built.problem != HullProblem::none)
            return failed(built.problem, tolerance);
        const double lost = left_out(built.mesh, built.dropped);
        if (lost > 2.0 * tolerance && join_tolerance > 0.0) {
            join_tolerance = join_tolerance > tolerance / 10.0 ? join_tolerance / 2.0 : 0.0;
            continue;
        }
        HullResult result;
        result.tolerance = Real(tolerance);
        result.left_out = Real(std::max(lost, left_out(built.mesh, built.left_over)));
        result.mesh = std::move(built.mesh);
        return result;
    }
}

} // namespace plumb::inline PLUMB_PRECISION

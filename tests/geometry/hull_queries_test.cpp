#include "engine/geometry/hull_queries.h"

#include "engine/geometry/quickhull.h"
#include "tests/geometry/hull_points.h"
#include "tests/geometry/oracle.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());
constexpr int no_limit = 1 << 20;

// --- Exact, on the lattice -----------------------------------------------------------------------

struct LatticeHull {
    ExactHull exact;
    HullMesh mesh;
};

LatticeHull any_lattice_hull(Random &random) {
    for (;;) {
        const std::uint32_t reach = 1 + random.next_index(4);
        std::vector<Lattice> lattice;
        std::vector<Vec3> points;
        const std::size_t size = 4 + random.next_index(10);
        for (std::size_t i = 0; i < size; ++i) {
            Lattice p;
            for (std::int64_t &x : p)
                x = std::int64_t(random.next_index(2 * reach + 1)) - reach;
            lattice.push_back(p);
            points.push_back({Real(p[0]), Real(p[1]), Real(p[2])});
        }
        HullResult result = convex_hull(points, no_limit);
        if (result.mesh)
            return {exact_hull(lattice), std::move(*result.mesh)};
    }
}

Lattice any_lattice(Random &random, std::int64_t reach) {
    Lattice p;
    for (std::int64_t &x : p)
        x = std::int64_t(random.next_index(std::uint32_t(2 * reach + 1))) - reach;
    return p;
}

Vec3 real(const Lattice &p) {
    return {Real(p[0]), Real(p[1]), Real(p[2])};
}

// Greatest height over a facet, times the length of its normal: the sign is exact.
bool exact_contains(const ExactHull &hull, const Lattice &p) {
    for (const auto &[facet, corners] : hull.facets)
        if (facet[0] * p[0] + facet[1] * p[1] + facet[2] * p[2] > facet[3])
            return false;
    return true;
}

// Whether a + t (b - a) is in the hull for some t >= 0 (and <= 1 for a segment): clips the interval
// of t with integer fractions.
bool exact_meets(const ExactHull &hull, const Lattice &a, const Lattice &d, bool is_segment) {
    std::int64_t enter_up = 0, enter_down = 1; // t >= up / down
    std::int64_t exit_up = 1, exit_down = is_segment ? 1 : 0;
    for (const auto &[facet, corners] : hull.facets) {
        const std::int64_t above = facet[0] * a[0] + facet[1] * a[1] + facet[2] * a[2] - facet[3];
        const std::int64_t climb = facet[0] * d[0] + facet[1] * d[1] + facet[2] * d[2];
        if (climb == 0) {
            if (above > 0)
                return false;
        } else if (climb < 0) { // t >= above / -climb
            if (above * enter_down > enter_up * -climb) {
                enter_up = above;
                enter_down = -climb;
            }
        } else if (-above * exit_down < exit_up * climb) { // t <= -above / climb
            exit_up = -above;
            exit_down = climb;
        }
    }
    return enter_up * exit_down <= exit_up * enter_down;
}

TEST(HullQueries, ExactOnTheLattice) {
    Random random(1);
    const int count = trials(1'000'000);
    int inside = 0, met = 0, on_border = 0;
    LatticeHull hull = any_lattice_hull(random);
    for (int trial = 0; trial < count; ++trial) {
        if (trial % 200 == 0)
            hull = any_lattice_hull(random);
        const Lattice shift = any_lattice(random, trial % 3 == 0 ? 1000 : 0);
        const ConvexHull placed{&hull.mesh, real(shift)};
        const Lattice a = any_lattice(random, 5);
        const bool is_in = exact_contains(hull.exact, a);
        const Vec3 at_a = real(a) + real(shift);
        ASSERT_EQ(contains(placed, at_a), is_in) << "trial " << trial;
        inside += is_in;
        const Vec3 closest = closest_point(placed, at_a);
        ASSERT_EQ(closest == at_a, is_in) << "trial " << trial;

        Lattice b = any_lattice(random, 5);
        if (trial % 16 == 0)
            b = a;
        if (trial % 16 < 4) // along an axis, or within a face in that direction
            b[std::size_t(trial % 3)] = a[std::size_t(trial % 3)];
        const Lattice d{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
        const bool meets = exact_meets(hull.exact, a, d, true);
        ASSERT_EQ(linetest(placed, at_a, real(b) + real(shift)), meets) << "trial " << trial;
        met += meets;
        on_border += meets && !is_in && !exact_contains(hull.exact, b);
        if (a == b)
            continue;
        const Ray ray{at_a, real(d) * std::scalbn(Real(1), int(random.next_index(41)) - 20)};
        ASSERT_EQ(ray_interval(placed, ray).has_value(), exact_meets(hull.exact, a, d, false))
            << "trial " << trial;
    }
    EXPECT_GT(inside, count / 50);
    EXPECT_GT(met, count / 10);
    EXPECT_GT(on_border, count / 50);
}

// --- Against heights in double -------------------------------------------------------------------

// The hull in the world in wide numbers, with the planes through the three corners of each face.
// The normals of needles need the extra width.
using L = glm::vec<3, long double, glm::defaultp>;

using WideQuat = glm::qua<long double, glm::defaultp>;

WideQuat wide_rotation(const ConvexHull &hull) {
    return glm::normalize(
        WideQuat(hull.rotation.w, hull.rotation.x, hull.rotation.y, hull.rotation.z));
}

void place_vertices(const ConvexHull &hull, std::vector<L> &vertices) {
    const WideQuat turn = wide_rotation(hull);
    vertices.clear();
    for (const Vec3 &vertex : hull.mesh->vertices)
        vertices.push_back(turn * L(vertex) + L(hull.position));
}

// The doubt of hull_queries.h, plus the rounding into the mesh frame: a difference and a product
// with a quaternion (a dozen roundings).
double doubt_of(const ConvexHull &hull, const L &p) {
    const Aabb &box = hull.mesh->box;
    const Vec3 far = glm::max(glm::abs(box.min), glm::abs(box.max));
    const L local = p - L(hull.position);
    const double reach = double(std::abs(local.x) + std::abs(local.y) + std::abs(local.z)) +
                         double(far.x + far.y + far.z);
    return double(hull.mesh->slack) + 24.0 * epsilon * reach +
           2.0 * epsilon * double(glm::length(L(hull.position)));
}

class WideHull {
  public:
    explicit WideHull(const ConvexHull &hull) : hull_(hull) {
        const WideQuat turn = wide_rotation(hull);
        const HullMesh &mesh = *hull.mesh;
        place_vertices(hull, vertices);
        for (const auto &[a, b, c] : mesh.face_corners) {
            bases_.push_back(vertices[a]);
            const L base(mesh.vertices[a]);
            normals_.push_back(turn * glm::normalize(glm::cross(L(mesh.vertices[b]) - base,
                                                                L(mesh.vertices[c]) - base)));
        }
    }
    double height(const L &p) const { return double(highest(p).height); }
    // Whether the line origin + t u is deeper than `depth` at some 0 <= t <= length. Its height is
    // convex and piecewise linear in t: extends the pieces at both ends to where they cross and
    // replaces one of them by the piece there (Kelley 1960), until the answer is known.
    bool dips_below(const L &origin, const L &u, long double length, long double depth) const {
        long double at_low = 0.0L, at_high = length;
        Part low = highest(origin), high = highest(origin + length * u);
        for (int i = 0; i < 1000; ++i) {
            const long double fall = glm::dot(normals_[low.face], u);
            const long double climb = glm::dot(normals_[high.face], u);
            if (low.height < -depth || high.height < -depth)
                return true;
            if (fall >= 0.0L || climb <= 0.0L)
                return false;
            const long double step =
                (high.height - low.height - climb * (at_high - at_low)) / (fall - climb);
            if (low.height + fall * step >= -depth)
                return false; // nothing is lower than the crossing
            const long double t = at_low + step;
            const Part here = highest(origin + t * u);
            const bool is_falling = glm::dot(normals_[here.face], u) < 0.0L;
            (is_falling ? low : high) = here;
            (is_falling ? at_low : at_high) = t;
        }
        ADD_FAILURE() << "no end of parts";
        return true;
    }
    // A lower bound on the distance of p, from the plane through q perpendicular to p - q: no
    // vertex lies beyond the plane by more than what is subtracted.
    double distance_beyond(const L &p, const L &q) const {
        const L way = glm::normalize(p - q);
        long double beyond = 0.0L;
        for (const L &vertex : vertices)
            beyond = std::max(beyond, glm::dot(way, vertex - q));
        return double(glm::length(p - q) - beyond);
    }
    // Looks at all edges, and at all faces with p directly above.
    double distance(const L &p) const {
        const HullMesh &mesh = *hull_.mesh;
        if (height(p) <= 0.0)
            return 0.0;
        long double least = 1e300L;
        for (const HullMesh::Edge &edge : mesh.edges) {
            const L a = vertices[edge.a], along = vertices[edge.b] - a;
            const long double s =
                std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0L, 1.0L);
            least = std::min(least, glm::length(p - a - s * along));
        }
        for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
            const HullMesh::Face &loop = mesh.faces[face];
            bool is_above = glm::dot(normals_[face], p - bases_[face]) >= 0.0L;
            for (std::uint32_t i = 0; i < loop.count; ++i) {
                const L &a = vertices[mesh.vertex_indices[loop.first + i]];
                const L &b = vertices[mesh.vertex_indices[loop.first + (i + 1) % loop.count]];
                is_above = is_above && glm::dot(glm::cross(normals_[face], b - a), p - a) >= 0.0L;
            }
            if (is_above)
                least = std::min(least, glm::dot(normals_[face], p - bases_[face]));
        }
        return double(least);
    }
    double doubt(const L &p) const { return doubt_of(hull_, p); }

    std::vector<L> vertices;

  private:
    struct Part {
        long double height = -1e300L;
        std::size_t face = 0;
    };
    // The greatest height over the planes of the faces.
    Part highest(const L &p) const {
        Part greatest;
        for (std::size_t i = 0; i < bases_.size(); ++i) {
            const long double height = glm::dot(normals_[i], p - bases_[i]);
            if (height > greatest.height)
                greatest = {height, i};
        }
        return greatest;
    }

    ConvexHull hull_;
    std::vector<L> bases_, normals_;
};

struct AnyHull {
    HullMesh mesh;
    ConvexHull hull;
};

// A hull of the given family, with up to 64 vertices, placed anywhere, of size about `size`.
void make_hull(Random &random, int family, double size, AnyHull &result) {
    for (;;) {
        const std::vector<Vec3> points =
            placed_points(random, any_points(random, family), size, 0.0);
        HullResult made = convex_hull(points, 4 << random.next_index(5));
        if (!made.mesh)
            continue;
        result.mesh = std::move(*made.mesh);
        const double far = random.next_index(2) == 0 ? size : std::min(1e5, 1e3 * size);
        result.hull = {&result.mesh, any_vector(random, far), awkward_rotation(random)};
        return;
    }
}

TEST(HullQueries, PointsAgainstHeightsInWideNumbers) {
    Random random(2);
    const int count = trials(1'000'000);
    AnyHull any;
    double size = 1.0;
    make_hull(random, 0, size, any);
    WideHull oracle_hull(any.hull);
    int inside = 0;
    for (int trial = 0; trial < count; ++trial) {
        if (trial % 1000 == 0) {
            size = std::pow(10.0, random.next_in(-3.0, 5.0));
            make_hull(random, trial / 1000 % families, size, any);
            oracle_hull = WideHull(any.hull);
        }
        // Around a vertex, or between vertices: near the surface as often as not.
        const std::uint32_t n = std::uint32_t(oracle_hull.vertices.size());
        const double weight = random.next_in(-0.2, 1.2);
        const V near = glm::mix(V(oracle_hull.vertices[random.next_index(n)]),
                                V(oracle_hull.vertices[random.next_index(n)]), weight);
        const double away = size * std::pow(10.0, random.next_in(-8.0, 0.5));
        const V target = near + away * any_direction(random);
        const Vec3 point{Real(target.x), Real(target.y), Real(target.z)};
        const L p(point);
        const double doubt = oracle_hull.doubt(p);
        const double height = oracle_hull.height(p);
        const bool is_in = contains(any.hull, point);
        inside += is_in;
        if (std::abs(height) > doubt) {
            ASSERT_EQ(is_in, height < 0.0) << "trial " << trial << " height " << height;
        }
        const Vec3 closest = closest_point(any.hull, point);
        if (is_in) {
            ASSERT_EQ(closest, point);
            continue;
        }
        ASSERT_LE(oracle_hull.height(L(closest)), doubt) << "trial " << trial;
        // Where a plane proves that nothing is nearer, the search over all edges and faces is
        // mostly skipped.
        const L q(closest);
        if (trial % 4 != 0 &&
            oracle_hull.distance_beyond(p, q) >= double(glm::length(p - q)) - doubt)
            continue;
        ASSERT_NEAR(double(glm::length(p - L(closest))), oracle_hull.distance(p), doubt)
            << "trial " << trial;
    }
    EXPECT_GT(inside, count / 20);
}

TEST(HullQueries, RaysAgainstHeightsInWideNumbers) {
    Random random(3);
    const int count = trials(1'000'000);
    int hits = 0;
    AnyHull any;
    for (int trial = 0; trial < count;) {
        const double size = std::pow(10.0, random.next_in(-3.0, 5.0));
        make_hull(random, int(random.next_index(families)), size, any);
        const WideHull wide_hull(any.hull);
        const std::uint32_t n = std::uint32_t(wide_hull.vertices.size());
        for (int i = 0; i < 1000; ++i, ++trial) {
            // Aimed at a vertex, an edge or a chord, or just beside it.
            V target(wide_hull.vertices[random.next_index(n)]);
            if (random.next_index(3) != 0)
                target = glm::mix(target, V(wide_hull.vertices[random.next_index(n)]),
                                  random.next_unit());
            if (random.next_index(2) == 0)
                target += any_direction(random) * (size * std::pow(10.0, random.next_in(-7, 0)));
            const V from = wide(any.hull.position) + (3.0 * size) * any_direction(random);
            const Vec3 origin{Real(from.x), Real(from.y), Real(from.z)};
            const V to = target - wide(origin);
            const double scale = std::pow(10.0, random.next_in(-6.0, 6.0)) / size;
            const Vec3 direction{Real(to.x * scale), Real(to.y * scale), Real(to.z * scale)};
            const double speed = glm::length(wide(direction));
            const L u = L(direction) / glm::length(L(direction));
            const double length = 10.0 * size;
            const Ray ray{origin, direction, Real(length / speed)};
            const auto interval = ray_interval(any.hull, ray);
            const double doubt =
                2.0 * wide_hull.doubt(L(origin) + static_cast<long double>(length) * u);
            const auto at = [&](double t) {
                return wide_hull.height(L(origin) + static_cast<long double>(t) * u);
            };
            if (!interval) {
                ASSERT_FALSE(wide_hull.dips_below(L(origin), u, length, doubt))
                    << "trial " << trial;
                continue;
            }
            ++hits;
            ASSERT_LE(interval->t_enter, interval->t_exit);
            ASSERT_LE(interval->t_exit, ray.max_t);
            ASSERT_LE(at(double(interval->t_enter) * speed), doubt) << "trial " << trial;
            ASSERT_LE(at(double(interval->t_exit) * speed), doubt) << "trial " << trial;
            if (interval->t_enter > Real(0)) {
                ASSERT_GE(at(double(interval->t_enter) * speed), -doubt) << "trial " << trial;
                ASSERT_NEAR(glm::length(wide(interval->enter_normal)), 1.0, 16 * epsilon);
            }
            if (interval->t_exit < ray.max_t) {
                ASSERT_GE(at(double(interval->t_exit) * speed), -doubt) << "trial " << trial;
            }
        }
    }
    EXPECT_GT(hits, count / 3);
}

TEST(HullQueries, SupportAndFaces) {
    Random random(4);
    const int count = trials(1'000'000);
    AnyHull any;
    for (int trial = 0; trial < count; ++trial) {
        if (trial % 500 == 0)
            make_hull(random, trial / 500 % families, std::pow(10.0, random.next_in(-3.0, 5.0)),
                      any);
        const HullMesh &mesh = any.mesh;
        Vec3 d = any_vector(random, 1.0) * Real(std::pow(10.0, random.next_in(-6.0, 6.0)));
        if (trial % 4 == 0)
            d = mesh.planes[random.next_index(std::uint32_t(mesh.planes.size()))].normal;
        if (trial % 7 == 0)
            d[trial % 3] = trial % 2 == 0 ? Real(0) : -Real(0);
        double greatest = -1e300;
        for (const Vec3 &vertex : mesh.vertices)
            greatest = std::max(greatest, glm::dot(wide(vertex), wide(d)));
        const double length = glm::length(wide(d));
        const V far = glm::max(glm::abs(wide(mesh.box.min)), glm::abs(wide(mesh.box.max)));
        const double rounding = 3.0 * epsilon * length * (far.x + far.y + far.z);
        const std::uint32_t found = support_vertex(mesh, d);
        ASSERT_GE(glm::dot(wide(mesh.vertices[found]), wide(d)), greatest - rounding);
        const std::uint32_t start = random.next_index(std::uint32_t(mesh.vertices.size()));
        const std::uint32_t climbed = support_vertex(mesh, d, start);
        ASSERT_GE(glm::dot(wide(mesh.vertices[climbed]), wide(d)),
                  greatest - rounding - double(mesh.slack) * length)
            << "trial " << trial;

        const std::uint32_t face = supporting_face(mesh, d);
        double most = -1e300;
        for (const Plane &plane : mesh.planes)
            most = std::max(most, glm::dot(wide(plane.normal), wide(d)));
        ASSERT_GE(glm::dot(wide(mesh.planes[face].normal), wide(d)), most - 4 * epsilon * length);
    }
}

// With any number of vertices, duplicates among them, whatever the processor's vector width.
TEST(HullQueries, TheSupportVertexIsTheFirstOfTheFarthest) {
    Random random(7);
    const auto whole = [&] { return static_cast<Real>(random.next_index(7)) - Real(3); };
    for (std::size_t count = 1; count < 70; ++count)
        for (int trial = 0; trial < 30; ++trial) {
            HullMesh mesh;
            while (mesh.vertices.size() < count)
                mesh.vertices.emplace_back(whole(), whole(), whole());
            const Vec3 d{whole(), whole(), whole()};
            std::uint32_t farthest = 0;
            for (std::uint32_t i = 1; i < count; ++i)
                if (glm::dot(mesh.vertices[i], d) > glm::dot(mesh.vertices[farthest], d))
                    farthest = i;
            ASSERT_EQ(support_vertex(mesh, d), farthest) << count << " vertices";
        }
}

TEST(HullQueries, BoundsAndSides) {
    Random random(5);
    const int count = trials(1'000'000);
    AnyHull any;
    std::vector<L> vertices;
    double size = 1.0;
    for (int trial = 0; trial < count; ++trial) {
        if (trial % 500 == 0) {
            size = std::pow(10.0, random.next_in(-3.0, 5.0));
            make_hull(random, trial / 500 % families, size, any);
        }
        any.hull.position = any_vector(random, trial % 2 == 0 ? size : 1e5);
        any.hull.rotation = awkward_rotation(random);
        place_vertices(any.hull, vertices);
        L low{1e300L}, high{-1e300L};
        for (const L &vertex : vertices) {
            low = glm::min(low, vertex);
            high = glm::max(high, vertex);
        }
        const Aabb box = bounds(any.hull);
        const double band = doubt_of(any.hull, high);
        for (int i = 0; i < 3; ++i) {
            ASSERT_NEAR(double(box.min[i]), double(low[i]), band);
            ASSERT_NEAR(double(box.max[i]), double(high[i]), band);
        }
        const V n = any_direction(random);
        const Vec3 normal{Real(n.x), Real(n.y), Real(n.z)};
        double least = 1e300, top = -1e300;
        for (const L &vertex : vertices) {
            const double height = double(glm::dot(L(normal), vertex));
            least = std::min(least, height);
            top = std::max(top, height);
        }
        const double offset = least + (top - least) * random.next_in(-0.5, 1.5);
        const PlaneTest test = classify(Plane{normal, Real(offset)}, any.hull);
        const double expected = double(Real(offset)) < least ? least - double(Real(offset))
                                : double(Real(offset)) > top ? top - double(Real(offset))
                                                             : 0.0;
        const double plane_band = band + 8.0 * epsilon * std::abs(offset);
        ASSERT_NEAR(double(test.distance), expected, plane_band);
        if (std::abs(expected) > plane_band) {
            ASSERT_EQ(test.side, expected > 0.0 ? PlaneSide::in_front : PlaneSide::behind);
        }
    }
}

TEST(HullQueries, MisuseNamesTheValue) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const Vec3 x{Real(1), Real(0), Real(0)};
    const Vec3 o{Real(0)};
    const HullMesh mesh =
        *convex_hull(std::vector{o, x, Vec3{x.y, x.x, x.z}, Vec3{x.y, x.z, x.x}}, 8).mesh;
    const HullMesh empty;
    const ConvexHull good{&mesh};
    says([&] { check_valid(ConvexHull{}); }, "none");
    says([&] { contains(ConvexHull{&empty}, o); }, "empty");
    says([&] { bounds(ConvexHull{&mesh, Vec3{nan}}); }, "nan");
    says(
        [&] {
            support(ConvexHull{&mesh, o, Quat{Real(2), Real(0), Real(0), Real(0)}}, x);
        },
        "(2, 0");
    says([&] { support(good, Vec3{nan}); }, "nan");
    says([&] { contains(good, Vec3{nan}); }, "nan");
    says([&] { closest_point(good, Vec3{nan}); }, "nan");
    says([&] { linetest(good, o, Vec3{nan}); }, "nan");
    says([&] { ray_interval(good, Ray{o, o}); }, "(0, 0, 0)");
    says([&] { ray_interval(good, Ray{o, x, nan}); }, "nan");
    says([&] { classify(Plane{Real(3) * x, Real(0)}, good); }, "3");
    // Whether the ray starts inside.
    const auto hit = raycast(good, Ray{Vec3{Real(0.125)}, x});
    ASSERT_TRUE(hit);
    EXPECT_TRUE(hit->starts_inside);
    const auto entering = raycast(good, Ray{{Real(-2), Real(0.125), Real(0.125)}, Real(4) * x});
    ASSERT_TRUE(entering);
    EXPECT_EQ(entering->t, Real(0.5));
    EXPECT_EQ(entering->normal, -x);
    EXPECT_FALSE(ray_interval(good, Ray{Real(-2) * x, x, Real(-1)}));
    EXPECT_FALSE(ray_interval(good, Ray{Real(-2) * x, x, Real(1.5)}));
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION

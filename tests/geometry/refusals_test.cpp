// Every public query refuses arguments that have no answer, and names the caller's own value: 4711
// or a NaN is put into one place after another.
#include "engine/plumb.h"
#include "tests/geometry/convex_oracle.h"
#include "tests/says.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();
constexpr Real negative = Real(-4711); // not a valid size

const HullMesh &cube() {
    static const HullMesh mesh =
        *convex_hull(oracle::prism(4, oracle::V{1.0, 1.0, 1.0}, 1.0).vertices, 64).mesh;
    return mesh;
}

// A valid value of each kind, and invalid ones with the value the message must name.
template <typename Shape> struct Bad {
    Shape shape;
    const char *named;
};
template <typename Shape> struct Kind;
const Vec3 far{nan, Real(0), Real(0)};
const Vec3 zero{Real(0)}, one{Real(1)};
const Quat stretched{Real(1.0005), Real(0), Real(0), Real(0)};

template <> struct Kind<Vec3> {
    static Vec3 good() { return one; }
    static std::vector<Bad<Vec3>> bad() { return {{far, "nan"}}; }
};
template <> struct Kind<Sphere> {
    static Sphere good() { return {zero, Real(1)}; }
    static std::vector<Bad<Sphere>> bad() {
        return {{{far, Real(1)}, "nan"},
                {{zero, nan}, "nan"},
                {{zero, negative}, "-4711"},
                {{zero, std::numeric_limits<Real>::infinity()}, "inf"}};
    }
};
template <> struct Kind<Box> {
    static Box good() { return {zero, identity_rotation, one}; }
    static std::vector<Bad<Box>> bad() {
        return {{{far, identity_rotation, one}, "nan"},
                {{zero, Quat{nan, Real(0), Real(0), Real(0)}, one}, "nan"},
                {{zero, stretched, one}, "1.0005"},
                {{zero, identity_rotation, far}, "nan"},
                {{zero, identity_rotation, {Real(1), negative, Real(1)}}, "-4711"}};
    }
};
template <> struct Kind<Aabb> {
    static Aabb good() { return {-one, one}; }
    static std::vector<Bad<Aabb>> bad() { return {{{far, one}, "nan"}, {{zero, far}, "nan"}}; }
};
template <> struct Kind<Capsule> {
    static Capsule good() { return {zero, one, Real(1)}; }
    static std::vector<Bad<Capsule>> bad() {
        return {{{far, one, Real(1)}, "nan"},
                {{zero, far, Real(1)}, "nan"},
                {{zero, one, nan}, "nan"},
                {{zero, one, Real(-0.25)}, "-0.25"},
                {{zero, one, negative}, "-4711"}};
    }
};
template <> struct Kind<Cylinder> {
    static Cylinder good() { return {zero, one, Real(1)}; }
    static std::vector<Bad<Cylinder>> bad() {
        return {{{far, one, Real(1)}, "nan"},
                {{zero, far, Real(1)}, "nan"},
                {{one, one, Real(1)}, "twice"},
                {{zero, one, nan}, "nan"},
                {{zero, one, negative}, "-4711"}};
    }
};
template <> struct Kind<HalfSpace> {
    static HalfSpace good() { return {}; }
    static std::vector<Bad<HalfSpace>> bad() {
        return {{{far, Real(0)}, "nan"}, {{{Real(0), Real(1), Real(0)}, nan}, "nan"}};
    }
};
template <> struct Kind<Plane> {
    static Plane good() { return {}; }
    static std::vector<Bad<Plane>> bad() {
        return {{{far, Real(0)}, "nan"}, {{{Real(0), Real(1), Real(0)}, nan}, "nan"}};
    }
};
template <> struct Kind<Segment> {
    static Segment good() { return {zero, one}; }
    static std::vector<Bad<Segment>> bad() { return {{{far, one}, "nan"}, {{zero, far}, "nan"}}; }
};
template <> struct Kind<Triangle> {
    static Triangle good() { return {zero, one, {Real(1), Real(0), Real(0)}}; }
    static std::vector<Bad<Triangle>> bad() {
        return {{{far, one, zero}, "nan"}, {{zero, far, one}, "nan"}, {{zero, one, far}, "nan"}};
    }
};
template <> struct Kind<ConvexHull> {
    static ConvexHull good() { return {&cube(), zero, identity_rotation}; }
    static std::vector<Bad<ConvexHull>> bad() {
        return {{{nullptr, zero, identity_rotation}, "none"},
                {{&cube(), far, identity_rotation}, "nan"},
                {{&cube(), zero, stretched}, "1.0005"},
                {{&cube(), zero, Quat{nan, Real(0), Real(0), Real(0)}}, "nan"}};
    }
};
template <> struct Kind<Ray> {
    static Ray good() { return {zero, one, Real(1)}; }
    static std::vector<Bad<Ray>> bad() {
        return {{{far, one, Real(1)}, "nan"},
                {{zero, far, Real(1)}, "nan"},
                {{zero, zero, Real(1)}, "zero"},
                {{zero, one, nan}, "nan"}};
    }
};
template <> struct Kind<Real> {
    static Real good() { return Real(1); }
    static std::vector<Bad<Real>> bad() { return {{nan, "nan"}, {negative, "-4711"}}; }
};
template <> struct Kind<Transform> {
    static Transform good() { return {}; }
    static std::vector<Bad<Transform>> bad() {
        return {{{far, identity_rotation}, "nan"},
                {{zero, stretched}, "1.0005"},
                {{zero, Quat{nan, Real(0), Real(0), Real(0)}}, "nan"}};
    }
};

// Calls the query with each of its arguments bad in turn.
template <typename... Arguments, typename Query>
void refuses(const std::string &what, const Query &query) {
    const auto with_bad = [&]<std::size_t... I>(std::index_sequence<I...>) {
        const auto at = [&]<std::size_t Place, typename Argument>(
                            std::integral_constant<std::size_t, Place>, Argument *) {
            for (const Bad<Argument> &bad : Kind<Argument>::bad()) {
                SCOPED_TRACE(what + ", argument " + std::to_string(Place) + " with " + bad.named);
                std::tuple<Arguments...> all{Kind<Arguments>::good()...};
                std::get<Place>(all) = bad.shape;
                says([&] { (void)std::apply(query, all); }, bad.named);
            }
        };
        (at(std::integral_constant<std::size_t, I>{}, static_cast<Arguments *>(nullptr)), ...);
    };
    with_bad(std::index_sequence_for<Arguments...>{});
    EXPECT_NO_THROW((void)query(Kind<Arguments>::good()...)) << what;
}

// Counts the queries that exist and checks that they refuse.
#define PLUMB_REFUSES(CALL, ...)                                                                   \
    [&]<typename... Arguments>(std::tuple<Arguments...> *) {                                       \
        const auto query = [](const auto &...args) -> decltype(CALL(args...)) {                    \
            return CALL(args...);                                                                  \
        };                                                                                         \
        if constexpr (std::invocable<decltype(query), const Arguments &...>) {                     \
            refuses<Arguments...>(#CALL, query);                                                   \
            ++queries;                                                                             \
        }                                                                                          \
    }(static_cast<std::tuple<__VA_ARGS__> *>(nullptr))

template <typename... Kinds, typename Visit> void for_kinds(const Visit &visit) {
    (visit.template operator()<Kinds>(), ...);
}
template <typename Visit> void for_all_kinds(const Visit &visit) {
    for_kinds<Vec3, Sphere, Box, Aabb, Capsule, Cylinder, HalfSpace, Plane, Segment, Triangle,
              ConvexHull>(visit);
}

TEST(Refusals, OfOneShape) {
    int queries = 0;
    for_all_kinds([&]<typename A>() {
        if constexpr (!std::same_as<A, Vec3>) {
            PLUMB_REFUSES(placed, A, Transform);
            if constexpr (!std::same_as<A, HalfSpace>) // has no bounds
                PLUMB_REFUSES(bounds, A);
            PLUMB_REFUSES(contains, A, Vec3);
            PLUMB_REFUSES(closest_point, A, Vec3);
            PLUMB_REFUSES(squared_distance, A, Vec3);
            PLUMB_REFUSES(ray_interval, A, Ray);
            if constexpr (requires { ray_interval(Kind<A>::good(), Ray{}); })
                PLUMB_REFUSES(raycast, A, Ray);
            PLUMB_REFUSES(linetest, A, Vec3, Vec3);
            if constexpr (!std::same_as<A, HalfSpace>) // has no inertia
                PLUMB_REFUSES(principal_inertia, A, Real);
            PLUMB_REFUSES(volume, A);
        }
        PLUMB_REFUSES(classify, Plane, A);
    });
    PLUMB_REFUSES(inertia, ConvexHull, Real);
    PLUMB_REFUSES(support, ConvexHull, Vec3);
    PLUMB_REFUSES(area, Triangle);
    PLUMB_REFUSES(normal, Triangle);
    PLUMB_REFUSES(barycentric, Triangle, Vec3);
    PLUMB_REFUSES(separating_axis, Box, Box);
    PLUMB_REFUSES(contains, Ray, Vec3);
    PLUMB_REFUSES(closest_point, Ray, Vec3);
    PLUMB_REFUSES(intersection, Plane, Plane);
    EXPECT_EQ(queries, 90);
}

TEST(Refusals, OfTwoShapes) {
    int queries = 0;
    for_all_kinds([&]<typename A>() {
        for_all_kinds([&]<typename B>() {
            PLUMB_REFUSES(overlaps, A, B);
            if constexpr (!(std::same_as<A, Vec3> && std::same_as<B, Vec3>)) // that is GLM's
                PLUMB_REFUSES(distance, A, B);
            PLUMB_REFUSES(penetration, A, B);
            PLUMB_REFUSES(proximity, A, B);
            PLUMB_REFUSES(cast, A, Vec3, B);
            PLUMB_REFUSES(collide, A, B, Real);
        });
    });
    EXPECT_EQ(queries, 515);
}

TEST(Refusals, OfSurfaces) {
    const std::array<Triangle, 2> surface = {Kind<Triangle>::good(),
                                             Triangle{zero, one, Vec3{Real(0), nan, Real(0)}}};
    says([&] { (void)mass_properties(surface); }, "nan");
    TriangleMesh mesh{{zero, one, Vec3{Real(1), nan, Real(0)}}, {{0, 1, 2}}};
    says([&] { (void)bounds(mesh); }, "nan");
    mesh.vertices[2] = Vec3{Real(1), Real(0), Real(0)};
    mesh.triangles[0][1] = 3;
    says([&] { (void)bounds(mesh); }, "got 3");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION

#include "engine/geometry/epa.h"
#include "engine/geometry/gjk.h"
#include "engine/geometry/manifold.h"
#include "engine/geometry/overlap.h"
#include "engine/geometry/sat.h"
#include "engine/geometry/triangle_overlap.h"
#include "engine/math/basis.h"
#include "tests/bench/contest.h"
#include "tests/bench/inputs.h"
#include "tests/bench/peer_bullet.h"
#include "tests/bench/peer_fcl.h"

#include "app/lab/queries/book_queries.h"

namespace plumb {

namespace {

template <auto Ask, typename A, typename B>
std::function<std::uint64_t()> each(std::span<const A> a, std::span<const B> b) {
    return [a, b] {
        std::uint64_t yes = 0;
        for (std::size_t i = 0; i < a.size(); ++i)
            yes += Ask(a[i], b[i]) ? 1 : 0;
        return yes;
    };
}

constexpr double twice = 2;

template <typename A, typename B>
Contest overlap_contest(std::string name, std::span<const A> a, std::span<const B> b) {
    return {std::move(name),
            a.size(),
            {"overlaps", each<[](const A &x, const B &y) { return overlaps(x, y); }>(a, b)},
            {{"FCL collide", fcl_peer::overlaps(a, b)}},
            twice};
}

template <typename A, typename B>
void add_book(Contest &contest, std::span<const A> a, std::span<const B> b) {
    contest.others.push_back(
        {"the book's", each<[](const A &x, const B &y) { return book::overlaps(x, y); }>(a, b)});
}

bool touches(const Manifold &manifold) {
    for (int k = 0; k < manifold.count; ++k)
        if (manifold.points[static_cast<std::size_t>(k)].separation <= 0)
            return true;
    return false;
}

template <auto Collide, typename A, typename B>
Contest contact_contest(std::string name, std::span<const A> a, std::span<const B> b) {
    return {std::move(name),
            a.size(),
            {"collide", each<Collide>(a, b)},
            {{"Bullet's algorithm", bullet::contacts(a, b)}},
            twice};
}

// With what a world knows of a pair from its last step, as Bullet's algorithms do: the normal,
// which has turned a little since.
std::function<std::uint64_t()> collide_again(std::span<const ConvexHull> a,
                                             std::span<const ConvexHull> b) {
    constexpr Real turned = Real(0.01); // rad
    return [a, b, normals = std::vector<Vec3>(a.size(), Vec3{Real(0)})]() mutable {
        std::uint64_t yes = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            const Manifold found = collide(a[i], b[i], 0, normals[i]);
            if (found.count > 0)
                normals[i] = found.normal + turned * tangent_basis(found.normal).t1;
            yes += touches(found) ? 1 : 0;
        }
        return yes;
    };
}

template <typename A, typename B>
Contest distance_contest(std::string name, std::span<const A> a, std::span<const B> b) {
    return {std::move(name),
            a.size(),
            {"distance",
             each<[](const A &x, const B &y) { return distance(x, y).distance <= 0; }>(a, b)},
            {{"FCL distance", fcl_peer::distances(a, b)}},
            twice};
}

} // namespace

std::vector<Contest> pair_contests() {
    const auto spheres = inputs::kept(1, [](Random &r) { return inputs::sphere(r, 0.8); });
    const auto more_spheres = inputs::kept(2, [](Random &r) { return inputs::sphere(r, 0.8); });
    const auto aabbs = inputs::kept(3, [](Random &r) { return inputs::aabb(r, 0.7); });
    const auto boxes = inputs::kept(4, [](Random &r) { return inputs::box(r, 0.7); });
    const auto more_boxes = inputs::kept(5, [](Random &r) { return inputs::box(r, 0.7); });
    const auto capsules = inputs::kept(6, [](Random &r) { return inputs::capsule(r, 0.8); });
    const auto more_capsules = inputs::kept(7, [](Random &r) { return inputs::capsule(r, 0.8); });
    const auto cylinders = inputs::kept(8, [](Random &r) { return inputs::cylinder(r, 0.8); });
    const auto more_cylinders = inputs::kept(9, [](Random &r) { return inputs::cylinder(r, 0.8); });
    const auto hulls = inputs::kept(10, [](Random &r) { return inputs::hull(r, 0.7); });
    const auto more_hulls = inputs::kept(11, [](Random &r) { return inputs::hull(r, 0.7); });
    const auto triangles = inputs::kept(12, [](Random &r) { return inputs::triangle(r, 0.6); });
    const auto more_triangles =
        inputs::kept(13, [](Random &r) { return inputs::triangle(r, 0.6); });

    std::vector<Contest> contests;
    contests.push_back(overlap_contest("sphere, sphere: overlap", spheres, more_spheres));
    contests.push_back(overlap_contest("sphere, aligned box: overlap", spheres, aabbs));
    add_book(contests.back(), spheres, aabbs);
    contests.push_back(overlap_contest("sphere, box: overlap", spheres, boxes));
    contests.push_back(overlap_contest("aligned box, box: overlap", aabbs, boxes));
    add_book(contests.back(), aabbs, boxes);
    contests.push_back(overlap_contest("box, box: overlap", boxes, more_boxes));
    add_book(contests.back(), boxes, more_boxes);
    contests.push_back(overlap_contest("capsule, capsule: overlap", capsules, more_capsules));
    contests.push_back(overlap_contest("capsule, box: overlap", capsules, boxes));
    contests.push_back(overlap_contest("cylinder, cylinder: overlap", cylinders, more_cylinders));
    contests.push_back(overlap_contest("hull, hull: overlap", hulls, more_hulls));
    contests.push_back(
        {"triangle, triangle: overlap",
         triangles.size(),
         {"overlaps", each<[](const Triangle &a, const Triangle &b) { return overlaps(a, b); }>(
                          triangles, more_triangles)},
         {},
         twice});
    add_book(contests.back(), triangles, more_triangles);

    contests.push_back(distance_contest("sphere, box: distance", spheres, boxes));
    contests.push_back(distance_contest("box, box: distance", boxes, more_boxes));
    contests.push_back(distance_contest("capsule, box: distance", capsules, boxes));
    contests.push_back(distance_contest("cylinder, cylinder: distance", cylinders, more_cylinders));
    contests.push_back(distance_contest("hull, hull: distance", hulls, more_hulls));

    // Distance, or penetration depth if they overlap, as Bullet's pair detector computes.
    const auto signed_contest = [&]<typename A, typename B>(std::string name, std::span<const A> a,
                                                            std::span<const B> b) {
        contests.push_back(
            {std::move(name),
             a.size(),
             {"proximity",
              each<[](const A &x, const B &y) { return proximity(x, y).separation <= 0; }>(a, b)},
             {{"Bullet GJK and EPA", bullet::closest(a, b)}},
             twice});
    };
    signed_contest("box, box: signed distance", boxes, more_boxes);
    signed_contest("capsule, box: signed distance", capsules, boxes);
    signed_contest("cylinder, cylinder: signed distance", cylinders, more_cylinders);
    signed_contest("hull, hull: signed distance", hulls, more_hulls);

    contests.push_back(contact_contest<[](const Sphere &a, const Sphere &b) {
        return touches(collide(Shape{a}, Shape{b}, 0));
    }>("sphere, sphere: manifold", spheres, more_spheres));
    contests.push_back(contact_contest<[](const Sphere &a, const Box &b) {
        return touches(collide(Shape{a}, Shape{b}, 0));
    }>("sphere, box: manifold", spheres, boxes));
    contests.push_back(contact_contest<[](const Box &a, const Box &b) {
        return touches(collide(Shape{a}, Shape{b}, 0));
    }>("box, box: manifold", boxes, more_boxes));
    contests.push_back(contact_contest<[](const Capsule &a, const Capsule &b) {
        return touches(collide(Shape{a}, Shape{b}, 0));
    }>("capsule, capsule: manifold", capsules, more_capsules));
    contests.push_back({"hull, hull: manifold",
                        hulls.size(),
                        {"collide", collide_again(hulls, more_hulls)},
                        {{"Bullet's algorithm", bullet::contacts(hulls, more_hulls)}},
                        twice});
    return contests;
}

} // namespace plumb

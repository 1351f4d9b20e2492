#include "app/lab/queries/book_queries.h"
#include "engine/geometry/hull_queries.h"
#include "engine/geometry/raycast.h"
#include "tests/bench/contest.h"
#include "tests/bench/inputs.h"
#include "tests/bench/peer_bullet.h"

namespace plumb {

namespace {

template <auto Ask, typename Solid>
std::function<std::uint64_t()> each(std::span<const Ray> rays, std::span<const Solid> solids) {
    return [rays, solids] {
        std::uint64_t yes = 0;
        for (std::size_t i = 0; i < rays.size(); ++i)
            yes += Ask(solids[i], rays[i]) ? 1 : 0;
        return yes;
    };
}

// The first hit with its point and normal.
template <typename Solid>
Contest contest(std::string name, std::span<const Ray> rays, std::span<const Solid> solids) {
    return {
        std::move(name),
        rays.size(),
        {"raycast",
         each<[](const Solid &solid, const Ray &ray) { return raycast(solid, ray).has_value(); }>(
             rays, solids)},
        {{"Bullet rayTestSingle", bullet::rays(rays, solids)}},
        2};
}

template <typename Solid>
void add_book(Contest &contest, std::span<const Ray> rays, std::span<const Solid> solids) {
    contest.others.push_back(
        {"the book's",
         each<[](const Solid &solid, const Ray &ray) { return book::raycast(solid, ray); }>(
             rays, solids)});
}

} // namespace

std::vector<Contest> ray_contests() {
    const auto rays = inputs::kept(20, [](Random &r) { return inputs::ray(r); });
    const auto spheres = inputs::kept(21, [](Random &r) { return inputs::sphere(r, 0.5); });
    const auto aabbs = inputs::kept(22, [](Random &r) { return inputs::aabb(r, 0.5); });
    const auto boxes = inputs::kept(23, [](Random &r) { return inputs::box(r, 0.5); });
    const auto capsules = inputs::kept(24, [](Random &r) { return inputs::capsule(r, 0.5); });
    const auto cylinders = inputs::kept(25, [](Random &r) { return inputs::cylinder(r, 0.5); });
    const auto triangles = inputs::kept(26, [](Random &r) { return inputs::triangle(r, 0.5); });
    const auto hulls = inputs::kept(27, [](Random &r) { return inputs::hull(r, 0.5); });

    std::vector<Contest> contests;
    contests.push_back(
        {"ray, aligned box",
         rays.size(),
         {"ray_interval",
          each<[](const Aabb &box, const Ray &ray) { return ray_interval(box, ray).has_value(); }>(
              rays, aabbs)},
         {{"Bullet btRayAabb2", bullet::rays_aabbs(rays, aabbs)}}, // checks nothing
         2});
    add_book(contests.back(), rays, aabbs);
    contests.push_back(contest("ray, sphere", rays, spheres));
    add_book(contests.back(), rays, spheres);
    contests.push_back(contest("ray, box", rays, boxes));
    add_book(contests.back(), rays, boxes);
    contests.push_back(contest("ray, capsule", rays, capsules));
    contests.push_back(contest("ray, cylinder", rays, cylinders));
    contests.push_back(contest("ray, triangle", rays, triangles));
    add_book(contests.back(), rays, triangles);
    contests.push_back(contest("ray, hull", rays, hulls));
    return contests;
}

} // namespace plumb

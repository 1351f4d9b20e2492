// Batch queries against a loop over the scalar ones.
#include "engine/geometry/batch.h"
#include "engine/geometry/overlap.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/triangle.h"
#include "tests/bench/contest.h"
#include "tests/bench/inputs.h"
#include "tests/bench/peer_bullet.h"

#include <bit>
#include <memory>

namespace plumb {

namespace {

struct Columns {
    std::vector<Aabb> boxes, others;
    std::vector<Sphere> spheres;
    std::vector<std::vector<float>> box = std::vector<std::vector<float>>(6);
    std::vector<std::vector<float>> other = std::vector<std::vector<float>>(6);
    std::vector<std::vector<float>> sphere = std::vector<std::vector<float>>(4);
    std::vector<std::uint64_t> bits = std::vector<std::uint64_t>(bit_words(inputs::count));
    std::vector<float> t_enter = std::vector<float>(inputs::count);
    std::vector<float> t_exit = std::vector<float>(inputs::count);
    Ray ray{{-3, 0.1f, 0.2f}, {1, 0.02f, -0.05f}, 10};

    Columns() {
        boxes = inputs::many(40, [](Random &r) { return inputs::aabb(r, 0.8); });
        others = inputs::many(41, [](Random &r) { return inputs::aabb(r, 0.8); });
        spheres = inputs::many(42, [](Random &r) { return inputs::sphere(r, 1); });
        for (std::size_t i = 0; i < inputs::count; ++i)
            for (int axis = 0; axis < 3; ++axis) {
                const auto column = static_cast<std::size_t>(axis);
                box[column].push_back(boxes[i].min[axis]);
                box[column + 3].push_back(boxes[i].max[axis]);
                other[column].push_back(others[i].min[axis]);
                other[column + 3].push_back(others[i].max[axis]);
                sphere[column].push_back(spheres[i].center[axis]);
            }
        for (const Sphere &s : spheres)
            sphere[3].push_back(s.radius);
    }
    [[nodiscard]] static AabbBatch batch(const std::vector<std::vector<float>> &c) {
        return {c[0], c[1], c[2], c[3], c[4], c[5]};
    }
    [[nodiscard]] SphereBatch sphere_batch() const {
        return {sphere[0], sphere[1], sphere[2], sphere[3]};
    }
    [[nodiscard]] std::uint64_t yes() const {
        std::uint64_t sum = 0;
        for (const std::uint64_t word : bits)
            sum += static_cast<std::uint64_t>(std::popcount(word));
        return sum;
    }
};

} // namespace

std::vector<Contest> batch_contests() {
    const auto c = std::make_shared<Columns>();
    std::vector<Contest> contests;
    contests.push_back(
        {"ray, 1024 aligned boxes at once",
         inputs::count,
         {"batch",
          [c] {
              ray_interval(Columns::batch(c->box), c->ray, {c->bits, c->t_enter, c->t_exit});
              return c->yes();
          }},
         {{"our scalar loop",
           [c] {
               std::uint64_t yes = 0;
               for (const Aabb &box : c->boxes)
                   yes += ray_interval(box, c->ray).has_value() ? 1 : 0;
               return yes;
           }},
          {"our prepared loop",
           [c] {
               const PreparedRay ray(c->ray);
               std::uint64_t yes = 0;
               for (const Aabb &box : c->boxes)
                   yes += ray_interval(box, ray).has_value() ? 1 : 0;
               return yes;
           }},
          {"Bullet btRayAabb2, loop", bullet::ray_aabbs(c->ray, c->boxes)}},
         1});
    contests.push_back(
        {"ray, 1024 spheres at once",
         inputs::count,
         {"batch",
          [c] {
              ray_interval(c->sphere_batch(), c->ray, {c->bits, c->t_enter, c->t_exit});
              return c->yes();
          }},
         {{"our scalar loop",
           [c] {
               std::uint64_t yes = 0;
               for (const Sphere &sphere : c->spheres)
                   yes += ray_interval(sphere, c->ray).has_value() ? 1 : 0;
               return yes;
           }}},
         0});
    contests.push_back({"1024 pairs of aligned boxes at once",
                        inputs::count,
                        {"batch",
                         [c] {
                             overlaps(Columns::batch(c->box), Columns::batch(c->other), c->bits);
                             return c->yes();
                         }},
                        {{"our scalar loop",
                          [c] {
                              std::uint64_t yes = 0;
                              for (std::size_t i = 0; i < inputs::count; ++i)
                                  yes += overlaps(c->boxes[i], c->others[i]) ? 1 : 0;
                              return yes;
                          }}},
                        0});
    return contests;
}

} // namespace plumb

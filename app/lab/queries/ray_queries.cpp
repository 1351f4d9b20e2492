// The charted queries: rays.
#include "app/lab/queries/book_queries.h"
#include "app/lab/queries/plain_queries.h"
#include "app/lab/queries/query_case.h"
#include "app/lab/queries/query_list.h"
#include "app/lab/queries/query_oracle.h"
#include "app/lab/queries/turned_boxes.h"
#include "engine/geometry/raycast.h"

#include <utility>

namespace plumb {

QueryCase ray_sphere(Random &random, std::size_t adversarial) {
    using Input = Pair<Sphere, Ray>;
    Inputs<Input> inputs = gather<Input>(
        random, adversarial,
        [&](const Lattice &at, Judged<Input> &one) {
            const oracle::Ball ball = any_ball(random, at);
            const oracle::Line line = any_ray(random, at, ball);
            one.input = {real_sphere(ball, at), real_ray(random, line, at)};
            one.truth = oracle::meets(line, ball);
        },
        [&] {
            return Input{{any_vector(random, 1), 0.8f}, timed_ray(random)};
        });
    return query<[](const Input &i) { return book::raycast(i.a, i.b); },
                 [](const Input &i) { return plain::raycast(i.a, i.b); },
                 [](const Input &i) { return ray_interval(i.a, i.b).has_value(); }>(
        "ray, sphere", std::move(inputs));
}

QueryCase ray_aligned_box(Random &random, std::size_t adversarial) {
    using Input = Pair<Aabb, Ray>;
    Inputs<Input> inputs = gather<Input>(
        random, adversarial,
        [&](const Lattice &at, Judged<Input> &one) {
            const oracle::Block block = any_block(random, at);
            const oracle::Line line = any_ray(random, at, block);
            one.input = {real_aabb(block, at), real_ray(random, line, at)};
            one.truth = oracle::meets(line, block);
        },
        [&] {
            return Input{timed_aabb(random, 1), timed_ray(random)};
        });
    return query<[](const Input &i) { return book::raycast(i.a, i.b); },
                 [](const Input &i) { return plain::raycast(i.a, i.b); },
                 [](const Input &i) { return ray_interval(i.a, i.b).has_value(); }>(
        "ray, aligned box", std::move(inputs));
}

QueryCase ray_box(Random &random, std::size_t adversarial) {
    const std::size_t part = adversarial / 4;
    using Input = Pair<Box, Ray>;
    Inputs<Input> inputs = gather<Input>(
        random, adversarial - part,
        [&](const Lattice &at, Judged<Input> &one) {
            const oracle::Block block = any_block(random, at);
            const oracle::Line line = any_ray(random, at, block);
            one.input = {real_box(block, at), real_ray(random, line, at)};
            one.truth = oracle::meets(line, block);
        },
        [&] {
            return Input{any_box(random, 1), timed_ray(random)};
        });
    add_family(inputs, "turned", part, [&](Input &input) {
        input = {any_box(random, 1), timed_ray(random)};
        return truth_of(input.a, input.b.origin, input.b.direction, 1e30L);
    });
    return query<[](const Input &i) { return book::raycast(i.a, i.b); },
                 [](const Input &i) { return plain::raycast(i.a, i.b); },
                 [](const Input &i) { return ray_interval(i.a, i.b).has_value(); }>(
        "ray, box", std::move(inputs));
}

QueryCase ray_triangle(Random &random, std::size_t adversarial) {
    using Input = Pair<Triangle, Ray>;
    Inputs<Input> inputs = gather<Input>(
        random, adversarial,
        [&](const Lattice &at, Judged<Input> &one) {
            oracle::Corners corners = any_corners(random, at);
            const oracle::Line line = any_ray(random, at, corners);
            // The book's triangles are one-sided: query from that side.
            const auto facing = [&] {
                const oracle::Point u = corners[1] - corners[0];
                const oracle::Point v = corners[2] - corners[0];
                return (u.y * v.z - u.z * v.y) * line.along.x +
                       (u.z * v.x - u.x * v.z) * line.along.y +
                       (u.x * v.y - u.y * v.x) * line.along.z;
            };
            if (facing() > 0)
                std::swap(corners[1], corners[2]);
            one.input = {real_triangle(corners, at), real_ray(random, line, at)};
            one.truth = oracle::meets(line, corners);
        },
        [&] {
            const Triangle t = timed_triangle(random, 0.5);
            const Vec3 origin = any_vector(random, 4);
            const auto u = static_cast<float>(random.next_in(-0.2, 0.8));
            const auto v = static_cast<float>(random.next_in(-0.2, 0.8));
            const Vec3 target = t.a + u * (t.b - t.a) + v * (t.c - t.a);
            return Input{t, Ray{origin, target - origin}};
        });
    return query<[](const Input &i) { return book::raycast(i.a, i.b); },
                 [](const Input &i) { return plain::raycast(i.a, i.b); },
                 [](const Input &i) { return raycast(i.a, i.b).has_value(); }>("ray, triangle",
                                                                               std::move(inputs));
}

} // namespace plumb

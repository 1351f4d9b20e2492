// The charted queries: pairs of shapes.
#include "app/lab/queries/book_queries.h"
#include "app/lab/queries/plain_queries.h"
#include "app/lab/queries/query_case.h"
#include "app/lab/queries/query_list.h"
#include "app/lab/queries/query_oracle.h"
#include "app/lab/queries/turned_boxes.h"
#include "engine/geometry/overlap.h"
#include "engine/geometry/sat.h"
#include "engine/geometry/triangle_overlap.h"

#include <utility>

namespace plumb {

QueryCase sphere_aligned_box(Random &random, std::size_t adversarial) {
    using Input = Pair<Sphere, Aabb>;
    Inputs<Input> inputs = gather<Input>(
        random, adversarial,
        [&](const Lattice &at, Judged<Input> &one) {
            const oracle::Ball ball = any_ball(random, at);
            const oracle::Block block = any_block(random, at);
            one.input = {real_sphere(ball, at), real_aabb(block, at)};
            one.truth = oracle::meets(ball, block);
        },
        [&] {
            return Input{{any_vector(random, 1.5), 0.8f}, timed_aabb(random, 1)};
        });
    return query<[](const Input &i) { return book::overlaps(i.a, i.b); },
                 [](const Input &i) { return plain::overlaps(i.a, i.b); },
                 [](const Input &i) { return overlaps(i.a, i.b); }>("sphere, aligned box",
                                                                    std::move(inputs));
}

QueryCase aligned_box_box(Random &random, std::size_t adversarial) {
    const std::size_t part = adversarial / 4;
    using Input = Pair<Aabb, Box>;
    Inputs<Input> inputs = gather<Input>(
        random, part,
        [&](const Lattice &at, Judged<Input> &one) {
            const oracle::Block a = any_block(random, at), b = any_block(random, at);
            one.input = {real_aabb(a, at), real_box(b, at)};
            one.truth = oracle::meets(a, b);
        },
        [&] {
            return Input{timed_aabb(random, 1), any_box(random, 1)};
        });
    const auto judged = [](const Input &input) {
        const Box a{0.5f * (input.a.min + input.a.max), identity_rotation,
                    0.5f * (input.a.max - input.a.min)};
        return truth_of(a, input.b);
    };
    add_family(inputs, "turned", 2 * part, [&](Input &input) {
        input = {timed_aabb(random, 1), any_box(random, 1)};
        return judged(input);
    });
    add_family(inputs, "nearly parallel", part, [&](Input &input) {
        input = {timed_aabb(random, 1), any_box(random, 1)};
        input.b.rotation = nearby(random, identity_rotation);
        return judged(input);
    });
    return query<[](const Input &i) { return book::overlaps(i.a, i.b); },
                 [](const Input &i) { return plain::overlaps(i.a, i.b); },
                 [](const Input &i) { return overlaps(i.a, i.b); }>("aligned box, box",
                                                                    std::move(inputs));
}

QueryCase box_box(Random &random, std::size_t adversarial) {
    const std::size_t part = adversarial / 4;
    using Input = Pair<Box, Box>;
    Inputs<Input> inputs = gather<Input>(
        random, part,
        [&](const Lattice &at, Judged<Input> &one) {
            const oracle::Block a = any_block(random, at), b = any_block(random, at);
            one.input = {real_box(a, at), real_box(b, at)};
            one.truth = oracle::meets(a, b);
        },
        [&] {
            return Input{any_box(random, 1), any_box(random, 1)};
        });
    add_family(inputs, "turned", part, [&](Input &input) {
        input = {any_box(random, 1), any_box(random, 1)};
        return truth_of(input.a, input.b);
    });
    add_family(inputs, "nearly parallel", part, [&](Input &input) {
        input = {any_box(random, 1), any_box(random, 1)};
        input.b.rotation = nearby(random, input.a.rotation);
        return truth_of(input.a, input.b);
    });
    add_family(inputs, "edge against edge", part, [&](Input &input) {
        input = edge_on_edge(random);
        return truth_of(input.a, input.b);
    });
    return query<[](const Input &i) { return book::overlaps(i.a, i.b); },
                 [](const Input &i) { return plain::overlaps(i.a, i.b); },
                 [](const Input &i) { return overlaps(i.a, i.b); }>("box, box", std::move(inputs));
}

QueryCase triangle_aligned_box(Random &random, std::size_t adversarial) {
    using Input = Pair<Triangle, Aabb>;
    Inputs<Input> inputs = gather<Input>(
        random, adversarial,
        [&](const Lattice &at, Judged<Input> &one) {
            const oracle::Corners corners = any_corners(random, at);
            const oracle::Block block = any_block(random, at);
            one.input = {real_triangle(corners, at), real_aabb(block, at)};
            one.truth = oracle::meets(corners, block);
        },
        [&] {
            return Input{timed_triangle(random, 1.2), timed_aabb(random, 1)};
        });
    return query<[](const Input &i) { return book::overlaps(i.a, i.b); },
                 [](const Input &i) { return plain::overlaps(i.a, i.b); },
                 [](const Input &i) { return overlaps(i.a, i.b); }>("triangle, aligned box",
                                                                    std::move(inputs));
}

QueryCase triangle_triangle(Random &random, std::size_t adversarial) {
    using Input = Pair<Triangle, Triangle>;
    Inputs<Input> inputs = gather<Input>(
        random, adversarial,
        [&](const Lattice &at, Judged<Input> &one) {
            oracle::Corners a = any_corners(random, at), b = any_corners(random, at);
            switch (random.next_index(4)) {
            case 0: // coplanar
                for (std::size_t i = 0; i < 3; ++i)
                    a[i].y = b[i].y = at.offset.y;
                break;
            case 1: // shared edge
                b[0] = a[0];
                b[1] = a[1];
                break;
            case 2: // shared corner
                b[0] = a[0];
                break;
            default:
                break;
            }
            one.input = {real_triangle(a, at), real_triangle(b, at)};
            one.truth = oracle::meets(a, b);
        },
        [&] {
            return Input{timed_triangle(random, 0.7), timed_triangle(random, 0.7)};
        });
    return query<[](const Input &i) { return book::overlaps(i.a, i.b); },
                 [](const Input &i) { return plain::overlaps(i.a, i.b); },
                 [](const Input &i) { return overlaps(i.a, i.b); }>("triangle, triangle",
                                                                    std::move(inputs));
}

} // namespace plumb

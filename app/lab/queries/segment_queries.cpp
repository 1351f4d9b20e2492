// The charted queries: segments.
#include "app/lab/queries/book_queries.h"
#include "app/lab/queries/plain_queries.h"
#include "app/lab/queries/query_case.h"
#include "app/lab/queries/query_list.h"
#include "app/lab/queries/query_oracle.h"
#include "app/lab/queries/turned_boxes.h"
#include "engine/geometry/raycast.h"

#include <utility>

namespace plumb {

QueryCase segment_aligned_box(Random &random, std::size_t adversarial) {
    using Input = Pair<Aabb, Segment>;
    Inputs<Input> inputs = gather<Input>(
        random, adversarial,
        [&](const Lattice &at, Judged<Input> &one) {
            const oracle::Block block = any_block(random, at);
            const oracle::Line line = any_segment(random, at, block);
            one.input = {real_aabb(block, at), real_segment(line, at)};
            one.truth = oracle::meets(line, block);
        },
        [&] {
            return Input{timed_aabb(random, 1), {any_vector(random, 2), any_vector(random, 2)}};
        });
    return query<[](const Input &i) { return book::linetest(i.a, i.b.a, i.b.b); },
                 [](const Input &i) { return plain::linetest(i.a, i.b.a, i.b.b); },
                 [](const Input &i) { return linetest(i.a, i.b.a, i.b.b); }>("segment, aligned box",
                                                                             std::move(inputs));
}

QueryCase segment_box(Random &random, std::size_t adversarial) {
    const std::size_t part = adversarial / 4;
    using Input = Pair<Box, Segment>;
    Inputs<Input> inputs = gather<Input>(
        random, adversarial - part,
        [&](const Lattice &at, Judged<Input> &one) {
            const oracle::Block block = any_block(random, at);
            const oracle::Line line = any_segment(random, at, block);
            one.input = {real_box(block, at), real_segment(line, at)};
            one.truth = oracle::meets(line, block);
        },
        [&] {
            return Input{any_box(random, 1), {any_vector(random, 2), any_vector(random, 2)}};
        });
    add_family(inputs, "turned", part, [&](Input &input) {
        input = {any_box(random, 1), {any_vector(random, 2), any_vector(random, 2)}};
        return truth_of(input.a, input.b.a, input.b.b - input.b.a, 1);
    });
    return query<[](const Input &i) { return book::linetest(i.a, i.b.a, i.b.b); },
                 [](const Input &i) { return plain::linetest(i.a, i.b.a, i.b.b); },
                 [](const Input &i) { return linetest(i.a, i.b.a, i.b.b); }>("segment, box",
                                                                             std::move(inputs));
}

QueryCase segment_triangle(Random &random, std::size_t adversarial) {
    using Input = Pair<Triangle, Segment>;
    Inputs<Input> inputs = gather<Input>(
        random, adversarial,
        [&](const Lattice &at, Judged<Input> &one) {
            const oracle::Corners corners = any_corners(random, at);
            const oracle::Line line = any_segment(random, at, corners);
            one.input = {real_triangle(corners, at), real_segment(line, at)};
            one.truth = oracle::meets(line, corners);
        },
        [&] {
            return Input{timed_triangle(random, 0.5),
                         {any_vector(random, 2), any_vector(random, 2)}};
        });
    return query<[](const Input &i) { return book::linetest(i.a, i.b.a, i.b.b); },
                 [](const Input &i) { return plain::linetest(i.a, i.b.a, i.b.b); },
                 [](const Input &i) { return linetest(i.a, i.b.a, i.b.b); }>("segment, triangle",
                                                                             std::move(inputs));
}

} // namespace plumb

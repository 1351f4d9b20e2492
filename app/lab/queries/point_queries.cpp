// The charted queries: points in and on shapes.
#include "app/lab/queries/book_queries.h"
#include "app/lab/queries/plain_queries.h"
#include "app/lab/queries/query_case.h"
#include "app/lab/queries/query_list.h"
#include "app/lab/queries/query_oracle.h"
#include "engine/geometry/contains.h"
#include "engine/geometry/triangle.h"

#include <utility>

namespace plumb {

QueryCase point_in_sphere(Random &random, std::size_t adversarial) {
    using Input = Pair<Sphere, Vec3>;
    Inputs<Input> inputs = gather<Input>(
        random, adversarial,
        [&](const Lattice &at, Judged<Input> &one) {
            const oracle::Ball ball = any_ball(random, at);
            const oracle::Point p = any_point(random, at);
            one.input = {real_sphere(ball, at), at.real(p)};
            one.truth = oracle::contains(ball, p);
        },
        [&] {
            return Input{{any_vector(random, 0.5), 1.0f}, any_vector(random, 1)};
        });
    return query<[](const Input &i) { return book::contains(i.a, i.b); },
                 [](const Input &i) { return plain::contains(i.a, i.b); },
                 [](const Input &i) { return contains(i.a, i.b); }>("point in sphere",
                                                                    std::move(inputs));
}

QueryCase point_on_segment(Random &random, std::size_t adversarial) {
    using Input = Pair<Segment, Vec3>;
    Inputs<Input> inputs = gather<Input>(
        random, adversarial,
        [&](const Lattice &at, Judged<Input> &one) {
            const oracle::Line line = any_segment(random, at);
            // Half of the points are on the line, so that some are hits.
            oracle::Point p = any_point(random, at);
            if (random.next_index(2) == 0) {
                const oracle::Int step = whole(random, 2);
                p = line.origin +
                    oracle::Point{step * line.along.x, step * line.along.y, step * line.along.z};
            }
            one.input = {real_segment(line, at), at.real(p)};
            one.truth = oracle::contains(line, p);
        },
        [&] {
            const Vec3 a = any_vector(random, 1), b = any_vector(random, 1);
            return Input{{a, b}, 0.5f * (a + b)};
        });
    return query<[](const Input &i) { return book::contains(i.a, i.b); },
                 [](const Input &i) { return plain::contains(i.a, i.b); },
                 [](const Input &i) { return contains(i.a, i.b); }>("point on segment",
                                                                    std::move(inputs));
}

QueryCase point_in_triangle(Random &random, std::size_t adversarial) {
    using Input = Pair<Triangle, Vec3>;
    Inputs<Input> inputs = gather<Input>(
        random, adversarial,
        [&](const Lattice &at, Judged<Input> &one) {
            oracle::Corners corners = any_corners(random, at);
            oracle::Point p = any_point(random, at);
            if (random.next_index(2) == 0) { // coplanar
                for (oracle::Point &corner : corners)
                    corner.y = at.offset.y;
                p.y = at.offset.y;
            }
            one.input = {real_triangle(corners, at), at.real(p)};
            one.truth = oracle::contains(corners, p);
        },
        [&] {
            const Triangle t = timed_triangle(random, 1);
            const float u = static_cast<float>(random.next_in(0, 1));
            return Input{t, t.a + u * (t.b - t.a) + (1 - u) * (t.c - t.a) * 0.9f};
        });
    return query<[](const Input &i) { return book::contains(i.a, i.b); },
                 [](const Input &i) { return plain::contains(i.a, i.b); },
                 [](const Input &i) { return contains(i.a, i.b); }>("point in triangle",
                                                                    std::move(inputs));
}

} // namespace plumb

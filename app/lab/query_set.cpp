#include "app/lab/query_set.h"

#include "app/lab/book_queries.h"
#include "app/lab/plain_queries.h"
#include "app/lab/query_oracle.h"
#include "engine/core/random.h"
#include "engine/geometry/closest_point.h"
#include "engine/geometry/contains.h"
#include "engine/geometry/overlap.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/sat.h"
#include "engine/geometry/triangle.h"
#include "engine/geometry/triangle_overlap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

template <typename A, typename B> struct Pair {
    A a;
    B b;
};

// An input and its truth.
template <typename Input> struct Judged {
    Input input;
    bool truth = false;
    std::uint8_t family = 0;
};

// --- Whole-number inputs -------------------------------------------------------------------------

// Where a case lies and how large it is. All its coordinates are whole numbers times `unit`.
struct Lattice {
    oracle::Int spread = 4; // coordinates about the offset
    oracle::Point offset;
    float unit = 1;

    [[nodiscard]] Vec3 real(const oracle::Point &p) const {
        return Vec3{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)} *
               unit;
    }
};

const std::vector<std::string> lattice_families{
    "on faces, edges and corners", // small numbers: coincidences everywhere
    "anywhere", "far from the origin",
    "tiny and huge", // 2^-10 to 2^16 m
};

oracle::Int whole(Random &random, oracle::Int reach) {
    return static_cast<oracle::Int>(random.next_index(static_cast<std::uint32_t>(2 * reach + 1))) -
           reach;
}

Lattice any_lattice(Random &random, std::uint8_t &family) {
    family = static_cast<std::uint8_t>(random.next_index(4));
    Lattice lattice;
    switch (family) {
    case 0:
        lattice.spread = 2 + random.next_index(3);
        break;
    case 1:
        lattice.spread = 500;
        break;
    case 2:
        lattice.offset = {whole(random, 8000), whole(random, 8000), whole(random, 8000)};
        break;
    default:
        lattice.unit = std::ldexp(1.0f, static_cast<int>(random.next_index(27)) - 10);
        break;
    }
    return lattice;
}

oracle::Point any_point(Random &random, const Lattice &lattice) {
    return lattice.offset + oracle::Point{whole(random, lattice.spread),
                                          whole(random, lattice.spread),
                                          whole(random, lattice.spread)};
}

// A vector with many zeros, and not zero itself.
oracle::Point any_direction(Random &random, oracle::Int spread) {
    oracle::Point d;
    do {
        d = {whole(random, spread), whole(random, spread), whole(random, spread)};
        if (random.next_index(3) == 0)
            d.x = 0;
        if (random.next_index(3) == 0)
            d.y = 0;
        if (random.next_index(3) == 0)
            d.z = 0;
    } while (d == oracle::Point{});
    return d;
}

oracle::Block any_block(Random &random, const Lattice &lattice) {
    const oracle::Point p = any_point(random, lattice);
    const oracle::Point q = any_point(random, lattice);
    return {{std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)},
            {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)}};
}

oracle::Ball any_ball(Random &random, const Lattice &lattice) {
    return {any_point(random, lattice), static_cast<oracle::Int>(random.next_index(
                                            static_cast<std::uint32_t>(2 * lattice.spread + 1)))};
}

// One in eight is flat.
oracle::Corners any_corners(Random &random, const Lattice &lattice) {
    oracle::Corners corners{any_point(random, lattice), any_point(random, lattice),
                            any_point(random, lattice)};
    if (random.next_index(8) == 0)
        corners[2] = random.next_index(2) == 0 ? corners[0] : corners[1];
    for (oracle::Point &corner : corners)
        corner = {corner.x & ~oracle::Int{1}, corner.y & ~oracle::Int{1},
                  corner.z & ~oracle::Int{1}};
    return corners;
}

// A point on a face, an edge or a corner of a box, or within it.
oracle::Point any_place(Random &random, const oracle::Block &block) {
    const auto one = [&](oracle::Int low, oracle::Int high) {
        switch (random.next_index(3)) {
        case 0:
            return low;
        case 1:
            return high;
        default:
            return low + static_cast<oracle::Int>(
                             random.next_index(static_cast<std::uint32_t>(high - low + 1)));
        }
    };
    const oracle::Int x = one(block.min.x, block.max.x), y = one(block.min.y, block.max.y);
    return {x, y, one(block.min.z, block.max.z)};
}

// The end of an axis of a ball, or its middle.
oracle::Point any_place(Random &random, const oracle::Ball &ball) {
    const oracle::Int r = random.next_index(2) == 0 ? ball.radius : -ball.radius;
    const oracle::Point reach[] = {{r, 0, 0}, {0, r, 0}, {0, 0, r}, {}};
    return ball.center + reach[random.next_index(4)];
}

// A corner, or the corner of the parallelogram of which two edges span half: beside the triangle,
// but in its plane and in line with its edges. Triangles that are to have whole middles of edges
// have even corners.
oracle::Point any_place(Random &random, const oracle::Corners &triangle) {
    const oracle::Point &a = triangle[random.next_index(3)];
    const oracle::Point &b = triangle[random.next_index(3)];
    const auto middle = [](oracle::Int p, oracle::Int q) { return (p + q) / 2; };
    return {middle(a.x, b.x), middle(a.y, b.y), middle(a.z, b.z)};
}

oracle::Line any_segment(Random &random, const Lattice &lattice) {
    const oracle::Point origin = any_point(random, lattice);
    if (random.next_index(8) == 0)
        return {origin, {}, true};
    return {origin, any_direction(random, lattice.spread), true};
}

// Half of them through a place on the shape.
template <typename Solid>
oracle::Line any_ray(Random &random, const Lattice &lattice, const Solid &solid) {
    oracle::Line line{any_point(random, lattice), any_direction(random, lattice.spread)};
    if (random.next_index(2) == 0) {
        const oracle::Point target = any_place(random, solid);
        const auto steps = static_cast<oracle::Int>(random.next_index(4));
        line.origin = target - oracle::Point{steps * line.along.x, steps * line.along.y,
                                             steps * line.along.z};
    }
    return line;
}

// Of half of them one end is on the shape, of a quarter both.
template <typename Solid>
oracle::Line any_segment(Random &random, const Lattice &lattice, const Solid &solid) {
    const oracle::Line line = any_segment(random, lattice);
    if (random.next_index(2) == 0)
        return line;
    const oracle::Point start = any_place(random, solid);
    if (random.next_index(2) == 0)
        return {start, line.along, true};
    return {start, any_place(random, solid) - start, true};
}

// Zeros of either sign, and lengths from 2^-20 to 2^20.
Ray real_ray(Random &random, const oracle::Line &line, const Lattice &lattice) {
    Vec3 direction = lattice.real(line.along) / lattice.unit *
                     std::ldexp(1.0f, static_cast<int>(random.next_index(41)) - 20);
    for (int i = 0; i < 3; ++i)
        if (direction[i] == 0 && random.next_index(2) == 0)
            direction[i] = -0.0f;
    return {lattice.real(line.origin), direction};
}

Segment real_segment(const oracle::Line &line, const Lattice &lattice) {
    return {lattice.real(line.origin), lattice.real(line.origin + line.along)};
}
Aabb real_aabb(const oracle::Block &block, const Lattice &lattice) {
    return {lattice.real(block.min), lattice.real(block.max)};
}
Sphere real_sphere(const oracle::Ball &ball, const Lattice &lattice) {
    return {lattice.real(ball.center), static_cast<float>(ball.radius) * lattice.unit};
}
Triangle real_triangle(const oracle::Corners &corners, const Lattice &lattice) {
    return {lattice.real(corners[0]), lattice.real(corners[1]), lattice.real(corners[2])};
}
// An oriented box that is not turned. Halves of whole numbers are as exact.
Box real_box(const oracle::Block &block, const Lattice &lattice) {
    return {0.5f * lattice.real(block.min + block.max), identity_rotation,
            0.5f * lattice.real(block.max - block.min)};
}

// --- Turned boxes, judged in long double with a margin
// ---------------------------------------------

using Long = long double;
using LongVec = glm::vec<3, Long, glm::defaultp>;
using LongMat = glm::mat<3, 3, Long, glm::defaultp>;

constexpr Long undecided = 1e-4L; // of the size of the boxes

struct LongBox {
    LongVec center;
    LongMat axes;
    LongVec half;

    explicit LongBox(const Box &box)
        : center(box.center),
          axes(glm::mat3_cast(glm::normalize(glm::qua<Long, glm::defaultp>(box.rotation)))),
          half(box.half_extents) {}
};

// Empty when a margin decides.
std::optional<bool> truth_of(const Box &box, const Vec3 &origin, const Vec3 &along, Long max_t) {
    const LongBox wide(box);
    const LongVec o = (LongVec(origin) - wide.center) * wide.axes;
    const LongVec d = LongVec(along) * wide.axes;
    const Long margin = undecided * (glm::length(wide.half) + glm::length(o));
    const auto meets = [&](Long grow) {
        Long enter = 0, exit = max_t;
        for (int i = 0; i < 3; ++i) {
            const Long h = wide.half[i] + grow;
            if (h < 0)
                return false;
            if (d[i] == 0) {
                if (std::abs(o[i]) > h)
                    return false;
                continue;
            }
            const Long one = (-h - o[i]) / d[i], other = (h - o[i]) / d[i];
            enter = std::max(enter, std::min(one, other));
            exit = std::min(exit, std::max(one, other));
        }
        return enter <= exit;
    };
    const bool grown = meets(margin);
    return grown == meets(-margin) ? std::optional(grown) : std::nullopt;
}

std::optional<bool> truth_of(const Box &box_a, const Box &box_b) {
    const LongBox a(box_a), b(box_b);
    const LongVec t = b.center - a.center;
    Long separation = -1e30L;
    const auto try_axis = [&](const LongVec &axis) {
        const Long length = glm::length(axis);
        if (length < 1e-6L)
            return;
        const LongVec u = axis / length;
        Long reach = 0;
        for (int i = 0; i < 3; ++i)
            reach += std::abs(glm::dot(a.axes[i], u)) * a.half[i] +
                     std::abs(glm::dot(b.axes[i], u)) * b.half[i];
        separation = std::max(separation, std::abs(glm::dot(t, u)) - reach);
    };
    for (int i = 0; i < 3; ++i) {
        try_axis(a.axes[i]);
        try_axis(b.axes[i]);
        for (int j = 0; j < 3; ++j)
            try_axis(glm::cross(a.axes[i], b.axes[j]));
    }
    const Long margin = undecided * (glm::length(a.half) + glm::length(b.half));
    if (std::abs(separation) < margin)
        return std::nullopt;
    return separation < 0;
}

Vec3 any_vector(Random &random, double reach) {
    const auto x = static_cast<float>(random.next_in(-reach, reach));
    const auto y = static_cast<float>(random.next_in(-reach, reach));
    const auto z = static_cast<float>(random.next_in(-reach, reach));
    return {x, y, z};
}

Vec3 any_half(Random &random) {
    return 0.1f + glm::abs(any_vector(random, 1));
}

Quat any_rotation(Random &random) {
    Quat q = identity_rotation;
    do {
        const Vec3 v = any_vector(random, 1);
        q = Quat{static_cast<float>(random.next_in(-1, 1)), v.x, v.y, v.z};
    } while (glm::dot(q, q) < 0.01f);
    return glm::normalize(q);
}

Box any_box(Random &random, double reach) {
    return {any_vector(random, reach), any_rotation(random), any_half(random)};
}

// Nearly as another is turned.
Quat nearby(Random &random, const Quat &q) {
    const Vec3 v = any_vector(random, random.next_index(2) == 0 ? 1e-3 : 1e-6);
    return glm::normalize(q * Quat{1, v.x, v.y, v.z});
}

// Two boxes that an edge of each parts: nearest to each other along edges at right angles.
Pair<Box, Box> edge_on_edge(Random &random) {
    const float quarter = 0.38268343f, rest = 0.92387953f; // sin and cos of 22.5 degrees
    const Box a{Vec3{0}, Quat{rest, quarter, 0, 0}, Vec3{1, 0.5f, 0.5f}}; // an edge along x on top
    const float gap = static_cast<float>(random.next_in(-0.2, 0.2));
    const float height = 0.5f * std::sqrt(2.0f);
    const Box b{Vec3{static_cast<float>(random.next_in(-0.3, 0.3)), 2 * height + gap, 0},
                Quat{rest, 0, 0, quarter}, Vec3{0.5f, 0.5f, 1}}; // and along z below
    const Quat turn = any_rotation(random);
    const auto turned = [&](const Box &box) {
        return Box{turn * box.center, turn * box.rotation, box.half_extents};
    };
    return {turned(a), turned(b)};
}

// --- The table
// -------------------------------------------------------------------------------------

template <typename Input> struct Inputs {
    std::vector<Input> timed;
    std::vector<Judged<Input>> judged;
    std::vector<std::string> families;
};

template <auto Ask, typename Input>
MethodOfQuery method(QueryMethod which, std::shared_ptr<const Inputs<Input>> inputs) {
    MethodOfQuery result;
    result.method = which;
    result.ask_all = [inputs] {
        std::uint64_t yes = 0;
        for (const Input &input : inputs->timed)
            yes += Ask(input) ? 1 : 0;
        return yes;
    };
    result.judge = [inputs] {
        std::vector<FamilyScore> scores;
        for (const std::string &family : inputs->families)
            scores.push_back({family, 0, 0});
        for (const Judged<Input> &one : inputs->judged) {
            FamilyScore &score = scores[one.family];
            ++score.asked;
            score.wrong += Ask(one.input) != one.truth ? 1 : 0;
        }
        return scores;
    };
    return result;
}

template <auto Book, auto Plain, auto Ours, typename Input>
QueryCase query(std::string name, Inputs<Input> &&inputs) {
    const auto shared = std::make_shared<const Inputs<Input>>(std::move(inputs));
    QueryCase result;
    result.name = std::move(name);
    result.batch = shared->timed.size();
    result.methods.push_back(method<Book, Input>(QueryMethod::book, shared));
    result.methods.push_back(method<Plain, Input>(QueryMethod::plain, shared));
    result.methods.push_back(method<Ours, Input>(QueryMethod::ours, shared));
    return result;
}

constexpr std::size_t timed_batch = 1024;

// Inputs of a lattice, judged by whole numbers, and random ones to be timed.
template <typename Input, typename MakeCase, typename MakeTimed>
Inputs<Input> gather(Random &random, std::size_t adversarial, const MakeCase &make_case,
                     const MakeTimed &make_timed) {
    Inputs<Input> inputs;
    inputs.families = lattice_families;
    inputs.judged.reserve(adversarial);
    while (inputs.judged.size() < adversarial) {
        Judged<Input> one;
        const Lattice lattice = any_lattice(random, one.family);
        make_case(lattice, one);
        inputs.judged.push_back(one);
    }
    while (inputs.timed.size() < timed_batch)
        inputs.timed.push_back(make_timed());
    return inputs;
}

// Adds what is judged with a margin.
template <typename Input, typename Make>
void add_family(Inputs<Input> &inputs, const char *name, std::size_t count, const Make &make) {
    inputs.families.emplace_back(name);
    const auto family = static_cast<std::uint8_t>(inputs.families.size() - 1);
    for (std::size_t i = 0; i < count;) {
        Input input;
        const std::optional<bool> truth = make(input);
        if (!truth)
            continue;
        inputs.judged.push_back({input, *truth, family});
        ++i;
    }
}

// Rays that hit about half of the time: towards a shape of a size of about one.
Ray timed_ray(Random &random) {
    const Vec3 origin = any_vector(random, 4);
    return {origin, any_vector(random, 1.6) - origin};
}
Triangle timed_triangle(Random &random, double reach) {
    const Vec3 a = any_vector(random, reach);
    return {a, a + any_vector(random, 1.5), a + any_vector(random, 1.5)};
}
Aabb timed_aabb(Random &random, double reach) {
    const Vec3 center = any_vector(random, reach), half = any_half(random);
    return {center - half, center + half};
}

} // namespace

std::string_view query_method_name(QueryMethod method) {
    switch (method) {
    case QueryMethod::book:
        return "book";
    case QueryMethod::plain:
        return "plain";
    case QueryMethod::ours:
        return "plumb";
    }
    return "";
}

std::vector<QueryCase> query_cases(std::uint64_t seed, std::size_t adversarial) {
    std::vector<QueryCase> cases;
    Random random(seed);
    const std::size_t part = adversarial / 4;

    {
        using Input = Pair<Sphere, Vec3>;
        cases.push_back(query<[](const Input &i) { return book::contains(i.a, i.b); },
                              [](const Input &i) { return plain::contains(i.a, i.b); },
                              [](const Input &i) { return contains(i.a, i.b); }>(
            "point in sphere",
            gather<Input>(
                random, adversarial,
                [&](const Lattice &at, Judged<Input> &one) {
                    const oracle::Ball ball = any_ball(random, at);
                    const oracle::Point p = any_point(random, at);
                    one.input = {real_sphere(ball, at), at.real(p)};
                    one.truth = oracle::contains(ball, p);
                },
                [&] {
                    return Input{{any_vector(random, 0.5), 1.0f}, any_vector(random, 1)};
                })));
    }
    {
        using Input = Pair<Segment, Vec3>;
        cases.push_back(query<[](const Input &i) { return book::contains(i.a, i.b); },
                              [](const Input &i) { return plain::contains(i.a, i.b); },
                              [](const Input &i) { return contains(i.a, i.b); }>(
            "point on segment",
            gather<Input>(
                random, adversarial,
                [&](const Lattice &at, Judged<Input> &one) {
                    const oracle::Line line = any_segment(random, at);
                    // Half of them on the line, so that there is something to find.
                    oracle::Point p = any_point(random, at);
                    if (random.next_index(2) == 0) {
                        const oracle::Int step = whole(random, 2);
                        p = line.origin + oracle::Point{step * line.along.x, step * line.along.y,
                                                        step * line.along.z};
                    }
                    one.input = {real_segment(line, at), at.real(p)};
                    one.truth = oracle::contains(line, p);
                },
                [&] {
                    const Vec3 a = any_vector(random, 1), b = any_vector(random, 1);
                    return Input{{a, b}, 0.5f * (a + b)};
                })));
    }
    {
        using Input = Pair<Triangle, Vec3>;
        cases.push_back(query<[](const Input &i) { return book::contains(i.a, i.b); },
                              [](const Input &i) { return plain::contains(i.a, i.b); },
                              [](const Input &i) { return contains(i.a, i.b); }>(
            "point in triangle",
            gather<Input>(
                random, adversarial,
                [&](const Lattice &at, Judged<Input> &one) {
                    oracle::Corners corners = any_corners(random, at);
                    oracle::Point p = any_point(random, at);
                    if (random.next_index(2) == 0) { // in one plane
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
                })));
    }
    {
        using Input = Pair<Sphere, Ray>;
        cases.push_back(query<[](const Input &i) { return book::raycast(i.a, i.b); },
                              [](const Input &i) { return plain::raycast(i.a, i.b); },
                              [](const Input &i) { return ray_interval(i.a, i.b).has_value(); }>(
            "ray, sphere", gather<Input>(
                               random, adversarial,
                               [&](const Lattice &at, Judged<Input> &one) {
                                   const oracle::Ball ball = any_ball(random, at);
                                   const oracle::Line line = any_ray(random, at, ball);
                                   one.input = {real_sphere(ball, at), real_ray(random, line, at)};
                                   one.truth = oracle::meets(line, ball);
                               },
                               [&] {
                                   return Input{{any_vector(random, 1), 0.8f}, timed_ray(random)};
                               })));
    }
    {
        using Input = Pair<Aabb, Ray>;
        cases.push_back(query<[](const Input &i) { return book::raycast(i.a, i.b); },
                              [](const Input &i) { return plain::raycast(i.a, i.b); },
                              [](const Input &i) { return ray_interval(i.a, i.b).has_value(); }>(
            "ray, aligned box",
            gather<Input>(
                random, adversarial,
                [&](const Lattice &at, Judged<Input> &one) {
                    const oracle::Block block = any_block(random, at);
                    const oracle::Line line = any_ray(random, at, block);
                    one.input = {real_aabb(block, at), real_ray(random, line, at)};
                    one.truth = oracle::meets(line, block);
                },
                [&] {
                    return Input{timed_aabb(random, 1), timed_ray(random)};
                })));
    }
    {
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
        cases.push_back(query<[](const Input &i) { return book::raycast(i.a, i.b); },
                              [](const Input &i) { return plain::raycast(i.a, i.b); },
                              [](const Input &i) { return ray_interval(i.a, i.b).has_value(); }>(
            "ray, box", std::move(inputs)));
    }
    {
        using Input = Pair<Triangle, Ray>;
        cases.push_back(query<[](const Input &i) { return book::raycast(i.a, i.b); },
                              [](const Input &i) { return plain::raycast(i.a, i.b); },
                              [](const Input &i) { return raycast(i.a, i.b).has_value(); }>(
            "ray, triangle",
            gather<Input>(
                random, adversarial,
                [&](const Lattice &at, Judged<Input> &one) {
                    oracle::Corners corners = any_corners(random, at);
                    const oracle::Line line = any_ray(random, at, corners);
                    // The book's triangles have one side: it is asked from that side.
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
                })));
    }
    {
        using Input = Pair<Aabb, Segment>;
        cases.push_back(query<[](const Input &i) { return book::linetest(i.a, i.b.a, i.b.b); },
                              [](const Input &i) { return plain::linetest(i.a, i.b.a, i.b.b); },
                              [](const Input &i) { return linetest(i.a, i.b.a, i.b.b); }>(
            "segment, aligned box",
            gather<Input>(
                random, adversarial,
                [&](const Lattice &at, Judged<Input> &one) {
                    const oracle::Block block = any_block(random, at);
                    const oracle::Line line = any_segment(random, at, block);
                    one.input = {real_aabb(block, at), real_segment(line, at)};
                    one.truth = oracle::meets(line, block);
                },
                [&] {
                    return Input{timed_aabb(random, 1),
                                 {any_vector(random, 2), any_vector(random, 2)}};
                })));
    }
    {
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
        cases.push_back(query<[](const Input &i) { return book::linetest(i.a, i.b.a, i.b.b); },
                              [](const Input &i) { return plain::linetest(i.a, i.b.a, i.b.b); },
                              [](const Input &i) { return linetest(i.a, i.b.a, i.b.b); }>(
            "segment, box", std::move(inputs)));
    }
    {
        using Input = Pair<Triangle, Segment>;
        cases.push_back(query<[](const Input &i) { return book::linetest(i.a, i.b.a, i.b.b); },
                              [](const Input &i) { return plain::linetest(i.a, i.b.a, i.b.b); },
                              [](const Input &i) { return linetest(i.a, i.b.a, i.b.b); }>(
            "segment, triangle",
            gather<Input>(
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
                })));
    }
    {
        using Input = Pair<Sphere, Aabb>;
        cases.push_back(query<[](const Input &i) { return book::overlaps(i.a, i.b); },
                              [](const Input &i) { return plain::overlaps(i.a, i.b); },
                              [](const Input &i) { return overlaps(i.a, i.b); }>(
            "sphere, aligned box",
            gather<Input>(
                random, adversarial,
                [&](const Lattice &at, Judged<Input> &one) {
                    const oracle::Ball ball = any_ball(random, at);
                    const oracle::Block block = any_block(random, at);
                    one.input = {real_sphere(ball, at), real_aabb(block, at)};
                    one.truth = oracle::meets(ball, block);
                },
                [&] {
                    return Input{{any_vector(random, 1.5), 0.8f}, timed_aabb(random, 1)};
                })));
    }
    {
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
        cases.push_back(query<[](const Input &i) { return book::overlaps(i.a, i.b); },
                              [](const Input &i) { return plain::overlaps(i.a, i.b); },
                              [](const Input &i) { return overlaps(i.a, i.b); }>(
            "aligned box, box", std::move(inputs)));
    }
    {
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
        cases.push_back(query<[](const Input &i) { return book::overlaps(i.a, i.b); },
                              [](const Input &i) { return plain::overlaps(i.a, i.b); },
                              [](const Input &i) { return overlaps(i.a, i.b); }>(
            "box, box", std::move(inputs)));
    }
    {
        using Input = Pair<Triangle, Aabb>;
        cases.push_back(query<[](const Input &i) { return book::overlaps(i.a, i.b); },
                              [](const Input &i) { return plain::overlaps(i.a, i.b); },
                              [](const Input &i) { return overlaps(i.a, i.b); }>(
            "triangle, aligned box",
            gather<Input>(
                random, adversarial,
                [&](const Lattice &at, Judged<Input> &one) {
                    const oracle::Corners corners = any_corners(random, at);
                    const oracle::Block block = any_block(random, at);
                    one.input = {real_triangle(corners, at), real_aabb(block, at)};
                    one.truth = oracle::meets(corners, block);
                },
                [&] {
                    return Input{timed_triangle(random, 1.2), timed_aabb(random, 1)};
                })));
    }
    {
        using Input = Pair<Triangle, Triangle>;
        cases.push_back(query<[](const Input &i) { return book::overlaps(i.a, i.b); },
                              [](const Input &i) { return plain::overlaps(i.a, i.b); },
                              [](const Input &i) { return overlaps(i.a, i.b); }>(
            "triangle, triangle",
            gather<Input>(
                random, adversarial,
                [&](const Lattice &at, Judged<Input> &one) {
                    oracle::Corners a = any_corners(random, at), b = any_corners(random, at);
                    switch (random.next_index(4)) {
                    case 0: // coplanar
                        for (std::size_t i = 0; i < 3; ++i)
                            a[i].y = b[i].y = at.offset.y;
                        break;
                    case 1: // a common edge
                        b[0] = a[0];
                        b[1] = a[1];
                        break;
                    case 2: // a common corner
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
                })));
    }
    return cases;
}

} // namespace plumb

#include "engine/scene/repeat.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <tuple>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

constexpr std::uint64_t saturated = std::uint64_t{1} << 63;

std::uint64_t times(std::uint64_t a, std::uint64_t b) {
    return b != 0 && a > saturated / b ? saturated : a * b;
}

std::uint64_t natural(int count) {
    PLUMB_CHECK(count >= 1, "a repeat's count must be at least 1, got " << count);
    return static_cast<std::uint64_t>(count);
}

glm::dquat turn_about_y(double angle) {
    return {std::cos(0.5 * angle), 0, std::sin(0.5 * angle), 0};
}

// Uniform over all rotations: Shoemake 1992, "Uniform random rotations", Graphics Gems III, p. 129.
glm::dquat random_turn(Random &random) {
    const double u = random.next_unit();
    const double a = 2 * std::numbers::pi * random.next_unit();
    const double b = 2 * std::numbers::pi * random.next_unit();
    const double inner = std::sqrt(1 - u);
    const double outer = std::sqrt(u);
    return {outer * std::cos(b), inner * std::sin(a), inner * std::cos(a), outer * std::sin(b)};
}

// Points in a grid of cells min_distance wide, so that only 27 cells need testing for a neighbour.
class SpacedPoints {
  public:
    explicit SpacedPoints(double min_distance) : min_distance_(min_distance) {}

    bool has_room_for(const glm::dvec3 &point) const {
        const auto [cx, cy, cz] = cell(point);
        for (std::int64_t x = cx - 1; x <= cx + 1; ++x)
            for (std::int64_t y = cy - 1; y <= cy + 1; ++y)
                for (std::int64_t z = cz - 1; z <= cz + 1; ++z) {
                    const auto found = cells_.find({x, y, z});
                    if (found == cells_.end())
                        continue;
                    for (const glm::dvec3 &other : found->second)
                        if (glm::distance(point, other) < min_distance_)
                            return false;
                }
        return true;
    }

    void add(const glm::dvec3 &point) { cells_[cell(point)].push_back(point); }

  private:
    using Cell = std::tuple<std::int64_t, std::int64_t, std::int64_t>;

    Cell cell(const glm::dvec3 &point) const {
        const auto index = [&](double x) {
            return static_cast<std::int64_t>(std::floor(x / min_distance_));
        };
        return {index(point.x), index(point.y), index(point.z)};
    }

    double min_distance_;
    std::map<Cell, std::vector<glm::dvec3>> cells_;
};

// The i-th of `count` positions, `spacing` apart and centred on 0.
double centred(int i, int count, double spacing) {
    return (i - 0.5 * (count - 1)) * spacing;
}

struct Placer {
    const glm::dvec3 &at;
    Random &random;
    std::vector<Placement> placed;

    void put(const glm::dvec3 &offset, const glm::dquat &turn = {1, 0, 0, 0}) {
        placed.push_back({at + offset, turn});
    }

    void operator()(const GridRepeat &grid) {
        for (int y = 0; y < grid.count.y; ++y)
            for (int z = 0; z < grid.count.z; ++z)
                for (int x = 0; x < grid.count.x; ++x)
                    put({centred(x, grid.count.x, grid.spacing.x), y * grid.spacing.y,
                         centred(z, grid.count.z, grid.spacing.z)});
    }

    void operator()(const StackRepeat &stack) {
        for (int i = 0; i < stack.count; ++i)
            put({0, i * stack.spacing, 0}, turn_about_y(i * stack.turn));
    }

    void operator()(const LineRepeat &line) {
        for (int i = 0; i < line.count; ++i)
            put(static_cast<double>(i) * line.step);
    }

    void operator()(const PyramidRepeat &pyramid) {
        for (int layer = 0; layer < pyramid.base; ++layer) {
            const int width = pyramid.base - layer;
            const int depth = pyramid.square ? width : 1;
            for (int z = 0; z < depth; ++z)
                for (int x = 0; x < width; ++x)
                    put({centred(x, width, pyramid.spacing.x), layer * pyramid.spacing.y,
                         centred(z, depth, pyramid.spacing.x)});
        }
    }

    void operator()(const RingRepeat &ring) {
        for (int i = 0; i < ring.count; ++i) {
            const double angle = 2 * std::numbers::pi * i / ring.count;
            put({ring.radius * std::sin(angle), 0, ring.radius * std::cos(angle)},
                turn_about_y(ring.facing ? angle : 0));
        }
    }

    void operator()(const ScatterRepeat &scatter) {
        SpacedPoints points(scatter.min_distance);
        for (int i = 0; i < scatter.count; ++i) {
            glm::dvec3 offset{0};
            bool has_room = false;
            for (int attempt = 0; attempt < scatter_attempts && !has_room; ++attempt) {
                for (int axis = 0; axis < 3; ++axis)
                    offset[axis] =
                        random.next_in(-scatter.half_extents[axis], scatter.half_extents[axis]);
                has_room = scatter.min_distance <= 0 || points.has_room_for(offset);
            }
            if (!has_room)
                return;
            if (scatter.min_distance > 0)
                points.add(offset);
            put(offset, scatter.random_rotation ? random_turn(random) : glm::dquat{1, 0, 0, 0});
        }
    }
};

struct CopyCounter {
    std::uint64_t operator()(const GridRepeat &grid) const {
        return times(times(natural(grid.count.x), natural(grid.count.y)), natural(grid.count.z));
    }
    std::uint64_t operator()(const StackRepeat &stack) const { return natural(stack.count); }
    std::uint64_t operator()(const LineRepeat &line) const { return natural(line.count); }
    std::uint64_t operator()(const PyramidRepeat &pyramid) const {
        const std::uint64_t n = natural(pyramid.base);
        // Gauss's sums; n (n + 1) is below 2^63 for every int, but the third factor may overflow
        // it.
        const std::uint64_t pairs = n * (n + 1);
        if (!pyramid.square)
            return pairs / 2;
        const std::uint64_t product = times(pairs, 2 * n + 1);
        return product == saturated ? saturated : product / 6;
    }
    std::uint64_t operator()(const RingRepeat &ring) const { return natural(ring.count); }
    std::uint64_t operator()(const ScatterRepeat &scatter) const { return natural(scatter.count); }
};

} // namespace

std::size_t repeat_count(const Repeat &repeat) {
    return std::visit(CopyCounter{}, repeat);
}

std::vector<Placement> placements(const Repeat &repeat, const glm::dvec3 &position,
                                  Random &random) {
    Placer placer{position, random, {}};
    placer.placed.reserve(repeat_count(repeat));
    std::visit(placer, repeat);
    return std::move(placer.placed);
}

} // namespace plumb

// The quadtree and the octree: boxes in the cells of a regularly divided world.
#pragma once

#include "engine/geometry/shapes_2d.h"
#include "engine/geometry/slab.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

template <int Dim> struct OrthtreeShapes;

template <> struct OrthtreeShapes<2> {
    using Point = Vec2;
    using Box = Rectangle;
    using Ball = Circle;
    using Line = Segment2;
    using HalfLine = Ray2;
};

template <> struct OrthtreeShapes<3> {
    using Point = Vec3;
    using Box = Aabb;
    using Ball = Sphere;
    using Line = Segment;
    using HalfLine = Ray;
};

// A tree of cells, each divided into 2^Dim equal ones. An item is in exactly one cell: the deepest
// on the way to the item's centre that contains it when grown to twice its size ("loose", Ulrich
// 2000, "Loose Octrees", Game Programming Gems). If cells were not grown, every item on a dividing
// plane, however small, would stay at the top and be tested by each query; with an item in many
// cells, queries would meet it many times. Items too large for any cell or outside the world are in
// the root: they are found like all others, only more slowly.
//
// A cell is divided if and only if there are more than `capacity` items in and below it, so the
// cells depend on the current items, not on the history. Copyable. The order of visits depends on
// the history. Do not change the tree from within a visit.
//
// A non-finite or invalid box, ball, line or ray, or an item that is not in the tree, fails a
// check. All sets are closed; sizes and positions are compared without rounding, so queries are
// exact for the boxes, except those with balls (the squared distance is rounded: 4 epsilon) and
// with lines and rays (slab.h).
template <int Dim> class Orthtree {
  public:
    using Point = typename OrthtreeShapes<Dim>::Point;
    using Box = typename OrthtreeShapes<Dim>::Box;
    using Ball = typename OrthtreeShapes<Dim>::Ball;
    using Line = typename OrthtreeShapes<Dim>::Line;
    using HalfLine = typename OrthtreeShapes<Dim>::HalfLine;
    using Item = std::int32_t;
    static constexpr Item none = -1;
    static constexpr int depth_limit = 16;

    // The root, at depth 0, is `world`, which must have a size on every axis. max_depth in [0,
    // depth_limit], capacity > 0.
    Orthtree(const Box &world, int max_depth, int capacity);

    // Queries return `user`. An empty box fails a check.
    Item insert(const Box &box, std::uint32_t user);
    // The item's number may be reused.
    void remove(Item item);
    // Returns whether the item moved to another cell.
    bool update(Item item, const Box &box);

    std::uint32_t user(Item item) const;
    const Box &bounds(Item item) const;
    std::size_t size() const { return static_cast<std::size_t>(cells_[0].count); }

    // Each calls visit(user) -> bool for every item whose box touches the given shape, and stops
    // when visit returns false. Empty boxes touch nothing.
    template <typename Visit> void query(const Box &box, Visit &&visit) const;
    template <typename Visit> void query(const Ball &ball, Visit &&visit) const;
    template <typename Visit> void query(const Line &line, Visit &&visit) const;
    // For any region: meets(box) -> bool. If it accepts a box it must accept every box that
    // contains it.
    template <typename Meets, typename Visit> void query_if(Meets &&meets, Visit &&visit) const;

    // Calls visit(user, ray) -> Real for items whose box the ray hits, nearer cells first; the
    // result is the new max_t (return ray.max_t to continue, 0 to stop, as for an any-hit query).
    // Closest-hit searches can be built on this.
    template <typename Visit> void raycast(HalfLine ray, Visit &&visit) const;

    struct Closest {
        std::uint32_t user = 0;
        Real distance = Real(0);
    };
    // The item with the least distance(user) -> Real from `point`; of equal ones, the least user.
    // The distance must not be negative or less than that to the item's box; infinity skips an
    // item. None when all are skipped.
    template <typename Distance>
    std::optional<Closest> closest(const Point &point, Distance &&distance) const;

    // Calls visit(user_a, user_b) once for each pair of items whose boxes touch.
    template <typename Visit> void pairs(Visit &&visit) const;

    // Calls visit(box, depth, count) for every cell, parents first, with the number of items in and
    // below it; the box is not grown.
    template <typename Visit> void cells(Visit &&visit) const;

    // Fails a check when links, counts or places are inconsistent. For tests.
    void validate() const;

  private:
    using Index = std::int32_t;
    static constexpr Index fan_out = 1 << Dim;

    struct Cell {
        Point center{Real(0)};
        Point half_extents{Real(0)};
        Index parent = none;
        Index first_child = none; // the others follow it
        Index first_item = none;
        std::int32_t count = 0; // items here and below
        std::int32_t depth = 0;
    };

    struct Entry {
        Box box;
        Index cell = none; // none in a free entry
        Index next = none; // in a free entry: the next free one
        Index previous = none;
        std::uint32_t user = 0;
    };

    // Each cell on the way down leaves at most fan_out - 1 others pending.
    static constexpr std::size_t pending_capacity = 1 + depth_limit * (fan_out - 1);

    static bool touches(const Box &a, const Box &b) {
        for (int i = 0; i < Dim; ++i)
            if (!(a.min[i] <= b.max[i] && b.min[i] <= a.max[i]))
                return false;
        return true;
    }
    static bool holds(const Box &outer, const Box &inner) {
        for (int i = 0; i < Dim; ++i)
            if (!(outer.min[i] <= inner.min[i] && inner.max[i] <= outer.max[i]))
                return false;
        return true;
    }
    // Every operation is monotonic: a box that contains another is never farther.
    static Real squared_distance(const Box &box, const Point &point) {
        Real sum = Real(0);
        for (int i = 0; i < Dim; ++i) {
            const Real d = std::max({box.min[i] - point[i], point[i] - box.max[i], Real(0)});
            sum += d * d;
        }
        return sum;
    }
    static bool meets(const Box &box, const HalfLine &ray, Real &enter) {
        Real exit = Real(0);
        int axis = -1;
        if constexpr (Dim == 2)
            return slab_interval(lifted(box), lifted(ray), enter, exit, axis);
        else
            return slab_interval(box, ray, enter, exit, axis);
    }
    // The box around the items of any cell but the root.
    static Box grown(const Cell &cell) {
        return {cell.center - Real(2) * cell.half_extents,
                cell.center + Real(2) * cell.half_extents};
    }

    static void check_point(const Point &point);
    static void check_box(const Box &box);
    static void check_numbers(const Box &box);
    static void check_ball(const Ball &ball);
    static void check_ray(const HalfLine &ray);
    static void check_distance(Real distance);
    void check_item(Item item) const;

    Cell &cell(Index index) { return cells_[static_cast<std::size_t>(index)]; }
    const Cell &cell(Index index) const { return cells_[static_cast<std::size_t>(index)]; }
    Entry &entry(Index index) { return entries_[static_cast<std::size_t>(index)]; }
    const Entry &entry(Index index) const { return entries_[static_cast<std::size_t>(index)]; }

    template <typename Meets, typename Visit> void visit_met(Meets &&meets, Visit &&visit) const;
    Index child_for(const Cell &parent, const Box &box) const;
    Index destination(const Box &box) const;
    void attach(Item item);
    void detach(Item item);
    void link(Item item, Index to);
    void unlink(Item item);
    void divide(Index index);
    void unite(Index index);

    int max_depth_ = 0;
    std::int32_t capacity_ = 0;
    std::vector<Cell> cells_; // the root, then children in blocks of fan_out
    std::vector<Entry> entries_;
    std::vector<Index> free_blocks_;
    Index free_entry_ = none;
};

extern template class Orthtree<2>;
extern template class Orthtree<3>;

using Quadtree = Orthtree<2>;
using Octree = Orthtree<3>;

template <int Dim>
template <typename Meets, typename Visit>
void Orthtree<Dim>::visit_met(Meets &&meets, Visit &&visit) const {
    std::array<Index, pending_capacity> pending; // cells known to be met
    std::size_t count = 0;
    pending[count++] = 0;
    while (count > 0) {
        const Cell &here = cell(pending[--count]);
        for (Index i = here.first_item; i != none; i = entry(i).next)
            if (meets(entry(i).box) && !visit(i))
                return;
        if (here.first_child == none)
            continue;
        for (Index k = here.first_child + fan_out - 1; k >= here.first_child; --k)
            if (cell(k).count > 0 && meets(grown(cell(k))))
                pending[count++] = k;
    }
}

template <int Dim>
template <typename Meets, typename Visit>
void Orthtree<Dim>::query_if(Meets &&meets, Visit &&visit) const {
    visit_met(meets, [&](Item item) { return visit(entry(item).user); });
}

template <int Dim>
template <typename Visit>
void Orthtree<Dim>::query(const Box &box, Visit &&visit) const {
    check_numbers(box);
    if (!holds(box, {box.min, box.min})) // empty
        return;
    query_if([&](const Box &other) { return touches(box, other); }, visit);
}

template <int Dim>
template <typename Visit>
void Orthtree<Dim>::query(const Ball &ball, Visit &&visit) const {
    check_ball(ball);
    const Real squared = ball.radius * ball.radius;
    query_if([&](const Box &box) { return squared_distance(box, ball.center) <= squared; }, visit);
}

template <int Dim>
template <typename Visit>
void Orthtree<Dim>::query(const Line &line, Visit &&visit) const {
    check_point(line.a);
    check_point(line.b);
    if (line.a == line.b) {
        query(Box{line.a, line.a}, visit);
        return;
    }
    // The endpoint b is not lost to rounding: if it is in a box, the slab test's quotient has its
    // numerator rounded like its denominator, and so is at most 1.
    const HalfLine ray{line.a, line.b - line.a, Real(1)};
    check_ray(ray);
    Real enter = Real(0);
    query_if([&](const Box &box) { return meets(box, ray, enter); }, visit);
}

template <int Dim>
template <typename Visit>
void Orthtree<Dim>::raycast(HalfLine ray, Visit &&visit) const {
    check_ray(ray);
    struct Met {
        Index cell;
        Real enter;
    };
    std::array<Met, pending_capacity> pending; // the nearest last
    std::size_t count = 0;
    pending[count++] = {0, Real(0)};
    while (count > 0) {
        const Met met = pending[--count];
        if (met.enter > ray.max_t)
            continue; // a nearer hit was found since
        const Cell &here = cell(met.cell);
        for (Index i = here.first_item; i != none; i = entry(i).next) {
            Real enter = Real(0);
            if (!meets(entry(i).box, ray, enter))
                continue;
            ray.max_t = visit(entry(i).user, static_cast<const HalfLine &>(ray));
            if (!(ray.max_t > Real(0)))
                return;
        }
        if (here.first_child == none)
            continue;
        const std::size_t first = count;
        for (Index k = here.first_child; k < here.first_child + fan_out; ++k) {
            Met next{k, Real(0)};
            if (cell(k).count == 0 || !meets(grown(cell(k)), ray, next.enter))
                continue;
            std::size_t place = count++;
            for (; place > first && pending[place - 1].enter < next.enter; --place)
                pending[place] = pending[place - 1];
            pending[place] = next;
        }
    }
}

template <int Dim>
template <typename Distance>
auto Orthtree<Dim>::closest(const Point &point, Distance &&distance) const
    -> std::optional<Closest> {
    check_point(point);
    constexpr Real endless = std::numeric_limits<Real>::infinity();
    // Each square is rounded by less than 4 epsilon of itself.
    constexpr Real slack = Real(1) + Real(8) * std::numeric_limits<Real>::epsilon();
    Closest best{0, endless};
    Real bound = endless; // boxes with a larger squared distance are not closer
    struct Near {
        Index cell;
        Real squared;
    };
    std::array<Near, pending_capacity> pending; // the nearest last
    std::size_t count = 0;
    pending[count++] = {0, Real(0)};
    while (count > 0) {
        const Near near = pending[--count];
        if (near.squared > bound)
            continue;
        const Cell &here = cell(near.cell);
        for (Index i = here.first_item; i != none; i = entry(i).next) {
            if (squared_distance(entry(i).box, point) > bound)
                continue;
            const Closest candidate{entry(i).user, distance(entry(i).user)};
            check_distance(candidate.distance);
            if (candidate.distance < best.distance ||
                (candidate.distance == best.distance && candidate.user < best.user)) {
                best = candidate;
                bound = best.distance * best.distance * slack;
            }
        }
        if (here.first_child == none)
            continue;
        const std::size_t first = count;
        for (Index k = here.first_child; k < here.first_child + fan_out; ++k) {
            if (cell(k).count == 0)
                continue;
            const Near next{k, squared_distance(grown(cell(k)), point)};
            if (next.squared > bound)
                continue;
            std::size_t place = count++;
            for (; place > first && pending[place - 1].squared < next.squared; --place)
                pending[place] = pending[place - 1];
            pending[place] = next;
        }
    }
    if (best.distance == endless)
        return std::nullopt;
    return best;
}

template <int Dim> template <typename Visit> void Orthtree<Dim>::pairs(Visit &&visit) const {
    const auto end = static_cast<Item>(entries_.size());
    for (Item a = 0; a < end; ++a) {
        if (entry(a).cell == none)
            continue;
        visit_met([&](const Box &box) { return touches(entry(a).box, box); },
                  [&](Item b) {
                      if (b > a)
                          visit(entry(a).user, entry(b).user);
                      return true;
                  });
    }
}

template <int Dim> template <typename Visit> void Orthtree<Dim>::cells(Visit &&visit) const {
    std::array<Index, pending_capacity> pending;
    std::size_t count = 0;
    pending[count++] = 0;
    while (count > 0) {
        const Cell &here = cell(pending[--count]);
        visit(Box{here.center - here.half_extents, here.center + here.half_extents},
              static_cast<int>(here.depth), static_cast<std::size_t>(here.count));
        if (here.first_child == none)
            continue;
        for (Index k = here.first_child + fan_out - 1; k >= here.first_child; --k)
            pending[count++] = k;
    }
}

} // namespace plumb::inline PLUMB_PRECISION

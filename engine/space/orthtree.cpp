#include "engine/space/orthtree.h"

#include "engine/core/check.h"
#include "engine/math/printed.h"

#include <cmath>

namespace plumb::inline PLUMB_PRECISION {

namespace {

template <typename Point> bool all_finite(const Point &point) {
    for (int i = 0; i < Point::length(); ++i)
        if (!std::isfinite(point[i]))
            return false;
    return true;
}

} // namespace

template <int Dim> void Orthtree<Dim>::check_point(const Point &point) {
    PLUMB_CHECK(all_finite(point), "point must be finite, got " << Printed{point});
}

// Query boxes may be infinite.
template <int Dim> void Orthtree<Dim>::check_numbers(const Box &box) {
    for (int i = 0; i < Dim; ++i)
        PLUMB_CHECK(!std::isnan(box.min[i]) && !std::isnan(box.max[i]),
                    "box bounds must be numbers, got [" << box.min[i] << ", " << box.max[i]
                                                        << "] on axis " << i);
}

template <int Dim> void Orthtree<Dim>::check_box(const Box &box) {
    for (int i = 0; i < Dim; ++i)
        PLUMB_CHECK(std::isfinite(box.min[i]) && std::isfinite(box.max[i]) &&
                        box.min[i] <= box.max[i],
                    "a box in a tree must be finite and not empty, got ["
                        << box.min[i] << ", " << box.max[i] << "] on axis " << i);
}

template <int Dim> void Orthtree<Dim>::check_ball(const Ball &ball) {
    PLUMB_CHECK(all_finite(ball.center), "centre must be finite, got " << Printed{ball.center});
    PLUMB_CHECK(ball.radius >= Real(0) && std::isfinite(ball.radius),
                "radius must be finite and not negative, got " << ball.radius);
}

template <int Dim> void Orthtree<Dim>::check_ray(const HalfLine &ray) {
    PLUMB_CHECK(all_finite(ray.origin), "ray origin must be finite, got " << Printed{ray.origin});
    PLUMB_CHECK(all_finite(ray.direction) && ray.direction != Point{Real(0)},
                "ray direction must be finite and not zero, got " << Printed{ray.direction});
    PLUMB_CHECK(!std::isnan(ray.max_t), "ray max_t must be a number, got " << ray.max_t);
}

template <int Dim> void Orthtree<Dim>::check_distance(Real distance) {
    PLUMB_CHECK(distance >= Real(0), "a distance must not be negative, got " << distance);
}

template <int Dim> void Orthtree<Dim>::check_item(Item item) const {
    PLUMB_CHECK(item >= 0 && static_cast<std::size_t>(item) < entries_.size() &&
                    entry(item).cell != none,
                "not an item of this tree: " << item);
}

template <int Dim>
Orthtree<Dim>::Orthtree(const Box &world, int max_depth, int capacity)
    : max_depth_(max_depth), capacity_(capacity) {
    for (int i = 0; i < Dim; ++i)
        PLUMB_CHECK(std::isfinite(world.min[i]) && std::isfinite(world.max[i]) &&
                        world.min[i] < world.max[i],
                    "the world of a tree must be finite and nonempty, got ["
                        << world.min[i] << ", " << world.max[i] << "] on axis " << i);
    PLUMB_CHECK(max_depth >= 0 && max_depth <= depth_limit,
                "max_depth must be in [0, " << depth_limit << "], got " << max_depth);
    PLUMB_CHECK(capacity > 0, "capacity must be positive, got " << capacity);
    cells_.emplace_back();
    cells_[0].center = Real(0.5) * world.min + Real(0.5) * world.max;
    cells_[0].half_extents = Real(0.5) * world.max - Real(0.5) * world.min;
}

template <int Dim>
typename Orthtree<Dim>::Item Orthtree<Dim>::insert(const Box &box, std::uint32_t user) {
    check_box(box);
    Item item = free_entry_;
    if (item == none) {
        entries_.emplace_back();
        item = static_cast<Item>(entries_.size() - 1);
    } else {
        free_entry_ = entry(item).next;
    }
    entry(item).box = box;
    entry(item).user = user;
    attach(item);
    return item;
}

template <int Dim> void Orthtree<Dim>::remove(Item item) {
    check_item(item);
    detach(item);
    entry(item) = Entry{};
    entry(item).next = free_entry_;
    free_entry_ = item;
}

template <int Dim> bool Orthtree<Dim>::update(Item item, const Box &box) {
    check_item(item);
    check_box(box);
    if (destination(box) == entry(item).cell) {
        entry(item).box = box;
        return false;
    }
    detach(item);
    entry(item).box = box;
    attach(item);
    return true;
}

template <int Dim> std::uint32_t Orthtree<Dim>::user(Item item) const {
    check_item(item);
    return entry(item).user;
}

template <int Dim> const typename Orthtree<Dim>::Box &Orthtree<Dim>::bounds(Item item) const {
    check_item(item);
    return entry(item).box;
}

// The child that contains the box's centre, if it (grown) contains the box; else none. Halves are
// added, so no box is too large.
template <int Dim>
typename Orthtree<Dim>::Index Orthtree<Dim>::child_for(const Cell &parent, const Box &box) const {
    if (parent.first_child == none)
        return none;
    Index child = parent.first_child;
    for (int i = 0; i < Dim; ++i)
        if (Real(0.5) * box.min[i] + Real(0.5) * box.max[i] >= parent.center[i])
            child += 1 << i;
    return holds(grown(cell(child)), box) ? child : none;
}

template <int Dim> typename Orthtree<Dim>::Index Orthtree<Dim>::destination(const Box &box) const {
    Index here = 0;
    for (;;) {
        const Index child = child_for(cell(here), box);
        if (child == none)
            return here;
        here = child;
    }
}

// Counts the item in the cells on its way down, and divides those that become too full.
template <int Dim> void Orthtree<Dim>::attach(Item item) {
    Index here = 0;
    for (;;) {
        ++cell(here).count;
        if (cell(here).first_child == none && cell(here).count > capacity_ &&
            cell(here).depth < max_depth_)
            divide(here);
        const Index child = child_for(cell(here), entry(item).box);
        if (child == none)
            break;
        here = child;
    }
    link(item, here);
}

// Merges the topmost cell that is left with no more than its capacity.
template <int Dim> void Orthtree<Dim>::detach(Item item) {
    const Index from = entry(item).cell;
    unlink(item);
    Index sparse = none;
    for (Index here = from; here != none; here = cell(here).parent) {
        --cell(here).count;
        if (cell(here).first_child != none && cell(here).count <= capacity_)
            sparse = here;
    }
    if (sparse != none)
        unite(sparse);
}

template <int Dim> void Orthtree<Dim>::link(Item item, Index to) {
    Entry &here = entry(item);
    here.cell = to;
    here.previous = none;
    here.next = cell(to).first_item;
    if (here.next != none)
        entry(here.next).previous = item;
    cell(to).first_item = item;
}

template <int Dim> void Orthtree<Dim>::unlink(Item item) {
    Entry &here = entry(item);
    if (here.previous == none)
        cell(here.cell).first_item = here.next;
    else
        entry(here.previous).next = here.next;
    if (here.next != none)
        entry(here.next).previous = here.previous;
    here.cell = here.next = here.previous = none;
}

template <int Dim> void Orthtree<Dim>::divide(Index index) {
    Index first = none;
    if (free_blocks_.empty()) {
        first = static_cast<Index>(cells_.size());
        cells_.resize(cells_.size() + static_cast<std::size_t>(fan_out));
    } else {
        first = free_blocks_.back();
        free_blocks_.pop_back();
    }
    Cell &parent = cell(index);
    parent.first_child = first;
    for (Index k = 0; k < fan_out; ++k) {
        Cell &child = cell(first + k);
        child = Cell{};
        child.parent = index;
        child.depth = parent.depth + 1;
        child.half_extents = Real(0.5) * parent.half_extents;
        for (int i = 0; i < Dim; ++i)
            child.center[i] = (k >> i & 1) != 0 ? parent.center[i] + child.half_extents[i]
                                                : parent.center[i] - child.half_extents[i];
    }
    for (Item item = parent.first_item; item != none;) {
        const Item next = entry(item).next;
        const Index child = child_for(parent, entry(item).box);
        if (child != none) {
            unlink(item);
            link(item, child);
            ++cell(child).count;
        }
        item = next;
    }
}

// Moves all items below into the cell itself.
template <int Dim> void Orthtree<Dim>::unite(Index index) {
    const Index first = cell(index).first_child;
    for (Index k = first; k < first + fan_out; ++k) {
        if (cell(k).first_child != none)
            unite(k);
        while (cell(k).first_item != none) {
            const Item item = cell(k).first_item;
            unlink(item);
            link(item, index);
        }
    }
    cell(index).first_child = none;
    free_blocks_.push_back(first);
}

template <int Dim> void Orthtree<Dim>::validate() const {
    std::size_t reached_cells = 0;
    std::size_t reached_items = 0;
    std::vector<Index> pending{0};
    while (!pending.empty()) {
        const Index index = pending.back();
        pending.pop_back();
        const Cell &here = cell(index);
        ++reached_cells;
        std::int32_t count = 0;
        Index previous = none;
        for (Index i = here.first_item; i != none; previous = i, i = entry(i).next) {
            PLUMB_CHECK(entry(i).cell == index && entry(i).previous == previous,
                        "item " << i << " is in the list of cell " << index << " but names cell "
                                << entry(i).cell << " and item " << entry(i).previous);
            PLUMB_CHECK(destination(entry(i).box) == index, "item " << i << " is in cell " << index
                                                                    << ", its place is "
                                                                    << destination(entry(i).box));
            ++count;
        }
        reached_items += static_cast<std::size_t>(count);
        if (here.first_child != none) {
            for (Index k = here.first_child; k < here.first_child + fan_out; ++k) {
                PLUMB_CHECK(cell(k).parent == index && cell(k).depth == here.depth + 1,
                            "cell " << k << " is a child of " << index << " but names "
                                    << cell(k).parent << " at depth " << cell(k).depth);
                count += cell(k).count;
                pending.push_back(k);
            }
        }
        PLUMB_CHECK(count == here.count,
                    "cell " << index << " counts " << here.count << " items, it has " << count);
        PLUMB_CHECK(
            (here.first_child != none) == (here.count > capacity_ && here.depth < max_depth_),
            "cell " << index << " with " << here.count << " items at depth " << here.depth
                    << " should " << (here.first_child != none ? "not " : "") << "be divided");
    }
    const std::size_t free_cells = free_blocks_.size() * static_cast<std::size_t>(fan_out);
    PLUMB_CHECK(reached_cells + free_cells == cells_.size(),
                reached_cells << " cells in use and " << free_cells << " free, of "
                              << cells_.size());
    for (Index i = free_entry_; i != none; i = entry(i).next) {
        PLUMB_CHECK(entry(i).cell == none, "free item " << i << " is in cell " << entry(i).cell);
        ++reached_items;
    }
    PLUMB_CHECK(reached_items == entries_.size(),
                reached_items << " items found, of " << entries_.size());
}

template class Orthtree<2>;
template class Orthtree<3>;

} // namespace plumb::inline PLUMB_PRECISION

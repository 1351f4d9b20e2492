// A static bounding volume hierarchy of axis-aligned boxes.
#pragma once

#include "engine/geometry/shapes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// Built top-down with the binned surface area heuristic (Wald 2007, "On fast Construction of
// SAH-based Bounding Volume Hierarchies"), then collapsed into nodes of eight children with their
// bounds side by side, so one ray tests all eight at once (Wald, Benthin, Boulos 2008, "Getting Rid
// of Packets"). Copyable; flat arrays; the same boxes give the same tree.
class Bvh {
  public:
    static constexpr std::size_t width = 8;
    static constexpr std::size_t leaf_size = 4; // maximum items in a leaf

    // A child is a node, a leaf (marked by `leaf_bit`), or missing: then its bounds are inverted,
    // lowest above highest, and nothing meets them.
    static constexpr std::uint32_t leaf_bit = 0x8000'0000U;
    static constexpr std::uint32_t no_child = 0xFFFF'FFFFU;
    struct alignas(64) Node {
        Real bounds[3][2][width]; // by axis, lowest and highest, child
        std::uint32_t children[width];
    };
    // Maximum number of pending children in a traversal from the root.
    static constexpr std::size_t stack_size = 512;

    // Items are identified by their index in `boxes`. No boxes is fine; a box that is empty, not
    // finite or beyond 1e15 m, where areas overflow in float, fails a check.
    explicit Bvh(std::span<const Aabb> boxes);

    // Refits the same tree to boxes that have moved; there must be as many as before. Answers stay
    // right; queries slow down as boxes move away from where the tree was built.
    void refit(std::span<const Aabb> boxes);

    std::size_t size() const { return items_.size(); }
    const Aabb &bounds() const { return bounds_; } // empty without items

    // Parents before their children, the root first; empty without items.
    std::span<const Node> nodes() const { return nodes_; }
    std::size_t leaf_count() const { return first_.size() - 1; }
    std::span<const std::uint32_t> items(std::size_t leaf) const {
        return std::span(items_).subspan(first_[leaf], first_[leaf + 1] - first_[leaf]);
    }

    // Calls visit(item) for the items of every leaf whose box touches `box` (closed sets): all
    // items that touch it and some that do not. Stops when visit returns false.
    template <typename Visit> void query(const Aabb &box, Visit &&visit) const {
        query_where(
            [&box](const Node &node, std::size_t child) {
                const auto &bounds = node.bounds;
                return (bounds[0][0][child] <= box.max.x) & (box.min.x <= bounds[0][1][child]) &
                       (bounds[1][0][child] <= box.max.y) & (box.min.y <= bounds[1][1][child]) &
                       (bounds[2][0][child] <= box.max.z) & (box.min.z <= bounds[2][1][child]);
            },
            visit);
    }

    // Calls visit(item) for the items of every leaf that meets(node, child) accepts along with all
    // its ancestors; stops when visit returns false. meets must reject a missing child.
    template <typename Meets, typename Visit> void query_where(Meets &&meets, Visit &&visit) const;

    // Calls visit(item) -> Real for the items of leaves, those nearer to `point` first, while a
    // leaf's squared distance is at most `most`, or what visit last returned.
    template <typename Visit> void nearest(const Vec3 &point, Real most, Visit &&visit) const;

  private:
    struct Builder;

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> items_; // by leaf
    std::vector<std::uint32_t> first_; // each leaf's start in items_, and the end
    Aabb bounds_;
};

template <typename Meets, typename Visit>
void Bvh::query_where(Meets &&meets, Visit &&visit) const {
    if (nodes_.empty())
        return;
    std::array<std::uint32_t, stack_size> pending;
    std::size_t count = 0;
    pending[count++] = 0;
    while (count > 0) {
        const std::uint32_t here = pending[--count];
        if ((here & leaf_bit) != 0) {
            for (const std::uint32_t item : items(here & ~leaf_bit))
                if (!visit(item))
                    return;
            continue;
        }
        const Node &node = nodes_[here];
        for (std::size_t child = width; child-- > 0;)
            if (meets(node, child))
                pending[count++] = node.children[child];
    }
}

template <typename Visit> void Bvh::nearest(const Vec3 &point, Real most, Visit &&visit) const {
    if (nodes_.empty())
        return;
    struct Entry {
        Real squared;
        std::uint32_t child;
    };
    // Rounding may put an item's squared distance below that of the box around it.
    constexpr Real slack = Real(1) - Real(8) * std::numeric_limits<Real>::epsilon();
    std::array<Entry, stack_size> pending;
    std::size_t count = 0;
    pending[count++] = {Real(0), 0};
    while (count > 0) {
        const Entry here = pending[--count];
        if (here.squared > most)
            continue;
        if ((here.child & leaf_bit) != 0) {
            for (const std::uint32_t item : items(here.child & ~leaf_bit))
                most = visit(item);
            continue;
        }
        const Node &node = nodes_[here.child];
        const std::size_t bottom = count;
        for (std::size_t child = 0; child < width && node.children[child] != no_child; ++child) {
            Real squared = Real(0);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const Real at = point[static_cast<int>(axis)];
                const Real outside = std::max(
                    {node.bounds[axis][0][child] - at, at - node.bounds[axis][1][child], Real(0)});
                squared += outside * outside;
            }
            squared *= slack;
            if (squared > most)
                continue;
            std::size_t place = count++; // the nearest on top
            for (; place > bottom && pending[place - 1].squared < squared; --place)
                pending[place] = pending[place - 1];
            pending[place] = {squared, node.children[child]};
        }
    }
}

} // namespace plumb::inline PLUMB_PRECISION

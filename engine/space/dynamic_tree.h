// A dynamic binary tree of axis-aligned boxes: the broad phase.
#pragma once

#include "engine/geometry/frustum.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/shapes.h"
#include "engine/geometry/slab.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <glm/common.hpp>

namespace plumb::inline PLUMB_PRECISION {

// Leaves hold boxes fattened by a margin, so small moves cost nothing. Insertion is branch and
// bound on the surface area, with rotations (Catto, "Dynamic Bounding Volume Hierarchies", GDC
// 2019). Copyable: a copy answers every query like the original. Which leaves a query visits
// depends only on the fat boxes; their order depends on the history. Do not change the tree from
// within a visit.
class DynamicTree {
  public:
    using Leaf = std::int32_t;
    static constexpr Leaf none = -1;

    // `margin` >= 0, in metres, is added on every side of each box.
    explicit DynamicTree(Real margin);

    // Queries return `user`. An empty or non-finite box fails a check.
    Leaf insert(const Aabb &box, std::uint32_t user);
    // A leaf that is not in the tree fails a check, here and below. Its number may be reused.
    void remove(Leaf leaf);
    // Returns whether the leaf got a new fat box because the old one no longer contained `box`. The
    // new one is extended by `way`, the motion expected next.
    bool update(Leaf leaf, const Aabb &box, const Vec3 &way = Vec3{Real(0)});

    // Whether the leaf's fat box contains `box`; if so, `update` changes nothing.
    bool holds(Leaf leaf, const Aabb &box) const;
    std::uint32_t user(Leaf leaf) const;
    const Aabb &fat_bounds(Leaf leaf) const;
    std::size_t size() const { return leaf_count_; }

    // Calls visit(user) for every leaf whose fat box touches `box` (closed sets; an empty box
    // touches nothing); stops when visit returns false.
    template <typename Visit> void query(const Aabb &box, Visit &&visit) const;

    // Calls visit(user, ray) -> Real for leaves whose fat box the ray hits, the nearer child first;
    // the result is the new max_t (return ray.max_t to continue, 0 to stop). Closest-hit searches
    // can be built on this. A zero or non-finite direction, or a NaN, fails a check.
    template <typename Visit> void raycast(Ray ray, Visit &&visit) const;

    // The building block of the queries below: calls visit(user) for every leaf with meets(fat
    // box), and stops when visit returns false. Whole branches are skipped, so if `meets` accepts a
    // box it must accept every box that contains it, to the last bit.
    template <typename Meets, typename Visit> void query_if(Meets &&meets, Visit &&visit) const;

    // Every leaf whose fat box touches the sphere: the rounded squared distance to its centre is at
    // most the rounded squared radius. The answer can be wrong only if the distance is within 2
    // epsilon radius of the radius (a radius whose square underflows counts as zero). A NaN, an
    // infinity or a negative radius fails a check.
    template <typename Visit> void query(const Sphere &sphere, Visit &&visit) const;
    // Every leaf whose fat box touches the segment, by the slab test (slab.h); a box that contains
    // an endpoint always does. a == b is a point. A NaN or an infinity fails a check.
    template <typename Visit> void query(const Segment &segment, Visit &&visit) const;
    // Every leaf whose fat box is not entirely in front of a frustum plane, judged as in `classify`
    // (frustum.h) by its corner farthest behind the plane; off by at most 4 epsilon times the
    // largest coordinate.
    template <typename Visit> void query(const Frustum &frustum, Visit &&visit) const;

    struct Hit {
        std::uint32_t user = 0;
        Real t = Real(0);
    };
    // The first hit along the ray. Calls hit(user, ray) -> optional<Real>: where the ray, shortened
    // to the nearest hit so far, first hits the object that `user` stands for. At equal t the least
    // user wins, so as long as no hit lies before its leaf's box, the answer does not depend on the
    // tree's history.
    template <typename FirstHit>
    std::optional<Hit> closest_hit(const Ray &ray, FirstHit &&hit) const;
    // Whether is_hit(user, ray) -> bool is true for any leaf whose fat box the ray hits; stops at
    // the first.
    template <typename IsHit> bool any_hit(const Ray &ray, IsHit &&is_hit) const;

    // Replaces `pairs` with the users (lesser, greater) of all leaves whose fat boxes touch each
    // other, each pair once, in ascending order. The vector's memory is reused.
    void overlapping_pairs(std::vector<std::pair<std::uint32_t, std::uint32_t>> &pairs) const;

    // Calls visit(box, depth, is_leaf) for every node, parents first; the root has depth 0.
    template <typename Visit> void each_node(Visit &&visit) const;

    // Fails a check when links, boxes or heights are inconsistent. For tests.
    void validate() const;
    int height() const; // 0 for a single leaf or none

  private:
    using Index = std::int32_t;

    struct Node {
        Aabb box;
        Index parent = none; // in a free node: the next free one
        std::array<Index, 2> children{none, none};
        std::int32_t height = 0; // 0: leaf, -1: free
        std::uint32_t user = 0;

        bool is_leaf() const { return height == 0; }
    };

    // Nodes still to visit: on the caller's stack unless the tree is very deep.
    class Pending {
      public:
        bool is_empty() const { return count_ == 0; }
        void push(Index index, Real key = Real(0)) {
            if (count_ < inline_capacity)
                inline_[count_] = {index, key};
            else
                more_.push_back({index, key});
            ++count_;
        }
        struct Entry {
            Index index;
            Real key;
        };
        Entry pop() {
            --count_;
            if (count_ < inline_capacity)
                return inline_[count_];
            const Entry last = more_.back();
            more_.pop_back();
            return last;
        }

      private:
        static constexpr std::size_t inline_capacity = 96;
        std::array<Entry, inline_capacity> inline_;
        std::vector<Entry> more_;
        std::size_t count_ = 0;
    };

    static bool touches(const Aabb &a, const Aabb &b) {
        return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y &&
               b.min.y <= a.max.y && a.min.z <= b.max.z && b.min.z <= a.max.z;
    }
    static bool is_empty_box(const Aabb &box) {
        return !(box.min.x <= box.max.x && box.min.y <= box.max.y && box.min.z <= box.max.z);
    }
    static void check_ray(const Ray &ray);
    static void check_sphere(const Sphere &sphere);
    static void check_segment(const Segment &segment);
    static bool touches(const Aabb &box, const Sphere &sphere) {
        // Every operation is monotonic: a box that contains another is never farther.
        const Vec3 gap =
            glm::max(glm::max(box.min - sphere.center, sphere.center - box.max), Vec3{Real(0)});
        return gap.x * gap.x + gap.y * gap.y + gap.z * gap.z <= sphere.radius * sphere.radius;
    }
    static bool touches(const Aabb &box, const Frustum &frustum) {
        // Monotonic too: a larger box's corner is never farther in front.
        return std::ranges::all_of(frustum.planes, [&](const Plane &plane) {
            const Vec3 &n = plane.normal;
            const Real x = n.x * (n.x > Real(0) ? box.min.x : box.max.x);
            const Real y = n.y * (n.y > Real(0) ? box.min.y : box.max.y);
            const Real z = n.z * (n.z > Real(0) ? box.min.z : box.max.z);
            return !(x + y + z > plane.offset);
        });
    }
    // Calls visit(user, ray) -> bool for leaves whose fat box the ray hits, the nearer child first,
    // until it returns false. visit may shorten the ray.
    template <typename Visit> void walk(Ray ray, Visit &&visit) const;

    Node &node(Index index) { return nodes_[static_cast<std::size_t>(index)]; }
    const Node &node(Index index) const { return nodes_[static_cast<std::size_t>(index)]; }
    void check_leaf(Leaf leaf) const;
    Aabb fattened(const Aabb &box) const;
    Index allocate();
    void release(Index index);
    Index best_sibling(const Aabb &box) const;
    void link(Leaf leaf);
    void unlink(Leaf leaf);
    void refit_upwards(Index index);
    void refit(Index index);
    void rotate(Index index);
    int slot_in_parent(Index index) const;
    Index sibling_of(Index index) const;
    bool is_still_near(Leaf leaf, const Aabb &box) const;

    Real margin_ = Real(0);
    std::vector<Node> nodes_;
    Index root_ = none;
    Index free_ = none;
    std::size_t leaf_count_ = 0;
};

template <typename Meets, typename Visit>
void DynamicTree::query_if(Meets &&meets, Visit &&visit) const {
    if (root_ == none)
        return;
    Pending pending;
    pending.push(root_);
    while (!pending.is_empty()) {
        const Node &here = node(pending.pop().index);
        if (!meets(here.box))
            continue;
        if (here.is_leaf()) {
            if (!visit(here.user))
                return;
        } else {
            pending.push(here.children[1]);
            pending.push(here.children[0]);
        }
    }
}

template <typename Visit> void DynamicTree::query(const Aabb &box, Visit &&visit) const {
    if (is_empty_box(box))
        return;
    query_if([&](const Aabb &here) { return touches(here, box); }, visit);
}

template <typename Visit> void DynamicTree::query(const Sphere &sphere, Visit &&visit) const {
    check_sphere(sphere);
    query_if([&](const Aabb &here) { return touches(here, sphere); }, visit);
}

template <typename Visit> void DynamicTree::query(const Segment &segment, Visit &&visit) const {
    check_segment(segment);
    const Ray ray{segment.a, segment.b - segment.a, Real(1)};
    Real enter = Real(0);
    Real exit = Real(0);
    int axis = -1;
    query_if([&](const Aabb &here) { return slab_interval(here, ray, enter, exit, axis); }, visit);
}

template <typename Visit> void DynamicTree::query(const Frustum &frustum, Visit &&visit) const {
    query_if([&](const Aabb &here) { return touches(here, frustum); }, visit);
}

template <typename Visit> void DynamicTree::walk(Ray ray, Visit &&visit) const {
    check_ray(ray);
    if (root_ == none)
        return;
    Real enter = Real(0);
    Real exit = Real(0);
    int axis = -1;
    if (!slab_interval(node(root_).box, ray, enter, exit, axis))
        return;
    Pending pending; // nodes the ray hits, keyed by entry parameter
    pending.push(root_, enter);
    while (!pending.is_empty()) {
        const typename Pending::Entry entry = pending.pop();
        if (entry.key > ray.max_t)
            continue; // a nearer hit was found since
        const Node &here = node(entry.index);
        if (here.is_leaf()) {
            if (!visit(here.user, ray))
                return;
            continue;
        }
        std::array<Real, 2> enters{};
        std::array<bool, 2> is_met{};
        for (std::size_t i = 0; i < 2; ++i)
            is_met[i] = slab_interval(node(here.children[i]).box, ray, enters[i], exit, axis);
        const std::size_t far = enters[1] < enters[0] ? 0 : 1;
        if (is_met[far])
            pending.push(here.children[far], enters[far]);
        if (is_met[1 - far])
            pending.push(here.children[1 - far], enters[1 - far]);
    }
}

template <typename Visit> void DynamicTree::raycast(Ray ray, Visit &&visit) const {
    walk(ray, [&](std::uint32_t user, Ray &left) {
        left.max_t = visit(user, static_cast<const Ray &>(left));
        return left.max_t > Real(0);
    });
}

template <typename FirstHit>
std::optional<DynamicTree::Hit> DynamicTree::closest_hit(const Ray &ray, FirstHit &&hit) const {
    std::optional<Hit> best;
    walk(ray, [&](std::uint32_t user, Ray &left) {
        const std::optional<Real> t = hit(user, static_cast<const Ray &>(left));
        if (t && (!best || *t < best->t || (*t == best->t && user < best->user))) {
            best = Hit{user, *t};
            left.max_t = *t;
        }
        return true;
    });
    return best;
}

template <typename IsHit> bool DynamicTree::any_hit(const Ray &ray, IsHit &&is_hit) const {
    bool any = false;
    walk(ray, [&](std::uint32_t user, Ray &left) {
        any = is_hit(user, static_cast<const Ray &>(left));
        return !any;
    });
    return any;
}

template <typename Visit> void DynamicTree::each_node(Visit &&visit) const {
    if (root_ == none)
        return;
    std::vector<std::pair<Index, int>> pending{{root_, 0}};
    while (!pending.empty()) {
        const auto [index, depth] = pending.back();
        pending.pop_back();
        const Node &here = node(index);
        visit(here.box, depth, here.is_leaf());
        if (!here.is_leaf()) {
            pending.emplace_back(here.children[1], depth + 1);
            pending.emplace_back(here.children[0], depth + 1);
        }
    }
}

} // namespace plumb::inline PLUMB_PRECISION

#include "engine/space/dynamic_tree.h"

#include "engine/core/check.h"
#include "engine/geometry/aabb.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

bool holds(const Aabb &outer, const Aabb &inner) {
    return outer.min.x <= inner.min.x && outer.min.y <= inner.min.y && outer.min.z <= inner.min.z &&
           inner.max.x <= outer.max.x && inner.max.y <= outer.max.y && inner.max.z <= outer.max.z;
}

void check_finite_box(const Aabb &box) {
    for (int i = 0; i < 3; ++i) {
        PLUMB_CHECK(std::isfinite(box.min[i]) && std::isfinite(box.max[i]),
                    "a box in a tree must be finite, got [" << box.min[i] << ", " << box.max[i]
                                                            << "] on axis " << i);
        PLUMB_CHECK(box.min[i] <= box.max[i], "a box in a tree must not be empty, got ["
                                                  << box.min[i] << ", " << box.max[i]
                                                  << "] on axis " << i);
    }
}

} // namespace

DynamicTree::DynamicTree(Real margin) : margin_(margin) {
    PLUMB_CHECK(margin >= Real(0) && std::isfinite(margin),
                "tree margin must be finite and not negative, got " << margin);
}

void DynamicTree::check_ray(const Ray &ray) {
    for (int i = 0; i < 3; ++i)
        PLUMB_CHECK(std::isfinite(ray.origin[i]) && std::isfinite(ray.direction[i]),
                    "ray must be finite, got origin " << ray.origin[i] << " and direction "
                                                      << ray.direction[i] << " on axis " << i);
    PLUMB_CHECK(ray.direction != Vec3{Real(0)}, "ray direction must not be zero, got (0, 0, 0)");
    PLUMB_CHECK(!std::isnan(ray.max_t), "ray max_t must be a number, got " << ray.max_t);
}

void DynamicTree::check_sphere(const Sphere &sphere) {
    for (int i = 0; i < 3; ++i)
        PLUMB_CHECK(std::isfinite(sphere.center[i]),
                    "sphere centre must be finite, got " << sphere.center[i] << " on axis " << i);
    PLUMB_CHECK(sphere.radius >= Real(0) && std::isfinite(sphere.radius),
                "sphere radius must be finite and not negative, got " << sphere.radius);
}

void DynamicTree::check_segment(const Segment &segment) {
    for (int i = 0; i < 3; ++i)
        PLUMB_CHECK(std::isfinite(segment.b[i] - segment.a[i]),
                    "segment must be finite, got [" << segment.a[i] << ", " << segment.b[i]
                                                    << "] on axis " << i);
}

void DynamicTree::check_leaf(Leaf leaf) const {
    PLUMB_CHECK(leaf >= 0 && static_cast<std::size_t>(leaf) < nodes_.size() && node(leaf).is_leaf(),
                "not a leaf of this tree: " << leaf);
}

Aabb DynamicTree::fattened(const Aabb &box) const {
    return {box.min - margin_, box.max + margin_};
}

DynamicTree::Leaf DynamicTree::insert(const Aabb &box, std::uint32_t user) {
    check_finite_box(box);
    const Index leaf = allocate();
    node(leaf).box = fattened(box);
    node(leaf).user = user;
    link(leaf);
    ++leaf_count_;
    return leaf;
}

void DynamicTree::remove(Leaf leaf) {
    check_leaf(leaf);
    unlink(leaf);
    release(leaf);
    --leaf_count_;
}

bool DynamicTree::update(Leaf leaf, const Aabb &box, const Vec3 &way) {
    check_leaf(leaf);
    check_finite_box(box);
    if (plumb::holds(node(leaf).box, box))
        return false;
    Aabb fat = fattened(box);
    fat.min += glm::min(way, Vec3{Real(0)});
    fat.max += glm::max(way, Vec3{Real(0)});
    if (is_still_near(leaf, fat)) {
        node(leaf).box = fat;
        refit_upwards(node(leaf).parent);
        return true;
    }
    unlink(leaf);
    node(leaf).box = fat;
    link(leaf);
    return true;
}

std::uint32_t DynamicTree::user(Leaf leaf) const {
    check_leaf(leaf);
    return node(leaf).user;
}

bool DynamicTree::holds(Leaf leaf, const Aabb &box) const {
    return plumb::holds(fat_bounds(leaf), box);
}

const Aabb &DynamicTree::fat_bounds(Leaf leaf) const {
    check_leaf(leaf);
    return node(leaf).box;
}

int DynamicTree::height() const {
    return root_ == none ? 0 : node(root_).height;
}

DynamicTree::Index DynamicTree::allocate() {
    if (free_ == none) {
        nodes_.emplace_back();
        return static_cast<Index>(nodes_.size() - 1);
    }
    const Index index = free_;
    free_ = node(index).parent;
    node(index) = Node{};
    return index;
}

void DynamicTree::release(Index index) {
    node(index) = Node{};
    node(index).height = -1;
    node(index).parent = free_;
    free_ = index;
}

// The sibling for which a new leaf adds the least area to the tree: the area of the new parent plus
// the growth of all its ancestors. Branch and bound: below a node the cost is at least the leaf's
// own area plus the growth so far.
DynamicTree::Index DynamicTree::best_sibling(const Aabb &box) const {
    const Real own_area = half_area(box);
    Index best = root_;
    Real best_cost = half_area(joined(node(root_).box, box));
    Pending pending; // keyed by the ancestors' growth
    pending.push(root_, Real(0));
    while (!pending.is_empty()) {
        const typename Pending::Entry entry = pending.pop();
        if (own_area + entry.key >= best_cost)
            continue;
        const Node &here = node(entry.index);
        const Real joined_area = half_area(joined(here.box, box));
        const Real cost = joined_area + entry.key;
        if (cost < best_cost) {
            best_cost = cost;
            best = entry.index;
        }
        if (here.is_leaf())
            continue;
        const Real growth = entry.key + (joined_area - half_area(here.box));
        if (own_area + growth >= best_cost)
            continue;
        // Visit the child that grows less first: its cost is likely to prune the other.
        std::array<Real, 2> grown{};
        for (std::size_t i = 0; i < 2; ++i) {
            const Aabb &child = node(here.children[i]).box;
            grown[i] = half_area(joined(child, box)) - half_area(child);
        }
        const std::size_t later = grown[1] < grown[0] ? 0 : 1;
        pending.push(here.children[later], growth);
        pending.push(here.children[1 - later], growth);
    }
    return best;
}

int DynamicTree::slot_in_parent(Index index) const {
    return node(node(index).parent).children[0] == index ? 0 : 1;
}

DynamicTree::Index DynamicTree::sibling_of(Index index) const {
    return node(node(index).parent).children[static_cast<std::size_t>(1 - slot_in_parent(index))];
}

// Whether a leaf with a new box is still well placed beside its sibling: refitting its ancestors,
// with rotations, costs a quarter of finding a better place (Kopta et al. 2012, "Fast, effective
// BVH updates for animated scenes").
bool DynamicTree::is_still_near(Leaf leaf, const Aabb &box) const {
    constexpr Real most = Real(1.5);
    if (node(leaf).parent == none)
        return false;
    const Aabb &beside = node(sibling_of(leaf)).box;
    return half_area(joined(beside, box)) <= most * (half_area(beside) + half_area(box));
}

void DynamicTree::link(Leaf leaf) {
    if (root_ == none) {
        root_ = leaf;
        node(leaf).parent = none;
        return;
    }
    const Index sibling = best_sibling(node(leaf).box);
    const Index old_parent = node(sibling).parent;
    const Index new_parent = allocate();
    if (old_parent == none)
        root_ = new_parent;
    else
        node(old_parent).children[static_cast<std::size_t>(slot_in_parent(sibling))] = new_parent;
    node(new_parent).parent = old_parent;
    node(new_parent).children = {sibling, leaf};
    node(sibling).parent = new_parent;
    node(leaf).parent = new_parent;
    refit_upwards(new_parent);
}

void DynamicTree::unlink(Leaf leaf) {
    const Index parent = node(leaf).parent;
    if (parent == none) {
        root_ = none;
        return;
    }
    const Index sibling = sibling_of(leaf);
    const Index grandparent = node(parent).parent;
    node(sibling).parent = grandparent;
    node(leaf).parent = none;
    if (grandparent == none)
        root_ = sibling;
    else
        node(grandparent).children[static_cast<std::size_t>(slot_in_parent(parent))] = sibling;
    release(parent);
    refit_upwards(grandparent);
}

void DynamicTree::refit(Index index) {
    Node &here = node(index);
    const Node &left = node(here.children[0]);
    const Node &right = node(here.children[1]);
    here.box = joined(left.box, right.box);
    here.height = 1 + std::max(left.height, right.height);
}

void DynamicTree::refit_upwards(Index index) {
    for (; index != none; index = node(index).parent) {
        refit(index);
        rotate(index);
    }
}

// Swaps a child with a grandchild on the other side if that shrinks the other child's box. Only
// that box and the heights above it change (Kopta et al. 2012).
void DynamicTree::rotate(Index index) {
    const Node &here = node(index);
    Real best_gain = Real(0);
    std::size_t best_child = 0;
    std::size_t best_grandchild = 0;
    for (std::size_t i = 0; i < 2; ++i) {
        // Child i moves down into the place of grandchild j, which moves up.
        const Node &child = node(here.children[i]);
        const Node &other = node(here.children[1 - i]);
        if (other.is_leaf())
            continue;
        const Real old_area = half_area(other.box);
        for (std::size_t j = 0; j < 2; ++j) {
            const Aabb &stays = node(other.children[1 - j]).box;
            const Real gain = old_area - half_area(joined(child.box, stays));
            if (gain > best_gain) {
                best_gain = gain;
                best_child = i;
                best_grandchild = j;
            }
        }
    }
    if (!(best_gain > Real(0)))
        return;
    const Index down = here.children[best_child];
    const Index other = here.children[1 - best_child];
    const Index up = node(other).children[best_grandchild];
    node(index).children[best_child] = up;
    node(up).parent = index;
    node(other).children[best_grandchild] = down;
    node(down).parent = other;
    refit(other);
    refit(index);
}

// Tests the tree against itself: for every inner node, one child's subtree against the other's,
// descending into the larger box of each touching pair.
void DynamicTree::overlapping_pairs(
    std::vector<std::pair<std::uint32_t, std::uint32_t>> &pairs) const {
    pairs.clear();
    std::vector<std::pair<Index, Index>> pending;
    for (const Node &inner : nodes_) {
        if (inner.height <= 0)
            continue;
        pending.emplace_back(inner.children[0], inner.children[1]);
        while (!pending.empty()) {
            auto [a, b] = pending.back();
            pending.pop_back();
            if (!touches(node(a).box, node(b).box))
                continue;
            if (node(a).is_leaf() && node(b).is_leaf()) {
                pairs.push_back(std::minmax({node(a).user, node(b).user}));
                continue;
            }
            if (node(a).is_leaf() ||
                (!node(b).is_leaf() && half_area(node(a).box) < half_area(node(b).box)))
                std::swap(a, b);
            pending.emplace_back(node(a).children[0], b);
            pending.emplace_back(node(a).children[1], b);
        }
    }
    std::sort(pairs.begin(), pairs.end());
}

void DynamicTree::validate() const {
    std::size_t leaves = 0;
    std::size_t inner = 0;
    if (root_ != none) {
        PLUMB_CHECK(node(root_).parent == none, "the root " << root_ << " has a parent");
        std::vector<Index> pending{root_};
        while (!pending.empty()) {
            const Index index = pending.back();
            pending.pop_back();
            const Node &here = node(index);
            PLUMB_CHECK(here.height >= 0, "node " << index << " is linked, and free");
            if (here.is_leaf()) {
                ++leaves;
                PLUMB_CHECK(here.children[0] == none && here.children[1] == none,
                            "leaf " << index << " has children");
                continue;
            }
            ++inner;
            const Node &left = node(here.children[0]);
            const Node &right = node(here.children[1]);
            PLUMB_CHECK(left.parent == index && right.parent == index,
                        "the children of node " << index << " have another parent");
            PLUMB_CHECK(here.height == 1 + std::max(left.height, right.height),
                        "node " << index << " has height " << here.height);
            const Aabb both = joined(left.box, right.box);
            PLUMB_CHECK(here.box.min == both.min && here.box.max == both.max,
                        "the box of node " << index << " is not that of its children");
            PLUMB_CHECK(leaves + inner <= nodes_.size(), "the tree has a cycle at " << index);
            pending.push_back(here.children[0]);
            pending.push_back(here.children[1]);
        }
    }
    std::size_t free = 0;
    for (Index index = free_; index != none; index = node(index).parent) {
        ++free;
        PLUMB_CHECK(node(index).height == -1, "node " << index << " is free, and linked");
        PLUMB_CHECK(free <= nodes_.size(), "the list of free nodes has a cycle at " << index);
    }
    PLUMB_CHECK(leaves == leaf_count_,
                "the tree has " << leaves << " leaves but counts " << leaf_count_);
    PLUMB_CHECK(leaves + inner + free == nodes_.size(),
                "of " << nodes_.size() << " nodes " << leaves + inner + free << " are found");
}

} // namespace plumb::inline PLUMB_PRECISION

#include "engine/space/bvh.h"

#include "engine/core/check.h"
#include "engine/geometry/aabb.h"

#include <cmath>
#include <iterator>

#include <glm/common.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

void check_box(const Aabb &box, std::size_t item) {
    constexpr Real reach = Real(1e15);
    for (int i = 0; i < 3; ++i)
        PLUMB_CHECK(-reach <= box.min[i] && box.min[i] <= box.max[i] && box.max[i] <= reach,
                    "box " << item << " of a tree must be nonempty and within " << reach
                           << " m, got [" << box.min[i] << ", " << box.max[i] << "] on axis " << i);
}

void set_child(Bvh::Node &node, std::size_t child, const Aabb &box) {
    for (int axis = 0; axis < 3; ++axis) {
        node.bounds[axis][0][child] = box.min[axis];
        node.bounds[axis][1][child] = box.max[axis];
    }
}

Aabb joined_children(const Bvh::Node &node) {
    Aabb box;
    for (int axis = 0; axis < 3; ++axis) {
        const auto &lowest = node.bounds[axis][0];
        const auto &highest = node.bounds[axis][1];
        box.min[axis] = *std::min_element(std::begin(lowest), std::end(lowest));
        box.max[axis] = *std::max_element(std::begin(highest), std::end(highest));
    }
    return box;
}

} // namespace

// The binary tree that is collapsed into nodes.
struct Bvh::Builder {
    struct Item {
        Aabb box;
        std::uint32_t index = 0;
        // Twice the centre, which sorts the same.
        Real center(int axis) const { return box.min[axis] + box.max[axis]; }
    };
    // Items [first, first + count) and their bounds.
    struct Range {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
        Aabb box;
        Aabb centers;
    };
    // A node of the binary tree; `left` is 0 in a leaf.
    struct Branch {
        Range range;
        std::uint32_t left = 0, right = 0;
    };
    struct Split {
        int axis = -1; // -1: no useful split
        int bin = 0;   // first bin of the right side
    };

    static constexpr int bin_count = 16;
    // Below this depth ranges are halved by count, which bounds the tree's height and with it the
    // traversal stack: 32 more levels hold the maximum number of items.
    static constexpr int greedy_depth = 36;

    std::vector<Item> items;
    std::vector<Branch> branches;

    explicit Builder(std::span<const Aabb> boxes) {
        items.resize(boxes.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            check_box(boxes[i], i);
            items[i] = {boxes[i], static_cast<std::uint32_t>(i)};
        }
        branches.reserve(boxes.size());
        branches.push_back({measured(0, static_cast<std::uint32_t>(boxes.size())), 0, 0});
        split(0, 0);
    }

    Range measured(std::uint32_t first, std::uint32_t count) const {
        Range range{first, count, {}, {}};
        for (std::uint32_t i = first; i < first + count; ++i) {
            const Aabb &box = items[i].box;
            range.box = joined(range.box, box);
            const Vec3 center = box.min + box.max;
            range.centers = joined(range.centers, {center, center});
        }
        return range;
    }

    // Bins are evenly spaced between the lowest and the highest centre.
    struct Bins {
        Real lowest;
        Real scale;
        Bins(const Range &range, int axis)
            : lowest(range.centers.min[axis]),
              scale(Real(bin_count) / (range.centers.max[axis] - range.centers.min[axis])) {}
        int operator()(Real center) const {
            return std::min(static_cast<int>((center - lowest) * scale), bin_count - 1);
        }
    };

    // Wald 2007, section 3: the plane between two bins with the least A_l N_l + A_r N_r, N counted
    // in leaves, as a leaf's items are tested all at once.
    Split best_split(const Range &range) const {
        Split best;
        Real best_cost = std::numeric_limits<Real>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            const Bins bin_of(range, axis);
            if (!std::isfinite(bin_of.scale)) // the centres (nearly) coincide
                continue;
            std::array<Aabb, bin_count> boxes{};
            std::array<std::uint32_t, bin_count> counts{};
            for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
                const auto bin = static_cast<std::size_t>(bin_of(items[i].center(axis)));
                boxes[bin] = joined(boxes[bin], items[i].box);
                ++counts[bin];
            }
            std::array<Real, bin_count> right_costs{};
            Aabb box;
            std::uint32_t count = 0;
            for (std::size_t bin = bin_count; bin-- > 1;) {
                box = joined(box, boxes[bin]);
                count += counts[bin];
                right_costs[bin] = cost(box, count);
            }
            box = {};
            count = 0;
            for (std::size_t bin = 1; bin < bin_count; ++bin) {
                box = joined(box, boxes[bin - 1]);
                count += counts[bin - 1];
                const Real sum = cost(box, count) + right_costs[bin];
                if (count > 0 && count < range.count && sum < best_cost) {
                    best_cost = sum;
                    best = {axis, static_cast<int>(bin)};
                }
            }
        }
        return best;
    }

    static Real cost(const Aabb &box, std::uint32_t count) {
        const std::size_t leaves = (count + leaf_size - 1) / leaf_size;
        return count == 0 ? Real(0) : half_area(box) * static_cast<Real>(leaves);
    }

    // Partitions the range's items; returns where the right side begins.
    std::uint32_t divided(const Range &range, int depth) {
        const auto first = items.begin() + std::ptrdiff_t(range.first);
        const auto last = first + std::ptrdiff_t(range.count);
        if (depth < greedy_depth) {
            const Split found = best_split(range);
            if (found.axis >= 0) {
                const Bins bin_of(range, found.axis);
                const auto middle = std::partition(first, last, [&](const Item &item) {
                    return bin_of(item.center(found.axis)) < found.bin;
                });
                return static_cast<std::uint32_t>(middle - items.begin());
            }
        }
        const Vec3 spread = range.centers.max - range.centers.min;
        const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0
                         : spread.y >= spread.z                       ? 1
                                                                      : 2;
        const auto middle = first + (last - first) / 2;
        std::nth_element(first, middle, last, [axis](const Item &a, const Item &b) {
            const Real left = a.center(axis);
            const Real right = b.center(axis);
            return left < right || (left == right && a.index < b.index);
        });
        return static_cast<std::uint32_t>(middle - items.begin());
    }

    void split(std::uint32_t branch, int depth) {
        const Range range = branches[branch].range;
        if (range.count <= leaf_size)
            return;
        const std::uint32_t middle = divided(range, depth);
        const auto left = static_cast<std::uint32_t>(branches.size());
        branches[branch].left = left;
        branches[branch].right = left + 1;
        branches.push_back({measured(range.first, middle - range.first), 0, 0});
        branches.push_back({measured(middle, range.first + range.count - middle), 0, 0});
        split(left, depth + 1);
        split(left + 1, depth + 1);
    }

    // Appends the node for `root` of the binary tree, and everything below it.
    std::uint32_t collapse(Bvh &bvh, std::uint32_t root) const {
        std::array<std::uint32_t, width> children{root};
        std::size_t count = 1;
        while (count < width) { // open the largest child
            std::size_t widest = width;
            for (std::size_t i = 0; i < count; ++i)
                if (branches[children[i]].left != 0 &&
                    (widest == width || half_area(branches[children[i]].range.box) >
                                            half_area(branches[children[widest]].range.box)))
                    widest = i;
            if (widest == width)
                break;
            const Branch &opened = branches[children[widest]];
            children[widest] = opened.left;
            children[count++] = opened.right;
        }
        const auto index = static_cast<std::uint32_t>(bvh.nodes_.size());
        bvh.nodes_.push_back({});
        for (std::size_t i = 0; i < width; ++i) {
            std::uint32_t child = no_child;
            Aabb box;
            if (i < count) {
                const Branch &branch = branches[children[i]];
                box = branch.range.box;
                child = branch.left != 0 ? collapse(bvh, children[i]) : leaf(bvh, branch.range);
            }
            set_child(bvh.nodes_[index], i, box);
            bvh.nodes_[index].children[i] = child;
        }
        return index;
    }

    std::uint32_t leaf(Bvh &bvh, const Range &range) const {
        const auto number = static_cast<std::uint32_t>(bvh.leaf_count());
        for (std::uint32_t i = range.first; i < range.first + range.count; ++i)
            bvh.items_.push_back(items[i].index);
        bvh.first_.push_back(static_cast<std::uint32_t>(bvh.items_.size()));
        return leaf_bit | number;
    }
};

Bvh::Bvh(std::span<const Aabb> boxes) : first_{0} {
    PLUMB_CHECK(boxes.size() < leaf_bit,
                "a tree holds fewer than 2^31 boxes, got " << boxes.size());
    if (boxes.empty())
        return;
    const Builder builder(boxes);
    items_.reserve(boxes.size());
    builder.collapse(*this, 0);
    bounds_ = joined_children(nodes_[0]);
    nodes_.shrink_to_fit();
    first_.shrink_to_fit();
}

void Bvh::refit(std::span<const Aabb> boxes) {
    PLUMB_CHECK(boxes.size() == size(),
                "a tree must be refitted to as many boxes as it was built from, "
                    << size() << ", got " << boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        check_box(boxes[i], i);
    for (std::size_t index = nodes_.size(); index-- > 0;) {
        Node &node = nodes_[index];
        for (std::size_t i = 0; i < width && node.children[i] != no_child; ++i) {
            const std::uint32_t child = node.children[i];
            Aabb box;
            if ((child & leaf_bit) == 0)
                box = joined_children(nodes_[child]);
            else
                for (const std::uint32_t item : items(child & ~leaf_bit))
                    box = joined(box, boxes[item]);
            set_child(node, i, box);
        }
    }
    if (!nodes_.empty())
        bounds_ = joined_children(nodes_[0]);
}

} // namespace plumb::inline PLUMB_PRECISION

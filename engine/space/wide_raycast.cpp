#include "engine/space/wide_raycast.h"

#include <bit>
#include <cmath>
#include <limits>

// Highway includes this file again for each target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/space/wide_raycast.cpp"
// Vectors of unknown size cannot be array elements.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
// After foreach_target.h, which must choose the target first.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace plumb::inline PLUMB_PRECISION {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using BoxTag = hn::CappedTag<Real, Bvh::width>;
using BlockTag = hn::CappedTag<Real, Bvh::leaf_size>;
using Boxes = hn::Vec<BoxTag>;
using Triangles = hn::Vec<BlockTag>;

// One bit per lane, the first lane lowest.
template <typename Tag> unsigned bits(Tag tag, hn::Mask<Tag> mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(tag, mask, bytes);
    return bytes[0];
}

struct BoxRay {
    Boxes enter_origin[3], leave_origin[3], inverse[3];
    std::size_t enter_side[3];

    explicit BoxRay(const WideRay &ray) {
        const BoxTag tag;
        for (int axis = 0; axis < 3; ++axis) {
            enter_origin[axis] = hn::Set(tag, ray.enter_origin[axis]);
            leave_origin[axis] = hn::Set(tag, ray.leave_origin[axis]);
            inverse[axis] = hn::Set(tag, ray.inverse[axis]);
            enter_side[axis] = ray.enter_side[axis];
        }
    }

    // Which children the ray enters by `latest`, and when.
    HWY_INLINE unsigned meets(const Bvh::Node &node, Real latest, Real *HWY_RESTRICT enters) const {
        const BoxTag tag;
        unsigned met = 0;
        for (std::size_t i = 0; i < Bvh::width; i += hn::MaxLanes(tag)) {
            Boxes enter = hn::Zero(tag);
            Boxes leave = hn::Set(tag, latest);
            for (int axis = 0; axis < 3; ++axis) {
                const Real *near = node.bounds[axis][enter_side[axis]] + i;
                const Real *far = node.bounds[axis][1 - enter_side[axis]] + i;
                enter = hn::Max(enter, hn::Mul(hn::Sub(hn::Load(tag, near), enter_origin[axis]),
                                               inverse[axis]));
                leave = hn::Min(
                    leave, hn::Mul(hn::Sub(hn::Load(tag, far), leave_origin[axis]), inverse[axis]));
            }
            hn::Store(enter, tag, enters + i);
            met |= bits(tag, hn::Le(enter, leave)) << i;
        }
        return met;
    }
};

struct BlockRay {
    Triangles origin[3];
    Triangles side_direction[2], main_direction;
    Triangles doubt, doubt_size;
    std::size_t axes[3];

    explicit BlockRay(const WideRay &ray) {
        const BlockTag tag;
        for (std::size_t i = 0; i < 3; ++i) {
            axes[i] = ray.axes[i];
            origin[i] = hn::Set(tag, ray.origin[axes[i]]);
        }
        for (std::size_t i = 0; i < 2; ++i)
            side_direction[i] = hn::Set(tag, static_cast<Real>(ray.direction[axes[i]]));
        main_direction = hn::Set(tag, static_cast<Real>(ray.direction[axes[2]]));
        // A corner's projection, below, is off by at most delta = 12 u reach, u = epsilon / 2. In a
        // triangle of size h that the line hits, no projected corner is farther than 4 h from the
        // line, so an edge function is off by at most 20 delta h + 7 delta^2.
        const Real delta = Real(8) * std::numeric_limits<Real>::epsilon() * ray.reach;
        doubt = hn::Set(tag, Real(24) * delta);
        doubt_size = hn::Set(tag, delta);
    }

    // Which triangles the line may hit: all that it does hit, and a few others.
    HWY_INLINE unsigned may_meet(const TriangleBlock &block) const {
        const BlockTag tag;
        unsigned met = 0;
        for (std::size_t i = 0; i < Bvh::leaf_size; i += hn::MaxLanes(tag)) {
            // Woop, Benthin, Wald 2013, section 3: sheared so that the ray is the third axis;
            // multiplied by the direction's main component instead of divided, so that small
            // integers stay exact.
            Triangles x[3], y[3];
            for (int corner = 0; corner < 3; ++corner) {
                const auto &at = block.corners[corner];
                const Triangles z = hn::Sub(hn::Load(tag, at[axes[2]] + i), origin[2]);
                x[corner] = hn::Sub(
                    hn::Mul(hn::Sub(hn::Load(tag, at[axes[0]] + i), origin[0]), main_direction),
                    hn::Mul(side_direction[0], z));
                y[corner] = hn::Sub(
                    hn::Mul(hn::Sub(hn::Load(tag, at[axes[1]] + i), origin[1]), main_direction),
                    hn::Mul(side_direction[1], z));
            }
            const Triangles u = hn::Sub(hn::Mul(x[1], y[2]), hn::Mul(x[2], y[1]));
            const Triangles v = hn::Sub(hn::Mul(x[2], y[0]), hn::Mul(x[0], y[2]));
            const Triangles w = hn::Sub(hn::Mul(x[0], y[1]), hn::Mul(x[1], y[0]));
            const Triangles least = hn::Min(hn::Min(u, v), w);
            const Triangles most = hn::Max(hn::Max(u, v), w);
            const Triangles error =
                hn::Mul(doubt, hn::Add(hn::Load(tag, block.sizes + i), doubt_size));
            met |= bits(tag, hn::Or(hn::Ge(least, hn::Neg(error)), hn::Le(most, error))) << i;
        }
        return met;
    }
};

// Prefetches a child that will be visited soon.
HWY_INLINE void fetch(const Bvh::Node *nodes, const TriangleBlock *blocks, std::uint32_t child) {
    const bool is_leaf = (child & Bvh::leaf_bit) != 0;
    const char *const first =
        is_leaf ? reinterpret_cast<const char *>(blocks + (child & ~Bvh::leaf_bit))
                : reinterpret_cast<const char *>(nodes + child);
    for (std::size_t i = 0; i < 4; ++i) // a node, or most of a block
        hwy::Prefetch(first + 64 * i);
}

template <bool any>
bool search(const Bvh::Node *nodes, const TriangleBlock *blocks, const WideRay &ray, WideHit &hit) {
    struct Entry {
        Real enter;
        std::uint32_t child;
    };
    const BoxRay box_ray(ray);
    const BlockRay block_ray(ray);
    Entry pending[Bvh::stack_size];
    std::size_t count = 0;
    Real latest = ray.max_time;
    bool is_hit = false;
    std::uint32_t here = 0;
    for (;;) {
        if ((here & Bvh::leaf_bit) == 0) {
            const Bvh::Node &node = nodes[here];
            HWY_ALIGN Real enters[Bvh::width];
            unsigned met = box_ray.meets(node, latest, enters);
            if (met != 0) {
                // Continue with the nearest; push the others, nearer ones on top.
                const auto lowest = [&] {
                    const auto child = static_cast<std::size_t>(std::countr_zero(met));
                    fetch(nodes, blocks, node.children[child]);
                    return Entry{enters[child], node.children[child]};
                };
                Entry nearest = lowest();
                met &= met - 1;
                const std::size_t bottom = count;
                for (; met != 0; met &= met - 1) {
                    const Entry entry = lowest();
                    const bool is_nearer = !any && entry.enter < nearest.enter;
                    const Entry further = is_nearer ? nearest : entry;
                    nearest = is_nearer ? entry : nearest;
                    std::size_t place = count++;
                    for (; !any && place > bottom && pending[place - 1].enter < further.enter;
                         --place)
                        pending[place] = pending[place - 1];
                    pending[place] = further;
                }
                here = nearest.child;
                continue;
            }
        } else {
            const TriangleBlock &block = blocks[here & ~Bvh::leaf_bit];
            for (unsigned may = block_ray.may_meet(block); may != 0; may &= may - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(may));
                Real time = Real(0);
                std::array<double, 3> edges;
                if (!meets(ray, block.at(lane), time, edges))
                    continue;
                if (time < latest ||
                    (time == latest && (!is_hit || block.triangles[lane] < hit.triangle()))) {
                    is_hit = true;
                    latest = time;
                    hit = {time, &block, lane, edges};
                    if (any)
                        return true;
                }
            }
        }
        do {
            if (count == 0)
                return is_hit;
            --count;
        } while (pending[count].enter > latest);
        here = pending[count].child;
    }
}

bool search_first(const Bvh::Node *nodes, const TriangleBlock *blocks, const WideRay &ray,
                  WideHit &hit) {
    return search<false>(nodes, blocks, ray, hit);
}

bool search_any(const Bvh::Node *nodes, const TriangleBlock *blocks, const WideRay &ray,
                WideHit &hit) {
    return search<true>(nodes, blocks, ray, hit);
}

} // namespace HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace plumb::inline PLUMB_PRECISION {

HWY_EXPORT(search_first);
HWY_EXPORT(search_any);

bool first_hit(std::span<const Bvh::Node> nodes, const TriangleBlock *blocks, const WideRay &ray,
               WideHit &hit) {
    return !nodes.empty() && HWY_DYNAMIC_DISPATCH(search_first)(nodes.data(), blocks, ray, hit);
}

bool any_hit(std::span<const Bvh::Node> nodes, const TriangleBlock *blocks, const WideRay &ray) {
    WideHit hit;
    return !nodes.empty() && HWY_DYNAMIC_DISPATCH(search_any)(nodes.data(), blocks, ray, hit);
}

} // namespace plumb::inline PLUMB_PRECISION

#endif

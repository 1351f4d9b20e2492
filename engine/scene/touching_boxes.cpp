#include "engine/scene/touching_boxes.h"

#include "engine/space/bvh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace plumb {

namespace {

// Rounded outwards, so that touching boxes still touch.
f32::Aabb rounded_out(const BoundsDesc &box) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    f32::Aabb rounded;
    for (int axis = 0; axis < 3; ++axis) {
        rounded.min[axis] = std::nextafter(static_cast<float>(box.min[axis]), -infinity);
        rounded.max[axis] = std::nextafter(static_cast<float>(box.max[axis]), infinity);
    }
    return rounded;
}

bool touch(const BoundsDesc &a, const BoundsDesc &b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
}

} // namespace

void for_touching_boxes(std::span<const BoundsDesc> boxes,
                        const std::function<bool(std::size_t, std::size_t)> &visit) {
    std::vector<f32::Aabb> rounded;
    rounded.reserve(boxes.size());
    for (const BoundsDesc &box : boxes)
        rounded.push_back(rounded_out(box));
    const f32::Bvh tree(rounded);
    std::vector<std::uint32_t> others;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        others.clear();
        tree.query(rounded[i], [&](std::uint32_t j) {
            if (j < i && touch(boxes[i], boxes[j]))
                others.push_back(j);
            return true;
        });
        std::sort(others.begin(), others.end());
        for (const std::uint32_t j : others)
            if (!visit(i, j))
                return;
    }
}

} // namespace plumb

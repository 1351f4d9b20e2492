#include "app/lab/queries/turned_boxes.h"

#include "app/lab/queries/query_inputs.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

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

} // namespace

std::optional<bool> truth_of(const Box &box, const Vec3 &origin, const Vec3 &along,
                             long double max_t) {
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

Quat nearby(Random &random, const Quat &q) {
    const Vec3 v = any_vector(random, random.next_index(2) == 0 ? 1e-3 : 1e-6);
    return glm::normalize(q * Quat{1, v.x, v.y, v.z});
}

Pair<Box, Box> edge_on_edge(Random &random) {
    const float quarter = 0.38268343f, rest = 0.92387953f; // sin and cos of 22.5 degrees
    const Box a{Vec3{0}, Quat{rest, quarter, 0, 0}, Vec3{1, 0.5f, 0.5f}}; // top edge along x
    const float gap = static_cast<float>(random.next_in(-0.2, 0.2));
    const float height = 0.5f * std::sqrt(2.0f);
    const Box b{Vec3{static_cast<float>(random.next_in(-0.3, 0.3)), 2 * height + gap, 0},
                Quat{rest, 0, 0, quarter}, Vec3{0.5f, 0.5f, 1}}; // bottom edge along z
    const Quat turn = any_rotation(random);
    const auto turned = [&](const Box &box) {
        return Box{turn * box.center, turn * box.rotation, box.half_extents};
    };
    return {turned(a), turned(b)};
}

} // namespace plumb

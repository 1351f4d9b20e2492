#include "app/render/culling.h"

#include "engine/core/check.h"

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb {

float bounding_radius(const DrawShape &shape) {
    switch (shape.kind) {
    case DrawKind::sphere:
        return shape.size.x;
    case DrawKind::box:
        return glm::length(shape.size);
    case DrawKind::capsule:
        return shape.size.x + shape.size.y;
    case DrawKind::cylinder:
        return std::hypot(shape.size.x, shape.size.y);
    }
    PLUMB_CHECK(false, "unknown kind of shape " << static_cast<int>(shape.kind));
}

namespace {

Aabb box_around(const DrawShape &shape) {
    // Drawing adds no more than 1% to a shape (softened edges, outlines).
    const float radius = 1.01f * bounding_radius(shape);
    return {shape.position - radius, shape.position + radius};
}

bool same(const Aabb &a, const Aabb &b) {
    return a.min == b.min && a.max == b.max;
}

} // namespace

void Culling::rebuild(std::span<const DrawShape> shapes) {
    boxes_.clear();
    items_.clear();
    tree_.reset();
    if (shapes.empty())
        return;
    Aabb world;
    for (const DrawShape &shape : shapes) {
        boxes_.push_back(box_around(shape));
        world.min = glm::min(world.min, boxes_.back().min);
        world.max = glm::max(world.max, boxes_.back().max);
    }
    // Room to move: shapes that leave the world are still found, but tested one by one.
    const Vec3 air = 0.5f * (world.max - world.min) + 1.0f;
    constexpr int depth = 8, capacity = 16;
    tree_.emplace(Aabb{world.min - air, world.max + air}, depth, capacity);
    for (std::size_t i = 0; i < boxes_.size(); ++i)
        items_.push_back(tree_->insert(boxes_[i], static_cast<std::uint32_t>(i)));
}

void Culling::update(std::span<const DrawShape> shapes) {
    if (shapes.size() != boxes_.size()) {
        rebuild(shapes);
        return;
    }
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const Aabb box = box_around(shapes[i]);
        if (same(box, boxes_[i]))
            continue;
        boxes_[i] = box;
        tree_->update(items_[i], box);
    }
}

std::span<const std::uint8_t> Culling::in_view(const Frustum &frustum) {
    in_view_.assign(boxes_.size(), 0);
    if (tree_)
        tree_->query_if(
            [&](const Aabb &box) { return classify(frustum, box) != FrustumSide::outside; },
            [&](std::uint32_t shape) {
                in_view_[shape] = 1;
                return true;
            });
    return in_view_;
}

} // namespace plumb

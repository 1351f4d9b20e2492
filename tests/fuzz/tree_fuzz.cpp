// libFuzzer target: any stream of changes leaves the trees valid, and all of them find the same; a
// mesh is hit exactly where one of its triangles is.
#include "engine/geometry/raycast.h"
#include "engine/space/bvh.h"
#include "engine/space/dynamic_tree.h"
#include "engine/space/mesh_tree.h"
#include "engine/space/orthtree.h"
#include "tests/fuzz/input.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace plumb {
namespace {

struct Item {
    Aabb box;
    DynamicTree::Leaf leaf = DynamicTree::none;
    Octree::Item item = Octree::none;
    std::uint32_t user = 0;
};

bool touch(const Aabb &a, const Aabb &b) {
    for (int i = 0; i < 3; ++i)
        if (a.min[i] > b.max[i] || b.min[i] > a.max[i])
            return false;
    return true;
}

// Each tree must find the same items in a box as a list.
void compare(const std::vector<Item> &items, const DynamicTree &tree, const Octree &octree,
             const Aabb &box) {
    std::vector<std::uint32_t> expected, found;
    for (const Item &item : items)
        if (touch(item.box, box))
            expected.push_back(item.user);
    std::sort(expected.begin(), expected.end());
    const auto take = [&](std::uint32_t user) {
        found.push_back(user);
        return true;
    };
    const auto is_as_expected = [&] {
        std::sort(found.begin(), found.end());
        const bool same = found == expected;
        found.clear();
        return same;
    };
    tree.query(box, take);
    FUZZ_ASSERT(is_as_expected());
    octree.query(box, take);
    FUZZ_ASSERT(is_as_expected());
    std::vector<Aabb> boxes;
    for (const Item &item : items)
        boxes.push_back(item.box);
    // Its leaves hold several items, so it may visit some outside the box.
    Bvh(boxes).query(box, [&](std::uint32_t index) {
        if (touch(boxes[index], box))
            found.push_back(items[index].user);
        return true;
    });
    FUZZ_ASSERT(is_as_expected());
}

void check_mesh(FuzzInput &input) {
    TriangleMesh mesh;
    for (std::uint32_t i = 3 + input.below(20); i > 0; --i)
        mesh.vertices.push_back(input.point());
    const auto corner = [&] { return input.below(std::uint32_t(mesh.vertices.size())); };
    for (std::uint32_t i = input.below(40); i > 0; --i) {
        const std::uint32_t a = corner(), b = corner();
        mesh.triangles.push_back({a, b, corner()});
    }
    const MeshTree tree(mesh);
    while (!input.is_empty()) {
        const Vec3 origin = input.point(), direction = input.point();
        if (direction == Vec3{Real(0)})
            continue;
        const Ray ray{origin, direction, std::numeric_limits<Real>::infinity()};
        bool is_hit = false;
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
            is_hit = is_hit || raycast(triangle(mesh, i), ray).has_value();
        const std::optional<MeshHit> hit = raycast(tree, ray);
        FUZZ_ASSERT(hit.has_value() == is_hit && is_met(tree, ray) == is_hit);
        if (!hit)
            continue;
        FUZZ_ASSERT(hit->t >= Real(0));
        FUZZ_ASSERT(raycast(triangle(mesh, hit->triangle), ray).has_value());
    }
}

} // namespace
} // namespace plumb

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    using namespace plumb;
    FuzzInput input(data, size);
    if (input.below(4) == 0) {
        check_mesh(input);
        return 0;
    }
    DynamicTree tree(Real(0));
    Octree octree({Vec3{Real(-4)}, Vec3{Real(4)}}, 5, 2);
    std::vector<Item> items;
    std::uint32_t next = 0;
    for (int step = 0; step < 60 && !input.is_empty(); ++step) {
        const std::uint32_t which = input.below(4);
        if (which == 0 || items.empty()) {
            Item item;
            item.box = input.aabb();
            item.user = next++;
            item.leaf = tree.insert(item.box, item.user);
            item.item = octree.insert(item.box, item.user);
            items.push_back(item);
        } else if (which == 1) {
            const std::size_t at = input.below(static_cast<std::uint32_t>(items.size()));
            tree.remove(items[at].leaf);
            octree.remove(items[at].item);
            items.erase(items.begin() + static_cast<std::ptrdiff_t>(at));
        } else if (which == 2) {
            Item &item = items[input.below(static_cast<std::uint32_t>(items.size()))];
            item.box = input.aabb();
            // A leaf keeps its box if that still holds the new one; reinsert for equal answers.
            tree.remove(item.leaf);
            item.leaf = tree.insert(item.box, item.user);
            octree.update(item.item, item.box);
        } else {
            compare(items, tree, octree, input.aabb());
        }
        tree.validate();
        octree.validate();
    }
    return 0;
}

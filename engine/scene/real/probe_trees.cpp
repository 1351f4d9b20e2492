// Tree probes: trees over many boxes, and a mesh's own tree.
#include "engine/scene/real/probe_asking.h"

#include "engine/core/check.h"
#include "engine/geometry/overlap.h"
#include "engine/geometry/raycast.h"
#include "engine/space/bvh.h"
#include "engine/space/orthtree.h"

#include <algorithm>
#include <concepts>
#include <limits>

#include <glm/common.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

void draw_cell(Asking &ask, const Aabb &box, int depth) {
    if (ask.probe.level < 0 || ask.probe.level == depth)
        draw_edges(ask.answer, box, ProbeTone::faint);
}

// What a region, a point and a ray find among the items; `items` marks those in the region.
struct Found {
    std::vector<bool> items;
    std::size_t tested = 0;
    std::optional<std::uint32_t> closest;
    double distance = 0;
    std::optional<std::uint32_t> hit;
    double t = 0;

    explicit Found(std::size_t count) : items(count, false) {}
    bool visit(std::uint32_t item) {
        items[item] = true;
        return true;
    }
};

Real distance_to(const Aabb &box, const Vec3 &point) {
    return glm::distance(glm::clamp(point, box.min, box.max), point);
}

// Where the ray enters an item: its new max_t in the search for nearer ones.
template <typename HalfLine>
Real enter_item(Found &found, std::uint32_t item, const Aabb &box, const HalfLine &ray) {
    const std::optional<RayInterval> inside = [&] {
        if constexpr (std::same_as<HalfLine, Ray2>)
            return ray_interval(box, lifted(ray));
        else
            return ray_interval(box, ray);
    }();
    if (!inside)
        return ray.max_t;
    found.hit = item;
    found.t = static_cast<double>(inside->t_enter);
    return inside->t_enter;
}

template <int Dim> struct Lowered;
template <> struct Lowered<2> {
    static Rectangle box(const Aabb &box) { return {Vec2{box.min}, Vec2{box.max}}; }
    static Vec2 point(const glm::dvec3 &p) { return flattened(p); }
    static Ray2 ray(const Ray &r) { return {Vec2{r.origin}, Vec2{r.direction}, r.max_t}; }
    static Aabb lift(const Rectangle &r) { return lifted(r); }
};
template <> struct Lowered<3> {
    static Aabb box(const Aabb &box) { return box; }
    static Vec3 point(const glm::dvec3 &p) { return Vec3{p}; }
    static Ray ray(const Ray &r) { return r; }
    static Aabb lift(const Aabb &box) { return box; }
};

template <int Dim> void ask_orthtree(Asking &ask, const std::vector<Aabb> &items, Found &found) {
    using Low = Lowered<Dim>;
    const ProbeScatterDesc &scatter = *ask.probe.scatter;
    const glm::dvec3 half = scatter.half_extents + scatter.size;
    const Aabb world{Vec3{scatter.center - half}, Vec3{scatter.center + half}};
    Orthtree<Dim> tree(Low::box(world), 6, 4);
    for (std::size_t i = 0; i < items.size(); ++i)
        tree.insert(Low::box(items[i]), static_cast<std::uint32_t>(i));

    std::size_t cells = 0;
    int deepest = 0;
    tree.cells([&](const auto &box, int depth, std::size_t) {
        ++cells;
        deepest = std::max(deepest, depth);
        draw_cell(ask, Low::lift(box), depth);
    });
    ask.count("nodes", cells);
    ask.count("depth", static_cast<std::size_t>(deepest));

    const auto visit = [&](std::uint32_t item) { return found.visit(item); };
    if (!ask.shapes.empty())
        std::visit(
            [&](const auto &region) {
                if constexpr (requires { tree.query(region, visit); })
                    tree.query(region, visit);
                else
                    PLUMB_CHECK(false, "this tree cannot be queried with this kind of shape");
            },
            ask.shapes.front().shape);
    if (!ask.probe.points.empty()) {
        const Vec3 point{ask.probe.points.front()};
        const auto nearest =
            tree.closest(Low::point(ask.probe.points.front()),
                         [&](std::uint32_t item) { return distance_to(items[item], point); });
        if (nearest) {
            found.closest = nearest->user;
            found.distance = static_cast<double>(nearest->distance);
        }
    }
    if (ask.probe.ray)
        tree.raycast(Low::ray(ray_of(*ask.probe.ray)), [&](std::uint32_t item, const auto &ray) {
            return enter_item(found, item, items[item], ray);
        });
}

void draw_bvh(Asking &ask, const Bvh &tree) {
    std::vector<int> depths(tree.nodes().size(), 0);
    int deepest = 0;
    for (std::size_t n = 0; n < tree.nodes().size(); ++n) {
        const Bvh::Node &node = tree.nodes()[n];
        for (std::size_t child = 0; child < Bvh::width; ++child) {
            const std::uint32_t to = node.children[child];
            if (to == Bvh::no_child)
                continue;
            const int depth = depths[n] + 1;
            deepest = std::max(deepest, depth);
            if ((to & Bvh::leaf_bit) == 0)
                depths[to] = depth;
            Aabb box;
            for (int axis = 0; axis < 3; ++axis) {
                box.min[axis] = node.bounds[axis][0][child];
                box.max[axis] = node.bounds[axis][1][child];
            }
            draw_cell(ask, box, depth);
        }
    }
    draw_cell(ask, tree.bounds(), 0);
    ask.count("nodes", tree.nodes().size() + tree.leaf_count());
    ask.count("depth", static_cast<std::size_t>(deepest));
}

void ask_bvh(Asking &ask, const std::vector<Aabb> &items, Found &found) {
    const Bvh tree(items);
    draw_bvh(ask, tree);
    if (!ask.shapes.empty()) {
        const Aabb *region = std::get_if<Aabb>(&ask.shapes.front().shape);
        PLUMB_CHECK(region, "a bvh can only be queried with an aabb");
        tree.query(*region, [&](std::uint32_t item) {
            ++found.tested;
            return !overlaps(*region, items[item]) || found.visit(item);
        });
    }
    if (!ask.probe.points.empty()) {
        const Vec3 point{ask.probe.points.front()};
        Real best = std::numeric_limits<Real>::infinity();
        tree.nearest(point, best, [&](std::uint32_t item) {
            const Real away = distance_to(items[item], point);
            if (away < best || (away == best && item < found.closest)) {
                best = away;
                found.closest = item;
                found.distance = static_cast<double>(away);
            }
            return best * best;
        });
    }
}

// A mesh's own tree.
void answer_mesh_tree(Asking &ask, const MeshTree &mesh) {
    ask.draw(0, ProbeTone::plain);
    draw_bvh(ask, mesh.tree());
    ask.count("items", mesh.mesh().triangles.size());
    if (ask.probe.ray)
        show_hit(ask, raycast(mesh, ray_of(*ask.probe.ray)));
}

} // namespace

void answer_tree(Asking &ask) {
    const ProbeTree kind = *ask.probe.tree;
    if (!ask.probe.scatter) {
        const auto *mesh =
            ask.shapes.empty() ? nullptr : std::get_if<MeshTree>(&ask.shapes.front().shape);
        PLUMB_CHECK(mesh && kind == ProbeTree::bvh,
                    "without a scatter, tree must be \"bvh\" and the shape a mesh");
        answer_mesh_tree(ask, *mesh);
        return;
    }
    const std::vector<Aabb> items = scattered_boxes(*ask.probe.scatter);
    Found found(items.size());
    switch (kind) {
    case ProbeTree::quadtree:
        ask_orthtree<2>(ask, items, found);
        break;
    case ProbeTree::octree:
        ask_orthtree<3>(ask, items, found);
        break;
    case ProbeTree::bvh:
        ask_bvh(ask, items, found);
        break;
    }
    for (std::size_t i = 0; i < items.size(); ++i) {
        const bool is_best = found.hit == i || found.closest == i;
        draw_item(ask, items[i],
                  is_best          ? ProbeTone::result
                  : found.items[i] ? ProbeTone::yes
                                   : ProbeTone::no);
    }
    ask.count("items", items.size());
    if (!ask.shapes.empty()) {
        ask.draw(0, ProbeTone::query);
        ask.count("found", static_cast<std::size_t>(std::ranges::count(found.items, true)));
    }
    if (found.tested > 0)
        ask.count("tested", found.tested);
    if (found.closest) {
        const glm::dvec3 from = ask.probe.points.front();
        const Aabb &box = items[*found.closest];
        const glm::dvec3 to = wide(glm::clamp(Vec3{from}, box.min, box.max));
        ask.answer.points.push_back({from, ProbeTone::query});
        ask.answer.lines.push_back({from, to, ProbeTone::result, false, true});
        ask.number("distance", found.distance);
        ask.label(0.5 * (from + to), found.distance);
    }
    if (!ask.probe.ray)
        return;
    ask.flag("hit", found.hit.has_value());
    draw_ray(ask, *ask.probe.ray, found.hit ? std::optional(found.t) : std::nullopt);
    if (!found.hit)
        return;
    ask.number("t", found.t);
    const Ray ray = ray_of(*ask.probe.ray);
    const glm::dvec3 at = wide(ray.origin) + found.t * wide(ray.direction);
    ask.answer.points.push_back({at, ProbeTone::result});
    ask.answer.labels.push_back({at, "t " + short_number(found.t)});
}

} // namespace plumb::inline PLUMB_PRECISION

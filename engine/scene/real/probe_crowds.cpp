// What is asked of crowds of shapes: trees, models, frustums.
#include "engine/core/check.h"
#include "engine/geometry/frustum.h"
#include "engine/geometry/overlap.h"
#include "engine/geometry/raycast.h"
#include "engine/math/matrices.h"
#include "engine/scene/real/probe_asking.h"
#include "engine/space/bvh.h"
#include "engine/space/model_scene.h"
#include "engine/space/orthtree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

ProbeShapeDesc box_desc(const Aabb &box) {
    ProbeShapeDesc desc;
    desc.kind = ProbeShapeKind::aabb;
    desc.position = 0.5 * wide(box.min + box.max);
    desc.half_extents = 0.5 * wide(box.max - box.min);
    return desc;
}

void draw_item(Asking &ask, const Aabb &box, ProbeTone tone) {
    if (ask.flat) {
        const Rectangle item{Vec2{box.min}, Vec2{box.max}};
        draw_shape(ask.answer, box_desc(box), {item, nullptr}, tone, 0);
        ask.answer.surfaces.back().is_opaque = true;
    } else {
        ask.answer.solids.push_back({box_desc(box), tone, 0, true});
    }
}

Ray ray_of(const ProbeRayDesc &ray) {
    if (ray.end)
        return {Vec3{ray.origin}, Vec3{*ray.end - ray.origin}, Real(1)};
    return {Vec3{ray.origin}, Vec3{ray.direction},
            ray.max_t ? static_cast<Real>(*ray.max_t) : std::numeric_limits<Real>::infinity()};
}

void draw_ray(Asking &ask, const ProbeRayDesc &ray, std::optional<double> hit_t) {
    const glm::dvec3 direction = ray.end ? *ray.end - ray.origin : ray.direction;
    const double length = glm::length(direction);
    const double shown = ray.end ? 1.0
                         : hit_t ? *hit_t + 1 / length
                                 : ray.max_t.value_or(12 / length);
    ask.answer.lines.push_back({ray.origin, ray.origin + shown * direction,
                                hit_t ? ProbeTone::query : ProbeTone::no, !ray.end, true});
}

// ---- trees ----

void draw_cell(Asking &ask, const Aabb &box, int depth) {
    if (ask.probe.level < 0 || ask.probe.level == depth)
        draw_edges(ask.answer, box, ProbeTone::faint);
}

// What a region, a point and a ray find among items, whose boxes are `items`.
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

// The entry of a ray into an item, with which it goes on looking for nearer ones.
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
                    PLUMB_CHECK(false, "this tree is not asked with such a shape");
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
        PLUMB_CHECK(region, "a bvh is asked with an aabb");
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

// The tree that a mesh carries.
void answer_mesh_tree(Asking &ask, const MeshTree &mesh) {
    ask.draw(0, ProbeTone::plain);
    draw_bvh(ask, mesh.tree());
    ask.count("items", mesh.mesh().triangles.size());
    if (!ask.probe.ray)
        return;
    const std::optional<MeshHit> hit = raycast(mesh, ray_of(*ask.probe.ray));
    ask.flag("hit", hit.has_value());
    draw_ray(ask, *ask.probe.ray, hit ? std::optional<double>(hit->t) : std::nullopt);
    if (!hit)
        return;
    ask.number("t", hit->t);
    ask.answer.points.push_back({wide(hit->point), ProbeTone::result, wide(hit->normal)});
}

} // namespace

void answer_tree(Asking &ask) {
    const ProbeTree kind = *ask.probe.tree;
    if (!ask.probe.scatter) {
        const auto *mesh =
            ask.shapes.empty() ? nullptr : std::get_if<MeshTree>(&ask.shapes.front().shape);
        PLUMB_CHECK(mesh && kind == ProbeTree::bvh, "without a scatter it is the bvh of a mesh");
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

// ---- models ----

void answer_models(Asking &ask) {
    // Meshes in their own frames; the models place them.
    std::vector<MeshTree> meshes;
    for (const ProbeShapeDesc &shape : ask.probe.shapes) {
        PLUMB_CHECK(shape.kind == ProbeShapeKind::mesh,
                    "a model has a mesh, and no " << probe_shape_name(shape.kind));
        ProbeShapeDesc local = shape;
        local.position = glm::dvec3(0);
        local.orientation = glm::dquat(1, 0, 0, 0);
        meshes.push_back(std::get<MeshTree>(make_shape(local).shape));
    }
    ModelScene scene;
    std::map<std::string, ModelScene::Model> model_of;
    std::vector<ModelScene::Model> models;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const ProbeShapeDesc &shape = ask.probe.shapes[i];
        const auto parent = model_of.find(shape.parent);
        const Placement local{Vec3{shape.position}, Quat{shape.orientation}, Real(1)};
        models.push_back(scene.add(&meshes[i], local,
                                   parent == model_of.end() ? ModelScene::none : parent->second));
        if (!shape.name.empty())
            model_of[shape.name] = models.back();
    }
    const std::optional<ModelScene::Hit> hit = scene.raycast(ray_of(*ask.probe.ray));
    std::vector<ModelScene::Model> touched;
    if (!ask.probe.points.empty()) {
        ProbeShapeDesc ball;
        ball.position = ask.probe.points.front();
        ball.radius = ask.probe.margin;
        touched =
            scene.overlapping(Sphere{Vec3{ball.position}, static_cast<Real>(ask.probe.margin)});
        ask.answer.solids.push_back({ball, ProbeTone::query, 0});
        ask.count("found", touched.size());
    }
    for (std::size_t i = 0; i < models.size(); ++i) {
        const Placement &world = scene.world(models[i]);
        ProbeShapeDesc placed = ask.probe.shapes[i];
        placed.position = wide(world.position);
        placed.orientation = glm::dquat{world.rotation};
        const bool is_hit = hit && hit->model == models[i];
        const bool is_touched = std::ranges::find(touched, models[i]) != touched.end();
        draw_shape(ask.answer, placed, make_shape(placed),
                   is_hit       ? ProbeTone::yes
                   : is_touched ? ProbeTone::partly
                                : ProbeTone::plain,
                   i);
        draw_edges(ask.answer, scene.bounds(models[i]), ProbeTone::faint);
        const ModelScene::Model parent = scene.parent(models[i]);
        if (parent != ModelScene::none)
            ask.answer.lines.push_back({wide(scene.world(parent).position), wide(world.position),
                                        ProbeTone::axis, true, true});
        ask.answer.labels.push_back({placed.position, placed.name});
    }
    ask.count("models", scene.size());
    ask.flag("hit", hit.has_value());
    draw_ray(ask, *ask.probe.ray, hit ? std::optional<double>(hit->t) : std::nullopt);
    if (!hit)
        return;
    ask.number("t", hit->t);
    ask.answer.points.push_back({wide(hit->point), ProbeTone::result, wide(hit->normal)});
}

// ---- cameras ----

namespace {

Mat4 view_projection(const ProbeCameraDesc &camera) {
    const Vec3 eye{camera.eye};
    const Vec3 target{camera.target};
    // Straight up or down, "up" is -z.
    const Vec3 along = glm::normalize(target - eye);
    const Vec3 up = std::abs(along.y) < Real(0.999) ? Vec3{Real(0), Real(1), Real(0)}
                                                    : Vec3{Real(0), Real(0), Real(-1)};
    const auto near = static_cast<Real>(camera.near);
    const auto far = static_cast<Real>(camera.far);
    const auto aspect = static_cast<Real>(camera.aspect);
    Mat4 projection{Real(1)};
    if (camera.height) {
        const Real half = Real(0.5) * static_cast<Real>(*camera.height);
        projection = glm::ortho(-half * aspect, half * aspect, -half, half, near, far);
    } else {
        projection = glm::perspective(static_cast<Real>(camera.fov), aspect, near, far);
    }
    return projection * glm::lookAt(eye, target, up);
}

void draw_frustum(Asking &ask, const Frustum &frustum) {
    const auto corner = [&](int i) { return wide(frustum.corners[static_cast<std::size_t>(i)]); };
    for (int i = 0; i < 8; ++i)
        for (const int bit : {1, 2, 4})
            if ((i & bit) == 0)
                ask.answer.lines.push_back({corner(i), corner(i | bit), ProbeTone::query});
    // The near face stands for the picture; a tick shows where it is up.
    const glm::dvec3 top = 0.5 * (corner(2) + corner(3));
    ask.answer.lines.push_back(
        {top, top + 0.25 * (top - 0.5 * (corner(0) + corner(1))), ProbeTone::query});
    const glm::dvec3 &eye = ask.probe.camera->eye;
    ask.answer.points.push_back({eye, ProbeTone::query});
    if (!ask.probe.camera->height)
        for (int i = 0; i < 4; ++i)
            ask.answer.lines.push_back({eye, corner(i), ProbeTone::faint});
}

constexpr std::array side_tones{ProbeTone::no, ProbeTone::partly, ProbeTone::yes};

} // namespace

void answer_frustum(Asking &ask) {
    const Frustum frustum = frustum_of(view_projection(*ask.probe.camera));
    std::array<std::size_t, 3> sides{};
    for (std::size_t s = 0; s < ask.shapes.size(); ++s) {
        const FrustumSide side = std::visit(
            [&](const auto &shape) -> FrustumSide {
                if constexpr (requires { classify(frustum, shape); })
                    return classify(frustum, shape);
                else
                    PLUMB_CHECK(false, "a frustum does not classify this kind of shape");
            },
            ask.shapes[s].shape);
        ++sides[static_cast<std::size_t>(side)];
        ask.draw(s, side_tones[static_cast<std::size_t>(side)]);
    }
    for (const glm::dvec3 &point : ask.probe.points) {
        const auto side = static_cast<std::size_t>(classify(frustum, Vec3{point}));
        ++sides[side];
        ask.answer.points.push_back({point, side_tones[side]});
    }
    draw_frustum(ask, frustum);
    ask.count("inside", sides[2]);
    ask.count("across", sides[1]);
    ask.count("outside", sides[0]);
}

void answer_cull(Asking &ask) {
    const Frustum frustum = frustum_of(view_projection(*ask.probe.camera));
    const ProbeScatterDesc &scatter = *ask.probe.scatter;
    const std::vector<Aabb> items = scattered_boxes(scatter);
    const glm::dvec3 half = scatter.half_extents + scatter.size;
    Octree tree(Aabb{Vec3{scatter.center - half}, Vec3{scatter.center + half}}, 6, 8);
    for (std::size_t i = 0; i < items.size(); ++i)
        tree.insert(items[i], static_cast<std::uint32_t>(i));
    std::vector<bool> seen(items.size(), false);
    std::size_t tested = 0;
    tree.query_if(
        [&](const Aabb &box) {
            ++tested;
            return classify(frustum, box) != FrustumSide::outside;
        },
        [&](std::uint32_t item) {
            seen[item] = true;
            return true;
        });
    std::size_t count = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const bool is_across = seen[i] && classify(frustum, items[i]) == FrustumSide::across;
        count += seen[i] ? 1 : 0;
        draw_item(ask, items[i],
                  is_across ? ProbeTone::partly
                  : seen[i] ? ProbeTone::yes
                            : ProbeTone::no);
    }
    draw_frustum(ask, frustum);
    ask.answer.labels.push_back(
        {ask.probe.camera->eye,
         std::to_string(count) + " of " + std::to_string(items.size()) + " seen"});
    ask.count("items", items.size());
    ask.count("seen", count);
    ask.count("culled", items.size() - count);
    ask.count("tested", tested);
}

void answer_pick(Asking &ask) {
    const ProbeCameraDesc &camera = *ask.probe.camera;
    const Mat4 matrix = view_projection(camera);
    const std::optional<Mat4> inverse = try_inverse(matrix);
    PLUMB_CHECK(inverse.has_value(), "the camera's matrix has no inverse");
    const Viewport viewport{Vec2{Real(0)}, Vec2{static_cast<Real>(100 * camera.aspect), Real(100)}};
    const Vec2 pixel{*camera.pixel};
    const Ray ray = pick_ray(pixel, *inverse, viewport);
    const ProbeRayDesc asked{wide(ray.origin), wide(ray.direction), 1.0, {}};
    std::optional<RayFound> first;
    std::size_t first_shape = 0;
    for (std::size_t s = 0; s < ask.shapes.size(); ++s) {
        const std::optional<RayFound> found = ray_into(ask.shapes[s].shape, asked);
        if (found && (!first || found->t < first->t)) {
            first = found;
            first_shape = s;
        }
    }
    for (std::size_t s = 0; s < ask.shapes.size(); ++s)
        ask.draw(s, first && s == first_shape ? ProbeTone::yes : ProbeTone::plain);
    draw_frustum(ask, frustum_of(matrix));
    ask.flag("hit", first.has_value());
    const glm::dvec3 end = first ? first->point : asked.origin + asked.direction;
    ask.answer.lines.push_back({camera.eye, end, ProbeTone::result, true, true});
    ask.answer.points.push_back({asked.origin, ProbeTone::result});
    if (!first)
        return;
    ask.answer.points.push_back({first->point, ProbeTone::result, first->normal});
    ask.count("shape", first_shape);
    ask.number("distance", glm::distance(first->point, camera.eye));
    ask.vector(first->point);
    // Back to the picture: where the point is drawn.
    const Vec4 clip = matrix * Vec4{Vec3{first->point}, Real(1)};
    const Vec2 drawn = Real(0.5) * (Vec2{clip.x, -clip.y} / clip.w + Real(1)) * viewport.size;
    ask.number("pixel_x", drawn.x);
    ask.number("pixel_y", drawn.y);
}

} // namespace plumb::inline PLUMB_PRECISION

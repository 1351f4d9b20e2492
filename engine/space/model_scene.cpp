#include "engine/space/model_scene.h"

#include "engine/core/check.h"
#include "engine/math/constants.h"
#include "engine/math/printed.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

bool can_be_placed(const Vec3 &v) {
    return std::abs(v.x) <= mesh_reach && std::abs(v.y) <= mesh_reach &&
           std::abs(v.z) <= mesh_reach;
}

void check_placement(const Placement &placement, const char *whose) {
    PLUMB_CHECK(can_be_placed(placement.position), whose << " position must be finite and within "
                                                         << mesh_reach << " m, got "
                                                         << Printed{placement.position});
    const Quat &q = placement.rotation;
    PLUMB_CHECK(is_unit(glm::dot(q, q)),
                whose << " rotation must have unit length, got (w, x, y, z) = (" << q.w << ", "
                      << q.x << ", " << q.y << ", " << q.z << ')');
    PLUMB_CHECK(placement.scale >= Real(1e-6) && placement.scale <= Real(1e6),
                whose << " scale must be from 1e-6 to 1e6, got " << placement.scale);
}

Placement joined(const Placement &parent, const Placement &local) {
    return {parent.position + rotated(parent.rotation, parent.scale * local.position),
            glm::normalize(parent.rotation * local.rotation), parent.scale * local.scale};
}

Vec3 to_world_point(const Placement &placement, const Vec3 &local) {
    return placement.position + rotated(placement.rotation, placement.scale * local);
}

Vec3 to_local_point(const Placement &placement, const Vec3 &world) {
    return rotated(glm::conjugate(placement.rotation), world - placement.position) /
           placement.scale;
}

// The ray in the mesh's frame; its parameter t stays the same.
Ray to_local(const Placement &placement, const Ray &ray) {
    return {to_local_point(placement, ray.origin),
            rotated(glm::conjugate(placement.rotation), ray.direction) / placement.scale,
            ray.max_t};
}

Sphere to_local(const Placement &placement, const Sphere &sphere) {
    return {to_local_point(placement, sphere.center), sphere.radius / placement.scale};
}

Box to_local(const Placement &placement, const Box &box) {
    return {to_local_point(placement, box.center),
            glm::conjugate(placement.rotation) * box.rotation, box.half_extents / placement.scale};
}

Aabb world_bounds(const Placement &placement, const Aabb &local) {
    if (!(local.min.x <= local.max.x))
        return {};
    const Vec3 half = placement.scale * (local.max - local.min) / Real(2);
    const Vec3 center = to_world_point(placement, (local.min + local.max) / Real(2));
    Vec3 reach{Real(0)};
    for (int i = 0; i < 3; ++i) {
        Vec3 axis{Real(0)};
        axis[i] = half[i];
        reach += glm::abs(rotated(placement.rotation, axis));
    }
    // Rounded outwards by more than all the rounding above, whose terms have one of these sizes.
    const Vec3 size = placement.scale * glm::max(glm::abs(local.min), glm::abs(local.max));
    const Vec3 slack =
        Real(16) * epsilon * (size.x + size.y + size.z + glm::abs(placement.position));
    return {center - reach - slack, center + reach + slack};
}

} // namespace

void ModelScene::check_model(Model model) const {
    PLUMB_CHECK(has(model), "not a model of this scene: " << model);
}

bool ModelScene::has(Model model) const {
    return model >= 0 && static_cast<std::size_t>(model) < nodes_.size() && !node(model).is_free;
}

ModelScene::Model &ModelScene::first_of(Model parent) {
    return parent == none ? first_root_ : node(parent).first_child;
}

ModelScene::Model &ModelScene::last_of(Model parent) {
    return parent == none ? last_root_ : node(parent).last_child;
}

void ModelScene::attach(Model model, Model parent) {
    Node &here = node(model);
    here.parent = parent;
    here.previous = last_of(parent);
    here.next = none;
    if (here.previous == none)
        first_of(parent) = model;
    else
        node(here.previous).next = model;
    last_of(parent) = model;
}

void ModelScene::detach(Model model) {
    const Node &here = node(model);
    if (here.previous == none)
        first_of(here.parent) = here.next;
    else
        node(here.previous).next = here.next;
    if (here.next == none)
        last_of(here.parent) = here.previous;
    else
        node(here.next).previous = here.previous;
}

// Parents before their children.
std::vector<ModelScene::Model> ModelScene::with_all_below(Model top) const {
    std::vector<Model> all{top};
    for (std::size_t i = 0; i < all.size(); ++i)
        for (Model child = node(all[i]).first_child; child != none; child = node(child).next)
            all.push_back(child);
    return all;
}

// Gives `top` a placement and a parent, if every placement below it stays valid.
void ModelScene::place(Model top, const Placement &local, Model parent) {
    const std::vector<Model> models = with_all_below(top);
    std::vector<Placement> worlds(models.size());
    std::size_t above = 0; // the parent's index in `models`: children are in their parents' order
    for (std::size_t i = 0; i < models.size(); ++i) {
        if (i == 0) {
            const Placement upright{local.position, glm::normalize(local.rotation), local.scale};
            worlds[i] = parent == none ? upright : joined(node(parent).world, local);
        } else {
            const Node &here = node(models[i]);
            while (models[above] != here.parent)
                ++above;
            worlds[i] = joined(worlds[above], here.local);
        }
        check_placement(worlds[i], "model's world");
    }
    node(top).local = local;
    for (std::size_t i = 0; i < models.size(); ++i) {
        node(models[i]).world = worlds[i];
        fit_leaf(models[i]);
    }
}

void ModelScene::fit_leaf(Model model) {
    Node &here = node(model);
    if (here.mesh == nullptr)
        return;
    here.bounds = world_bounds(here.world, here.mesh->tree().bounds());
    const bool is_empty = !(here.bounds.min.x <= here.bounds.max.x);
    if (is_empty && here.leaf != DynamicTree::none) {
        tree_.remove(here.leaf);
        here.leaf = DynamicTree::none;
    } else if (!is_empty && here.leaf == DynamicTree::none) {
        here.leaf = tree_.insert(here.bounds, static_cast<std::uint32_t>(model));
    } else if (!is_empty) {
        tree_.update(here.leaf, here.bounds);
    }
}

ModelScene::Model ModelScene::add(const MeshTree *mesh, const Placement &local, Model parent) {
    const Placement placement = local; // a copy: `local` may be a model's, about to move
    if (parent != none)
        check_model(parent);
    check_placement(placement, "model's");
    Model model = free_;
    if (model == none) {
        model = static_cast<Model>(nodes_.size());
        nodes_.emplace_back();
    } else {
        free_ = node(model).parent;
        node(model) = Node{};
    }
    node(model).mesh = mesh;
    try {
        place(model, placement, parent);
    } catch (...) {
        node(model).is_free = true;
        node(model).parent = free_;
        free_ = model;
        throw;
    }
    attach(model, parent);
    ++count_;
    return model;
}

void ModelScene::remove(Model model) {
    check_model(model);
    detach(model);
    for (const Model gone : with_all_below(model)) {
        if (node(gone).leaf != DynamicTree::none)
            tree_.remove(node(gone).leaf);
        node(gone) = Node{};
        node(gone).is_free = true;
        node(gone).parent = free_;
        free_ = gone;
        --count_;
    }
}

void ModelScene::set_local(Model model, const Placement &local) {
    check_model(model);
    check_placement(local, "model's");
    place(model, local, node(model).parent);
}

void ModelScene::set_parent(Model model, Model parent) {
    check_model(model);
    if (parent != none)
        check_model(parent);
    for (Model above = parent; above != none; above = node(above).parent)
        PLUMB_CHECK(above != model, "model " << model << " cannot be attached to " << parent
                                             << ", which is itself or attached to it");
    place(model, node(model).local, parent);
    detach(model);
    attach(model, parent);
}

void ModelScene::refit(Model model) {
    check_model(model);
    fit_leaf(model);
}

ModelScene::Model ModelScene::parent(Model model) const {
    check_model(model);
    return node(model).parent;
}

const MeshTree *ModelScene::mesh(Model model) const {
    check_model(model);
    return node(model).mesh;
}

const Placement &ModelScene::local(Model model) const {
    check_model(model);
    return node(model).local;
}

const Placement &ModelScene::world(Model model) const {
    check_model(model);
    return node(model).world;
}

Aabb ModelScene::bounds(Model model) const {
    check_model(model);
    return node(model).bounds;
}

std::vector<ModelScene::Model> ModelScene::listed(Model first) const {
    std::vector<Model> models;
    for (Model model = first; model != none; model = node(model).next)
        models.push_back(model);
    return models;
}

std::vector<ModelScene::Model> ModelScene::children(Model model) const {
    check_model(model);
    return listed(node(model).first_child);
}

std::vector<ModelScene::Model> ModelScene::roots() const {
    return listed(first_root_);
}

std::optional<ModelScene::Hit> ModelScene::raycast(const Ray &ray) const {
    MeshHit nearest;
    std::optional<DynamicTree::Hit> best;
    // Makes the same choice as closest_hit, to keep what that drops: the mesh's hit.
    tree_.closest_hit(ray, [&](std::uint32_t user, const Ray &left) -> std::optional<Real> {
        const Node &here = node(static_cast<Model>(user));
        const auto hit = plumb::raycast(*here.mesh, to_local(here.world, left));
        if (!hit)
            return std::nullopt;
        if (!best || hit->t < best->t || (hit->t == best->t && user < best->user)) {
            best = {user, hit->t};
            nearest = *hit;
        }
        return hit->t;
    });
    if (!best)
        return std::nullopt;
    const auto model = static_cast<Model>(best->user);
    const Placement &world = node(model).world;
    return Hit{model, nearest.triangle, nearest.t, to_world_point(world, nearest.point),
               rotated(world.rotation, nearest.normal)};
}

bool ModelScene::is_met(const Ray &ray) const {
    return tree_.any_hit(ray, [&](std::uint32_t user, const Ray &whole) {
        const Node &here = node(static_cast<Model>(user));
        return plumb::is_met(*here.mesh, to_local(here.world, whole));
    });
}

std::vector<ModelScene::Model> ModelScene::overlapping(const Sphere &sphere) const {
    std::vector<Model> found;
    tree_.query(sphere, [&](std::uint32_t user) {
        const Node &here = node(static_cast<Model>(user));
        if (overlaps(*here.mesh, to_local(here.world, sphere)))
            found.push_back(static_cast<Model>(user));
        return true;
    });
    std::sort(found.begin(), found.end());
    return found;
}

std::vector<ModelScene::Model> ModelScene::overlapping(const Box &box) const {
    check_valid(box);
    std::vector<Model> found;
    tree_.query(plumb::bounds(box), [&](std::uint32_t user) {
        const Node &here = node(static_cast<Model>(user));
        if (overlaps(*here.mesh, to_local(here.world, box)))
            found.push_back(static_cast<Model>(user));
        return true;
    });
    std::sort(found.begin(), found.end());
    return found;
}

} // namespace plumb::inline PLUMB_PRECISION

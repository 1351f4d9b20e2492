// Models: meshes placed in the world, some attached to others, with ray, sphere and box queries.
#pragma once

#include "engine/space/dynamic_tree.h"
#include "engine/space/mesh_tree.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// Scale, then rotate, then translate. The scale is uniform, so a sphere stays a sphere and a box a
// box through any number of parents, and every query can run in the mesh's own frame. Two
// non-uniform scales with a rotation between them shear, which no such transform can express.
struct Placement {
    Vec3 position{Real(0)};
    Quat rotation = identity_rotation; // unit length
    Real scale = Real(1);              // > 0
};

// A tree of models, each placed relative to its parent or the world. Copyable; meshes are borrowed
// and must outlive the scene, or the models that use them.
//
// A world placement is recomputed from the placements above it whenever one of them changes, always
// in the same way, so it does not drift or depend on the order of changes. Its scale must be 1e-6
// to 1e6 and its position within `mesh_reach` on each axis; otherwise a check fails and nothing is
// changed. Invalid values and models that are not in the scene fail a check, too.
//
// Queries run in each mesh's own frame, where the ray's origin, the sphere or the box must also be
// within `mesh_reach`. Rounding in that transform and in the placements above it shifts a model by
// up to 16 epsilon (d + 1) s, where d is the number of its ancestors and s adds up its distance
// from the query shape, its extent and the lengths of the positions from it to its root, in the
// world. A query can be wrong only if the shape passes the model's surface within that distance.
class ModelScene {
  public:
    using Model = std::int32_t;
    static constexpr Model none = -1;

    // A model without a mesh groups others. Numbers of removed models are reused.
    Model add(const MeshTree *mesh, const Placement &local, Model parent = none);
    // Removes the model and everything attached to it, directly or indirectly. To keep a child,
    // give it another parent first.
    void remove(Model model);
    // The placement relative to the parent.
    void set_local(Model model, const Placement &local);
    // Keeps the local placement, so the model moves with its new parent. A parent that is the model
    // itself or one of its descendants fails a check.
    void set_parent(Model model, Model parent);
    // Call this for each model whose mesh's vertices were moved.
    void refit(Model model);

    std::size_t size() const { return count_; }
    bool has(Model model) const;
    Model parent(Model model) const;
    const MeshTree *mesh(Model model) const;
    const Placement &local(Model model) const;
    const Placement &world(Model model) const;
    // In order of attachment.
    std::vector<Model> children(Model model) const;
    // The models without a parent, in the same order.
    std::vector<Model> roots() const;
    // World bounds of the model's mesh, rounded outwards; empty without a mesh or triangles.
    Aabb bounds(Model model) const;

    struct Hit {
        Model model = none;
        std::uint32_t triangle = 0;
        Real t = Real(0);
        Vec3 point{Real(0)};
        Vec3 normal{Real(0)}; // as in MeshHit, in the world
    };
    // The first triangle the ray hits; at equal t the least model wins.
    std::optional<Hit> raycast(const Ray &ray) const;
    // Whether there is a hit at all; cheaper.
    bool is_met(const Ray &ray) const;
    // The models with a triangle that overlaps the sphere or box, in ascending order.
    std::vector<Model> overlapping(const Sphere &sphere) const;
    std::vector<Model> overlapping(const Box &box) const;

    // The boxes that queries use, for drawing.
    const DynamicTree &tree() const { return tree_; }

  private:
    struct Node {
        Placement local;
        Placement world;
        Aabb bounds;
        const MeshTree *mesh = nullptr;
        Model parent = none; // in a free node: the next free one
        Model first_child = none, last_child = none;
        Model previous = none, next = none; // among siblings, or the roots
        DynamicTree::Leaf leaf = DynamicTree::none;
        bool is_free = false;
    };

    Node &node(Model model) { return nodes_[static_cast<std::size_t>(model)]; }
    const Node &node(Model model) const { return nodes_[static_cast<std::size_t>(model)]; }
    void check_model(Model model) const;
    Model &first_of(Model parent);
    Model &last_of(Model parent);
    void attach(Model model, Model parent);
    void detach(Model model);
    std::vector<Model> with_all_below(Model top) const;
    void place(Model top, const Placement &local, Model parent);
    void fit_leaf(Model model);
    std::vector<Model> listed(Model first) const;

    std::vector<Node> nodes_;
    DynamicTree tree_{Real(0)};
    Model free_ = none;
    Model first_root_ = none, last_root_ = none;
    std::size_t count_ = 0;
};

} // namespace plumb::inline PLUMB_PRECISION

// Models: meshes placed in the world, some attached to others, and what a ray, a sphere or a box
// meets of them.
#pragma once

#include "engine/space/dynamic_tree.h"
#include "engine/space/mesh_tree.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// Scale, then rotate, then translate. One scale for all axes: so a sphere stays a sphere and a box
// a box through any number of parents, and every question can be asked in the mesh's own frame. Two
// scales that differ by axis with a rotation between them shear, which no such transform could say.
struct Placement {
    Vec3 position{Real(0)};
    Quat rotation = identity_rotation; // unit length
    Real scale = Real(1);              // > 0
};

// A tree of models, each placed relative to its parent, or to the world. Copyable; meshes are
// borrowed and must outlive the scene, or the models that have them.
//
// A placement in the world is worked out from the placements above it whenever one of them changes,
// always in the same way, so it does not drift and does not depend on the order of changes. It must
// have a scale of 1e-6 to 1e6 and a position within `mesh_reach` on each axis; otherwise a check
// fails and nothing is changed. So it does for a model that is not in the scene, and a value that
// is not valid.
//
// Queries ask each mesh in its own frame, where the ray's origin, the sphere or the box must be
// within `mesh_reach` too. Rounding on the way there, and of the placements above, shifts a model
// by up to 16 epsilon (d + 1) s: d is the number of its parents, and s adds up its distance from
// what is asked, its extent and the lengths of the positions from it to its root, in the world. A
// query may be wrong where the shape passes the model's surface within that, and no further.
class ModelScene {
  public:
    using Model = std::int32_t;
    static constexpr Model none = -1;

    // A model without a mesh groups others. Numbers of models that were removed are used again.
    Model add(const MeshTree *mesh, const Placement &local, Model parent = none);
    // The model goes, and with it everything attached to it, and to those. To keep a child, give it
    // another parent first.
    void remove(Model model);
    // The placement relative to the parent.
    void set_local(Model model, const Placement &local);
    // Keeps the local placement, so the model moves with its new parent. One that is the model
    // itself, or attached to it over any number of others, fails a check.
    void set_parent(Model model, Model parent);
    // To be called for each model with a mesh whose vertices were moved.
    void refit(Model model);

    std::size_t size() const { return count_; }
    bool has(Model model) const;
    Model parent(Model model) const;
    const MeshTree *mesh(Model model) const;
    const Placement &local(Model model) const;
    const Placement &world(Model model) const;
    // In the order in which they were attached.
    std::vector<Model> children(Model model) const;
    // Those without a parent, likewise.
    std::vector<Model> roots() const;
    // Of the model's mesh in the world, rounded outwards; empty without a mesh or triangles.
    Aabb bounds(Model model) const;

    struct Hit {
        Model model = none;
        std::uint32_t triangle = 0;
        Real t = Real(0);
        Vec3 point{Real(0)};
        Vec3 normal{Real(0)}; // as MeshHit has it, in the world
    };
    // The first triangle that the ray meets; of hits at the same t that of the least model.
    std::optional<Hit> raycast(const Ray &ray) const;
    // Whether there is a hit at all; cheaper.
    bool is_met(const Ray &ray) const;
    // The models of which a triangle overlaps the sphere or box, in ascending order.
    std::vector<Model> overlapping(const Sphere &sphere) const;
    std::vector<Model> overlapping(const Box &box) const;

    // The boxes that queries go by, for drawing.
    const DynamicTree &tree() const { return tree_; }

  private:
    struct Node {
        Placement local;
        Placement world;
        Aabb bounds;
        const MeshTree *mesh = nullptr;
        Model parent = none; // of a free node: the next free one
        Model first_child = none, last_child = none;
        Model previous = none, next = none; // among the children of one parent, or the roots
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

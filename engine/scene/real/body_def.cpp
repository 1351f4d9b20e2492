#include "engine/scene/real/body_def.h"

#include "engine/geometry/quickhull.h"
#include "engine/math/rigid.h"
#include "engine/scene/real/hull_measures.h"

#include <algorithm>
#include <stdexcept>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// No shape of a scene needs more: a smooth hull of so many corners is round to 1 %.
std::shared_ptr<const HullMesh> make_hull(const HullDesc &desc, const std::string &body) {
    std::vector<Vec3> points;
    for (const glm::dvec3 &point : *desc.points)
        points.emplace_back(point);
    HullResult result = convex_hull(points, max_hull_vertices);
    if (!result.mesh)
        throw std::invalid_argument("the points of a hull of \"" + body + "\" have no solid hull");
    return std::make_shared<const HullMesh>(std::move(*result.mesh));
}

std::shared_ptr<const TriangleSurface> make_surface(const MeshDesc &desc) {
    TriangleMesh mesh;
    for (const glm::dvec3 &vertex : desc.data->vertices)
        mesh.vertices.emplace_back(vertex);
    mesh.triangles = desc.data->triangles;
    return std::make_shared<const TriangleSurface>(std::move(mesh),
                                                   desc.both_sides ? Sides::both : Sides::front);
}

std::shared_ptr<const TriangleSurface> make_surface(const HeightFieldDesc &desc) {
    HeightField field;
    field.rows = desc.rows;
    field.columns = desc.columns;
    field.spacing = static_cast<Real>(desc.spacing);
    const double x = -0.5 * (desc.columns - 1) * desc.spacing;
    const double z = -0.5 * (desc.rows - 1) * desc.spacing;
    field.origin = Vec3{static_cast<Real>(x), Real(0), static_cast<Real>(z)};
    for (const double height : *desc.heights)
        field.heights.push_back(static_cast<Real>(height));
    return std::make_shared<const TriangleSurface>(std::move(field), Sides::front);
}

// A shape of the scene, in the collider's frame, then placed in the body's.
class ColliderMaker {
  public:
    ColliderMaker(ColliderDef &out, const ColliderDesc &desc, const std::string &body)
        : out_(out), pose_{Vec3{desc.position}, unit(Quat{desc.orientation})},
          is_placed_(desc.position != glm::dvec3(0) || desc.orientation != glm::dquat(1, 0, 0, 0)),
          body_(body) {}

    void operator()(const SphereDesc &s) {
        place(Sphere{Vec3{Real(0)}, static_cast<Real>(s.radius)});
    }
    void operator()(const BoxDesc &b) {
        place(Box{Vec3{Real(0)}, identity_rotation, Vec3{b.half_extents}});
    }
    void operator()(const CapsuleDesc &c) {
        const auto half = static_cast<Real>(c.half_height);
        place(Capsule{Vec3{0, -half, 0}, Vec3{0, half, 0}, static_cast<Real>(c.radius)});
    }
    void operator()(const CylinderDesc &c) {
        const auto half = static_cast<Real>(c.half_height);
        place(Cylinder{Vec3{0, -half, 0}, Vec3{0, half, 0}, static_cast<Real>(c.radius)});
    }
    void operator()(const HullDesc &h) {
        out_.hull = make_hull(h, body_);
        place(ConvexHull{out_.hull.get(), Vec3{Real(0)}, identity_rotation});
    }
    void operator()(const PlaneDesc &) {
        place(HalfSpace{Vec3{Real(0), Real(1), Real(0)}, Real(0)});
    }
    void operator()(const MeshDesc &m) {
        out_.surface = make_surface(m);
        out_.surface_pose = pose_;
    }
    void operator()(const HeightFieldDesc &h) {
        out_.surface = make_surface(h);
        out_.surface_pose = pose_;
    }

  private:
    void place(const Shape &shape) { out_.shape = is_placed_ ? placed(shape, pose_) : shape; }

    ColliderDef &out_;
    Transform pose_;
    bool is_placed_;
    const std::string &body_;
};

} // namespace

const MaterialDesc &material_of(const SceneDesc &scene, const std::string &name) {
    static const MaterialDesc default_material;
    const auto named = std::ranges::find(scene.materials, name, &MaterialDesc::name);
    return name.empty() || named == scene.materials.end() ? default_material : *named;
}

BodyDef body_def(const SceneDesc &scene, const BodyDesc &desc) {
    BodyDef def;
    def.kind = desc.kind;
    for (const ColliderDesc &from : desc.colliders) {
        ColliderDef &to = def.colliders.emplace_back();
        std::visit(ColliderMaker(to, from, desc.name), from.shape);
        const MaterialDesc &material =
            material_of(scene, from.material.empty() ? desc.material : from.material);
        to.material = {static_cast<Real>(material.friction),
                       static_cast<Real>(material.restitution)};
        to.filter = {static_cast<std::uint32_t>(from.filter.layer), from.filter.ignores};
        to.sensor = from.sensor;
        to.density = static_cast<Real>(density_of(scene, desc, from));
    }
    if (desc.mass)
        def.mass = static_cast<Real>(*desc.mass);
    if (desc.center_of_mass)
        def.center_of_mass = Vec3{*desc.center_of_mass};
    if (desc.inertia)
        def.inertia = Vec3{*desc.inertia};
    def.pose = {Vec3{desc.position}, unit(Quat{desc.orientation})};
    if (desc.mass_pose)
        def.mass_pose = {Vec3{desc.mass_pose->position}, unit(Quat{desc.mass_pose->orientation})};
    def.velocity = Vec3{desc.velocity};
    def.angular_velocity = Vec3{desc.angular_velocity};
    def.locked = desc.locked;
    def.gravity_scale = static_cast<Real>(desc.gravity_scale);
    def.linear_damping = static_cast<Real>(desc.linear_damping);
    def.angular_damping = static_cast<Real>(desc.angular_damping);
    return def;
}

} // namespace plumb::inline PLUMB_PRECISION

// libFuzzer target: any sequence of calls leaves a world valid. The same calls give the same
// states, with threads too; a saved world restores and goes on the same; a refused call changes
// nothing.
#include "engine/core/check.h"
#include "engine/dynamics/world.h"
#include "engine/geometry/quickhull.h"
#include "tests/fuzz/input.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace plumb {
namespace {

constexpr std::size_t most_bodies = 12;
constexpr std::size_t most_particles = 24;
constexpr int most_steps = 24;

class Caller {
  public:
    Caller(const std::uint8_t *data, std::size_t size, TaskPool *tasks)
        : input_(data, size), tasks_(tasks), world_(method(), StepSettings{}) {}

    // A hash of all states along the way.
    std::uint64_t play() {
        while (!input_.is_empty()) {
            const std::uint64_t before = world_.hash();
            try {
                call();
            } catch (const CheckFailure &) {
                FUZZ_ASSERT(world_.hash() == before);
            }
            seen_.add(world_.hash());
        }
        return seen_.value();
    }

  private:
    std::string_view method() {
        return methods()[input_.below(static_cast<std::uint32_t>(methods().size()))].info.name;
    }
    // Occasionally one that is dead or never existed.
    BodyId body() {
        return ids_.empty() ? BodyId{}
                            : ids_[input_.below(static_cast<std::uint32_t>(ids_.size()))];
    }
    JointId joint() {
        return joints_.empty() ? JointId{}
                               : joints_[input_.below(static_cast<std::uint32_t>(joints_.size()))];
    }

    void call() {
        switch (input_.below(24)) {
        case 0:
        case 1:
        case 2:
            add();
            break;
        case 3:
            world_.remove_body(body());
            break;
        case 4:
            world_.set_motion(body(), {input_.point(), input_.rotation()}, input_.point(),
                              input_.point());
            break;
        case 5:
            world_.apply_impulse(body(), input_.point(), input_.point());
            break;
        case 6:
            join();
            break;
        case 7:
            world_.remove_joint(joint());
            break;
        case 8:
            world_.grab(body(), input_.point(), input_.point(), input_.number(), pull());
            break;
        case 9:
            world_.move_grab(input_.point());
            break;
        case 10:
            world_.release();
            break;
        case 11:
            world_.set_method(method());
            break;
        case 12:
            set();
            break;
        case 13:
            world_.save(saved_);
            saved_hash_ = world_.hash();
            break;
        case 14:
            if (saved_.model) {
                world_.restore(saved_);
                FUZZ_ASSERT(world_.hash() == saved_hash_);
            }
            break;
        case 15:
        case 16:
            add_particle();
            break;
        case 17:
            add_spring();
            break;
        case 18:
            world_.set_particle(particle(), input_.point(), input_.point());
            break;
        case 19:
            world_.grab_particle(particle(), input_.point(), input_.number(), pull());
            break;
        default:
            step();
            break;
        }
    }

    std::uint32_t particle() {
        return input_.below(static_cast<std::uint32_t>(world_.model().particles.size()) + 1);
    }
    GrabSpring pull() {
        if (input_.below(2) == 0)
            return {};
        const auto frequency = static_cast<double>(input_.number());
        return {frequency, static_cast<double>(input_.number())};
    }

    void add_particle() {
        if (world_.model().particles.size() >= most_particles)
            return;
        ParticleDef def;
        def.position = input_.point();
        def.velocity = input_.point();
        def.mass = input_.size();
        def.radius = input_.size();
        def.pinned = input_.below(4) == 0;
        world_.add_particle(def);
    }

    SpringEnd spring_end() {
        switch (input_.below(4)) {
        case 0:
            return {SpringEnd::Kind::world, 0, input_.point()};
        case 1:
            return {SpringEnd::Kind::body, body().index, input_.point()};
        default:
            return {SpringEnd::Kind::particle, particle(), Vec3{Real(0)}};
        }
    }
    void add_spring() {
        if (world_.model().springs.size() >= 2 * most_particles)
            return;
        SpringDef def;
        def.a = spring_end();
        def.b = spring_end();
        def.rest_length = input_.number();
        def.stiffness = input_.number();
        def.damping = input_.number();
        def.tear_strain = input_.below(2) == 0 ? Real(0) : input_.size();
        world_.add_spring(def);
    }

    void add() {
        if (world_.model().alive_bodies >= most_bodies)
            return;
        BodyDef def;
        def.kind = static_cast<BodyKind>(input_.below(3));
        for (std::uint32_t i = 1 + input_.below(3); i > 0; --i) {
            ColliderDef &collider = def.colliders.emplace_back();
            give_shape(collider, def.kind);
            collider.sensor = input_.below(8) == 0;
            collider.material.restitution = static_cast<Real>(input_.below(3)) / 2;
            collider.filter = {input_.below(3), input_.below(8)};
        }
        if (input_.below(2) == 0)
            def.mass = input_.size();
        def.pose = {input_.point(), input_.rotation()};
        def.velocity = input_.point();
        def.angular_velocity = input_.point();
        for (bool &axis : def.locked)
            axis = input_.below(8) == 0;
        def.linear_damping = input_.below(4) == 0 ? input_.number() : Real(0);
        def.angular_damping = input_.below(4) == 0 ? input_.number() : Real(0);
        if (def.kind == BodyKind::dynamic && input_.below(4) == 0) {
            def.force = input_.point();
            def.torque = input_.point();
        }
        def.gravity_scale = input_.below(4) == 0 ? input_.number() : Real(1);
        if (input_.below(8) == 0)
            def.center_of_mass = input_.point();
        ids_.push_back(world_.add_body(def));
    }

    void give_shape(ColliderDef &collider, BodyKind kind) {
        switch (input_.below(8)) {
        case 0:
            give_hull(collider);
            break;
        case 1:
            if (kind == BodyKind::dynamic && input_.below(8) != 0)
                give_hull(collider);
            else
                give_surface(collider);
            break;
        default:
            collider.shape = shape();
            break;
        }
    }
    void give_hull(ColliderDef &collider) {
        std::vector<Vec3> points;
        for (std::uint32_t i = 4 + input_.below(12); i > 0; --i)
            points.push_back(input_.point());
        HullResult hull = convex_hull(points, 32);
        if (!hull.mesh)
            return;
        collider.hull = std::make_shared<const HullMesh>(std::move(*hull.mesh));
        const Vec3 at = input_.below(2) == 0 ? Vec3{Real(0)} : input_.point();
        collider.shape = ConvexHull{collider.hull.get(), at, input_.rotation()};
    }
    void give_surface(ColliderDef &collider) {
        const auto sides = static_cast<Sides>(input_.below(3));
        if (input_.below(2) == 0) {
            HeightField field;
            field.rows = 2 + static_cast<int>(input_.below(3));
            field.columns = 2 + static_cast<int>(input_.below(3));
            field.spacing = input_.size();
            field.origin = input_.point();
            for (int i = field.rows * field.columns; i > 0; --i)
                field.heights.push_back(input_.number());
            collider.surface = std::make_shared<const TriangleSurface>(std::move(field), sides);
        } else {
            TriangleMesh mesh;
            for (std::uint32_t i = 3 + input_.below(6); i > 0; --i)
                mesh.vertices.push_back(input_.point());
            const auto corner = [&] { return input_.below(std::uint32_t(mesh.vertices.size())); };
            for (std::uint32_t i = 1 + input_.below(8); i > 0; --i) {
                const std::uint32_t a = corner(), b = corner();
                mesh.triangles.push_back({a, b, corner()});
            }
            collider.surface = std::make_shared<const TriangleSurface>(std::move(mesh), sides);
        }
        if (input_.below(2) == 0)
            collider.surface_pose = {input_.point(), input_.rotation()};
    }

    Shape shape() {
        const Vec3 at = input_.point();
        switch (input_.below(5)) {
        case 0:
            return Sphere{at, input_.size()};
        case 1:
            return Box{at, input_.rotation(), Vec3{input_.size(), input_.size(), input_.size()}};
        case 2:
            return Capsule{at, input_.point(), input_.size()};
        case 3:
            return Cylinder{at, at + Vec3{0, input_.size(), 0}, input_.size()};
        default:
            return HalfSpace{input_.rotation() * Vec3{0, 1, 0}, input_.number()};
        }
    }

    void join() {
        JointDef def;
        def.type = static_cast<JointType>(input_.below(5));
        def.a = input_.below(4) == 0 ? BodyId{} : body();
        def.b = body();
        def.anchor_a_local = input_.point();
        def.anchor_b_local = input_.point();
        def.frame_a_local = input_.rotation();
        def.frame_b_local = input_.below(2) == 0 ? def.frame_a_local : input_.rotation();
        def.max_length = input_.number();
        def.min_length = input_.below(3) == 0   ? Real(0)
                         : input_.below(2) == 0 ? def.max_length
                                                : input_.number();
        if (input_.below(2) == 0)
            def.limits = {input_.number(), input_.number()};
        if (input_.below(2) == 0)
            def.motor = {input_.number(), input_.number()};
        def.frequency = input_.below(2) == 0 ? Real(0) : input_.number();
        def.damping_ratio = input_.below(2) == 0 ? Real(1) : input_.number();
        def.collide_connected = input_.below(2) == 0;
        def.break_force = input_.below(4) == 0 ? input_.size() : Real(0);
        joints_.push_back(world_.add_joint(def));
    }

    void set() {
        StepSettings settings = world_.settings();
        settings.substeps = 1 + static_cast<int>(input_.below(4));
        settings.iterations = 1 + static_cast<int>(input_.below(4));
        settings.dt = input_.below(4) == 0 ? static_cast<double>(input_.number()) : 1.0 / 60;
        settings.speculative_distance = input_.below(4) == 0 ? 0.5 : 0.02;
        settings.max_substeps = input_.below(2) == 0 ? 1 : 1 + static_cast<int>(input_.below(40));
        settings.sleep_after = input_.below(2) == 0 ? 0 : 0.05;
        settings.substep_tolerance = input_.below(2) == 0 ? 3e-4 : 0.5;
        if (input_.below(4) == 0)
            settings.gravity = glm::dvec3{input_.point()};
        // Any setting, at either end of its range or anything else.
        if (input_.below(2) == 0) {
            const std::span<const SettingNumber> all = setting_numbers();
            const SettingNumber number = all[input_.below(static_cast<std::uint32_t>(all.size()))];
            const SettingRow &row = number.setting();
            // A step of ten thousand substeps is too slow.
            const bool is_dear = is_whole(row) && row.max > 100;
            const double value = input_.below(3) == 0   ? row.min
                                 : is_dear              ? input_.below(16)
                                 : input_.below(2) == 0 ? row.max
                                                        : static_cast<double>(input_.number());
            if (!is_whole(row) || value == std::floor(value))
                if (std::abs(value) <= 1e9)
                    set_setting(settings, number, value);
        }
        world_.set_settings(settings);
    }

    // A step taken twice from the same state gives the same result.
    void step() {
        if (++steps_ > most_steps)
            return;
        SavedWorld before;
        world_.save(before);
        world_.step(tasks_);
        const std::uint64_t after = world_.hash();
        world_.restore(before);
        world_.step(tasks_);
        FUZZ_ASSERT(world_.hash() == after);
        FUZZ_ASSERT(world_.step_count() == before.state.clock.step_count + 1);
        for (const Contact &contact : world_.contacts())
            FUZZ_ASSERT(contact.key.a < contact.key.b && contact.manifold.count >= 1 &&
                        contact.manifold.count <= 4);
        (void)world_.measure();
    }

    FuzzInput input_;
    TaskPool *tasks_;
    World world_;
    std::vector<BodyId> ids_; // every body ever created
    std::vector<JointId> joints_;
    SavedWorld saved_;
    std::uint64_t saved_hash_ = 0;
    int steps_ = 0;
    StateHash seen_;
};

} // namespace
} // namespace plumb

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    using namespace plumb;
    static TaskPool tasks(3);
    const std::uint64_t alone = Caller(data, size, nullptr).play();
    FUZZ_ASSERT(Caller(data, size, &tasks).play() == alone); // the replay
    return 0;
}

// libFuzzer target: any sequence of calls leaves a world sound. The same calls give the same
// states, with threads too; what was saved comes back and goes on the same; a call that is refused
// changes nothing.
#include "engine/core/check.h"
#include "engine/dynamics/world.h"
#include "tests/fuzz/input.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace plumb {
namespace {

constexpr std::size_t most_bodies = 12;
constexpr int most_steps = 24;

class Caller {
  public:
    Caller(const std::uint8_t *data, std::size_t size, TaskPool *tasks)
        : input_(data, size), tasks_(tasks), world_(method(), StepSettings{}) {}

    // Of all states on the way.
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
    // Now and then one that is no longer alive, or never was.
    BodyId body() {
        return ids_.empty() ? BodyId{}
                            : ids_[input_.below(static_cast<std::uint32_t>(ids_.size()))];
    }
    JointId joint() {
        return joints_.empty() ? JointId{}
                               : joints_[input_.below(static_cast<std::uint32_t>(joints_.size()))];
    }

    void call() {
        switch (input_.below(16)) {
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
            world_.grab(body(), input_.point(), input_.point(), input_.number());
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
        default:
            step();
            break;
        }
    }

    void add() {
        if (world_.model().alive_bodies >= most_bodies)
            return;
        BodyDef def;
        def.kind = static_cast<BodyKind>(input_.below(3));
        for (std::uint32_t i = 1 + input_.below(2); i > 0; --i) {
            ColliderDef &collider = def.colliders.emplace_back();
            collider.shape = shape();
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
        ids_.push_back(world_.add_body(def));
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
        def.max_length = input_.number();
        if (input_.below(2) == 0)
            def.limits = {input_.number(), input_.number()};
        if (input_.below(2) == 0)
            def.motor = {input_.number(), input_.number()};
        def.frequency = input_.below(2) == 0 ? Real(0) : input_.number();
        def.break_force = input_.below(4) == 0 ? input_.size() : Real(0);
        joints_.push_back(world_.add_joint(def));
    }

    void set() {
        StepSettings settings = world_.settings();
        settings.substeps = 1 + static_cast<int>(input_.below(4));
        settings.iterations = 1 + static_cast<int>(input_.below(4));
        settings.dt = input_.below(4) == 0 ? static_cast<double>(input_.number()) : 1.0 / 60;
        settings.speculative_distance = input_.below(4) == 0 ? 0.5 : 0.02;
        world_.set_settings(settings);
    }

    // Taken twice from the same state, a step is the same step.
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
        for (const Contact &contact : world_.contacts())
            FUZZ_ASSERT(contact.key.a < contact.key.b && contact.manifold.count >= 1 &&
                        contact.manifold.count <= 4);
        (void)world_.measure();
    }

    FuzzInput input_;
    TaskPool *tasks_;
    World world_;
    std::vector<BodyId> ids_; // all that there ever were
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

// libFuzzer target: any scene, and any commands during its run. A refused command or step changes
// nothing; a recording replays to the same hashes, also through a file and from mid-run; a scene
// written in mid-run goes on as the run does.
#include "engine/core/check.h"
#include "engine/scene/recording.h"
#include "engine/scene/scene_file.h"
#include "tests/fuzz/input.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace plumb {
namespace {

constexpr std::size_t most_bodies = 12;
constexpr int most_steps = 20;
constexpr int steps_beside = 3;

// A written file reads without errors.
template <typename Result> void check_read(const Result &read, const std::string &text) {
    if (read.ok())
        return;
    std::cerr << text << format_message("fuzz.toml", read.messages.front()) << '\n';
    FUZZ_ASSERT(false);
}

class Run {
  public:
    Run(const std::uint8_t *data, std::size_t size, TaskPool *tasks)
        : input_(data, size), tasks_(tasks) {}

    void play() {
        const std::string text = write_scene(scene());
        const SceneFileResult read = parse_scene(text, "fuzz.toml");
        if (!read.ok()) // a hull without volume, say
            return;
        FUZZ_ASSERT(write_scene(read.scene) == text);
        try {
            simulation_ = Simulation::create(read.scene, {}, tasks_);
        } catch (const std::invalid_argument &) {
            return;
        }
        const std::uint32_t record_from = input_.below(8);
        while (!input_.is_empty()) {
            if (!recorder_ && steps_ >= static_cast<int>(record_from) && can_be_written())
                recorder_.emplace(*simulation_);
            act();
        }
        if (recorder_)
            replay();
    }

  private:
    double number() { return static_cast<double>(input_.number()); }
    double size() { return static_cast<double>(input_.size()); }
    glm::dvec3 point() { return glm::dvec3{input_.point()}; }
    glm::dquat rotation() { return glm::normalize(glm::dquat{input_.rotation()}); }
    std::string method() {
        const auto all = method_infos();
        // The first ones support everything.
        const std::size_t count = input_.below(4) == 0 ? all.size() : 6;
        return std::string(all[input_.below(static_cast<std::uint32_t>(count))].name);
    }
    // Occasionally one that does not exist.
    std::string body() { return "b" + std::to_string(input_.below(next_body_ + 1)); }

    // ---- the scene

    std::string scene_body() { return "b" + std::to_string(input_.below(next_body_)); }

    ShapeDesc shape(bool is_fixed) {
        switch (input_.below(is_fixed ? 8 : 5)) {
        case 0:
            return SphereDesc{size()};
        case 1: {
            const double x = size(), y = size();
            return BoxDesc{{x, y, size()}};
        }
        case 2: {
            const double half_height = size();
            return CapsuleDesc{half_height, size()};
        }
        case 3: {
            const double half_height = size();
            return CylinderDesc{half_height, size()};
        }
        case 4: {
            std::vector<glm::dvec3> points;
            for (std::uint32_t i = 4 + input_.below(8); i > 0; --i)
                points.push_back(point());
            return HullDesc{std::make_shared<const std::vector<glm::dvec3>>(points), {}};
        }
        case 5:
            return PlaneDesc{};
        case 6: {
            HeightFieldDesc field;
            field.rows = 2 + static_cast<int>(input_.below(3));
            field.columns = 2 + static_cast<int>(input_.below(3));
            field.spacing = size();
            std::vector<double> heights;
            for (int i = field.rows * field.columns; i > 0; --i)
                heights.push_back(number());
            field.heights = std::make_shared<const std::vector<double>>(heights);
            return field;
        }
        default: {
            MeshData mesh;
            for (std::uint32_t i = 3 + input_.below(6); i > 0; --i)
                mesh.vertices.push_back(point());
            const auto corner = [&] { return input_.below(std::uint32_t(mesh.vertices.size())); };
            for (std::uint32_t i = 1 + input_.below(8); i > 0; --i) {
                const std::uint32_t a = corner(), b = corner();
                mesh.triangles.push_back({a, b, corner()});
            }
            MeshDesc desc;
            desc.data = std::make_shared<const MeshData>(std::move(mesh));
            desc.sides = static_cast<MeshSides>(input_.below(3));
            return desc;
        }
        }
    }

    BodyDesc new_body() {
        BodyDesc body;
        body.name = "b" + std::to_string(next_body_++);
        const std::uint32_t kind = input_.below(6);
        body.kind = kind == 0   ? BodyKind::static_body
                    : kind == 1 ? BodyKind::kinematic
                                : BodyKind::dynamic;
        for (std::uint32_t i = 1 + input_.below(2); i > 0; --i) {
            ColliderDesc &collider = body.colliders.emplace_back();
            collider.shape = shape(body.kind == BodyKind::static_body);
            if (input_.below(2) == 0) {
                collider.position = point();
                collider.orientation = rotation();
            }
            collider.sensor = input_.below(8) == 0;
            collider.filter = {static_cast<int>(input_.below(3)), input_.below(8)};
        }
        if (body.kind == BodyKind::dynamic) // from its volume it could exceed a file's limits
            body.mass = size();
        body.position = point();
        body.orientation = rotation();
        if (body.kind != BodyKind::static_body) {
            body.velocity = point();
            body.angular_velocity = point();
        }
        if (body.kind == BodyKind::dynamic)
            for (bool &axis : body.locked)
                axis = input_.below(8) == 0;
        return body;
    }

    JointDesc joint(int index) {
        JointDesc joint;
        joint.name = "j" + std::to_string(index);
        joint.type = static_cast<JointType>(input_.below(5));
        joint.body_b = scene_body();
        if (const std::string other = scene_body(); other != joint.body_b)
            joint.body_a = other;
        joint.anchor_a_local = point();
        joint.anchor_b_local = point();
        if (joint.type == JointType::distance) {
            joint.max_length = size();
            joint.min_length = input_.below(2) == 0 ? joint.max_length : 0;
        }
        const bool turns = joint.type == JointType::hinge || joint.type == JointType::slider;
        if (turns || joint.type == JointType::fixed) {
            joint.frame_a_local = rotation();
            joint.frame_b_local = joint.frame_a_local;
        }
        if (turns && input_.below(2) == 0)
            joint.limits = {-0.5, 0.25 * input_.below(4)};
        if (turns && input_.below(2) == 0) {
            joint.motor_speed = number();
            joint.max_motor_force = size();
        }
        if (input_.below(3) == 0)
            joint.frequency = size();
        if (input_.below(4) == 0)
            joint.break_force = size();
        joint.collide_connected = input_.below(2) == 0;
        return joint;
    }

    SceneDesc scene() {
        SceneDesc scene;
        scene.name = "fuzz";
        scene.world.method = method();
        scene.world.precision = input_.below(3) == 0 ? Precision::f64 : Precision::f32;
        for (std::uint32_t i = 1 + input_.below(5); i > 0; --i)
            scene.bodies.push_back(new_body());
        for (int i = static_cast<int>(input_.below(4)); i > 0; --i)
            scene.joints.push_back(joint(i));
        const std::uint32_t particles = input_.below(2) == 0 ? 0 : input_.below(5);
        for (std::uint32_t i = 0; i < particles; ++i) {
            ParticleDesc particle;
            particle.name = "p" + std::to_string(i);
            particle.position = point();
            particle.mass = size();
            particle.pinned = input_.below(4) == 0;
            if (!particle.pinned)
                particle.velocity = point();
            scene.particles.push_back(particle);
        }
        for (std::uint32_t i = 0; i < particles; ++i) {
            SpringDesc spring;
            spring.name = "s" + std::to_string(i);
            spring.a = "p" + std::to_string(i);
            if (input_.below(2) == 0 && i > 0)
                spring.b = "p" + std::to_string(i - 1);
            else if (input_.below(2) == 0)
                spring.b = scene_body();
            if (spring.b.empty() || spring.b[0] == 'b')
                spring.anchor_b_local = point();
            spring.rest_length = size();
            spring.stiffness = size();
            spring.damping = size();
            spring.tear_strain = input_.below(2) == 0 ? 0 : size();
            scene.springs.push_back(spring);
        }
        if (input_.below(4) == 0) {
            ClothDesc cloth;
            cloth.name = "sheet";
            cloth.position = point();
            cloth.orientation = rotation();
            cloth.cells = {2, 2};
            cloth.tear_strain = input_.below(2) == 0 ? 0 : 0.1;
            if (input_.below(2) == 0)
                cloth.pins = {0, 2};
            scene.cloths.push_back(cloth);
        }
        return scene;
    }

    // ---- the run

    void obey(const Command &command) {
        const std::uint64_t before = simulation_->hash();
        try {
            simulation_->apply(command);
        } catch (const std::invalid_argument &) {
            FUZZ_ASSERT(simulation_->hash() == before);
            return;
        }
        if (recorder_)
            recorder_->add(*simulation_, command);
    }

    Command command() {
        switch (input_.below(11)) {
        case 10: {
            if (input_.below(3) == 0)
                return RemoveJoint{input_.below(2) == 0 ? "j0" : "added"};
            JointDesc joint;
            joint.name = "added";
            joint.type = static_cast<JointType>(input_.below(5));
            joint.body_b = body();
            joint.anchor_a_local = point();
            joint.anchor_b_local = point();
            joint.max_length = size();
            return AddJoint{joint};
        }
        case 0:
        case 1:
            return AddBody{new_body()};
        case 2:
            return RemoveBody{body()};
        case 3: {
            SetMotion motion{body(), point(), rotation(), point(), {}};
            motion.angular_velocity = point();
            return motion;
        }
        case 4: {
            ApplyImpulse push{body(), point(), {}};
            push.point = point();
            return push;
        }
        case 5: {
            GrabBody grab{body(), point(), {}, 0, {}};
            grab.target = point();
            grab.max_force = number();
            return grab;
        }
        case 6: {
            GrabParticle grab{input_.below(2) == 0 ? "sheet[1,1]" : "p1", point(), 0, {}};
            grab.max_force = number();
            return grab;
        }
        case 7:
            if (input_.below(2) == 0)
                return MoveGrab{point()};
            return ReleaseGrab{};
        case 8:
            return SetMethod{method()};
        default: {
            GivenSettings given;
            given.give(&StepSettings::substeps, 1 + static_cast<int>(input_.below(4)));
            if (input_.below(2) == 0)
                given.give(&StepSettings::max_substeps, 1 + static_cast<int>(input_.below(32)));
            if (input_.below(2) == 0)
                given.give(&StepSettings::sleep_after, input_.below(2) == 0 ? 0.05 : 0);
            if (input_.below(2) == 0)
                given.give(&StepSettings::substep_tolerance, 0.5);
            if (input_.below(4) == 0)
                given.give(&StepSettings::gravity, point());
            if (input_.below(8) == 0)
                given.give(&StepSettings::dt, number());
            return SetSettings{given};
        }
        }
    }

    void step() {
        if (++steps_ > most_steps)
            return;
        if (input_.below(4) == 0 && recorder_)
            saved_ = simulation_->save();
        if (recorder_)
            recorder_->before_step(*simulation_);
        const std::uint64_t before = simulation_->hash();
        try {
            simulation_->step();
        } catch (const CheckFailure &) {
            FUZZ_ASSERT(simulation_->hash() == before);
            saved_.reset(); // no step has followed it
        }
    }

    void act() {
        switch (input_.below(16)) {
        case 0:
        case 1:
        case 2:
        case 3:
        case 4:
        case 5:
            obey(command());
            break;
        case 6:
            if (saved_) {
                simulation_->restore(*saved_);
                recorder_->went_back(*simulation_);
                saved_.reset(); // another step may follow it now
            }
            break;
        case 7:
            write_and_go_on();
            break;
        default:
            step();
            break;
        }
    }

    // Files only hold values within the scene limits.
    bool can_be_written() const {
        const auto is_small = [](const glm::dvec3 &v) {
            return std::abs(v.x) < 1e8 && std::abs(v.y) < 1e8 && std::abs(v.z) < 1e8;
        };
        const Frame frame = simulation_->read();
        return std::ranges::all_of(frame.bodies,
                                   [&](const BodyState &state) {
                                       return is_small(state.position) &&
                                              is_small(state.velocity) &&
                                              is_small(state.angular_velocity);
                                   }) &&
               std::ranges::all_of(frame.particles, [&](const ParticleState &state) {
                   return is_small(state.position) && is_small(state.velocity);
               });
    }

    // The hash after a few more steps.
    static std::uint64_t later(Simulation &simulation) {
        for (int i = 0; i < steps_beside; ++i)
            try {
                simulation.step();
            } catch (const CheckFailure &) {
                break;
            }
        return simulation.hash();
    }

    void write_and_go_on() {
        if (!can_be_written() || ++written_ > 3)
            return;
        const std::string text = write_scene(simulation_->describe());
        const SceneFileResult read = parse_scene(text, "fuzz.toml");
        check_read(read, text);
        FUZZ_ASSERT(write_scene(read.scene) == text);
        const auto again = Simulation::create(read.scene, {}, nullptr);
        FUZZ_ASSERT(again->hash() == simulation_->hash());
        const auto now = simulation_->save();
        const std::uint64_t expected = later(*simulation_);
        simulation_->restore(*now);
        FUZZ_ASSERT(later(*again) == expected);
    }

    void replay() {
        const Recording recording = recorder_->recording(*simulation_);
        const std::string text = write_recording(recording);
        const RecordingResult read = parse_recording(text, "fuzz.toml");
        check_read(read, text);
        FUZZ_ASSERT(write_recording(read.recording) == text);
        const auto again = Simulation::create(read.recording.scene, {}, nullptr);
        Replay replay(read.recording);
        for (;; again->step()) {
            FUZZ_ASSERT(replay.obey(*again));
            if (replay.is_at_end(*again))
                break;
        }
        FUZZ_ASSERT(again->hash() == simulation_->hash());
    }

    FuzzInput input_;
    TaskPool *tasks_;
    std::unique_ptr<Simulation> simulation_;
    std::optional<Recorder> recorder_;
    std::unique_ptr<Simulation::Saved> saved_;
    std::uint32_t next_body_ = 0;
    int steps_ = 0, written_ = 0;
};

} // namespace
} // namespace plumb

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    static plumb::TaskPool tasks(3);
    plumb::Run(data, size, &tasks).play();
    return 0;
}

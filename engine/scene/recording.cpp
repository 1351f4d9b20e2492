#include "engine/scene/recording.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <variant>

namespace plumb {

namespace {

// Takes the slot of a removed body and collides with nothing.
BodyDesc placeholder(const std::string &name) {
    BodyDesc body;
    body.name = name;
    body.kind = BodyKind::static_body;
    ColliderDesc &collider = body.colliders.emplace_back();
    collider.shape = SphereDesc{0.5};
    collider.sensor = true;
    return body;
}

// The same for a removed joint; it goes with the placeholder that it holds.
JointDesc placeholder_joint(const std::string &name, const std::string &body) {
    JointDesc joint;
    joint.name = name;
    joint.body_b = body;
    return joint;
}

} // namespace

void check_readable(const Command &command, const std::vector<MaterialDesc> &materials) {
    Recording alone;
    alone.scene.materials = materials;
    alone.hashes.push_back(0);
    alone.commands.push_back({0, command, 0});
    if (auto *add = std::get_if<AddBody>(&alone.commands.front().command)) {
        for (ColliderDesc &collider : add->body.colliders) {
            if (!is_complete(collider.shape))
                throw std::invalid_argument("a shape of \"" + add->body.name + "\" has no points");
            forget_file(collider.shape); // reading must not look for it
        }
    }
    const RecordingResult read = parse_recording(write_recording(alone), "command");
    if (!read.ok())
        throw std::invalid_argument(read.messages.front().what);
}

// Added bodies and joints fill the holes left by removed ones, which changes the solver's order.
// Scenes have no holes, so the recording recreates them: it adds placeholders and removes them
// again.
Recorder::Recorder(const Simulation &simulation) {
    recording_.scene = simulation.describe();
    std::vector<BodyDesc> &bodies = recording_.scene.bodies;
    for (std::size_t i = 0; i < simulation.body_count(); ++i) {
        if (simulation.body_info(i).alive)
            continue;
        const std::string name = simulation.free_name("removed_" + std::to_string(i));
        bodies.insert(bodies.begin() + static_cast<std::ptrdiff_t>(i), placeholder(name));
        recording_.commands.push_back({recording_.first_step(), RemoveBody{name}, 0});
    }
    const bool has_joint_holes = add_joint_placeholders(simulation);
    if (recording_.commands.empty())
        return;
    // A method without contacts or joints would refuse the scene with placeholders, though not what
    // remains.
    const MethodInfo &method = simulation.method();
    if (!method.contacts || (has_joint_holes && !method.joints)) {
        const WorldDesc other;
        set_run(recording_.scene.world, *find_method_info(other.method), simulation.settings());
        recording_.commands.push_back(
            {recording_.first_step(), SetMethod{std::string(method.name)}, 0});
    }
}

// All hold one body, so that removing it wakes nothing else. If no body's hole is to be filled, one
// after the last body is: there a new body would go anyway. Returns whether there are any.
bool Recorder::add_joint_placeholders(const Simulation &simulation) {
    std::vector<JointDesc> &joints = recording_.scene.joints;
    std::string body;
    for (std::size_t i = 0; i < simulation.joint_count(); ++i) {
        if (simulation.joint(i) != nullptr)
            continue;
        if (body.empty()) {
            if (recording_.commands.empty()) {
                const std::string name = simulation.free_name("removed");
                recording_.scene.bodies.push_back(placeholder(name));
                recording_.commands.push_back({recording_.first_step(), RemoveBody{name}, 0});
            }
            body = std::get<RemoveBody>(recording_.commands.front().command).body;
        }
        std::string name = "removed_" + std::to_string(i);
        while (std::ranges::find(joints, name, &JointDesc::name) != joints.end())
            name += '_';
        joints.insert(joints.begin() + static_cast<std::ptrdiff_t>(i),
                      placeholder_joint(name, body));
    }
    return !body.empty();
}

void Recorder::add(const Simulation &simulation, const Command &command) {
    recording_.commands.push_back({simulation.step_count(), command, 0});
}

void Recorder::before_step(const Simulation &simulation) {
    // A step that failed has already left a hash.
    forget_after(simulation.step_count());
    recording_.hashes.push_back(simulation.hash());
}

void Recorder::went_back(const Simulation &simulation) {
    forget_after(simulation.step_count());
}

void Recorder::forget_after(std::uint64_t step) {
    std::erase_if(recording_.commands,
                  [step](const RecordedCommand &command) { return command.step > step; });
    recording_.hashes.resize(
        std::min<std::size_t>(recording_.hashes.size(), step - recording_.first_step()));
}

Recording Recorder::recording(const Simulation &simulation) const {
    Recording whole = recording_;
    whole.hashes.resize(simulation.step_count() - recording_.first_step());
    whole.hashes.push_back(simulation.hash());
    return whole;
}

std::string hash_text(std::uint64_t hash) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    for (int shift = 60; shift >= 0; shift -= 4)
        text += digits[hash >> static_cast<unsigned>(shift) & 15U];
    return text;
}

bool RecordingResult::ok() const {
    return std::ranges::none_of(messages, [](const SceneMessage &message) {
        return message.severity == SceneMessage::Severity::error;
    });
}

bool Replay::obey(Simulation &simulation) {
    for (; next_ < recording_.commands.size() &&
           recording_.commands[next_].step <= simulation.step_count();
         ++next_)
        try {
            simulation.apply(recording_.commands[next_].command);
        } catch (const std::invalid_argument &error) {
            throw CommandFailure(recording_.commands[next_], error.what());
        }
    const std::uint64_t state = simulation.step_count() - recording_.first_step();
    return state >= recording_.hashes.size() || simulation.hash() == recording_.hashes[state];
}

std::string Replay::difference(const Simulation &simulation) const {
    const std::uint64_t step = simulation.step_count();
    return "the replay first differs at step " + std::to_string(step) + ": recorded " +
           hash_text(recording_.hashes.at(step - recording_.first_step())) + ", now " +
           hash_text(simulation.hash());
}

void Replay::went_back(const Simulation &simulation) {
    const auto later = std::ranges::upper_bound(recording_.commands, simulation.step_count(), {},
                                                &RecordedCommand::step);
    next_ = static_cast<std::size_t>(later - recording_.commands.begin());
}

} // namespace plumb

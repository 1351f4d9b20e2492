// A run as a scene and the commands that followed, with a hash of every state: a replay gives the
// same states bit for bit. The file format is described in scenes/README.md.
#pragma once

#include "engine/scene/command.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/simulation.h"

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

struct RecordedCommand {
    std::uint64_t step = 0; // steps taken before it
    Command command;
    std::size_t line = 0; // in the recording's file, if it was read from one
};

// Hashes are of the state at the start and after each step, including the commands at that step.
struct Recording {
    SceneDesc scene; // at the start, in full: method, settings, precision and state
    std::vector<RecordedCommand> commands; // in the order given
    std::vector<std::uint64_t> hashes;     // at least one
    std::uint64_t first_step() const { return scene.step_count; }
    std::uint64_t last_step() const { return first_step() + hashes.size() - 1; }
};

// Records what is done to a simulation. It must be told about every command, step and restore.
class Recorder {
  public:
    // Starts recording from the current state.
    explicit Recorder(const Simulation &simulation);

    // Call after a command has been executed.
    void add(const Simulation &simulation, const Command &command);
    // Call before each step; one that throws does not count.
    void before_step(const Simulation &simulation);
    // Call after restoring an earlier state, saved just before the step that followed it;
    // everything recorded after it is dropped.
    void went_back(const Simulation &simulation);

    // Up to the current state.
    Recording recording(const Simulation &simulation) const;

  private:
    bool add_joint_placeholders(const Simulation &simulation);
    void forget_after(std::uint64_t step);

    Recording recording_; // with hashes of all states but the current one
};

struct RecordingResult {
    Recording recording;                // complete only when ok()
    std::vector<SceneMessage> messages; // in the order of the file
    bool ok() const;                    // no message is an error
};

// Like parse_scene and load_scene, with the same messages about the scene. A scene without a
// recording is an error.
RecordingResult parse_recording(std::string_view text, const std::string &path);
RecordingResult load_recording(const std::filesystem::path &path);

// Like write_scene; files used by the scene are written by name only.
std::string write_recording(const Recording &recording);

// Throws std::invalid_argument, with the reader's message, if a file could not give the command
// back: a value out of range, a name that no body may have, a body with both mass and density.
// `materials`: the scene's. Bodies and joints that it names need not exist.
void check_readable(const Command &command, const std::vector<MaterialDesc> &materials);

// A state's hash as 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

// A recorded command that cannot be executed.
struct CommandFailure : std::invalid_argument {
    CommandFailure(const RecordedCommand &command, const std::string &what)
        : std::invalid_argument(what), line(command.line) {}
    std::size_t line;
};

// Replays a recording on a simulation created from its scene.
class Replay {
  public:
    // The recording must outlive it.
    explicit Replay(const Recording &recording) : recording_(recording) {}

    // Applies the commands recorded at the simulation's current step and compares hashes. False
    // when the state differs from the recorded one. Throws CommandFailure.
    bool obey(Simulation &simulation);
    // "the replay first differs at step 12: recorded 1f…, now 2e…"; call after `obey` returned
    // false.
    std::string difference(const Simulation &simulation) const;
    // Call after restoring an earlier state that was saved after `obey`.
    void went_back(const Simulation &simulation);
    // How many of the recording's commands have been applied.
    std::size_t given() const { return next_; }
    bool is_at_end(const Simulation &simulation) const {
        return simulation.step_count() >= recording_.last_step();
    }

  private:
    const Recording &recording_;
    std::size_t next_ = 0; // command
};

} // namespace plumb

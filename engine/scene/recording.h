// A run as a scene and the commands that followed, with a hash of every state: replayed, it gives
// the same states to the bit. The file's format is described in scenes/README.md.
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
    std::uint64_t step = 0; // how many steps had been taken
    Command command;
    std::size_t line = 0; // in the recording's file, if it was read from one
};

// Of the state at the start and after each step, the commands at that step included.
struct Recording {
    SceneDesc scene; // at the start, in full: method, settings, precision and state
    std::vector<RecordedCommand> commands; // in the order in which they were given
    std::vector<std::uint64_t> hashes;     // one at least
    std::uint64_t first_step() const { return scene.step_count; }
    std::uint64_t last_step() const { return first_step() + hashes.size() - 1; }
};

// Writes down what is done to a simulation, which must be told of all of it.
class Recorder {
  public:
    // A run that starts from the present state.
    explicit Recorder(const Simulation &simulation);

    // The command has been obeyed.
    void add(const Simulation &simulation, const Command &command);
    // A step is about to be taken, and has been if it did not throw.
    void before_step(const Simulation &simulation);
    // An earlier state has been restored: it was saved just before the step that followed it, and
    // what came after it is forgotten.
    void went_back(const Simulation &simulation);

    // Up to the present state.
    Recording recording(const Simulation &simulation) const;

  private:
    void forget_after(std::uint64_t step);

    Recording recording_; // the hashes of all states but the present one
};

struct RecordingResult {
    Recording recording;                // complete only when ok()
    std::vector<SceneMessage> messages; // in the order of the file
    bool ok() const;                    // no message is an error
};

// As parse_scene and load_scene, of which they take over what is said of scenes. A scene without a
// recording is an error.
RecordingResult parse_recording(std::string_view text, const std::string &path);
RecordingResult load_recording(const std::filesystem::path &path);

// As write_scene. Of files that the scene names, the names are written.
std::string write_recording(const Recording &recording);

// A state's hash as 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

// A command of a recording that cannot be obeyed.
struct CommandFailure : std::invalid_argument {
    CommandFailure(const RecordedCommand &command, const std::string &what)
        : std::invalid_argument(what), line(command.line) {}
    std::size_t line;
};

// Takes a recording's way through a simulation that was made of its scene.
class Replay {
  public:
    // The recording must outlive it.
    explicit Replay(const Recording &recording) : recording_(recording) {}

    // Gives the simulation the commands that were given at its present step, and compares. False
    // when the state is not the one that was recorded. Throws CommandFailure.
    bool obey(Simulation &simulation);
    // "the replay first differs at step 12: recorded 1f…, now 2e…", after `obey` was false.
    std::string difference(const Simulation &simulation) const;
    // An earlier state has been restored, as it was after `obey`.
    void went_back(const Simulation &simulation);
    // How many of the recording's commands have been given.
    std::size_t given() const { return next_; }
    bool is_at_end(const Simulation &simulation) const {
        return simulation.step_count() >= recording_.last_step();
    }

  private:
    const Recording &recording_;
    std::size_t next_ = 0; // command
};

} // namespace plumb

// The running scene: opened, stepped, taken back, changed and saved.
#pragma once

#include "app/files/output_file.h"
#include "app/lab/exit_code.h"
#include "app/lab/run/expectation_watch.h"
#include "app/lab/run/scene_text.h"
#include "app/sandbox/draw/pose_blend.h"
#include "app/sandbox/messages.h"
#include "app/sandbox/session/history.h"
#include "app/sandbox/session/run_trouble.h"
#include "app/sandbox/studies/ghost.h"
#include "app/sandbox/studies/graphs.h"
#include "app/sandbox/studies/plots.h"
#include "engine/core/task_pool.h"
#include "engine/scene/probe.h"
#include "engine/scene/recording.h"
#include "engine/scene/scene_desc.h"
#include "engine/scene/simulation.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// One value per step.
struct SessionGraphs {
    Graph find_pairs, collide, advance, finish; // s of wall time
    Graph energy;                               // J
};

// A recent impact.
struct SeenImpact {
    ImpactView impact;
    double age = 0; // s, since the end of its step
};

// Nothing here throws because of a scene, a file or a setting: errors go to messages(), and
// whatever was running goes on.
class Session {
  public:
    using Make = std::function<std::unique_ptr<Simulation>(const SceneDesc &, const RunOptions &,
                                                           TaskPool *)>;
    // `options` apply to every scene opened. `tasks` may be null and must outlive the session.
    explicit Session(RunOptions options = {}, TaskPool *tasks = nullptr,
                     Make make = &Simulation::create);

    // False, with the reasons in messages(), if the file is not a runnable scene.
    bool open(const std::filesystem::path &path);
    // A scene from elsewhere. `path` is where reload looks, and may be empty. `text` is the scene
    // file's text, if there is one.
    bool open(const SceneDesc &scene, const std::filesystem::path &path = {},
              std::optional<SceneText> text = {});
    // Plays a recording: the following steps repeat what was done in it and compare each state. It
    // cannot be stepped beyond its end unless something else is done to the world; from then on the
    // run is no longer the recorded one.
    bool open_recording(const std::filesystem::path &path);
    // outside_tolerance if a state differed from the recording, bad_input if a command could not be
    // carried out; a message says where.
    [[nodiscard]] ExitCode replay_outcome() const { return replay_outcome_; }
    // Reads the file again. If it is broken, the running scene stays.
    bool reload();
    // Restarts with the current method and settings.
    bool restart();
    // Restarts with the method and settings of the scene and the command line.
    bool restart_as_written();

    [[nodiscard]] bool running() const { return simulation_ != nullptr; }
    // Null without a scene.
    [[nodiscard]] Simulation *simulation() { return simulation_.get(); }
    [[nodiscard]] const Simulation *simulation() const { return simulation_.get(); }
    [[nodiscard]] const SceneDesc &scene() const { return scene_; }
    [[nodiscard]] const std::filesystem::path &path() const { return path_; }
    [[nodiscard]] const RunOptions &options() const { return options_; }

    // One step. False if there is nothing to step or the step failed; then a message says what and
    // where, and the session is stopped.
    bool step();
    // Goes back one remembered step. The state is bit for bit what it was, but the current method
    // and settings stay. False if no more is remembered.
    bool step_back();
    [[nodiscard]] std::size_t steps_remembered() const { return history_.size(); }
    // The last step failed; only stepping back or restarting helps.
    [[nodiscard]] bool stopped() const { return stopped_; }

    // Outcomes so far of the scene's expectations, in its order, judged as `check` would from the
    // start of the run to the current step. Empty for a scene with only probes.
    [[nodiscard]] std::vector<ExpectOutcome> expectations() const;
    // Since when (s) the run has missed this expectation; nullopt if it has not.
    [[nodiscard]] std::optional<double> missed_since(std::size_t expectation) const;
    // How the run failed, see TroubleWatch.
    [[nodiscard]] std::optional<Trouble> trouble() const;
    // Something other than stepping changed the run after its start (another method or setting, a
    // shot, a grab): the expectations then tell what happened, not what `check` would say.
    [[nodiscard]] bool disturbed() const { return disturbed_from_.has_value(); }
    // How a whole run of this scene with the present method and settings fared elsewhere, on a map
    // or chart: a phrase that says how it failed; empty if it held.
    void note_outcome(const std::string &failure);
    // Why the run may not hold as it goes on, in a sentence: its method and settings are noted to
    // have failed, or are not those it started with and not noted to hold. nullopt if neither.
    [[nodiscard]] std::optional<std::string> doubt() const;

    // Switches the method, with the scene's settings for it or else its own defaults.
    bool set_method(std::string_view name);
    bool set_settings(const StepSettings &settings);

    // Text of the running scene, to change numbers in: its file as opened, or, if there is none (a
    // recording counts as none), the scene as it began.
    [[nodiscard]] SceneText scene_text() const;

    // Runs a second simulation with this method beside the first, from the current state. It starts
    // over when the run does, and when the run is taken back to before the ghost existed. Empty: no
    // ghost. False, with a message, if the method cannot run the scene.
    bool set_ghost(const std::string &method);
    // Lets a lagging ghost catch up while nothing is stepped.
    void let_ghost_go_on();
    [[nodiscard]] const Ghost *ghost() const { return ghost_ ? &*ghost_ : nullptr; }

    // Takes effect with the next step. During a grab only the target may change. nullopt releases.
    void grab(const std::optional<GrabView> &grab);
    [[nodiscard]] const std::optional<GrabView> &grabbed() const { return grab_; }
    // The grab in effect: from grab(), the scene as saved, or the recording.
    [[nodiscard]] std::optional<GrabView> held() const;
    // False if nothing is held, or if the grab belongs to the recording.
    bool let_go();
    // Adds a ball (SI units). Returns its index, or nullopt with a message.
    std::optional<std::size_t> shoot(const glm::dvec3 &from, const glm::dvec3 &velocity,
                                     double radius);

    // The scene's probes as moved by the user, and their answers.
    [[nodiscard]] const std::vector<ProbeDesc> &probes() const { return probes_; }
    [[nodiscard]] const std::vector<ProbeAnswer> &answers() const { return answers_; }
    // See probe_handles. Expectations on a moved probe are dropped; a restart restores the scene's
    // own places and expectations.
    void move_probe(std::size_t probe, std::size_t handle, const glm::dvec3 &place);

    // Starting with the next scene opened, records the current run from its start to its current
    // state: steps taken back are dropped, and a restart starts the recording over.
    void record() { records_ = true; }
    // Writes the recording, and the mesh files beside it. Throws as OutputFile does, and
    // std::runtime_error if there is nothing to record.
    void write_recording(OutputFile &file) const;

    // Writes the current state as a scene file through OutputFile. Creates the folder and copies
    // the mesh files into it; a different file of the same name there is an error.
    bool save_scene(const std::filesystem::path &path);

    // States before and after the last step; equal after anything but a step.
    [[nodiscard]] const std::vector<BodyState> &previous_bodies() const { return previous_.bodies; }
    [[nodiscard]] const std::vector<BodyState> &present_bodies() const { return present_.bodies; }
    [[nodiscard]] const std::vector<ParticleState> &previous_particles() const {
        return previous_.particles;
    }
    [[nodiscard]] const Frame &present() const { return present_; } // without joints and contacts
    // From the last impact_shown seconds; cleared by anything but a step.
    static constexpr double impact_shown = 0.25;
    [[nodiscard]] const std::vector<SeenImpact> &impacts() const { return impacts_; }
    [[nodiscard]] const SessionGraphs &graphs() const { return graphs_; }
    // Quantities over time, from when they were chosen or the run began to the current step. False,
    // with a message, if the quantity does not exist.
    bool plot(const QuantityName &name);
    void unplot(std::size_t curve);
    [[nodiscard]] const Plots &plots() const { return plots_; }
    // Writes the plots as a table through OutputFile. Creates the folder.
    bool save_plots(const std::filesystem::path &path);
    // Phase times of the step that led to the current state; nullopt at the start of a run or after
    // going back, when the simulation's report is empty too.
    [[nodiscard]] const std::optional<StepTimes> &times() const { return times_; }
    // Whether running out of memory ever caused one of the messages().
    [[nodiscard]] bool memory_ran_out() const { return memory_ran_out_; }
    [[nodiscard]] Messages &messages() { return messages_; }
    [[nodiscard]] const Messages &messages() const { return messages_; }

  private:
    bool start(const SceneDesc &scene, const RunOptions &options,
               const std::optional<StepSettings> &settings);
    [[nodiscard]] std::string reason(const std::exception &failure);
    void say(const std::filesystem::path &path, const std::vector<SceneMessage> &all);
    void apply(const Command &command);
    bool play(const Recording &recording, const std::filesystem::path &path);
    bool obey_replay();
    void leave_recording();
    void choose_again(const std::string &method, const StepSettings &settings);
    void pull_grabbed();
    void let_go_of_all();
    void see_impacts();
    void read_present();
    void settle_poses();
    void disturb(std::uint64_t first_step);
    void settings_changed();
    void save_mesh_files(const std::filesystem::path &folder) const;

    RunOptions options_;
    TaskPool *tasks_ = nullptr;
    Make make_;
    SceneDesc scene_;
    std::filesystem::path path_;
    std::optional<SceneText> text_; // text of scene_
    std::unique_ptr<Simulation> simulation_;
    History history_; // states saved by simulation_
    std::optional<ExpectationWatch> watch_;
    std::optional<TroubleWatch> troubles_;
    // What a run is made with.
    struct Choice {
        const MethodInfo *method = nullptr;
        StepSettings settings;
    };
    [[nodiscard]] Choice chosen() const;
    Choice started_with_; // in its first step
    struct Noted {
        Choice choice;
        std::string failure;
    };
    std::optional<Noted> noted_;
    std::uint64_t first_step_ = 0;                // first step of the run
    std::optional<std::uint64_t> disturbed_from_; // states are disturbed from this step on
    std::optional<GrabView> grab_;
    std::optional<glm::dvec3> pulled_to_; // grab target the simulation has
    bool has_grabbed_ = false;            // in this run, so an earlier state may hold something
    bool records_ = false;
    std::optional<Recorder> recorder_; // records the current run
    std::vector<ProbeDesc> probes_;
    std::vector<ProbeAnswer> answers_;
    bool stopped_ = false;
    bool memory_ran_out_ = false;
    Frame previous_;
    Frame present_; // bodies, particles and impacts
    std::vector<SeenImpact> impacts_;
    std::optional<Ghost> ghost_;
    std::string ghost_method_; // empty: no ghost
    SessionGraphs graphs_;
    Plots plots_;
    std::optional<StepTimes> times_;
    Messages messages_;
    std::unique_ptr<const Recording> recording_; // the one opened
    std::optional<Replay> replay_;               // replays recording_, until something else is done
    ExitCode replay_outcome_ = ExitCode::fine;
};

} // namespace plumb

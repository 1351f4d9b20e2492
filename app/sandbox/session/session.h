// The scene that is running: opened, stepped, taken back, changed and saved.
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

// One value a step.
struct SessionGraphs {
    Graph find_pairs, collide, advance, finish; // s of wall time
    Graph energy;                               // J
};

// An impact that has just been.
struct SeenImpact {
    ImpactView impact;
    double age = 0; // s, since the end of its step
};

// Nothing here throws because of a scene, a file or a setting: what is wrong is said in messages(),
// and what was running before goes on.
class Session {
  public:
    using Make = std::function<std::unique_ptr<Simulation>(const SceneDesc &, const RunOptions &,
                                                           TaskPool *)>;
    // `options` hold for every scene that is opened. `tasks` may be null and must outlive the
    // session.
    explicit Session(RunOptions options = {}, TaskPool *tasks = nullptr,
                     Make make = &Simulation::create);

    // False, with the reasons in messages(), if the file is not a scene that can run.
    bool open(const std::filesystem::path &path);
    // A scene from elsewhere; `path` is where reload would look, and may be empty. `text` is its
    // file's, if it is of one.
    bool open(const SceneDesc &scene, const std::filesystem::path &path = {},
              std::optional<SceneText> text = {});
    // A recording's file: the steps that follow do what was done in it, and each state is compared.
    // There is no step beyond its end, until something else is done to the world: from there on the
    // run is no longer the recorded one.
    bool open_recording(const std::filesystem::path &path);
    // outside_tolerance when a state was not the recorded one, bad_input when a command could not
    // be obeyed; a message says where.
    [[nodiscard]] ExitCode replay_outcome() const { return replay_outcome_; }
    // The file again, as it is now. A file that is broken leaves the running scene as it is.
    bool reload();
    // From the start, with the method and settings now chosen.
    bool restart();
    // From the start, with the method and settings of the scene and the command line.
    bool restart_as_written();

    [[nodiscard]] bool running() const { return simulation_ != nullptr; }
    // Null if there is no scene.
    [[nodiscard]] Simulation *simulation() { return simulation_.get(); }
    [[nodiscard]] const Simulation *simulation() const { return simulation_.get(); }
    [[nodiscard]] const SceneDesc &scene() const { return scene_; }
    [[nodiscard]] const std::filesystem::path &path() const { return path_; }
    [[nodiscard]] const RunOptions &options() const { return options_; }

    // One step. False if there is nothing to step, or if the step failed: a message says what and
    // where, and the session is stopped.
    bool step();
    // Back by one remembered step: the state is, bit for bit, what it was, but method and settings
    // stay as now chosen. False when no more is remembered.
    bool step_back();
    [[nodiscard]] std::size_t steps_remembered() const { return history_.size(); }
    // The last step failed; only going back or starting again helps.
    [[nodiscard]] bool stopped() const { return stopped_; }

    // What has come so far of each of the scene's expectations, in its order: as `check` judges the
    // run from its start to the present step. Empty for a scene that has only probes.
    [[nodiscard]] std::vector<ExpectOutcome> expectations() const;
    // Since when the run has been outside the tolerance of one of them (s); nothing while none is
    // missed.
    [[nodiscard]] std::optional<double> missed_since(std::size_t expectation) const;
    // How the run has failed: see TroubleWatch.
    [[nodiscard]] std::optional<Trouble> trouble() const;
    // Something other than steps has changed the run after its start (another method or setting, a
    // shot, a grab): the expectations tell of what happened, not of what `check` would say.
    [[nodiscard]] bool disturbed() const { return disturbed_from_.has_value(); }

    // The method, with the settings that the scene or else the method has for it.
    bool set_method(std::string_view name);
    bool set_settings(const StepSettings &settings);

    // Of the running scene, to change numbers in: the file's as it was opened, or where there is
    // none (a recording is none) the scene as it began.
    [[nodiscard]] SceneText scene_text() const;

    // A second simulation by this method beside the first, from the present state; it begins anew
    // when the run does, and where it is taken back to before it was there. Empty: none. False,
    // with a message, for a method that cannot run the scene.
    bool set_ghost(const std::string &method);
    // Lets a ghost that lags come nearer while nothing is stepped.
    void let_ghost_go_on();
    [[nodiscard]] const Ghost *ghost() const { return ghost_ ? &*ghost_ : nullptr; }

    // From the next step on; of a grab that goes on, only the target may change. Nothing: lets go.
    void grab(const std::optional<GrabView> &grab);
    [[nodiscard]] const std::optional<GrabView> &grabbed() const { return grab_; }
    // What is held: by that, by the scene as it was saved, or by the recording.
    [[nodiscard]] std::optional<GrabView> held() const;
    // False if nothing is held, or as the recording has it.
    bool let_go();
    // Adds a ball, kg and m/s, in SI units; its index, or nothing with a message.
    std::optional<std::size_t> shoot(const glm::dvec3 &from, const glm::dvec3 &velocity,
                                     double radius);

    // The scene's probes as they have been moved, and what they are answered.
    [[nodiscard]] const std::vector<ProbeDesc> &probes() const { return probes_; }
    [[nodiscard]] const std::vector<ProbeAnswer> &answers() const { return answers_; }
    // See probe_handles. What was expected of the probe at its old place is expected no more; a
    // restart brings the scene's own places back, and what is expected there.
    void move_probe(std::size_t probe, std::size_t handle, const glm::dvec3 &place);

    // From the next scene that is opened on, the run that is going on is recorded, from its start
    // to its present state: what is stepped back over is forgotten, and a restart begins anew.
    void record() { records_ = true; }
    // Writes it, and the meshes' files beside it. Throws as OutputFile does, and
    // std::runtime_error when there is nothing to record.
    void write_recording(OutputFile &file) const;

    // Writes the present state as a scene file, as an OutputFile. Makes the folder, and copies the
    // meshes' files into it; one that has another file of a mesh's name is an error.
    bool save_scene(const std::filesystem::path &path);

    // Before and after the last step; the same after anything but a step.
    [[nodiscard]] const std::vector<BodyState> &previous_bodies() const { return previous_.bodies; }
    [[nodiscard]] const std::vector<BodyState> &present_bodies() const { return present_.bodies; }
    [[nodiscard]] const std::vector<ParticleState> &previous_particles() const {
        return previous_.particles;
    }
    [[nodiscard]] const Frame &present() const { return present_; } // joints, contacts left out
    // Of the last impact_shown seconds, as long as nothing but steps came in between.
    static constexpr double impact_shown = 0.25;
    [[nodiscard]] const std::vector<SeenImpact> &impacts() const { return impacts_; }
    [[nodiscard]] const SessionGraphs &graphs() const { return graphs_; }
    // Quantities over time, from when they were chosen or the run began, to the present step.
    // False, with a message, for what there is not.
    bool plot(const QuantityName &name);
    void unplot(std::size_t curve);
    [[nodiscard]] const Plots &plots() const { return plots_; }
    // As a table, as an OutputFile. Makes the folder.
    bool save_plots(const std::filesystem::path &path);
    // Of the phases of the step that led to the present state; nothing where none did, at a run's
    // start or after going back: then the simulation's report is empty, too.
    [[nodiscard]] const std::optional<StepTimes> &times() const { return times_; }
    // Whether that is why something in messages() failed, once at least.
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
    std::optional<SceneText> text_; // of scene_
    std::unique_ptr<Simulation> simulation_;
    History history_; // saved by simulation_
    std::optional<ExpectationWatch> watch_;
    std::optional<TroubleWatch> troubles_;
    std::uint64_t first_step_ = 0;                // of the run
    std::optional<std::uint64_t> disturbed_from_; // states from this step on
    std::optional<GrabView> grab_;
    std::optional<glm::dvec3> pulled_to_; // what the simulation knows of the grab
    bool has_grabbed_ = false; // in this run, so that an earlier state may hold something
    bool records_ = false;
    std::optional<Recorder> recorder_; // of the run that is going on
    std::vector<ProbeDesc> probes_;
    std::vector<ProbeAnswer> answers_;
    bool stopped_ = false;
    bool memory_ran_out_ = false;
    Frame previous_;
    Frame present_; // bodies and impacts
    std::vector<SeenImpact> impacts_;
    std::optional<Ghost> ghost_;
    std::string ghost_method_; // empty: none is wanted
    SessionGraphs graphs_;
    Plots plots_;
    std::optional<StepTimes> times_;
    Messages messages_;
    std::unique_ptr<const Recording> recording_; // that was opened
    std::optional<Replay> replay_;               // of it, until something else is done
    ExitCode replay_outcome_ = ExitCode::fine;
};

} // namespace plumb

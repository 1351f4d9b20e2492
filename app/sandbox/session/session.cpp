#include "app/sandbox/session/session.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <stdexcept>
#include <utility>

namespace plumb {

Session::Session(RunOptions options, TaskPool *tasks, Make make)
    : options_(std::move(options)), tasks_(tasks), make_(std::move(make)) {}

bool Session::open(const SceneDesc &scene, const std::filesystem::path &path,
                   std::optional<SceneText> text) {
    if (!start(scene, options_, {}))
        return false;
    recording_.reset();
    noted_.reset();
    path_ = path;
    text_ = std::move(text);
    return true;
}

bool Session::play(const Recording &recording, const std::filesystem::path &path) {
    auto kept = std::make_unique<const Recording>(recording);
    if (!start(kept->scene, {}, {}))
        return false;
    recording_ = std::move(kept);
    noted_.reset();
    text_.reset();
    replay_.emplace(*recording_);
    path_ = std::filesystem::path(path); // `path` may alias path_
    return true;
}

bool Session::restart() {
    if (!simulation_)
        return false;
    if (recording_)
        return play(Recording(*recording_), path_);
    RunOptions options = options_;
    options.method = std::string(simulation_->method().name);
    return start(SceneDesc(scene_), options, simulation_->settings());
}

bool Session::restart_as_written() {
    if (recording_)
        return play(Recording(*recording_), path_);
    return simulation_ && start(SceneDesc(scene_), options_, {});
}

bool Session::start(const SceneDesc &scene, const RunOptions &options,
                    const std::optional<StepSettings> &settings) {
    try {
        std::unique_ptr<Simulation> simulation = make_(scene, options, tasks_);
        if (settings)
            simulation->set_settings(*settings);
        std::vector<ProbeAnswer> answers;
        for (const ProbeDesc &probe : scene.probes)
            answers.push_back(answer(probe, simulation->precision()));
        std::optional<ExpectationWatch> watch;
        if (simulation->has_world())
            watch.emplace(*simulation, scene.expects);
        answers_ = std::move(answers);
        watch_ = std::move(watch);
        history_.clear(); // its states must go before the simulation that made them
        simulation_ = std::move(simulation);
        replay_.reset();
        replay_outcome_ = ExitCode::fine;
        recorder_.reset();
        if (records_ && simulation_->has_world())
            recorder_.emplace(*simulation_);
    } catch (const std::exception &failure) {
        messages_.error((scene.name.empty() ? "The scene" : scene.name) +
                        " cannot run: " + reason(failure));
        return false;
    }
    scene_ = scene;
    started_with_ = chosen();
    troubles_.reset();
    if (simulation_->has_world())
        troubles_.emplace(scene_, *simulation_);
    probes_ = scene.probes;
    stopped_ = false;
    first_step_ = simulation_->step_count();
    disturbed_from_.reset();
    grab_.reset();
    pulled_to_.reset();
    has_grabbed_ = false;
    graphs_ = {};
    times_.reset();
    if (simulation_->has_world())
        plots_.start(*simulation_);
    settle_poses();
    set_ghost(std::exchange(ghost_method_, {}));
    return true;
}

bool Session::step() {
    if (!simulation_ || stopped_ || !simulation_->has_world())
        return false;
    double energy_before = 0;
    bool is_held = false;
    try {
        if (grab_)
            leave_recording();
        if (replay_ && !obey_replay())
            return false;
        pull_grabbed();
        is_held = simulation_->grab().has_value();
        if (is_held) // a grab may add energy
            energy_before = simulation_->energy();
        if (simulation_->step_count() == first_step_)
            started_with_ = chosen();
        troubles_->begin_step(scene_, *simulation_);
        if (ghost_)
            ghost_->begin_step();
        history_.remember(*simulation_);
        if (recorder_)
            recorder_->before_step(*simulation_);
        simulation_->step(&times_.emplace());
    } catch (const std::exception &failure) {
        stopped_ = true;
        times_.reset();
        const std::string why = reason(failure);
        troubles_->failed(*simulation_, why);
        messages_.error("Step " + std::to_string(simulation_->step_count() + 1) +
                        " failed: " + why);
        settle_poses();
        return false;
    }
    const StepReport &report = simulation_->report();
    graphs_.find_pairs.add(times_->find_pairs);
    graphs_.collide.add(times_->collide);
    graphs_.advance.add(times_->advance);
    graphs_.finish.add(times_->finish);
    const double energy = simulation_->energy();
    if (is_held)
        troubles_->brought_in(*simulation_, energy - energy_before);
    graphs_.energy.add(energy);
    std::swap(previous_, present_);
    read_present();
    see_impacts();
    troubles_->sample(*simulation_, previous_, is_held);
    if (ghost_)
        ghost_->catch_up(*simulation_);
    if (!report.finite) {
        stopped_ = true;
        messages_.error(troubles_->trouble()->text + " With " +
                        std::string(simulation_->method().title) +
                        ", a shorter step or more substeps may help.");
        return false;
    }
    watch_->sample(*simulation_);
    plots_.sample(*simulation_);
    return true;
}

// False at the end, or if the run differs from the recording.
bool Session::obey_replay() {
    const std::string file = path_.filename().string();
    const std::size_t given = replay_->given();
    const double energy = simulation_->energy();
    try {
        if (!replay_->obey(*simulation_)) {
            replay_outcome_ = ExitCode::outside_tolerance;
            messages_.error(file + ": " + replay_->difference(*simulation_));
        }
        for (std::size_t i = given; ghost_ && i < replay_->given(); ++i)
            ghost_->apply(*simulation_, recording_->commands[i].command);
        if (given < replay_->given())
            troubles_->brought_in(*simulation_, simulation_->energy() - energy);
    } catch (const CommandFailure &failure) {
        replay_outcome_ = ExitCode::bad_input;
        messages_.error(file + ':' + std::to_string(failure.line) + ": " + failure.what());
    }
    if (replay_outcome_ != ExitCode::fine) {
        stopped_ = true;
        replay_.reset();
        return false;
    }
    if (!recording_->commands.empty() &&
        recording_->commands.front().step <= simulation_->step_count())
        disturb(recording_->commands.front().step + 1);
    if (present_.bodies.size() != simulation_->body_count())
        settle_poses();
    if (!replay_->is_at_end(*simulation_))
        return true;
    messages_.note("The recording ends here, in the recorded state " +
                   hash_text(simulation_->hash()) + '.');
    return false;
}

void Session::leave_recording() {
    if (!replay_)
        return;
    messages_.note("From step " + std::to_string(simulation_->step_count()) +
                   " on, this is no longer the recorded run.");
    replay_.reset();
    has_grabbed_ = true;     // the recording may have
    if (simulation_->grab()) // nothing else will release it
        apply(ReleaseGrab{});
}

// The restored state may contain a grab that the pointer no longer holds: release it.
void Session::let_go_of_all() {
    grab_.reset();
    pulled_to_.reset();
    if (has_grabbed_)
        apply(ReleaseGrab{});
}

bool Session::step_back() {
    if (!simulation_)
        return false;
    const std::string method(simulation_->method().name);
    const StepSettings settings = simulation_->settings();
    bool ghost_is_back = true;
    try {
        if (!history_.recall(*simulation_))
            return false;
        // Before commands are applied to both.
        ghost_is_back = !ghost_ || ghost_->go_back();
        if (recorder_)
            recorder_->went_back(*simulation_);
        watch_->go_back(*simulation_);
        plots_.go_back(*simulation_);
        troubles_->go_back(*simulation_);
        if (disturbed_from_ && simulation_->step_count() < *disturbed_from_)
            disturbed_from_.reset();
        if (replay_) { // the replay knows what was chosen then
            replay_->went_back(*simulation_);
        } else {
            choose_again(method, settings);
            let_go_of_all();
        }
    } catch (const std::exception &failure) {
        messages_.error("Cannot step back: " + reason(failure));
        return false;
    }
    stopped_ = false;
    times_.reset();
    for (Graph *graph : {&graphs_.find_pairs, &graphs_.collide, &graphs_.advance, &graphs_.finish,
                         &graphs_.energy})
        graph->take_back();
    settle_poses();
    if (!ghost_is_back)
        set_ghost(std::string(ghost_method_));
    return true;
}

void Session::choose_again(const std::string &method, const StepSettings &settings) {
    if (simulation_->method().name != method)
        apply(SetMethod{method});
    if (const auto changed = GivenSettings::differences(simulation_->settings(), settings);
        !changed.empty())
        apply(SetSettings{changed});
}

bool Session::set_method(std::string_view name) {
    if (!simulation_)
        return false;
    try {
        RunOptions options = options_;
        options.method = std::string(name);
        options.settings.erase_if([](const SettingRow &row) {
            return row.group != SettingGroup::world; // for the command line's method
        });
        const ResolvedRun run = resolve_run(scene_, options);
        if (const std::string why = why_not(*run.method, scene_); !why.empty())
            throw std::invalid_argument(why);
        StepSettings settings = run.settings;
        for (const SettingNumber number : setting_numbers())
            if (number.setting().group == SettingGroup::world)
                set_setting(settings, number, setting_value(simulation_->settings(), number));
        apply(SetMethod{std::string(name)});
        apply(SetSettings{GivenSettings::differences(simulation_->settings(), settings)});
        settings_changed();
        return true;
    } catch (const std::exception &failure) {
        messages_.error("Cannot change the method to " + std::string(name) + ": " +
                        reason(failure));
        return false;
    }
}

bool Session::set_settings(const StepSettings &settings) {
    if (!simulation_)
        return false;
    try {
        apply(SetSettings{GivenSettings::differences(simulation_->settings(), settings)});
        settings_changed();
        return true;
    } catch (const std::exception &failure) {
        messages_.error("Cannot change the settings: " + reason(failure));
        return false;
    }
}

void Session::apply(const Command &command) {
    leave_recording();
    const double energy = simulation_->energy();
    simulation_->apply(command);
    if (ghost_)
        ghost_->apply(*simulation_, command);
    if (troubles_)
        troubles_->brought_in(*simulation_, simulation_->energy() - energy);
    if (recorder_)
        recorder_->add(*simulation_, command);
}

void Session::grab(const std::optional<GrabView> &grab) {
    grab_ = grab;
    if (grab || !pulled_to_)
        return;
    apply(ReleaseGrab{});
    pulled_to_.reset();
}

std::optional<GrabView> Session::held() const {
    return grab_ || !simulation_ ? grab_ : simulation_->grab();
}

bool Session::let_go() {
    if (replay_ || !held())
        return false;
    grab({});
    if (simulation_->grab()) {
        disturb(simulation_->step_count() + 1);
        apply(ReleaseGrab{});
        has_grabbed_ = true;
    }
    return true;
}

void Session::pull_grabbed() {
    if (!grab_)
        return;
    has_grabbed_ = true;
    disturb(simulation_->step_count() + 1);
    if (!pulled_to_ && grab_->particle)
        apply(GrabParticle{simulation_->soft_parts().particle_name(*grab_->particle), grab_->target,
                           grab_->max_force});
    else if (!pulled_to_)
        apply(GrabBody{simulation_->body_info(grab_->body).name, grab_->local_point, grab_->target,
                       grab_->max_force});
    else if (*pulled_to_ != grab_->target)
        apply(MoveGrab{grab_->target});
    pulled_to_ = grab_->target;
}

std::optional<std::size_t> Session::shoot(const glm::dvec3 &from, const glm::dvec3 &velocity,
                                          double radius) {
    if (!simulation_)
        return {};
    BodyDesc ball;
    ball.name = simulation_->free_name("ball");
    ball.colliders.emplace_back().shape = SphereDesc{radius};
    ball.position = from;
    ball.velocity = velocity;
    try {
        apply(AddBody{ball});
        disturb(simulation_->step_count());
        settle_poses();
        return simulation_->find_body(ball.name);
    } catch (const std::exception &failure) {
        messages_.error("Cannot add a ball: " + reason(failure));
        return {};
    }
}

bool Session::set_ghost(const std::string &method) {
    ghost_.reset();
    ghost_method_.clear();
    if (method.empty() || !simulation_ || !simulation_->has_world())
        return method.empty();
    try {
        ghost_.emplace(*simulation_, method);
        ghost_method_ = method;
        return true;
    } catch (const std::exception &failure) {
        messages_.note("No ghost: " + reason(failure));
        return false;
    }
}

void Session::let_ghost_go_on() {
    if (ghost_ && simulation_)
        ghost_->go_on(*simulation_);
}

bool Session::plot(const QuantityName &name) {
    if (!simulation_)
        return false;
    try {
        plots_.add(*simulation_, name);
        return true;
    } catch (const std::exception &failure) {
        messages_.error("Cannot plot " + title_of(name) + ": " + reason(failure));
        return false;
    }
}

void Session::unplot(std::size_t curve) {
    plots_.remove(*simulation_, curve);
}

void Session::move_probe(std::size_t probe, std::size_t handle, const glm::dvec3 &place) {
    move_probe_handle(probes_.at(probe), handle, place);
    probes_[probe].expects.clear();
    probes_[probe].source.clear();
    answers_[probe] = answer(probes_[probe], simulation_->precision());
}

std::vector<ExpectOutcome> Session::expectations() const {
    std::vector<ExpectOutcome> outcomes;
    for (std::size_t i = 0; watch_ && i < watch_->size(); ++i)
        outcomes.push_back(watch_->outcome(i));
    return outcomes;
}

std::optional<double> Session::missed_since(std::size_t expectation) const {
    return watch_ ? watch_->missed_since(expectation) : std::nullopt;
}

std::optional<Trouble> Session::trouble() const {
    return troubles_ ? troubles_->trouble() : std::nullopt;
}

Session::Choice Session::chosen() const {
    return {&simulation_->method(), simulation_->settings()};
}

void Session::note_outcome(const std::string &failure) {
    if (simulation_)
        noted_ = Noted{chosen(), failure};
}

std::optional<std::string> Session::doubt() const {
    if (!simulation_ || !simulation_->has_world())
        return std::nullopt;
    const Choice now = chosen();
    const auto is_now = [&](const Choice &choice) {
        return choice.method == now.method &&
               GivenSettings::differences(choice.settings, now.settings).empty();
    };
    if (noted_ && is_now(noted_->choice))
        return noted_->failure.empty() ? std::nullopt
                                       : std::optional("With these settings the scene failed in "
                                                       "the lab: " +
                                                       noted_->failure + ".");
    if (simulation_->step_count() == first_step_ || is_now(started_with_))
        return std::nullopt;
    return "Not known to hold with these settings, which are not those the run started with.";
}

void Session::disturb(std::uint64_t first_step) {
    disturbed_from_ = std::min(disturbed_from_.value_or(first_step), first_step);
}

// New settings survive stepping back, so the run is entirely theirs only if changed at its very
// start.
void Session::settings_changed() {
    if (simulation_->step_count() > first_step_)
        disturb(first_step_ + 1);
}

std::string Session::reason(const std::exception &failure) {
    if (dynamic_cast<const std::bad_alloc *>(&failure) == nullptr)
        return failure.what();
    memory_ran_out_ = true;
    return "out of memory";
}

void Session::see_impacts() {
    for (SeenImpact &seen : impacts_)
        seen.age += simulation_->settings().dt;
    std::erase_if(impacts_, [](const SeenImpact &seen) { return seen.age >= impact_shown; });
    for (const ImpactView &impact : present_.impacts)
        impacts_.push_back({impact, 0});
}

void Session::read_present() {
    simulation_->read(present_, {.impacts = true});
}

void Session::settle_poses() {
    read_present();
    previous_ = present_;
    impacts_.clear();
}

} // namespace plumb

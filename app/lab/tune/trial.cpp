#include "app/lab/tune/trial.h"

#include "app/lab/run/run_text.h"
#include "app/lab/timing.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace plumb {

namespace {

// Scales each tolerance; an upper bound above zero is one, other bounds have none.
SceneDesc tightened(SceneDesc scene, double share) {
    for (ExpectDesc &expect : scene.expects) {
        expect.tolerance *= share;
        if (expect.relation == ExpectDesc::Relation::at_most && expect.value > 0)
            expect.value *= share;
    }
    return scene;
}

// Judges the measured values against the full tolerances.
void judge_in_full(const SceneDesc &scene, const JudgedRun &judged, TunedRun &run) {
    for (std::size_t i = 0; i < judged.outcomes.size(); ++i) {
        const ExpectOutcome &outcome = judged.outcomes[i];
        if (!outcome.judged())
            continue;
        const double error = judge(scene.expects[i], outcome.measured).scaled_error;
        if (error > run.error) {
            run.error = error;
            run.worst = scene.expects[i].name;
        }
    }
}

} // namespace

Trial::Trial(const std::vector<SceneDesc> &starts, const TuneOptions &options)
    : starts_(starts), options_(options) {
    for (const SceneDesc &start : starts)
        tightened_.push_back(tightened(start, options.tolerance));
}

std::unique_ptr<Simulation> Trial::make(const SceneDesc &scene, const RunOptions &options) const {
    return options_.make ? options_.make(scene, options)
                         : Simulation::create(scene, options, nullptr);
}

TunedRun Trial::run(const RunOptions &options, const Progress &progress) const {
    TunedRun run;
    run.options = options;
    run.resolved = resolve_run(scene(), options);
    const std::string what = scene().name + ": " + run_text(run.resolved);
    for (std::size_t start = 0; start < starts_.size(); ++start) {
        const auto simulation = make(tightened_[start], options);
        JudgeOptions judging;
        judging.give_up = true;
        judging.stop = options_.stop;
        judging.progress = [&](double fraction) {
            if (progress)
                progress((static_cast<double>(start) + fraction) /
                             static_cast<double>(starts_.size()),
                         what);
        };
        const JudgedRun judged = judge_run(*simulation, tightened_[start], judging);
        if (judged.stopped)
            return run;
        ++run.starts;
        judge_in_full(starts_[start], judged, run);
        if (const double simulated = static_cast<double>(judged.steps) * run.resolved.settings.dt;
            simulated > 0) {
            const double cost = judged.step_time / simulated;
            run.cost = start == 0 ? cost : std::min(run.cost, cost);
            if (start == 0)
                run.work =
                    static_cast<double>(judged.body_passes + judged.constraint_passes) / simulated;
        }
        if (!judged.all_met()) {
            run.verdict = judged.divergence ? TuneVerdict::diverged : TuneVerdict::missed;
            return run;
        }
    }
    run.verdict = TuneVerdict::met;
    return run;
}

RunTimer Trial::timer(const TunedRun &run) const {
    auto simulation = make(scene(), run.options);
    const double dt = simulation->settings().dt;
    std::vector<TimedPart> whole(1);
    whole.front().start = simulation->save();
    whole.front().steps =
        static_cast<std::uint64_t>(std::max(1L, std::lround(run_end(scene(), 0) / dt)));
    return {std::move(simulation), std::move(whole), run.cost};
}

void time_in_turns(const std::vector<TimedRun> &runs, const TuneOptions &options,
                   const Progress &progress) {
    const auto stopped = [&] { return options.stop && options.stop(); };
    const double rounds = options.repeats;
    std::vector<RunTimer> timers;
    timers.reserve(runs.size());
    for (const auto &[trial, run] : runs)
        timers.push_back(trial->timer(*run));
    std::vector<std::vector<double>> timings(runs.size());
    for (int round = 0; round < options.repeats; ++round)
        for (std::size_t i = 0; i < runs.size(); ++i) {
            if (stopped())
                return;
            if (progress)
                progress(
                    (round + static_cast<double>(i) / static_cast<double>(runs.size())) / rounds,
                    runs[i].trial->scene().name + ": timing " + run_text(runs[i].run->resolved));
            timings[i].push_back(timers[i].time(options.stop).value_or(runs[i].run->cost));
        }
    if (stopped())
        return;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        runs[i].run->cost = median(timings[i]);
        runs[i].run->timings = std::move(timings[i]);
    }
}

bool is_always_dearer(const TunedRun &run, const TunedRun &other) {
    for (std::size_t i = 0; i < std::min(run.timings.size(), other.timings.size()); ++i)
        if (run.timings[i] < same_cost * other.timings[i])
            return false;
    return true;
}

} // namespace plumb

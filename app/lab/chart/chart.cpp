#include "app/lab/chart/chart.h"

#include "app/lab/chart/chart_plan.h"
#include "app/lab/chart/pareto.h"
#include "app/lab/csv.h"
#include "app/lab/engines/engine_simulation.h"
#include "app/lab/map/answers.h"
#include "app/lab/run/run_text.h"
#include "app/lab/run/run_timer.h"
#include "app/lab/timing.h"
#include "engine/core/random.h"
#include "engine/core/task_pool.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace plumb {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The expectation charted, or else the first that should have been measured but could not be.
std::string unmeasured(const ErrorMeasure &measure, const JudgedRun &run) {
    if (measure.kind == ErrorMeasure::Kind::expectation)
        return run.outcomes[measure.expectation].desc.name;
    for (const ExpectOutcome &outcome : run.outcomes)
        if (outcome.verdict != Verdict::unseen && !std::isfinite(outcome.error))
            return outcome.desc.name;
    return "nothing was judged";
}

void judge_error(const ErrorMeasure &measure, ChartRun &run) {
    run.worst = worst_of(run.run.outcomes, measure.among);
    run.error = infinity;
    if (run.run.stopped) {
        run.status = ChartStatus::unfinished;
        return;
    }
    // A window that ended before the divergence has a result, but the method still failed.
    if (run.run.divergence) {
        run.status = ChartStatus::diverged;
        if (run.failure.empty()) // runs read from a table keep theirs
            run.failure = describe(*run.run.divergence);
        return;
    }
    if (measure.kind != ErrorMeasure::Kind::one_step)
        run.error = error_of(measure, run.run);
    else if (run.one_step.failure.empty())
        run.error = run.one_step.rms;
    run.status = !std::isfinite(run.error) ? ChartStatus::no_result
                 : run.run.all_met()       ? ChartStatus::fine
                                           : ChartStatus::outside;
    run.failure = run.status != ChartStatus::no_result ? ""
                  : run.one_step.failure.empty() ? "no result: " + unmeasured(measure, run.run)
                                                 : "no result: " + run.one_step.failure;
}

void set_cost(ChartRun &run) {
    if (run.timings.empty()) {
        const double simulated = static_cast<double>(run.run.steps) * run.resolved.settings.dt;
        run.cost = simulated > 0 ? run.run.step_time / simulated : 0;
        run.cost_low = run.cost_high = run.cost;
    } else {
        run.cost = median(run.timings);
        const auto [low, high] = std::minmax_element(run.timings.begin(), run.timings.end());
        run.cost_low = *low;
        run.cost_high = *high;
    }
}

void mark_front(SceneChart &chart) {
    std::vector<CostAndError> choices;
    // A run that fails the scene is no choice, however cheap. Errors below the floor count as
    // equal.
    const double floor = chart.steps_from ? chart.steps_from->floor() : 0;
    for (const ChartRun &run : chart.runs)
        choices.push_back(run.status == ChartStatus::fine && !chart.convergence
                              ? CostAndError{run.cost, std::max(run.error, floor)}
                              : CostAndError{infinity, infinity});
    const std::vector<bool> front = pareto_front(choices);
    for (std::size_t i = 0; i < front.size(); ++i)
        chart.runs[i].pareto = front[i];
}

} // namespace

std::string_view status_name(ChartStatus status) {
    switch (status) {
    case ChartStatus::fine:
        return "fine";
    case ChartStatus::outside:
        return "outside";
    case ChartStatus::diverged:
        return "diverged";
    case ChartStatus::no_result:
        return "no result";
    case ChartStatus::unfinished:
        return "unfinished";
    }
    return "";
}

std::size_t SceneChart::finished() const {
    return static_cast<std::size_t>(std::ranges::count_if(
        runs, [](const ChartRun &run) { return run.status != ChartStatus::unfinished; }));
}

double SceneChart::median_spread() const {
    std::vector<double> spreads;
    for (const ChartRun &run : runs)
        if (run.timings.size() > 1)
            spreads.push_back((run.cost_high - run.cost_low) / run.cost);
    return spreads.empty() ? 0 : median(spreads);
}

std::vector<MapAxis> axes_that_vary(const std::vector<SweepAxis> &sweep) {
    std::vector<MapAxis> axes;
    for (const SweepAxis &swept : sweep) {
        MapAxis axis;
        axis.name = setting_name(swept.setting);
        axis.setting = swept.setting;
        axis.values = swept.values;
        if (varies_the_scene(axis))
            axes.push_back(std::move(axis));
    }
    return axes;
}

bool is_outdated(const SceneChart &chart, const std::string &expectation) {
    return std::ranges::find(chart.outdated, expectation) != chart.outdated.end();
}

std::vector<std::string> not_judged(const SceneChart &chart) {
    std::vector<std::string> texts;
    if (std::string text = outdated_text(axes_that_vary(chart.sweep), chart.outdated);
        !text.empty())
        texts.push_back(std::move(text));
    const std::vector<ExpectDesc> expects = everything_expected(chart.scene);
    for (std::size_t i = 0; i < expects.size(); ++i) {
        if (is_outdated(chart, expects[i].name))
            continue;
        std::string who;
        const MethodInfo *last = nullptr;
        for (const ChartRun &run : chart.runs) {
            const MethodInfo *method = run.resolved.method;
            if (method == last || i >= run.run.outcomes.size() ||
                run.run.outcomes[i].verdict != Verdict::unseen)
                continue;
            who.append(last == nullptr ? "" : ", ").append(method->title);
            last = method;
        }
        if (last != nullptr)
            texts.push_back('"' + expects[i].name + "\" cannot be measured for " + who);
    }
    return texts;
}

std::string run_key(const ResolvedRun &run, int threads) {
    std::string key(run.method->name);
    key.append(" ")
        .append(precision_name(run.precision))
        .append(" ")
        .append(std::to_string(threads));
    for (const SettingNumber number : setting_numbers())
        key.append(" ").append(exact_number(setting_value(run.settings, number)));
    return key;
}

SweepAxis default_convergence_sweep() {
    return parse_sweep("dt=1/960..1/30");
}

bool expects_nothing(const SceneChart &chart) {
    return std::ranges::all_of(everything_expected(chart.scene), [&](const ExpectDesc &expect) {
        return is_outdated(chart, expect.name);
    });
}

void finish_chart(SceneChart &chart) {
    if (chart.steps_from)
        chart.measure = one_step_measure(chart.steps_from->frame, chart.steps_from->instants);
    else if (expects_nothing(chart))
        chart.measure =
            followed_measure(chart.scene, std::ranges::any_of(chart.runs, [](const ChartRun &run) {
                                 return run.run.had_contacts;
                             }));
    for (ChartRun &run : chart.runs)
        judge_error(chart.measure, run);
    mark_front(chart);
}

namespace {

// The chart in the making.
class Charting {
  public:
    Charting(const SceneDesc &scene, const ChartOptions &options,
             const std::function<void(const SceneChart &)> &changed)
        : scene_(scene), options_(options), changed_(changed),
          end_(run_end(scene, options.duration)) {
        if (options_.repeats < 1)
            throw std::invalid_argument("repeats must be at least 1");
        if (!(options_.timed > 0) || !(options_.duration > 0) || !(options_.budget > 0))
            throw std::invalid_argument("durations must be above 0 s");
        if (options_.shard.n < 1 || options_.shard.n > options_.shard.of)
            throw std::invalid_argument("a shard is I/N with I from 1 to N");
        if (options_.one_step && (options_.convergence || !options_.expect.empty()))
            throw std::invalid_argument("--one-step cannot be combined with --convergence or "
                                        "--expect");
        if (options_.convergence && options_.precisions.empty() && !options_.base.precision)
            options_.precisions = {Precision::f64};
        chart_.scene = scene;
        chart_.convergence = options_.convergence;
        chart_.sweep = sweep_of(options_);
        if (options_.convergence &&
            (chart_.sweep.size() != 1 || chart_.sweep.front().setting.setting().name != "dt"))
            throw std::invalid_argument(
                "a convergence chart sweeps dt alone: --sweep dt=1/960..1/30");
        chart_.measure = choose_measure(scene, options_.expect, options_.convergence);
        chart_.repeats = options_.convergence ? 0 : options_.repeats;
        chart_.timed = std::min(options_.timed, end_);
        chart_.wall_clock = std::ranges::any_of(options_.threads, [](int n) { return n > 1; });
        chart_.budget = options_.budget;
        chart_.seed = options_.seed;
        planned_ = plan_chart(scene, options_, chart_.sweep, chart_.left_out);
        chart_.planned = planned_.size();
        const std::vector<MapAxis> axes = axes_that_vary(chart_.sweep);
        if (options_.progress && !axes.empty())
            options_.progress(0, scene.name + ": what is expected");
        chart_.outdated = outdated_answers(
            scene, axes,
            {[&](std::span<const double>) { return scene; }, options_.base, options_.stop});
        chart_.measure =
            choose_measure(scene, options_.expect, options_.convergence, chart_.outdated);
    }

    SceneChart make() {
        if (options_.one_step)
            find_states();
        std::vector<std::size_t> mine;
        for (std::size_t i = options_.shard.n - 1; i < planned_.size(); i += options_.shard.of)
            mine.push_back(i);
        for (const std::size_t index : mine) {
            const auto known =
                options_.known.find(run_key(planned_[index].resolved, planned_[index].threads));
            if (stopped() && known == options_.known.end())
                continue; // runs already known are kept
            // Full runs and timings count as half of the work each.
            const double share =
                ((chart_.repeats > 0 ? 0.5 : 1) - states_share_) / static_cast<double>(mine.size());
            const double begin = states_share_ + share * static_cast<double>(chart_.runs.size());
            if (known == options_.known.end())
                run(index, begin, share);
            else
                go_on(index, known->second, begin);
            report_change();
        }
        for (int round = 0; round < chart_.repeats && !stopped(); ++round)
            time_all(round);
        chart_.interrupted = stopped();
        return std::move(chart_);
    }

  private:
    [[nodiscard]] bool stopped() const { return options_.stop && options_.stop(); }
    void progress(double fraction, const ChartRun &run) const {
        if (options_.progress)
            options_.progress(fraction, scene_.name + ": " + run_text(run.resolved));
    }
    // The states single steps start from.
    void find_states() {
        OneStepOptions options;
        options.base = options_.base;
        options.duration = end_;
        options.stop = options_.stop;
        states_share_ = 0.2;
        options.progress = [this](double fraction) {
            if (options_.progress)
                options_.progress(states_share_ * fraction, scene_.name + ": the accurate run");
        };
        states_.emplace(scene_, options);
        chart_.steps_from = {states_->frame(), states_->instants(), run_text(states_->accurate()),
                             states_->own_error()};
    }
    void report_change() {
        finish_chart(chart_);
        if (changed_)
            changed_(chart_);
    }

    std::unique_ptr<Simulation> simulation(const PlannedRun &run, const SceneDesc &scene) {
        if (run.engine != nullptr)
            return engine_simulation(*run.engine, scene, run.resolved);
        if (options_.make)
            return options_.make(scene, run.options);
        std::unique_ptr<TaskPool> &pool = pools_[run.threads];
        if (!pool && run.threads > 1)
            pool = std::make_unique<TaskPool>(run.threads);
        return Simulation::create(scene, run.options, pool.get());
    }

    void run(std::size_t index, double begin, double share) {
        const PlannedRun &next = planned_[index];
        ChartRun run;
        run.index = index;
        run.resolved = next.resolved;
        run.threads = next.threads;
        run.point = next.point;
        std::unique_ptr<Simulation> simulated = simulation(next, scene_);
        RunRecord record(end_, chart_.timed);
        JudgeOptions judging = noting(record, *simulated);
        judging.follow_errors = true;
        judging.progress = [&](double fraction) { progress(begin + share * fraction, run); };
        run.run = judge_run(*simulated, scene_, judging);
        if (next.engine != nullptr)
            drop_unmeasured(run.run.outcomes);
        judge_probes(scene_, run.resolved.precision, run.run.outcomes);
        for (ExpectOutcome &outcome : run.run.outcomes)
            if (is_outdated(chart_, outcome.desc.name))
                outcome.verdict = Verdict::unseen;
        if (states_ && !run.run.divergence && !run.run.stopped) {
            std::shared_ptr<Simulation> engine; // it keeps its memory inside, not in the scene
            run.one_step =
                states_->error_of([&](const SceneDesc &state) -> std::shared_ptr<Simulation> {
                    if (next.engine == nullptr)
                        return simulation(next, state);
                    if (engine)
                        put(*engine, state);
                    else
                        engine = simulation(next, state);
                    return engine;
                });
            run.run.stopped = stopped();
        }
        set_cost(run);
        timers_.emplace_back();
        if (!run.run.divergence && !run.run.stopped && chart_.repeats > 0)
            set_timer(std::move(simulated), record, run.run.step_time, run.cost);
        const double seconds = static_cast<double>(run.run.steps) * run.resolved.settings.dt;
        if (seconds > 0) {
            run.body_passes = static_cast<double>(run.run.body_passes) / seconds;
            run.constraint_passes = static_cast<double>(run.run.constraint_passes) / seconds;
        }
        chart_.runs.push_back(std::move(run));
    }

    // Takes over a known run; if timings are missing, runs it again to get the parts to time.
    void go_on(std::size_t index, ChartRun known, double begin) {
        known.index = index;
        known.resolved = planned_[index].resolved;
        known.point = planned_[index].point;
        timers_.emplace_back();
        if (!stopped() && !known.run.divergence &&
            known.timings.size() < static_cast<std::size_t>(chart_.repeats)) {
            std::unique_ptr<Simulation> simulated = simulation(planned_[index], scene_);
            RunRecord record(end_, chart_.timed);
            JudgeOptions judging = noting(record, *simulated);
            judging.progress = [&](double) { progress(begin, known); };
            const JudgedRun again = judge_run(*simulated, scene_, judging);
            if (!again.divergence && !again.stopped)
                set_timer(std::move(simulated), record, again.step_time, known.cost);
        }
        chart_.runs.push_back(std::move(known));
    }

    JudgeOptions noting(RunRecord &record, Simulation &simulated) const {
        JudgeOptions judging;
        judging.wall_clock = chart_.wall_clock;
        judging.duration = options_.duration;
        judging.stop = options_.stop;
        judging.times_called = record.times();
        judging.at_time = [&](double used) { record.note(simulated, used); };
        return judging;
    }

    // For the last run.
    void set_timer(std::unique_ptr<Simulation> simulated, RunRecord &record, double used,
                   double cost) {
        std::vector<TimedPart> parts = record.take_parts(*simulated, used);
        timers_.back().emplace(std::move(simulated), std::move(parts), cost, chart_.wall_clock);
    }

    // Times each run once, in a newly shuffled order: a machine that slows down does so for all.
    void time_all(int round) {
        std::vector<std::size_t> order(timers_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        Random random(chart_.seed + static_cast<std::uint64_t>(round));
        for (std::size_t i = order.size(); i > 1; --i)
            std::swap(order[i - 1], order[random.next_index(static_cast<std::uint32_t>(i))]);
        std::vector<std::optional<double>> timings(timers_.size());
        for (std::size_t k = 0; k < order.size() && !stopped(); ++k) {
            const std::size_t i = order[k];
            if (!timers_[i] ||
                chart_.runs[i].timings.size() >= static_cast<std::size_t>(chart_.repeats))
                continue;
            timings[i] = timers_[i]->time(options_.stop);
            if (!timings[i] && !stopped())
                timers_[i].reset();
            progress(
                0.5 + 0.5 *
                          (round + static_cast<double>(k + 1) / static_cast<double>(order.size())) /
                          chart_.repeats,
                chart_.runs[i]);
        }
        // An unfinished round would favour the runs it reached.
        if (stopped())
            return;
        for (std::size_t i = 0; i < timings.size(); ++i)
            if (timings[i]) {
                chart_.runs[i].timings.push_back(*timings[i]);
                set_cost(chart_.runs[i]);
            }
        report_change();
    }

    const SceneDesc &scene_;
    ChartOptions options_;
    const std::function<void(const SceneChart &)> &changed_;
    double end_; // s, of each run
    SceneChart chart_;
    std::optional<OneStepStates> states_;
    double states_share_ = 0; // fraction of the total work
    std::vector<PlannedRun> planned_;
    std::map<int, std::unique_ptr<TaskPool>> pools_; // by thread count; outlive the timers
    std::vector<std::optional<RunTimer>> timers_;    // one per run
};

} // namespace

std::vector<SweepAxis> sweep_of(const ChartOptions &options) {
    if (!options.sweep.empty())
        return options.sweep;
    return {options.convergence ? default_convergence_sweep() : default_sweep()};
}

SceneChart chart_scene(const SceneDesc &scene, const ChartOptions &options,
                       const std::function<void(const SceneChart &)> &changed) {
    return Charting(scene, options, changed).make();
}

} // namespace plumb

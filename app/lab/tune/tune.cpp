#include "app/lab/tune/tune.h"

#include "app/lab/run/method_choice.h"
#include "app/lab/tune/choice.h"
#include "app/lab/tune/plainer.h"
#include "app/lab/tune/search.h"
#include "app/lab/tune/starts.h"
#include "app/lab/tune/trial.h"

#include <algorithm>
#include <stdexcept>

namespace plumb {

namespace {

// A run's cost before timing is rough: one this many times as dear as another is not timed.
constexpr double out_of_question = 4;

class Rows {
  public:
    Rows(const SceneDesc &scene, const TuneOptions &options) : scene_(scene), options_(options) {}

    // Simplest first: its results rule out most of the others.
    std::vector<TuneRow> of(const MethodInfo &method) const {
        std::vector<TuneRow> rows;
        RunOptions start = options_.base;
        start.method = method.name;
        for (const Precision precision : precisions())
            for (const double dt : steps(start))
                for (const int iterations : iteration_counts(method))
                    for (const bool fixed : {true, false}) {
                        TuneRow row{start, fixed};
                        row.options.precision = precision;
                        row.options.settings.give(&StepSettings::dt, dt);
                        if (iterations > 0)
                            row.options.settings.give(&StepSettings::iterations, iterations);
                        if (set_mode(method, row) && (fixed || iterations <= 1))
                            rows.push_back(std::move(row));
                    }
        return rows;
    }

    bool is_given(std::string_view setting) const {
        return options_.base.settings.has(*find_setting(setting));
    }

  private:
    std::vector<Precision> precisions() const {
        if (options_.base.precision)
            return {*options_.base.precision};
        return {Precision::f32, Precision::f64};
    }
    std::vector<double> steps(const RunOptions &start) const {
        const double dt = resolve_run(scene_, start).settings.dt;
        if (is_given("dt"))
            return {dt};
        const SettingRow &row = *find_setting("dt");
        std::vector<double> steps;
        for (const double factor : {1.0, 2.0, 0.5, 0.25})
            if (factor * dt >= row.min && factor * dt <= row.max)
                steps.push_back(factor * dt);
        return steps;
    }
    // 0: unchanged.
    std::vector<int> iteration_counts(const MethodInfo &method) const {
        if (is_given("iterations") || !reads(method, *find_setting("iterations")))
            return {0};
        return {1, 2, 4, 8};
    }
    // False if the method has no such mode, or another is given.
    bool set_mode(const MethodInfo &method, TuneRow &row) const {
        if (!method.chooses_substeps())
            return row.fixed_substeps;
        if (is_given("max_substeps")) {
            const double most =
                *options_.base.settings.find(find_setting_numbers("max_substeps").front());
            return row.fixed_substeps == (most == 1);
        }
        row.options.settings.give(&StepSettings::max_substeps,
                                  row.fixed_substeps ? 1 : method.defaults.max_substeps);
        return true;
    }

    const SceneDesc &scene_;
    const TuneOptions &options_;
};

// Times the runs that may be the cheapest, and the scene's own to compare with.
void time_best(const Trial &trial, const TuneOptions &options, Tuning &tuning,
               const std::vector<std::size_t> &choices, const Progress &progress) {
    const auto run = [&](std::size_t i) -> const TunedRun & { return tuning.runs[i]; };
    double least = run(choices.front()).cost;
    for (const std::size_t i : choices)
        least = std::min(least, run(i).cost);
    std::vector<std::size_t> timed = choices;
    std::erase_if(timed, [&](std::size_t i) { return run(i).cost > out_of_question * least; });
    if (tuning.own().verdict != TuneVerdict::diverged &&
        std::ranges::find(timed, std::size_t{0}) == timed.end())
        timed.push_back(0);
    std::vector<TimedRun> runs;
    runs.reserve(timed.size());
    for (const std::size_t i : timed)
        runs.push_back({&trial, &tuning.runs[i]});
    time_in_turns(runs, options, progress);
}

// Runs the chosen settings with twice the substeps, and times it along with all timed runs.
void add_dearer(const Trial &trial, const TuneOptions &options, SubstepSearch &search,
                Tuning &tuning, const Progress &progress) {
    tuning.dearer.reset();
    RunOptions twice = tuning.runs[*tuning.chosen].options;
    const int substeps = 2 * tuning.runs[*tuning.chosen].resolved.settings.substeps;
    if (substeps > find_setting("substeps")->max)
        return;
    twice.settings.give(&StepSettings::substeps, substeps);
    const std::size_t dearer = search.run(twice);
    const TuneVerdict verdict = tuning.runs[dearer].verdict;
    if (verdict == TuneVerdict::unfinished)
        return;
    tuning.dearer = dearer;
    std::vector<TimedRun> runs;
    for (std::size_t i = 0; i < tuning.runs.size(); ++i)
        if (!tuning.runs[i].timings.empty() || i == tuning.chosen ||
            (i == dearer && verdict != TuneVerdict::diverged))
            runs.push_back({&trial, &tuning.runs[i]});
    time_in_turns(runs, options, progress);
}

// Whether that run met the scene, with less work, and was cheaper than the chosen one in every
// round.
bool is_cheaper(const Tuning &tuning, std::optional<std::size_t> other) {
    return other && tuning.runs[*other].verdict == TuneVerdict::met &&
           is_less_work(tuning.runs[*other], tuning.runs[*tuning.chosen]) &&
           both_timed(tuning.runs[*other], tuning.runs[*tuning.chosen]) &&
           is_always_dearer(tuning.runs[*tuning.chosen], tuning.runs[*other]);
}

} // namespace

const TunedRun &Tuning::plainest() const {
    const auto last =
        std::find_if(plainer.rbegin(), plainer.rend(), [](const auto &m) { return m.is_enough; });
    return last == plainer.rend() ? runs[*chosen] : last->run;
}

Tuning tune_scene(const SceneText &text, const TuneOptions &options) {
    if (!(options.tolerance > 0 && options.tolerance <= 1))
        throw std::invalid_argument("the fraction of the tolerances must be above 0 and at most 1");
    const std::vector<SceneDesc> starts = starts_of(text, options.starts);
    const SceneDesc &scene = starts.front();
    if (!has_world(scene) || scene.expects.empty())
        throw std::invalid_argument(scene.name + (has_world(scene)
                                                      ? " has no expectations; add an [[expect]] "
                                                        "for the settings to meet"
                                                      : " has only probes, no motion to tune"));
    Tuning tuning;
    tuning.scene = scene.name;
    tuning.expectations = scene.expects.size();
    tuning.tolerance = options.tolerance;
    tuning.starts = static_cast<int>(starts.size());
    tuning.budget = options.budget;
    const ResolvedRun own = resolve_run(scene, {}), given = resolve_run(scene, options.base);
    tuning.own_is_given = own.precision != given.precision ||
                          !GivenSettings::differences(own.settings, given.settings).empty();
    const std::vector<const MethodInfo *> methods =
        methods_for(scene, options.methods, tuning.left_out);
    if (methods.empty())
        throw std::invalid_argument(why_no_method(tuning.left_out));

    const Trial trial(starts, options);
    const Rows rows(scene, options);
    std::vector<TuneRow> all;
    for (const MethodInfo *method : methods)
        for (TuneRow &row : rows.of(*method))
            all.push_back(std::move(row));
    const auto stopped = [&] { return options.stop && options.stop(); };
    double from = 0, to = 0; // progress range of the current stage
    const auto progress = [&](double fraction, const std::string &what) {
        if (options.progress)
            options.progress(from + (to - from) * fraction, what);
    };
    SubstepSearch search(trial, tuning.runs, stopped, progress);
    constexpr double searching = 0.75, timing = 0.8, comparing = 0.85;
    const auto part = [&](std::size_t i) {
        return searching * static_cast<double>(i) / static_cast<double>(all.size() + 1);
    };
    to = part(1);
    (void)search.run(options.base);
    for (std::size_t i = 0; i < all.size() && !stopped(); ++i) {
        from = part(i + 1);
        to = part(i + 2);
        search.search(all[i]);
    }

    std::vector<std::size_t> choices;
    for (std::size_t i = 0; i < tuning.runs.size(); ++i)
        if (tuning.runs[i].verdict == TuneVerdict::met &&
            std::ranges::find(methods, tuning.runs[i].resolved.method) != methods.end())
            choices.push_back(i);
    erase_needless(tuning, choices);
    if (!choices.empty()) {
        from = searching;
        to = timing;
        if (!stopped())
            time_best(trial, options, tuning, choices, progress);
        tuning.chosen = cheapest_choice(tuning, choices);
    }
    // More substeps may even be cheaper: a stiffer scene comes to rest, and sleeps, earlier.
    while (tuning.chosen && !rows.is_given("substeps") && !stopped()) {
        from = timing;
        to = comparing;
        add_dearer(trial, options, search, tuning, progress);
        if (!is_cheaper(tuning, tuning.dearer))
            break;
        tuning.chosen = tuning.dearer;
    }
    if (tuning.chosen && options.plainer && !stopped()) {
        from = comparing;
        to = 1;
        leave_out(starts, options, tuning, progress);
    }
    tuning.interrupted = stopped();
    return tuning;
}

} // namespace plumb

#include "app/lab/chart/chart_plan.h"

#include "app/lab/engines/other_engines.h"
#include "app/lab/run/method_choice.h"
#include "app/lab/run/run_text.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace plumb {

namespace {

bool is_swept(const std::vector<SweepAxis> &sweep, SettingMember member) {
    return std::ranges::any_of(
        sweep, [&](const SweepAxis &axis) { return axis.setting.setting().member == member; });
}

// Whether a setting is neither swept nor given, so the chart may choose it.
bool is_open(const ChartOptions &options, const std::vector<SweepAxis> &sweep, const char *name) {
    const SettingRow &row = *find_setting(name);
    return !is_swept(sweep, row.member) && !options.base.settings.has(row);
}

// With adaptive substeps `substeps` is only the islands' minimum, which says little about how many
// they take. If substeps are swept and max_substeps is open, fixed substeps are charted as well,
// and adaptive ones up to the scene's own most, or the method's if the scene's are fixed.
std::vector<RunOptions> substep_modes(const SceneDesc &scene, const MethodInfo &method,
                                      const ChartOptions &options,
                                      const std::vector<SweepAxis> &sweep) {
    std::vector<RunOptions> modes{options.base};
    modes.front().method = std::string(method.name);
    if (options.convergence) {
        for (const char *name : {"substeps", "max_substeps"})
            if (is_open(options, sweep, name))
                modes.front().settings.give(find_setting_numbers(name).front(), 1);
    } else if (is_swept(sweep, &StepSettings::substeps) &&
               is_open(options, sweep, "max_substeps") && method.chooses_substeps()) {
        const int most = resolve_run(scene, modes.front()).settings.max_substeps;
        modes.push_back(modes.front());
        modes[0].settings.give(&StepSettings::max_substeps, 1);
        modes[1].settings.give(&StepSettings::max_substeps,
                               most > 1 ? most : method.defaults.max_substeps);
    }
    return modes;
}

// Whether the same run is already planned at `first` or later.
bool repeats(const PlannedRun &run, const std::vector<PlannedRun> &planned, std::size_t first) {
    return std::any_of(planned.begin() + static_cast<std::ptrdiff_t>(first), planned.end(),
                       [&](const PlannedRun &other) {
                           return other.threads == run.threads &&
                                  other.resolved.precision == run.resolved.precision &&
                                  same_work(*run.resolved.method, run.resolved.settings,
                                            other.resolved.settings);
                       });
}

// Values of a sweep over something that is not a setting.
template <typename Value, typename Read>
std::vector<Value> values_of(std::string_view text, const Read &read, const char *right) {
    std::vector<Value> values;
    for (std::string_view rest = text.substr(text.find('=') + 1);;) {
        const auto comma = rest.find(',');
        const std::optional<Value> value = read(rest.substr(0, comma));
        if (!value)
            throw std::invalid_argument("sweep \"" + std::string(text) + "\": write " + right);
        if (std::ranges::find(values, *value) == values.end())
            values.push_back(*value);
        if (comma == std::string_view::npos)
            return values;
        rest = rest.substr(comma + 1);
    }
}

std::optional<Precision> read_precision(std::string_view text) {
    for (const Precision precision : {Precision::f32, Precision::f64})
        if (precision_name(precision) == text)
            return precision;
    return std::nullopt;
}

std::optional<int> read_threads(std::string_view text) {
    constexpr int most = 256;
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool fine = error == std::errc() && end == text.data() + text.size();
    return fine && value >= 1 && value <= most ? std::optional(value) : std::nullopt;
}

} // namespace

void add_sweep(ChartOptions &options, std::string_view text) {
    if (text.starts_with("precision="))
        options.precisions = values_of<Precision>(text, read_precision, "precision=float,double");
    else if (text.starts_with("threads="))
        options.threads =
            values_of<int>(text, read_threads, "threads=1,2,4, whole numbers from 1 to 256");
    else
        options.sweep.push_back(parse_sweep(text));
}

std::vector<PlannedRun> plan_chart(const SceneDesc &scene, const ChartOptions &options,
                                   const std::vector<SweepAxis> &sweep,
                                   std::vector<std::string> &left_out) {
    const std::vector<SweepPoint> points = sweep_points(sweep);
    std::vector<std::optional<Precision>> precisions{options.base.precision};
    if (!options.precisions.empty())
        precisions.assign(options.precisions.begin(), options.precisions.end());
    const std::vector<int> threads =
        options.threads.empty() ? std::vector<int>{1} : options.threads;

    std::vector<PlannedRun> planned;
    for (const MethodInfo *method : methods_for(scene, options.methods, left_out)) {
        const std::size_t first = planned.size();
        for (const RunOptions &mode : substep_modes(scene, *method, options, sweep))
            for (const std::optional<Precision> &precision : precisions)
                for (const int count : threads)
                    for (const SweepPoint &point : points) {
                        PlannedRun run{mode, {}, count, point, nullptr};
                        run.options.precision = precision;
                        run.options.settings.give(given_by(sweep, point));
                        run.resolved = resolve_run(scene, run.options);
                        if (!repeats(run, planned, first))
                            planned.push_back(std::move(run));
                    }
    }
    for (const OtherEngine *engine : options.engines) {
        if (std::string why = why_not(*engine, scene); !why.empty()) {
            left_out.push_back(std::move(why));
            continue;
        }
        const std::size_t first = planned.size();
        for (const SweepPoint &point : points) {
            PlannedRun run{options.base, {}, 1, point, engine};
            run.options.settings.give(given_by(sweep, point));
            run.resolved = resolve_run(*engine, scene, run.options.settings);
            if (!repeats(run, planned, first))
                planned.push_back(std::move(run));
        }
    }
    return planned;
}

} // namespace plumb

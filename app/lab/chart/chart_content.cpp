// What a chart's picture shows.
#include "app/lab/chart/chart.h"
#include "app/lab/chart/log_axis.h"
#include "app/lab/run/run_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace plumb {

namespace {

// Names the worst expectation of each run, where there are several: by a letter, or once for all
// where it is always the same.
class WorstNames {
  public:
    explicit WorstNames(const SceneChart &chart) {
        if (chart.measure.kind != ErrorMeasure::Kind::worst)
            return;
        for (const ChartRun &run : chart.runs)
            if (run.worst && !run.run.divergence)
                letters_[*run.worst];
        std::size_t next = 0;
        for (auto &[expectation, letter] : letters_) {
            const ExpectOutcome outcome = judge(everything_expected(chart.scene)[expectation], 0);
            if (letters_.size() > 1)
                letter = std::string(1, static_cast<char>('a' + next % 26)) +
                         (next < 26 ? "" : std::to_string(next / 26));
            ++next;
            texts_.push_back((letter.empty() ? "" : letter + "  ") + outcome.desc.name + ": " +
                             demand(outcome));
        }
    }

    // What is added to a run's label.
    [[nodiscard]] std::string suffix(const ChartRun &run) const {
        if (!run.worst || run.run.divergence || letters_.size() < 2)
            return "";
        return " " + letters_.at(*run.worst);
    }
    [[nodiscard]] bool lettered() const { return letters_.size() > 1; }
    [[nodiscard]] const std::vector<std::string> &texts() const { return texts_; }

  private:
    std::map<std::size_t, std::string> letters_; // by expectation
    std::vector<std::string> texts_;
};

// The step, substeps and iterations always; others where a run has another value than the default.
bool is_worth_saying(const SceneChart &chart, SettingNumber number) {
    const SettingMember &member = number.setting().member;
    if (member == SettingMember(&StepSettings::dt) ||
        member == SettingMember(&StepSettings::substeps) ||
        member == SettingMember(&StepSettings::iterations))
        return true;
    return std::ranges::any_of(chart.runs, [&](const ChartRun &run) {
        return reads(*run.resolved.method, number.setting()) &&
               setting_value(run.resolved.settings, number) !=
                   setting_value(run.resolved.method->defaults, number);
    });
}

// Whether islands may take substeps of their own in it.
bool chooses(const ChartRun &run) {
    return run.resolved.method->chooses_substeps() && run.resolved.settings.max_substeps > 1;
}

// Whether the same method is there with just so many substeps and with at least so many.
bool has_both_modes(const SceneChart &chart) {
    return std::ranges::any_of(chart.runs, chooses) &&
           std::ranges::any_of(chart.runs, [](const ChartRun &run) {
               return run.resolved.method->chooses_substeps() && !chooses(run);
           });
}

// "4", or "4 (Soft step), 1 (Runge-Kutta 4)" where methods differ: each value once.
std::string values_by_method(const SceneChart &chart, SettingNumber number) {
    std::vector<std::pair<std::string, std::string>> groups; // value, titles
    const MethodInfo *last = nullptr;
    for (const ChartRun &run : chart.runs) {
        if (run.resolved.method == last)
            continue;
        last = run.resolved.method;
        const std::string value =
            setting_label(number, setting_value(run.resolved.settings, number));
        const auto group =
            std::ranges::find(groups, value, &std::pair<std::string, std::string>::first);
        if (group == groups.end())
            groups.emplace_back(value, last->title);
        else
            group->second += ", " + std::string(last->title);
    }
    if (groups.size() == 1)
        return groups.front().first;
    std::string each;
    for (const auto &[value, titles] : groups)
        each.append(each.empty() ? "" : ", ").append(value).append(" (").append(titles).append(")");
    return each;
}

} // namespace

ChartContent chart_content(const SceneChart &chart, const std::string &command) {
    ChartContent content;
    content.title =
        (chart.scene.title.empty() ? chart.scene.name : chart.scene.title) + ": what truth costs";
    content.subtitle = chart.measure.explanation;
    if (chart.interrupted) {
        const auto finished =
            std::count_if(chart.runs.begin(), chart.runs.end(), [](const ChartRun &run) {
                return run.status != ChartStatus::unfinished;
            });
        content.subtitle = "INTERRUPTED: " + std::to_string(finished) + " of " +
                           std::to_string(chart.planned) + " runs. " + content.subtitle;
    }
    content.cost_title = "CPU time per simulated second";
    content.error_title = chart.measure.title;
    // Where the numbers at the ticks have no unit of their own.
    if (chart.measure.unit != "1" && !takes_prefix(chart.measure.unit))
        content.error_title += " (" + chart.measure.unit + ")";
    content.error_unit = chart.measure.unit;
    const WorstNames worst(chart);
    content.label_meaning =
        sweep_label_meaning(chart.sweep) + (worst.lettered() ? ", worst expectation" : "");
    content.worst = worst.texts();
    content.limit = chart.measure.limit;
    content.limit_label = chart.measure.limit_label;
    content.left_out = chart.left_out;

    const bool both = has_both_modes(chart);
    const MethodInfo *method = nullptr;
    bool chosen = false;
    SweepPoint others; // the point less its first axis: each has its own line
    for (const ChartRun &run : chart.runs) {
        if (run.status == ChartStatus::unfinished || !(run.cost > 0))
            continue;
        const SweepPoint rest(run.point.begin() + 1, run.point.end());
        if (run.resolved.method != method || (both && chooses(run) != chosen)) {
            method = run.resolved.method;
            chosen = chooses(run);
            ChartSeries series;
            series.name = std::string(method->title);
            for (std::size_t i = 0; i < method_infos().size(); ++i)
                if (&method_infos()[i] == method)
                    series.style = i;
            if (both && method->chooses_substeps()) {
                series.name += chosen ? ", at least so many" : ", just so many";
                series.style += chosen ? 0 : method_infos().size();
            }
            content.series.push_back(std::move(series));
            content.series.back().lines.emplace_back();
            others = rest;
        } else if (rest != others) {
            content.series.back().lines.emplace_back();
            others = rest;
        }
        content.series.back().lines.back().push_back(content.marks.size());
        ChartMark mark;
        mark.cost = run.cost;
        mark.cost_low = run.cost_low;
        mark.cost_high = run.cost_high;
        mark.failed = !std::isfinite(run.error);
        mark.error = mark.failed ? 0 : run.error;
        mark.outside = run.status == ChartStatus::outside;
        mark.pareto = run.pareto;
        mark.label = sweep_label(chart.sweep, run.point) + worst.suffix(run);
        mark.series = content.series.size() - 1;
        content.marks.push_back(std::move(mark));
    }

    // What was not swept, where it is the same for all.
    std::string settings;
    const auto swept = [&](SettingNumber number) {
        return std::ranges::find(chart.sweep, number, &SweepAxis::setting) != chart.sweep.end();
    };
    const auto add = [&](const std::string &text) {
        settings += (settings.empty() ? "" : "  ·  ") + text;
    };
    if (!chart.runs.empty()) {
        const ResolvedRun &first = chart.runs.front().resolved;
        for (const SettingNumber number : setting_numbers())
            if (!swept(number) && is_worth_saying(chart, number) &&
                !(both && number.setting().name == "max_substeps"))
                add(setting_name(number) + " " + values_by_method(chart, number));
        add(std::string(precision_name(first.precision)) + " precision");
        const bool timed = std::any_of(chart.runs.begin(), chart.runs.end(),
                                       [](const ChartRun &run) { return !run.timings.empty(); });
        if (timed) {
            char text[160];
            std::snprintf(text, sizeof text,
                          "one thread, median of %d interleaved timings of the last %.4g s "
                          "(spread %.0f %%)",
                          chart.repeats, chart.timed, 100 * chart.median_spread());
            add(text);
        } else {
            add("one thread, timed once");
        }
    }
    content.footer.push_back(settings);
    if (!command.empty())
        content.footer.push_back(command);
    return content;
}

} // namespace plumb

// What a chart's picture shows.
#include "app/lab/chart/chart.h"
#include "app/lab/chart/convergence.h"
#include "app/lab/chart/curve_style.h"
#include "app/lab/chart/log_axis.h"
#include "app/lab/provenance.h"
#include "app/lab/run/method_choice.h"
#include "app/lab/run/run_text.h"
#include "app/lab/timing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace plumb {

namespace {

// Names each run's worst expectation if the scene has several: by a letter, or once if it is the
// same for all runs.
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

    // Appended to a run's label.
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

// dt, substeps and iterations always; others if any run has a non-default value.
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

// Whether any method appears with both fixed and adaptive substeps.
bool has_both_modes(const SceneChart &chart) {
    return std::ranges::any_of(chart.runs, [&](const ChartRun &run) {
        return curve_name(chart, run).find(" substeps") != std::string::npos;
    });
}

// Each method has a style of its own, the same on every chart. Further curves of a method keep its
// colour, and take other dashes and another shape; other engines take what no method has.
std::size_t style_of(const MethodInfo &method, const std::vector<ChartSeries> &earlier) {
    const auto methods = method_infos();
    const auto own = static_cast<std::size_t>(
        std::ranges::find_if(methods, [&](const MethodInfo &each) { return &each == &method; }) -
        methods.begin());
    const auto is_free = [&](std::size_t style) {
        return std::ranges::find(earlier, style, &ChartSeries::style) == earlier.end();
    };
    if (own < methods.size())
        for (std::size_t style = own; style < style_count; style += series_colour_count)
            if ((style == own || style >= methods.size()) && is_free(style))
                return style;
    for (std::size_t style = methods.size(); style < style_count; ++style)
        if (is_free(style))
            return style;
    return own % style_count;
}

// The first run's text, plus "and others" if any run differs.
std::string first_of(const SceneChart &chart, std::string ChartRun::*text,
                     const std::string &here) {
    const std::string &first = chart.runs.front().*text;
    const bool same =
        std::ranges::all_of(chart.runs, [&](const ChartRun &run) { return run.*text == first; });
    return (first.empty() ? here : first) + (same ? "" : " and others");
}

// "not finite", "check failed", "no result"
std::string short_reason(const ChartRun &run) {
    if (!run.run.divergence)
        return "no result";
    return run.failure.starts_with("not finite") ? "not finite" : "check failed";
}

// One line per series: "Explicit Euler, 1, 2, 4: not finite"; a single run gets its full failure
// text.
class FailedSeries {
  public:
    void add(const std::string &series, const std::string &point, const std::string &reason,
             const std::string &why) {
        const auto known = std::ranges::find(all_, series, &Entry::series);
        if (known == all_.end()) {
            all_.push_back({series, point, why, {reason}});
            return;
        }
        known->points += ", " + point;
        if (std::ranges::find(known->reasons, reason) == known->reasons.end())
            known->reasons.push_back(reason);
        known->why.clear();
    }
    [[nodiscard]] std::vector<std::string> lines() const {
        std::vector<std::string> lines;
        for (const Entry &entry : all_) {
            std::string why = entry.why;
            if (why.empty())
                for (const std::string &reason : entry.reasons)
                    why += (why.empty() ? "" : " or ") + reason;
            lines.push_back(entry.series + ", " + entry.points + ": " + why);
        }
        return lines;
    }

  private:
    struct Entry {
        std::string series, points, why;
        std::vector<std::string> reasons;
    };
    std::vector<Entry> all_;
};

// "4", or "4 (Soft step), 1 (Runge-Kutta 4)" where methods differ.
std::string values_by_method(const SceneChart &chart, SettingNumber number) {
    std::vector<std::pair<std::string, std::string>> values;
    const MethodInfo *last = nullptr;
    for (const ChartRun &run : chart.runs)
        if (run.resolved.method != last) {
            last = run.resolved.method;
            values.emplace_back(
                last->title, setting_label(number, setting_value(run.resolved.settings, number)));
        }
    return values_by_name(values);
}

// The explanation, capitalised as a sentence; a name stays as it is.
std::string subtitle_of(const ErrorMeasure &measure) {
    std::string text = measure.explanation;
    if (measure.kind != ErrorMeasure::Kind::expectation && !text.empty() && text[0] >= 'a' &&
        text[0] <= 'z')
        text[0] = static_cast<char>(text[0] - 'a' + 'A');
    return text;
}

} // namespace

ChartContent chart_content(const SceneChart &chart, const std::string &command) {
    ChartContent content;
    content.title = (chart.scene.title.empty() ? chart.scene.name : chart.scene.title) +
                    (chart.convergence  ? ": how the error falls with dt"
                     : chart.steps_from ? ": what an accurate step costs"
                                        : ": what accuracy costs");
    content.subtitle = subtitle_of(chart.measure);
    if (chart.interrupted)
        content.subtitle = "INTERRUPTED: " + std::to_string(chart.finished()) + " of " +
                           std::to_string(chart.planned) + " runs. " + content.subtitle;
    content.cost_title =
        chart.wall_clock ? "Wall time per simulated second" : "CPU time per simulated second";
    content.error_title = chart.measure.title;
    // Tick labels in power-of-ten form carry no unit then: see short_quantity.
    if (chart.measure.unit != "1" && !takes_prefix(chart.measure.unit))
        content.error_title += " (" + chart.measure.unit + ")";
    content.error_unit = chart.measure.unit;
    const WorstNames worst(chart);
    content.label_meaning =
        sweep_label_meaning(chart.sweep) + (worst.lettered() ? ", worst expectation" : "");
    content.worst = worst.texts();
    content.limit = chart.measure.limit;
    content.limit_label = chart.measure.limit_label;
    content.left_out = not_judged(chart);
    for (std::string &why : grouped_reasons(chart.left_out))
        content.left_out.push_back(std::move(why));
    if (chart.steps_from) {
        content.floor = chart.steps_from->floor();
        content.floor_label = "not resolved below " + short_quantity(*content.floor, "m");
    }

    if (chart.convergence) {
        content.cost_title = "dt";
        content.label_meaning.clear();
        content.worst.clear();
    } else {
        content.budget = chart.budget;
        content.budget_label = chart.budget == 1 ? "60 Hz" : "budget";
    }
    const std::vector<CurveOrder> orders = curve_orders(chart);
    // With many failures the crosses are too close for reasons; the list gives them.
    constexpr std::ptrdiff_t few = 6;
    const bool says_why = std::ranges::count_if(chart.runs, [](const ChartRun &run) {
                              return !std::isfinite(run.error);
                          }) <= few;
    FailedSeries failed;
    std::string curve;
    SweepPoint others; // the point without its first axis: one line for each
    for (const ChartRun &run : chart.runs) {
        if (run.status == ChartStatus::unfinished || !(run.cost > 0))
            continue;
        const SweepPoint rest(run.point.begin() + 1, run.point.end());
        if (const std::string name = curve_name(chart, run); name != curve) {
            curve = name;
            ChartSeries series{name, style_of(*run.resolved.method, content.series), {{}}};
            for (const CurveOrder &order : orders)
                if (order.name == name)
                    series.name += ": " + order_text(order);
            content.series.push_back(std::move(series));
            others = rest;
        } else if (rest != others) {
            content.series.back().lines.emplace_back();
            others = rest;
        }
        content.series.back().lines.back().push_back(content.marks.size());
        ChartMark mark;
        mark.cost = chart.convergence ? run.resolved.settings.dt : run.cost;
        mark.cost_low = chart.convergence ? mark.cost : run.cost_low;
        mark.cost_high = chart.convergence ? mark.cost : run.cost_high;
        mark.failed = !std::isfinite(run.error);
        mark.error = mark.failed ? 0 : run.error;
        mark.outside = run.status == ChartStatus::outside;
        mark.pareto = run.pareto;
        const std::string point = sweep_label(chart.sweep, run.point);
        if (mark.failed) {
            const std::string reason = short_reason(run);
            mark.label = chart.convergence ? reason : point;
            if (says_why && !chart.convergence)
                mark.label.append(" ").append(reason);
            failed.add(content.series.back().name, point, reason, run.failure);
        } else if (!chart.convergence) {
            mark.label = point + worst.suffix(run);
        }
        mark.series = content.series.size() - 1;
        content.marks.push_back(std::move(mark));
    }
    content.failures = failed.lines();

    // Settings that were not swept.
    std::string settings;
    const auto swept = [&](SettingNumber number) {
        return std::ranges::find(chart.sweep, number, &SweepAxis::setting) != chart.sweep.end();
    };
    const auto add = [&](const std::string &text) {
        settings += (settings.empty() ? "" : "  ·  ") + text;
    };
    const bool both = has_both_modes(chart);
    if (chart.steps_from)
        add("states of " + chart.steps_from->accurate + ", whose own error is " +
            with_unit(chart.steps_from->own_error.rms, "m"));
    if (!chart.runs.empty()) {
        const ResolvedRun &first = chart.runs.front().resolved;
        for (const SettingNumber number : setting_numbers())
            if (!swept(number) && is_worth_saying(chart, number) &&
                !(both && number.setting().name == "max_substeps"))
                add(setting_name(number) + " " + values_by_method(chart, number));
        if (std::ranges::all_of(chart.runs, [&](const ChartRun &run) {
                return run.resolved.precision == first.precision;
            }))
            add(std::string(precision_name(first.precision)) + " precision");
        const bool timed = std::any_of(chart.runs.begin(), chart.runs.end(),
                                       [](const ChartRun &run) { return !run.timings.empty(); });
        const std::string on = chart.wall_clock ? "wall time" : "one thread";
        if (timed) {
            char text[160];
            std::snprintf(text, sizeof text, "%s, %s of parts throughout the run", on.c_str(),
                          timings_text(chart.repeats).c_str());
            std::string all = text;
            if (chart.repeats > 1) {
                std::snprintf(text, sizeof text, " (spread %.0f %%)", 100 * chart.median_spread());
                all += text;
            }
            add(all);
        } else if (!chart.convergence) {
            add(on + ", timed once");
        }
        add(first_of(chart, &ChartRun::machine, machine()));
        add("commit " + first_of(chart, &ChartRun::commit, build_commit()));
    }
    content.footer.push_back(settings);
    if (!command.empty())
        content.footer.push_back(command);
    return content;
}

} // namespace plumb

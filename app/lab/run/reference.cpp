#include "app/lab/run/reference.h"

#include "app/lab/interrupt.h"
#include "app/lab/progress.h"
#include "app/lab/run/accurate_run.h"
#include "app/lab/run/judged_run.h"
#include "app/lab/run/run_text.h"
#include "app/lab/run/scene_text.h"
#include "app/lab/run/sweep.h"
#include "engine/scene/expect.h"
#include "engine/scene/file/truths.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <utility>

namespace plumb {

namespace {

// To a hundredth of the estimate: further digits mean nothing.
std::string known_digits(double value, double estimate) {
    constexpr double finest = 1e-12, coarsest = 1;
    const double shown = std::clamp(estimate / 100, finest, coarsest);
    char text[48];
    std::snprintf(text, sizeof text, "%.*f", -static_cast<int>(std::floor(std::log10(shown))),
                  value);
    return text;
}

// Rounds up to two digits.
double rounded_estimate(double change) {
    if (!std::isfinite(change))
        return std::numeric_limits<double>::infinity();
    if (change == 0)
        return 0;
    const int digit = static_cast<int>(std::floor(std::log10(change))) - 1;
    char text[24];
    std::snprintf(text, sizeof text, "%.0fe%d", std::ceil(change / std::pow(10, digit)), digit);
    return std::stod(text);
}

// A quantity at each step of a run.
struct Course {
    std::span<const double> times, values;
    double at(double time) const { return curve_at(values, times.front(), times.back(), time); }
};

double farthest(const std::vector<double> &curve, const Course &course, const ExpectDesc &desc) {
    double distance = 0;
    for (std::size_t i = 0; i < course.times.size(); ++i)
        if (const double time = course.times[i]; time >= desc.from && time <= desc.to)
            distance = std::max(
                distance, std::abs(curve_at(curve, desc.from, desc.to, time) - course.values[i]));
    return distance;
}

// The fewest values, to within a sixteenth, that interpolate the course closely enough; empty if
// that takes more than there are steps.
std::vector<double> curve_of(const Course &course, const ExpectDesc &desc) {
    for (std::size_t count = least_curve; count < course.times.size(); count += 1 + count / 16) {
        std::vector<double> curve;
        for (std::size_t i = 0; i < count; ++i)
            curve.push_back(course.at(std::lerp(
                desc.from, desc.to, static_cast<double>(i) / static_cast<double>(count - 1))));
        if (farthest(curve, course, desc) < desc.tolerance / 20)
            return curve;
    }
    return {};
}

// Replaces the curve by this course's own. Returns the distance from the course of the old or the
// new one, whichever is larger; NaN if either is missing.
double change_of_curve(RefinedTruth &truth, const Course &course) {
    const std::vector<double> before = std::exchange(truth.curve, curve_of(course, truth.desc));
    if (before.empty() || truth.curve.empty())
        return NAN;
    return std::max(farthest(before, course, truth.desc),
                    farthest(truth.curve, course, truth.desc));
}

} // namespace

bool RefinedTruth::agrees() const {
    return std::abs(value - desc.value) < desc.tolerance / 10;
}

std::vector<RefinedTruth> refine(const SceneDesc &scene, const RefineOptions &options) {
    std::vector<RefinedTruth> truths;
    for (const ExpectDesc &expect : scene.expects)
        if (expect.relation == ExpectDesc::Relation::equals &&
            (expect.estimate || !options.only_estimated)) {
            RefinedTruth &truth = truths.emplace_back();
            truth.desc = expect;
            truth.unit = judge(expect, 0).unit;
        }
    constexpr int substeps = 16;
    double dt = resolve_run(scene, {}).settings.dt;
    for (int halving = 0; halving <= options.halvings; ++halving, dt /= 2) {
        // Only runs until the last window of the truths not settled yet.
        SceneDesc left = scene;
        left.expects.clear();
        for (const RefinedTruth &truth : truths)
            if (!truth.settled())
                left.expects.push_back(truth.desc);
        if (left.expects.empty())
            break;
        const RunOptions run = accurate_run(scene, {}, dt, substeps);
        const std::unique_ptr<Simulation> simulation = Simulation::create(left, run, nullptr);
        JudgeOptions judging;
        judging.keep_courses = true;
        judging.stop = options.stop;
        judging.progress = [&](double fraction) {
            if (options.progress)
                options.progress(dt, fraction);
        };
        const JudgedRun judged = judge_run(*simulation, left, judging);
        if (judged.stopped)
            return {};
        for (std::size_t i = 0; i < judged.outcomes.size(); ++i) {
            const ExpectOutcome &outcome = judged.outcomes[i];
            RefinedTruth &truth = *std::ranges::find(
                truths, outcome.desc.name, [](const RefinedTruth &each) { return each.desc.name; });
            const double before = truth.value;
            truth.value = judged.divergence ? NAN : outcome.measured;
            double change = std::abs(truth.value - before);
            if (!truth.desc.curve.empty())
                change = std::isfinite(truth.value)
                             ? change_of_curve(truth, {judged.times, judged.courses[i]})
                             : NAN;
            truth.estimate = rounded_estimate(change);
            truth.run = resolve_run(scene, run);
        }
    }
    return truths;
}

namespace {

void print(std::ostream &out, const std::string &scene, const std::vector<RefinedTruth> &truths) {
    for (const RefinedTruth &truth : truths) {
        const bool known = truth.settled();
        out << (!known           ? "-     "
                : truth.agrees() ? "ok    "
                                 : "OTHER ")
            << scene << "/" << truth.desc.name << ": ";
        const bool is_curve = !truth.desc.curve.empty();
        if (!std::isfinite(truth.value))
            out << "nothing was measured";
        else if (is_curve && truth.curve.empty())
            out << "a curve with more values than there are steps";
        else if (is_curve)
            out << "a curve of " << truth.curve.size() << " values";
        else
            out << known_digits(truth.value, truth.estimate)
                << (truth.unit == "1" ? "" : " " + truth.unit);
        if (std::isfinite(truth.estimate))
            out << (known ? ", changed by " : ", not settled: still changed by ")
                << with_unit(truth.estimate, truth.unit);
        if (is_curve)
            out << "; the file's is off by " << with_unit(truth.value, truth.unit) << " ("
                << truth.desc.reduce << "), tolerance ";
        else
            out << "; the file says " << with_unit(truth.desc.value, truth.unit) << " ± ";
        out << with_unit(truth.desc.tolerance, truth.unit);
        if (truth.desc.estimate)
            out << ", by refinement";
        out << "  [" << run_text(truth.run) << "]\n";
    }
}

ExitCode write(const SceneText &scene, const std::vector<RefinedTruth> &truths, std::ostream &out,
               std::ostream &err) {
    std::vector<WrittenTruth> written;
    for (const RefinedTruth &truth : truths) {
        if (!truth.desc.estimate || !truth.settled())
            continue;
        std::vector<double> values = truth.curve;
        if (truth.desc.curve.empty())
            values = {truth.value};
        for (double &value : values)
            value = std::stod(known_digits(value, truth.estimate));
        written.push_back({truth.desc.name, std::move(values), truth.estimate});
    }
    std::string text;
    try {
        text = with_truths(scene.text, scene.path.string(), written);
    } catch (const std::invalid_argument &error) {
        throw std::invalid_argument(scene.path.string() +
                                    ": the true values cannot be written to it; " + error.what());
    }
    if (text == scene.text)
        out << "Nothing to write: the file already has these values.\n";
    else
        write_back(scene, text, err);
    return ExitCode::fine;
}

} // namespace

ExitCode refine_scene(const ReferenceCommand &command, std::ostream &out, std::ostream &err) {
    const std::optional<SceneText> text = read_scene(command.scene, err);
    if (!text)
        return ExitCode::bad_input;
    const SceneDesc scene = parse_scene(text->text, text->path.string()).scene;
    const auto estimated = [](const ExpectDesc &expect) { return expect.estimate.has_value(); };
    if (command.write && std::ranges::none_of(scene.expects, estimated))
        throw std::invalid_argument(
            text->path.string() +
            ": no expectation has an `estimate`, and only those with one are written; mark one "
            "with estimate = 0");
    const InterruptGuard interrupt;
    ProgressLine line(err);
    RefineOptions options;
    options.only_estimated = command.write;
    options.stop = InterruptGuard::requested;
    options.progress = [&](double dt, double fraction) {
        line.show(fraction, scene.name + ", dt " + format_dt(dt));
    };
    const std::vector<RefinedTruth> truths = refine(scene, options);
    line.clear();
    if (InterruptGuard::requested()) {
        err << "interrupted; nothing was written\n";
        return ExitCode::fine; // main reports the interruption
    }
    if (truths.empty())
        out << "-     " << scene.name
            << ": has no expectation with `equals`, so no true value to refine\n";
    print(out, scene.name, truths);
    out << std::flush;
    const bool wrong = std::ranges::any_of(truths, [&](const RefinedTruth &truth) {
        return truth.desc.estimate && (!truth.settled() || (!truth.agrees() && !command.write));
    });
    if (command.write)
        (void)write(*text, truths, out, err);
    return wrong ? ExitCode::outside_tolerance : ExitCode::fine;
}

} // namespace plumb

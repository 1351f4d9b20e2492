#include "app/lab/run/reference.h"

#include "app/lab/interrupt.h"
#include "app/lab/progress.h"
#include "app/lab/run/accurate_run.h"
#include "app/lab/run/judged_run.h"
#include "app/lab/run/run_text.h"
#include "app/lab/run/scene_text.h"
#include "app/lab/run/sweep.h"
#include "engine/scene/file/truths.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace plumb {

namespace {

// To a hundredth of the estimate: more digits would say nothing.
std::string known_digits(double value, double estimate) {
    constexpr double finest = 1e-12, coarsest = 1;
    const double shown = std::clamp(estimate / 100, finest, coarsest);
    char text[48];
    std::snprintf(text, sizeof text, "%.*f", -static_cast<int>(std::floor(std::log10(shown))),
                  value);
    return text;
}

// Two digits.
double rounded_estimate(double estimate) {
    char text[24];
    std::snprintf(text, sizeof text, "%.2g", estimate);
    return std::stod(text);
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
        // Only as far as the windows of those reach that are not settled.
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
        judging.stop = options.stop;
        judging.progress = [&](double fraction) {
            if (options.progress)
                options.progress(dt, fraction);
        };
        const JudgedRun judged = judge_run(*simulation, left, judging);
        if (judged.stopped)
            return {};
        for (const ExpectOutcome &outcome : judged.outcomes) {
            RefinedTruth &truth = *std::ranges::find(
                truths, outcome.desc.name, [](const RefinedTruth &each) { return each.desc.name; });
            const double before = truth.value;
            truth.value = judged.divergence ? NAN : outcome.measured;
            const double change = std::abs(truth.value - before);
            truth.estimate =
                std::isfinite(change) ? change : std::numeric_limits<double>::infinity();
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
        if (std::isfinite(truth.value))
            out << known_digits(truth.value, truth.estimate)
                << (truth.unit == "1" ? "" : " " + truth.unit);
        else
            out << "nothing was measured";
        if (std::isfinite(truth.estimate))
            out << (known ? ", changed by " : ", not settled: still changed by ")
                << with_unit(rounded_estimate(truth.estimate), truth.unit);
        out << "; the file says " << with_unit(truth.desc.value, truth.unit) << " within "
            << with_unit(truth.desc.tolerance, truth.unit);
        if (truth.desc.estimate)
            out << ", by refinement";
        out << "  [" << run_text(truth.run) << "]\n";
    }
}

ExitCode write(const SceneText &scene, const std::vector<RefinedTruth> &truths, std::ostream &out,
               std::ostream &err) {
    std::vector<WrittenTruth> written;
    for (const RefinedTruth &truth : truths)
        if (truth.desc.estimate && truth.settled())
            written.push_back({truth.desc.name,
                               std::stod(known_digits(truth.value, truth.estimate)),
                               rounded_estimate(truth.estimate)});
    std::string text;
    try {
        text = with_truths(scene.text, scene.path.string(), written);
    } catch (const std::invalid_argument &error) {
        throw std::invalid_argument(scene.path.string() +
                                    ": the truths cannot be written into it; " + error.what());
    }
    if (text == scene.text)
        out << "Nothing to write: the file has these truths.\n";
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
            ": none of its truths is by refinement, so there is none to write; those with an "
            "estimate are: estimate = 0");
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
        err << "interrupted; nothing is written\n";
        return ExitCode::fine; // the program says that it was interrupted
    }
    if (truths.empty())
        out << "-     " << scene.name << ": expects no motion to be equal to anything\n";
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

#include "app/lab/run/check.h"

#include "app/lab/interrupt.h"
#include "app/lab/progress.h"
#include "app/lab/run/load_scenes.h"
#include "app/lab/run/run_text.h"
#include "engine/scene/probe.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <stdexcept>

namespace plumb {

namespace {

// Counts the runs by outcome, and prints the totals.
class Tally {
  public:
    void add(const CheckOutcome &outcome) {
        if (exit_code(outcome) != ExitCode::fine)
            ++missed_;
        else if (outcome.run.any_judged())
            ++within_;
        else
            ++nothing_;
    }

    void skip() { ++skipped_; }

    [[nodiscard]] std::size_t runs() const { return within_ + missed_ + nothing_; }

    // "3 runs: 2 within tolerance, 1 with nothing to judge; 4 skipped"
    void print(std::ostream &out) const {
        const std::string skipped =
            skipped_ == 0 ? "" : "; " + std::to_string(skipped_) + " skipped";
        if (runs() == 0) {
            out << "nothing was checked" << skipped << '\n';
            return;
        }
        out << runs() << (runs() == 1 ? " run" : " runs");
        const char *separator = ": ";
        const auto say = [&](std::size_t count, const char *what) {
            if (count == 0)
                return;
            out << separator << count << ' ' << what;
            separator = ", ";
        };
        say(within_, "within tolerance");
        say(missed_, "not within tolerance");
        say(nothing_, "with nothing to judge");
        out << skipped << '\n';
    }

  private:
    std::size_t within_ = 0, missed_ = 0, nothing_ = 0, skipped_ = 0;
};

// False if the method cannot run the scene, or the options are refused.
bool can_run(const SceneDesc &scene, const RunOptions &options) {
    try {
        return why_not(*resolve_run(scene, options).method, scene).empty();
    } catch (const std::invalid_argument &) {
        return false;
    }
}

const char *sign(Verdict verdict) {
    switch (verdict) {
    case Verdict::met:
        return "ok    ";
    case Verdict::missed:
        return "MISSED ";
    case Verdict::pending:
    case Verdict::unseen:
        return "-     ";
    }
    return "";
}

} // namespace

CheckOutcome check_scene(const SceneDesc &scene, const RunOptions &options, TaskPool *tasks,
                         const JudgeOptions &judging) {
    CheckOutcome outcome;
    outcome.scene = scene.name;
    outcome.resolved = resolve_run(scene, options);
    outcome.why_not = why_not(*outcome.resolved.method, scene);
    if (!outcome.why_not.empty())
        return outcome;
    outcome.has_world = has_world(scene);
    if (outcome.has_world) {
        const auto simulation = Simulation::create(scene, options, tasks);
        outcome.run = judge_run(*simulation, scene, judging);
    }
    judge_probes(scene, outcome.resolved.precision, outcome.run.outcomes);
    return outcome;
}

ExitCode exit_code(const CheckOutcome &outcome) {
    if (!outcome.why_not.empty())
        return ExitCode::bad_input;
    if (outcome.run.divergence)
        return ExitCode::diverged;
    return outcome.run.all_met() ? ExitCode::fine : ExitCode::outside_tolerance;
}

void print(std::ostream &out, const CheckOutcome &outcome) {
    if (!outcome.why_not.empty()) {
        out << "-     " << outcome.scene << ": skipped: " << outcome.why_not << '\n';
        return;
    }
    const std::string how =
        "  [" +
        (outcome.has_world ? run_text(outcome.resolved)
                           : std::string(precision_name(outcome.resolved.precision))) +
        "]\n";
    for (const ExpectOutcome &expect : outcome.run.outcomes) {
        out << sign(expect.verdict) << outcome.scene << "/" << expect.desc.name << ": ";
        if (expect.judged())
            out << (std::isfinite(expect.measured) ? with_unit(expect.measured, expect.unit)
                                                   : "none")
                << ", expected " << demand(expect);
        else if (expect.verdict == Verdict::unseen)
            out << "not judged, as the run starts from a later state; expected " << demand(expect);
        else
            out << "not measured, expected " << demand(expect);
        if (expect.judged() && std::isfinite(expect.error) &&
            expect.desc.relation == ExpectDesc::Relation::equals && expect.desc.curve.empty())
            out << ", off by " << with_unit(expect.error, expect.unit);
        out << how;
    }
    if (outcome.run.outcomes.empty() && !outcome.has_world)
        out << "-     " << outcome.scene << ": expects nothing of its probes" << how;
    else if (outcome.run.outcomes.empty() && !outcome.run.divergence)
        out << "-     " << outcome.scene << ": expects nothing, stayed finite for "
            << with_unit(outcome.run.time, "s") << how;
    if (outcome.run.divergence)
        out << "DIVERGED " << outcome.scene << ": " << describe(*outcome.run.divergence) << how;
    if (outcome.run.stopped)
        out << "-     " << outcome.scene << ": interrupted at " << with_unit(outcome.run.time, "s")
            << how;
}

ExitCode check_scenes(const CheckCommand &command, std::ostream &out, std::ostream &err) {
    LoadedScenes loaded = load_scenes(command.scenes, err);
    ExitCode code = loaded.all_fine ? ExitCode::fine : ExitCode::bad_input;
    std::vector<RunOptions> runs;
    for (const std::string &method : command.methods) {
        runs.push_back(command.run);
        runs.back().method = method;
    }
    const bool pass_over = !runs.empty();
    if (runs.empty())
        runs.push_back(command.run);

    const InterruptGuard interrupt;
    ProgressLine line(err);
    Tally tally;
    // A scene without a world is the same for every method.
    const auto is_repeated = [&](const SceneDesc &scene, const RunOptions &options) {
        return !has_world(scene) && &options != &runs.front();
    };
    std::size_t total = 0;
    for (const SceneDesc &scene : loaded.scenes)
        for (const RunOptions &options : runs)
            if (!is_repeated(scene, options) && can_run(scene, options))
                ++total;
    const auto interrupted = [&] {
        tally.print(out);
        err << "interrupted: " << tally.runs() << " of " << total << " runs are done\n";
        return worse(code, ExitCode::outside_tolerance);
    };
    for (const SceneDesc &scene : loaded.scenes)
        for (const RunOptions &options : runs) {
            if (is_repeated(scene, options))
                continue;
            if (InterruptGuard::requested())
                return interrupted();
            JudgeOptions judging;
            judging.stop = InterruptGuard::requested;
            judging.progress = [&](double fraction) {
                line.show((static_cast<double>(tally.runs()) + fraction) /
                              static_cast<double>(std::max<std::size_t>(total, 1)),
                          scene.name + (options.method.empty() ? "" : ", " + options.method));
            };
            judging.progress(0);
            try {
                const CheckOutcome outcome = check_scene(scene, options, command.tasks, judging);
                line.clear();
                print(out, outcome);
                out << std::flush;
                if (!outcome.why_not.empty()) {
                    if (!pass_over)
                        code = worse(code, exit_code(outcome));
                    tally.skip();
                    continue;
                }
                if (outcome.run.stopped)
                    return interrupted();
                code = worse(code, exit_code(outcome));
                tally.add(outcome);
            } catch (const std::invalid_argument &error) {
                line.clear();
                err << scene.name << ": " << error.what() << '\n';
                code = ExitCode::bad_input;
                tally.skip();
            }
        }
    tally.print(out);
    return code;
}

} // namespace plumb

// Prints what tuning found.
#include "app/lab/run/method_choice.h"
#include "app/lab/run/run_text.h"
#include "app/lab/run/sweep.h"
#include "app/lab/timing.h"
#include "app/lab/tune/tune.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace plumb {

namespace {

bool has_iterations(const MethodInfo &method) {
    return reads(method, *find_setting("iterations"));
}

std::string in_words(const ResolvedRun &run) {
    const bool one = run.settings.substeps == 1 && substeps_text(run) == "1";
    std::string text = std::string(run.method->name) + " with " + substeps_text(run) +
                       (one ? " substep" : " substeps");
    if (has_iterations(*run.method))
        text += ", " + std::to_string(run.settings.iterations) +
                (run.settings.iterations == 1 ? " iteration" : " iterations");
    return text + " and a dt of " + format_dt(run.settings.dt) + ", in " +
           std::string(precision_name(run.precision));
}

std::string error_text(const TunedRun &run) {
    return three_digits(run.error) + " of its tolerance" +
           (run.worst.empty() ? "" : " (" + run.worst + ")");
}

std::string cost_text(const TunedRun &run) {
    return three_digits(1e3 * run.cost) + " ms of CPU time per simulated second";
}

std::string_view verdict_name(TuneVerdict verdict) {
    switch (verdict) {
    case TuneVerdict::met:
        return "met";
    case TuneVerdict::missed:
        return "missed";
    case TuneVerdict::diverged:
        return "diverged";
    case TuneVerdict::unfinished:
        return "unfinished";
    }
    return "";
}

void print_table(std::ostream &out, const Tuning &tuning) {
    char line[256];
    std::snprintf(line, sizeof line, "  %-20s %-7s %9s %10s %10s %10s %10s %9s\n", "method", "",
                  "substeps", "iterations", "dt", "passes/s", "CPU ms/s", "error");
    out << line;
    for (std::size_t i = 0; i < tuning.runs.size(); ++i) {
        const TunedRun &run = tuning.runs[i];
        const ResolvedRun &r = run.resolved;
        std::string cost = (run.timings.empty() ? "~" : "") + three_digits(1e3 * run.cost);
        std::snprintf(line, sizeof line, "  %-20.20s %-7s %9s %10s %10s %10.4g %10s %9s  %s",
                      std::string(r.method->name).c_str(),
                      std::string(precision_name(r.precision)).c_str(), substeps_text(r).c_str(),
                      has_iterations(*r.method) ? std::to_string(r.settings.iterations).c_str()
                                                : "-",
                      format_dt(r.settings.dt).c_str(), run.work, cost.c_str(),
                      run.verdict == TuneVerdict::diverged ? "-" : three_digits(run.error).c_str(),
                      std::string(verdict_name(run.verdict)).c_str());
        out << line;
        if (run.verdict == TuneVerdict::missed && run.starts > 1)
            out << " at start " << run.starts;
        if (!run.worst.empty())
            out << "; worst: " << run.worst;
        if (i == 0)
            out << (tuning.own_is_given ? "; the scene's own, with the given options"
                                        : "; the scene's own");
        if (i == tuning.chosen)
            out << "; CHOSEN";
        out << '\n';
    }
    out << "  passes/s: counted, over bodies and constraints; ~: from one run, not timed; error: "
           "the worst, in units\n  of its tolerance (a lower bound if missed)\n";
}

std::string ratio_text(double ratio) {
    return three_digits(ratio) + " times as much";
}

// Compared round by round if both were timed.
std::string times_as_much(const TunedRun &run, const TunedRun &other) {
    const bool timed = !run.timings.empty() && !other.timings.empty();
    return ratio_text(timed ? median_ratio(run.timings, other.timings) : run.cost / other.cost);
}

void print_choice(std::ostream &out, const Tuning &tuning) {
    const TunedRun &chosen = tuning.runs[*tuning.chosen];
    const TunedRun &own = tuning.own();
    out << in_words(chosen.resolved) << ": " << cost_text(chosen) << ", worst error "
        << error_text(chosen);
    const std::string owns = std::string("the scene's own settings") +
                             (tuning.own_is_given ? ", with the given options," : "");
    if (*tuning.chosen == 0)
        out << "; these are the scene's own settings"
            << (tuning.own_is_given ? ", with the given options" : "");
    else if (own.verdict == TuneVerdict::met)
        out << "; " << owns << " cost " << times_as_much(own, chosen);
    else
        out << "; " << owns << " miss: worst error " << error_text(own);
    out << ".\n";
}

void print_dearer(std::ostream &out, const Tuning &tuning) {
    const TunedRun &chosen = tuning.runs[*tuning.chosen], &dearer = tuning.runs[*tuning.dearer];
    out << "  Twice the substeps would cost " << times_as_much(dearer, chosen) << " and ";
    if (dearer.verdict == TuneVerdict::diverged)
        out << "diverge";
    else if (dearer.verdict == TuneVerdict::missed)
        out << "miss: the worst error would be " << error_text(dearer);
    else if (dearer.error < chosen.error)
        out << "bring the worst error to " << error_text(dearer);
    else
        out << "buy nothing: the worst error would be " << error_text(dearer);
    out << ".\n";
}

void print_plainer_table(std::ostream &out, const Tuning &tuning) {
    for (const PlainerModel &model : tuning.plainer) {
        out << "  without " << model.what << ": " << verdict_name(model.run.verdict);
        if (model.run.verdict != TuneVerdict::diverged)
            out << ", worst error " << error_text(model.run);
        if (model.times_as_dear > 0)
            out << ", " << ratio_text(model.times_as_dear);
        out << (model.is_enough ? "; LEFT OUT\n" : "\n");
    }
}

void print_plainer(std::ostream &out, const Tuning &tuning) {
    std::vector<std::string> less;
    double ratio = 1;
    for (const PlainerModel &model : tuning.plainer)
        if (model.is_enough) {
            less.push_back(model.what);
            ratio *= model.times_as_dear;
        }
    if (less.empty()) {
        if (!tuning.interrupted)
            out << "  No part of its model can be left out.\n";
        return;
    }
    out << "  It can do without ";
    for (std::size_t i = 0; i < less.size(); ++i)
        out << (i == 0 ? "" : i + 1 < less.size() ? ", " : " and ") << less[i];
    const TunedRun &full = tuning.runs[*tuning.chosen], &plain = tuning.plainest();
    out << (ratio < 1 / same_cost ? ": that costs " + ratio_text(ratio) : " at the same cost")
        << (less.size() == 1 ? ". Keeping it would " : ". Keeping them would ");
    if (full.error < plain.error && error_text(full) != error_text(plain))
        out << "bring the worst error from " << error_text(plain) << " to " << error_text(full);
    else
        out << "buy nothing: the worst error is " << error_text(plain) << " without it";
    out << ".\n";
}

// The run that missed by least.
const TunedRun *nearest(const Tuning &tuning) {
    const TunedRun *best = nullptr;
    for (const TunedRun &run : tuning.runs)
        if (run.verdict == TuneVerdict::missed && (best == nullptr || run.error < best->error))
            best = &run;
    return best;
}

} // namespace

void print(std::ostream &out, const Tuning &tuning, bool explain) {
    if (explain) {
        print_table(out, tuning);
        print_plainer_table(out, tuning);
    }
    for (const std::string &why : grouped_reasons(tuning.left_out))
        out << "  left out: " << why << '\n';
    const std::string all = tuning.expectations == 1
                                ? "its expectation"
                                : "all " + std::to_string(tuning.expectations) + " expectations";
    const std::string held = all + " within " + three_digits(tuning.tolerance) + " of " +
                             (tuning.expectations == 1 ? "its tolerance" : "their tolerances") +
                             ", from " + std::to_string(tuning.starts) +
                             (tuning.starts == 1 ? " start" : " starts");
    out << tuning.scene << ": ";
    if (!tuning.chosen) {
        out << "nothing tried meets " << held;
        const TunedRun *run = nearest(tuning);
        if (run != nullptr)
            out << "; the nearest is " << in_words(run->resolved) << ": "
                << (std::isfinite(run->error) ? "worst error at least " + error_text(*run)
                                              : "there was nothing to judge " + run->worst + " by");
        out << ".\n";
        if (run != nullptr && run->error <= 1)
            out << "  --tolerance 1 leaves no margin: the true value may itself be close to a "
                   "bound.\n";
        return;
    }
    out << (tuning.interrupted ? "the cheapest so far" : "the cheapest") << " that meets " << held
        << ", is ";
    print_choice(out, tuning);
    if (tuning.dearer)
        print_dearer(out, tuning);
    if (!tuning.plainer.empty())
        print_plainer(out, tuning);
    if (!tuning.found())
        out << "  That is over the budget of " << three_digits(1e3 * *tuning.budget)
            << " ms per simulated second.\n";
}

} // namespace plumb

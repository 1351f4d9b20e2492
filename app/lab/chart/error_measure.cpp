#include "app/lab/chart/error_measure.h"

#include "app/lab/chart/log_axis.h"
#include "app/lab/run/run_text.h"
#include "app/lab/run/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace plumb {

namespace {

std::string explain(const ExpectDesc &expect, const std::string &unit) {
    if (expect.quantity.empty()) // from a probe
        return "true value " + with_unit(expect.value, unit) + " (" + expect.source + ")";
    std::string text = expect.quantity + (expect.body.empty() ? "" : " of " + expect.body);
    if (expect.reduce == "last")
        text += " at " + with_unit(expect.to, "s");
    else
        text = expect.reduce + " of " + text + ", " + with_unit(expect.from, "s") + " to " +
               with_unit(expect.to, "s");
    switch (expect.relation) {
    case ExpectDesc::Relation::equals:
        text += expect.curve.empty() ? "; true value " + with_unit(expect.value, unit)
                                     : std::string("; compared with a curve");
        break;
    case ExpectDesc::Relation::at_most:
        text += "; should be at most " + with_unit(expect.value, unit);
        break;
    case ExpectDesc::Relation::at_least:
        text += "; should be at least " + with_unit(expect.value, unit);
        break;
    }
    if (!expect.source.empty())
        text += " (" + expect.source + ")";
    return text;
}

ErrorMeasure measure_of(const ExpectDesc &expect, std::size_t index) {
    const ExpectOutcome outcome = judge(expect, 0);
    ErrorMeasure measure;
    measure.kind = ErrorMeasure::Kind::expectation;
    measure.expectation = index;
    measure.name = expect.name;
    measure.unit = outcome.unit;
    measure.explanation = expect.name + ": " + explain(expect, outcome.unit);
    measure.limit = outcome.limit;
    const std::string bound = with_unit(expect.value, outcome.unit);
    const std::string limit = short_quantity(outcome.limit, outcome.unit);
    switch (expect.relation) {
    case ExpectDesc::Relation::equals:
        measure.title =
            "Error: " + (expect.curve.empty() ? "" : expect.reduce + " of ") + "|measured − true|";
        measure.limit_label = "tolerance " + limit;
        break;
    case ExpectDesc::Relation::at_most:
        measure.title =
            expect.value > 0 ? "Measured: " + expect.quantity : "Excess over the bound of " + bound;
        measure.limit_label = expect.value > 0 ? "bound " + limit : "at most " + bound;
        break;
    case ExpectDesc::Relation::at_least:
        measure.title = "Shortfall from the bound of " + bound;
        measure.limit_label = "at least " + bound;
        break;
    }
    return measure;
}

ErrorMeasure worst_measure(std::size_t count) {
    ErrorMeasure measure;
    measure.kind = ErrorMeasure::Kind::worst;
    measure.name = "worst";
    measure.unit = "1";
    measure.title = "Error in units of its tolerance";
    measure.explanation = "the worst of the scene's " + std::to_string(count) +
                          " expectations, each in units of its own tolerance";
    measure.limit = 1;
    measure.limit_label = "tolerance";
    return measure;
}

bool is_value_at_a_time(const ExpectDesc &expect) {
    return expect.reduce == "last" && expect.relation == ExpectDesc::Relation::equals &&
           expect.curve.empty() && !expect.quantity.empty();
}

} // namespace

ErrorMeasure choose_measure(const SceneDesc &scene, std::string_view expect, bool convergence,
                            const std::vector<std::string> &outdated) {
    const std::vector<ExpectDesc> expects = everything_expected(scene);
    const auto is_outdated = [&](const std::string &name) {
        return std::ranges::find(outdated, name) != outdated.end();
    };
    if (expect.empty()) {
        std::vector<std::size_t> counting, at_a_time;
        for (std::size_t i = 0; i < expects.size(); ++i)
            if (!is_outdated(expects[i].name)) {
                counting.push_back(i);
                if (convergence && is_value_at_a_time(expects[i]))
                    at_a_time.push_back(i);
            }
        if (counting.empty())
            return followed_measure(scene, false);
        const std::vector<std::size_t> &among = at_a_time.empty() ? counting : at_a_time;
        if (among.size() == 1)
            return measure_of(expects[among.front()], among.front());
        ErrorMeasure measure = worst_measure(among.size());
        if (among.size() < counting.size())
            measure.explanation =
                "the worst of the scene's " + std::to_string(among.size()) +
                " expectations of a value at a given time, each in units of its own tolerance";
        if (among.size() < expects.size())
            measure.among = among;
        return measure;
    }
    if (is_outdated(std::string(expect)))
        throw std::invalid_argument(
            "\"" + std::string(expect) + "\" of scene " + scene.name +
            " is stated for the file's own numbers, which the sweep changes");
    std::string names;
    for (std::size_t i = 0; i < expects.size(); ++i) {
        if (expects[i].name == expect)
            return measure_of(expects[i], i);
        names += (names.empty() ? "\"" : ", \"") + expects[i].name + '"';
    }
    throw std::invalid_argument("scene " + scene.name + " has no expectation \"" +
                                std::string(expect) + "\"; it has " +
                                (names.empty() ? "none" : names));
}

ErrorMeasure followed_measure(const SceneDesc &scene, bool had_contacts) {
    ErrorMeasure measure;
    if (!scene.joints.empty()) {
        measure.kind = ErrorMeasure::Kind::joint_drift;
        measure.name = "max_joint_drift";
        measure.unit = "m";
        measure.title = "Largest joint drift";
        measure.explanation = "the largest joint drift of the run";
    } else if (had_contacts) {
        measure.kind = ErrorMeasure::Kind::penetration;
        measure.name = "max_penetration";
        measure.unit = "m";
        measure.title = "Deepest penetration";
        measure.explanation = "the deepest penetration of the run";
    } else {
        measure.kind = ErrorMeasure::Kind::energy;
        measure.name = "max_energy_error";
        measure.unit = "1";
        measure.title = "Largest energy error";
        measure.explanation = "the largest |E − E0| / (K0 + |U0|) of the run";
    }
    return measure;
}

ErrorMeasure one_step_measure(double frame, std::size_t instants) {
    ErrorMeasure measure;
    measure.kind = ErrorMeasure::Kind::one_step;
    measure.name = "one_step";
    measure.unit = "m";
    measure.title = "RMS error of one step";
    measure.explanation =
        "how far off bodies are " + format_dt(frame) + " after each of " +
        std::to_string(instants) +
        " states of one accurate run, with rotation taken as length at the radius of gyration";
    return measure;
}

std::optional<std::size_t> worst_of(const std::vector<ExpectOutcome> &outcomes,
                                    const std::vector<std::size_t> &among) {
    std::optional<std::size_t> worst;
    double error = 0;
    for (std::size_t i = 0; i < outcomes.size(); ++i)
        if ((among.empty() || std::ranges::find(among, i) != among.end()) &&
            outcomes[i].verdict != Verdict::unseen && outcomes[i].scaled_error > error) {
            worst = i;
            error = outcomes[i].scaled_error;
        }
    return worst;
}

double error_of(const ErrorMeasure &measure, const JudgedRun &run) {
    switch (measure.kind) {
    case ErrorMeasure::Kind::worst: {
        const std::optional<std::size_t> worst = worst_of(run.outcomes, measure.among);
        if (worst)
            return run.outcomes[*worst].scaled_error;
        return run.any_judged() ? 0 : std::numeric_limits<double>::infinity();
    }
    case ErrorMeasure::Kind::expectation:
        return run.outcomes[measure.expectation].error;
    case ErrorMeasure::Kind::penetration:
        return run.max_penetration;
    case ErrorMeasure::Kind::joint_drift:
        return run.max_joint_drift;
    case ErrorMeasure::Kind::energy:
        return run.max_energy_error;
    case ErrorMeasure::Kind::one_step:
        break;
    }
    return std::numeric_limits<double>::infinity();
}

} // namespace plumb

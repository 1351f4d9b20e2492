#include "app/lab/run/run_text.h"

#include "app/lab/run/sweep.h"

#include <cstdio>

namespace plumb {

std::string_view precision_name(Precision precision) {
    switch (precision) {
    case Precision::f32:
        return "float";
    case Precision::f64:
        return "double";
    }
    return "";
}

std::string run_text(const ResolvedRun &run) {
    return std::string(run.method->name) + " substeps=" + substeps_text(run) +
           " iterations=" + std::to_string(run.settings.iterations) +
           " dt=" + format_dt(run.settings.dt) + " " + std::string(precision_name(run.precision));
}

std::string substeps_text(const ResolvedRun &run) {
    const StepSettings &s = run.settings;
    const bool chosen = run.method->chooses_substeps() && s.max_substeps > s.substeps;
    return std::to_string(s.substeps) + (chosen ? ".." + std::to_string(s.max_substeps) : "");
}

std::string with_digits(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
}

std::string three_digits(double value) {
    return with_digits(value, 3);
}

std::string with_unit(double value, std::string_view unit) {
    char text[48];
    std::snprintf(text, sizeof text, "%.6g", value);
    std::string all = text;
    if (unit != "1" && !unit.empty())
        all += " " + std::string(unit);
    return all;
}

} // namespace plumb

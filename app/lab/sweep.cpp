#include "app/lab/sweep.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace plumb {

namespace {

constexpr double largest_count = 1024;               // substeps or iterations in one step
constexpr std::size_t most_values = 64;              // on one axis
constexpr double smallest_dt = 1e-6, largest_dt = 1; // s

[[noreturn]] void refuse(std::string_view text, const std::string &why) {
    throw std::invalid_argument("sweep \"" + std::string(text) + "\": " + why);
}

double parse_plain_number(std::string_view whole, std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc() || end != text.data() + text.size() ||
        !std::isfinite(value))
        refuse(whole, "\"" + std::string(text) + "\" is not a number");
    return value;
}

// "0.01" or "1/60".
double parse_number(std::string_view whole, std::string_view text) {
    const auto slash = text.find('/');
    if (slash == std::string_view::npos)
        return parse_plain_number(whole, text);
    const double divisor = parse_plain_number(whole, text.substr(slash + 1));
    if (divisor == 0)
        refuse(whole, "division by zero in \"" + std::string(text) + "\"");
    return parse_plain_number(whole, text.substr(0, slash)) / divisor;
}

void check_value(std::string_view whole, SweepSetting setting, double value) {
    if (setting == SweepSetting::dt) {
        if (!(value >= smallest_dt && value <= largest_dt))
            refuse(whole, "dt must lie between 1e-6 and 1 s");
    } else if (!(value >= 1 && value <= largest_count) || value != std::floor(value)) {
        refuse(whole, std::string(sweep_setting_name(setting)) +
                          " must be whole numbers between 1 and 1024");
    }
}

} // namespace

std::string_view sweep_setting_name(SweepSetting setting) {
    switch (setting) {
    case SweepSetting::substeps:
        return "substeps";
    case SweepSetting::iterations:
        return "iterations";
    case SweepSetting::dt:
        return "dt";
    }
    return "";
}

double parse_fraction(std::string_view text) {
    return parse_number(text, text);
}

SweepAxis parse_sweep(std::string_view text) {
    const auto equals = text.find('=');
    if (equals == std::string_view::npos)
        refuse(text, "write SETTING=VALUES, for example substeps=1..16");
    const std::string_view name = text.substr(0, equals);
    const std::string_view range = text.substr(equals + 1);
    SweepAxis axis;
    if (name == "substeps")
        axis.setting = SweepSetting::substeps;
    else if (name == "iterations")
        axis.setting = SweepSetting::iterations;
    else if (name == "dt")
        axis.setting = SweepSetting::dt;
    else
        refuse(text,
               "\"" + std::string(name) + "\" cannot be swept; substeps, iterations and dt can");
    if (range.empty())
        refuse(text, "no values; for example " + std::string(name) +
                         (axis.setting == SweepSetting::dt ? "=1/240..1/30" : "=1..16"));

    if (const auto dots = range.find(".."); dots != std::string_view::npos) {
        const double low = parse_number(text, range.substr(0, dots));
        const double high = parse_number(text, range.substr(dots + 2));
        check_value(text, axis.setting, low);
        check_value(text, axis.setting, high);
        if (low > high)
            refuse(text, "the range must ascend");
        // A little slack, so that 1/240..1/30 ends at 1/30 whatever the rounding.
        const double end = high * (1 + 1e-9);
        double value = axis.setting == SweepSetting::dt ? low : 1;
        for (; value <= end; value *= 2)
            if (value >= low)
                axis.values.push_back(value);
        if (axis.values.empty())
            axis.values = low < high ? std::vector<double>{low, high} : std::vector<double>{low};
    } else {
        std::string_view rest = range;
        while (true) {
            const auto comma = rest.find(',');
            const double value = parse_number(text, rest.substr(0, comma));
            check_value(text, axis.setting, value);
            axis.values.push_back(value);
            if (comma == std::string_view::npos)
                break;
            rest = rest.substr(comma + 1);
        }
        std::sort(axis.values.begin(), axis.values.end());
        axis.values.erase(std::unique(axis.values.begin(), axis.values.end()), axis.values.end());
        if (axis.values.size() > most_values)
            refuse(text, "at most 64 values");
    }
    return axis;
}

SweepAxis default_sweep() {
    return {SweepSetting::substeps, {1, 2, 4, 8, 16}};
}

std::vector<SweepPoint> sweep_points(const std::vector<SweepAxis> &axes) {
    for (std::size_t i = 0; i < axes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (axes[i].setting == axes[j].setting)
                throw std::invalid_argument(std::string(sweep_setting_name(axes[i].setting)) +
                                            " is swept twice; give all its values in one sweep");
    std::vector<SweepPoint> points{{}};
    // The last axis outermost: each axis before it repeats inside.
    for (auto axis = axes.rbegin(); axis != axes.rend(); ++axis) {
        std::vector<SweepPoint> extended;
        for (const SweepPoint &point : points)
            for (const double value : axis->values) {
                extended.push_back(point);
                extended.back().insert(extended.back().begin(), value);
            }
        points = std::move(extended);
    }
    return points;
}

void apply(const std::vector<SweepAxis> &axes, const SweepPoint &point, StepSettings &settings) {
    for (std::size_t i = 0; i < axes.size(); ++i)
        switch (axes[i].setting) {
        case SweepSetting::substeps:
            settings.substeps = static_cast<int>(point[i]);
            break;
        case SweepSetting::iterations:
            settings.iterations = static_cast<int>(point[i]);
            break;
        case SweepSetting::dt:
            settings.dt = point[i];
            break;
        }
}

bool same_work(const MethodInfo &method, const StepSettings &a, const StepSettings &b) {
    const auto equal = [&](auto *passes) {
        return passes == nullptr ||
               passes(a.substeps, a.iterations) == passes(b.substeps, b.iterations);
    };
    return a.dt == b.dt && a.substeps == b.substeps && equal(method.body_passes) &&
           equal(method.constraint_passes);
}

std::string format_dt(double dt) {
    const double rate = 1 / dt;
    char text[48];
    if (rate >= 1 && std::abs(rate - std::round(rate)) < 1e-6 * rate)
        std::snprintf(text, sizeof text, "1/%.0f s", rate);
    else
        std::snprintf(text, sizeof text, "%.4g s", dt);
    return text;
}

std::string sweep_label(const std::vector<SweepAxis> &axes, const SweepPoint &point) {
    std::string counts, dt;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (axes[i].setting == SweepSetting::dt) {
            dt = format_dt(point[i]);
            continue;
        }
        if (!counts.empty())
            counts += "×";
        counts += std::to_string(static_cast<int>(point[i]));
    }
    return counts + (!counts.empty() && !dt.empty() ? ", " : "") + dt;
}

std::string sweep_label_meaning(const std::vector<SweepAxis> &axes) {
    std::string counts, dt;
    for (const SweepAxis &axis : axes) {
        if (axis.setting == SweepSetting::dt) {
            dt = "dt";
            continue;
        }
        if (!counts.empty())
            counts += " × ";
        counts += sweep_setting_name(axis.setting);
    }
    return counts + (!counts.empty() && !dt.empty() ? ", " : "") + dt;
}

} // namespace plumb

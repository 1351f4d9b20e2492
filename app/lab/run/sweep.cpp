#include "app/lab/run/sweep.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace plumb {

namespace {

constexpr std::size_t most_swept = 64; // on one axis

[[noreturn]] void refuse_values(std::string_view text, const std::string &why) {
    throw std::invalid_argument("sweep \"" + std::string(text) + "\": " + why);
}

double parse_value(std::string_view whole, SettingNumber setting, std::string_view text) {
    double value = 0;
    try {
        value = parse_number(text);
    } catch (const std::invalid_argument &error) {
        refuse_values(whole, error.what());
    }
    if (const std::string why = why_refused(setting, value); !why.empty())
        refuse_values(whole, why);
    return value;
}

SettingNumber parse_name(std::string_view whole, std::string_view name) {
    std::vector<SettingNumber> numbers;
    try {
        numbers = find_setting_numbers(name);
    } catch (const std::invalid_argument &error) {
        refuse_values(whole, error.what());
    }
    if (numbers.size() > 1)
        refuse_values(whole, std::string(name) +
                                 " has three components; sweep one of them, as in " +
                                 setting_name(numbers[1]) + "=-20..-1");
    return numbers.front();
}

std::vector<double> values_between(SettingNumber setting, double low, double high) {
    std::vector<double> values;
    if (is_whole(setting.setting())) {
        if (low == 0)
            values.push_back(0);
        for (double value = 1; value <= high; value *= 2)
            if (value >= low)
                values.push_back(value);
    } else if (low > 0) {
        // A little slack, so that 1/240..1/30 ends at 1/30 despite round-off.
        for (double value = low; value <= high * (1 + 1e-9); value *= 2)
            values.push_back(std::min(value, setting.setting().max));
    } else {
        for (int i = 0; i <= 4; ++i)
            values.push_back(i == 4 ? high : low + i * (high - low) / 4);
    }
    if (values.empty())
        values = {low, high};
    return values;
}

// Whole numbers first, joined by `times`, then the others, joined by commas.
template <typename Text>
std::string whole_first(const std::vector<SweepAxis> &axes, const char *times, const Text &text) {
    std::string counts, others;
    for (std::size_t i = 0; i < axes.size(); ++i)
        if (is_whole(axes[i].setting.setting()))
            counts += (counts.empty() ? "" : times) + text(i);
        else
            others += (others.empty() ? "" : ", ") + text(i);
    return counts + (!counts.empty() && !others.empty() ? ", " : "") + others;
}

} // namespace

SweepAxis parse_sweep(std::string_view text) {
    const auto equals = text.find('=');
    if (equals == std::string_view::npos)
        refuse_values(text, "write SETTING=VALUES, for example substeps=1..16");
    const std::string_view name = text.substr(0, equals);
    const std::string_view range = text.substr(equals + 1);
    SweepAxis axis;
    axis.setting = parse_name(text, name);
    if (range.empty())
        refuse_values(text, "no values; for example substeps=1..16 or dt=1/240..1/30");

    if (const auto dots = range.find(".."); dots != std::string_view::npos) {
        const double low = parse_value(text, axis.setting, range.substr(0, dots));
        const double high = parse_value(text, axis.setting, range.substr(dots + 2));
        if (low > high)
            refuse_values(text, "the range must be ascending");
        axis.values = values_between(axis.setting, low, high);
    } else {
        std::string_view rest = range;
        while (true) {
            const auto comma = rest.find(',');
            axis.values.push_back(parse_value(text, axis.setting, rest.substr(0, comma)));
            if (comma == std::string_view::npos)
                break;
            rest = rest.substr(comma + 1);
        }
    }
    std::sort(axis.values.begin(), axis.values.end());
    axis.values.erase(std::unique(axis.values.begin(), axis.values.end()), axis.values.end());
    if (axis.values.size() > most_swept)
        refuse_values(text, "at most 64 values");
    return axis;
}

SweepAxis default_sweep() {
    return parse_sweep("substeps=1..16");
}

std::vector<SweepPoint> sweep_points(const std::vector<SweepAxis> &axes) {
    for (std::size_t i = 0; i < axes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (axes[i].setting == axes[j].setting)
                throw std::invalid_argument(setting_name(axes[i].setting) +
                                            " is swept twice; give all its values in one sweep");
    std::vector<SweepPoint> points{{}};
    // The last axis varies slowest.
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

GivenSettings given_by(const std::vector<SweepAxis> &axes, const SweepPoint &point) {
    GivenSettings given;
    for (std::size_t i = 0; i < axes.size(); ++i)
        given.give(axes[i].setting, point[i]);
    return given;
}

void refuse_given(SettingNumber swept, const GivenSettings &given) {
    if (const std::optional<double> value = given.find(swept))
        throw std::invalid_argument(setting_name(swept) + " is given as " +
                                    number_or_fraction(*value) +
                                    " and also swept: drop one of them");
}

bool same_work(const MethodInfo &method, const StepSettings &a, const StepSettings &b) {
    return std::ranges::all_of(setting_numbers(), [&](SettingNumber number) {
        return !reads(method, number.setting()) ||
               setting_value(a, number) == setting_value(b, number);
    });
}

std::string setting_label(SettingNumber setting, double value) {
    if (setting.setting().unit == "s")
        return format_dt(value);
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    std::string label = text;
    if (!setting.setting().unit.empty())
        label += " " + std::string(setting.setting().unit);
    return label;
}

std::string values_by_name(const std::vector<std::pair<std::string, std::string>> &values) {
    std::vector<std::pair<std::string, std::string>> groups; // value, names
    for (const auto &[name, value] : values) {
        const auto group =
            std::ranges::find(groups, value, &std::pair<std::string, std::string>::first);
        if (group == groups.end())
            groups.emplace_back(value, name);
        else
            group->second.append(", ").append(name);
    }
    if (groups.size() == 1)
        return groups.front().first;
    std::string each;
    for (const auto &[value, names] : groups)
        each.append(each.empty() ? "" : ", ").append(value).append(" (" + names + ")");
    return each;
}

std::string format_dt(double dt) {
    const double rate = 1 / dt;
    char text[48];
    if (std::round(rate) > 1 && std::abs(rate - std::round(rate)) < 1e-6 * rate)
        std::snprintf(text, sizeof text, "1/%.0f s", rate);
    else
        std::snprintf(text, sizeof text, "%.4g s", dt);
    return text;
}

std::string sweep_label(const std::vector<SweepAxis> &axes, const SweepPoint &point) {
    return whole_first(axes, "×",
                       [&](std::size_t i) { return setting_label(axes[i].setting, point[i]); });
}

std::string sweep_label_meaning(const std::vector<SweepAxis> &axes) {
    return whole_first(axes, " × ", [&](std::size_t i) { return setting_name(axes[i].setting); });
}

} // namespace plumb

#include "app/lab/map/map_axis.h"

#include "app/lab/run/run_text.h"
#include "app/lab/run/sweep.h"
#include "engine/scene/given_settings.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace plumb {

namespace {

constexpr int most_values = 64; // on one axis
constexpr int usual_values = 10;

[[noreturn]] void refuse(std::string_view text, const std::string &why) {
    throw std::invalid_argument("axis \"" + std::string(text) + "\": " + why);
}

double parse_value(std::string_view whole, std::string_view text, const MapAxis &axis) {
    double value = 0;
    try {
        value = parse_number(text);
    } catch (const std::invalid_argument &error) {
        refuse(whole, error.what());
    }
    if (axis.setting)
        if (const std::string why = why_refused(*axis.setting, value); !why.empty())
            refuse(whole, why);
    return value;
}

// Settings take precedence over paths: "gravity.y" is a setting.
std::optional<SettingNumber> find_setting_number(std::string_view whole, std::string_view name) {
    std::vector<SettingNumber> numbers;
    try {
        numbers = find_setting_numbers(name);
    } catch (const std::invalid_argument &) {
        return std::nullopt; // a path in the scene, or unknown
    }
    if (numbers.size() > 1)
        refuse(whole, std::string(name) + " has three components; give one of them, as in " +
                          setting_name(numbers[1]) + "=-20..-1");
    return numbers.front();
}

// Strips ":N", "log" and ":Nlog" from the end of a range.
int take_count(std::string_view whole, std::string_view &range, bool &logarithmic) {
    constexpr std::string_view log = "log";
    logarithmic = range.ends_with(log);
    if (logarithmic)
        range.remove_suffix(log.size());
    const std::size_t colon = range.find(':');
    if (colon == std::string_view::npos)
        return usual_values;
    const std::string_view rest = range.substr(colon + 1);
    range = range.substr(0, colon);
    if (rest.empty() && logarithmic)
        return usual_values;
    int count = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), count);
    if (error != std::errc() || end != rest.data() + rest.size() || count < 2 ||
        count > most_values)
        refuse(whole, "after the colon, give the number of values, 2 to " +
                          std::to_string(most_values) +
                          ", and log for equal ratios: dt=1/240..1/15:9log");
    return count;
}

void set_range(std::string_view whole, std::string_view range, std::size_t dots, MapAxis &axis) {
    const std::string_view from = range.substr(0, dots);
    std::string_view to = range.substr(dots + 2);
    const int count = take_count(whole, to, axis.logarithmic);
    const double low = parse_value(whole, from, axis), high = parse_value(whole, to, axis);
    if (!(low < high))
        refuse(whole, "the range must be ascending");
    if (axis.logarithmic && low <= 0)
        refuse(whole, "a logarithmic range must start above 0");
    for (int i = 0; i < count; ++i) {
        const double part = static_cast<double>(i) / (count - 1);
        axis.values.push_back(i == 0             ? low
                              : i == count - 1   ? high
                              : axis.logarithmic ? low * std::pow(high / low, part)
                                                 : low + part * (high - low));
    }
}

void set_list(std::string_view whole, std::string_view list, MapAxis &axis) {
    while (true) {
        const auto comma = list.find(',');
        axis.values.push_back(parse_value(whole, list.substr(0, comma), axis));
        if (comma == std::string_view::npos)
            break;
        list.remove_prefix(comma + 1);
    }
    std::sort(axis.values.begin(), axis.values.end());
    axis.values.erase(std::unique(axis.values.begin(), axis.values.end()), axis.values.end());
    if (axis.values.size() < 2 || axis.values.size() > most_values)
        refuse(whole, "an axis has 2 to " + std::to_string(most_values) + " values");
}

// Of a number of a scene file: "spring.coil.stiffness" is in N/m. Empty if there is none, or it is
// not known.
std::string_view unit_of_path(std::string_view path) {
    for (const std::string_view component : {".x", ".y", ".z"})
        if (path.ends_with(component))
            path.remove_suffix(component.size());
    struct Row {
        std::string_view head, key, unit;
    };
    constexpr std::array rows{
        Row{"spring.", ".stiffness", "N/m"},
        Row{"spring.", ".damping", "N s/m"},
        Row{"spring.", ".rest_length", "m"},
        Row{"", ".frequency", "Hz"},
        Row{"", ".mass", "kg"},
        Row{"", ".position", "m"},
        Row{"", ".velocity", "m/s"},
        Row{"", ".angular_velocity", "rad/s"},
        Row{"body.", ".radius", "m"},
        Row{"body.", ".half_extents", "m"},
        Row{"speed", "", "m/s"},
        Row{"distance", "", "m"},
    };
    const auto *const found = std::ranges::find_if(rows, [&](const Row &row) {
        return path.starts_with(row.head) && path.ends_with(row.key);
    });
    return found == rows.end() ? std::string_view() : found->unit;
}

// 3 to 5 digits if that is exact; else the fewest, 3 to 9, that tell neighbours apart.
int digits_of(const MapAxis &axis) {
    constexpr int least = 3, exact = 5, most = 9;
    constexpr double rounding = 1e-9;
    const auto is_said = [&](double value, int digits) {
        return std::abs(std::strtod(with_digits(value, digits).c_str(), nullptr) - value) <=
               rounding * std::abs(value);
    };
    for (int digits = least; digits <= exact; ++digits)
        if (std::ranges::all_of(axis.values, [&](double v) { return is_said(v, digits); }))
            return digits;
    const auto look_alike = [&](int digits) {
        return std::ranges::adjacent_find(axis.values, {}, [&](double value) {
                   return with_digits(value, digits);
               }) != axis.values.end();
    };
    int digits = least;
    while (digits < most && look_alike(digits))
        ++digits;
    return digits;
}

} // namespace

MapAxis parse_map_axis(std::string_view text) {
    const auto equals = text.find('=');
    if (equals == 0 || equals == std::string_view::npos)
        refuse(text, "write NAME=FROM..TO, for example dt=1/240..1/15:9log");
    MapAxis axis;
    axis.name = text.substr(0, equals);
    if (axis.name == "precision" || axis.name == "threads")
        refuse(text, axis.name +
                         " is no axis of a map; only a chart sweeps it: `plumb chart SCENE "
                         "--sweep " +
                         (axis.name == "threads" ? "threads=1,2`" : "precision=float,double`"));
    axis.setting = find_setting_number(text, axis.name);
    const std::string_view range = text.substr(equals + 1);
    const auto dots = range.find("..");
    if (dots != std::string_view::npos)
        set_range(text, range, dots, axis);
    else
        set_list(text, range, axis);
    return axis.setting && is_whole(axis.setting->setting()) ? in_whole_numbers(axis) : axis;
}

std::vector<ChangedNumber> changed_numbers(const MapAxis &axis, double value) {
    if (axis.setting)
        return {};
    if (axis.numbers.empty())
        return {{axis.name, value}};
    std::vector<ChangedNumber> changed;
    for (const AxisNumber &number : axis.numbers)
        changed.push_back({number.path, number.offset + number.factor * value});
    return changed;
}

MapAxis in_whole_numbers(MapAxis axis) {
    for (double &value : axis.values)
        value = std::round(value);
    axis.values.erase(std::unique(axis.values.begin(), axis.values.end()), axis.values.end());
    if (axis.values.size() < 2)
        throw std::invalid_argument(axis.name + " takes whole numbers; give at least two");
    axis.whole = true;
    return axis;
}

double between(const MapAxis &axis, double low, double high) {
    const double middle =
        axis.logarithmic ? std::sqrt(low) * std::sqrt(high) : low + 0.5 * (high - low);
    return axis.whole ? std::floor(low + 0.5 * (high - low)) : middle;
}

double cell_position(const MapAxis &axis, double value) {
    const auto scale = [&](double v) { return axis.logarithmic ? std::log(v) : v; };
    // The interval that contains the value; the outermost ones extrapolate.
    std::size_t i = 1;
    while (i + 1 < axis.values.size() && axis.values[i] < value)
        ++i;
    const double low = scale(axis.values[i - 1]), high = scale(axis.values[i]);
    return static_cast<double>(i - 1) + (scale(value) - low) / (high - low);
}

std::string value_label(const MapAxis &axis, double value) {
    if (axis.setting && axis.setting->setting().unit == "s") {
        const std::string label = format_dt(value);
        if (label.starts_with("1/"))
            return label.substr(0, label.find(' '));
    }
    return with_digits(value, digits_of(axis));
}

std::string axis_title(const MapAxis &axis) {
    std::string title = axis.name;
    const std::string_view unit =
        axis.setting ? axis.setting->setting().unit : unit_of_path(axis.name);
    if (!unit.empty())
        title.append(" (").append(unit).append(")");
    if (!axis.numbers.empty()) { // one, or the components of one
        const std::string &path = axis.numbers.front().path;
        title += " by " + (axis.numbers.size() > 1 ? path.substr(0, path.rfind('.')) : path);
    }
    return title + (axis.logarithmic ? ", logarithmic" : "");
}

} // namespace plumb

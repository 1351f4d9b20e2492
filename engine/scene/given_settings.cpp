#include "engine/scene/given_settings.h"

#include "engine/dynamics/method_info.h"
#include "engine/scene/file/number.h"
#include "engine/scene/file/spelling.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <stdexcept>

namespace plumb {

namespace {

// The row's first number; the other two of a vector follow it.
SettingNumber number_of(const SettingMember &member) {
    const auto *const row = std::ranges::find(setting_rows, member, &SettingRow::member);
    return {static_cast<std::size_t>(row - setting_rows.begin()), 0};
}

bool is_same_number(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && text.front() == ' ')
        text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ')
        text.remove_suffix(1);
    return text;
}

double parse_plain_number(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc() || end != text.data() + text.size() ||
        !std::isfinite(value))
        throw std::invalid_argument("\"" + std::string(text) + "\" is not a number");
    return value;
}

// "m/s²" for "m/s^2".
std::string unit_for_people(std::string_view unit) {
    std::string text(unit);
    if (const std::size_t at = text.find("^2"); at != std::string::npos)
        text.replace(at, 2, "²");
    return text;
}

// The default shared by all methods, or else each method's own.
std::string default_for_people(const SettingRow &row) {
    const StepSettings first = method_infos().front().defaults;
    const bool same = std::ranges::all_of(method_infos(), [&](const MethodInfo &method) {
        return setting_text(row, method.defaults) == setting_text(row, first);
    });
    if (!same)
        return "the method's own";
    const std::string text = setting_text(row, first);
    const std::string quoted = text.find('/') == std::string::npos ? text : '"' + text + '"';
    return '`' + (is_vector(row) ? '[' + quoted + ']' : quoted) + '`';
}

std::string readers_for_people(const SettingRow &row) {
    std::string names;
    bool all = true;
    for (const MethodInfo &method : method_infos())
        if (reads(method, row))
            names += (names.empty() ? "`" : ", `") + std::string(method.name) + '`';
        else
            all = false;
    return all ? "all" : names;
}

} // namespace

void GivenSettings::give(double StepSettings::*member, double value) {
    give(number_of(member), value);
}

void GivenSettings::give(int StepSettings::*member, int value) {
    give(number_of(member), value);
}

void GivenSettings::give(glm::dvec3 StepSettings::*member, const glm::dvec3 &value) {
    SettingNumber number = number_of(member);
    for (; number.component < 3; ++number.component)
        give(number, value[number.component]);
}

void GivenSettings::give(const GivenSettings &others) {
    for (const auto &[number, value] : others.values_)
        give(number, value);
}

std::optional<double> GivenSettings::find(SettingNumber number) const {
    const auto found = values_.find(number);
    return found == values_.end() ? std::nullopt : std::optional(found->second);
}

bool GivenSettings::has(const SettingRow &row) const {
    return std::ranges::any_of(values_,
                               [&](const auto &entry) { return &entry.first.setting() == &row; });
}

void GivenSettings::apply_to(StepSettings &settings) const {
    for (const auto &[number, value] : values_)
        set_setting(settings, number, value);
}

StepSettings GivenSettings::applied() const {
    StepSettings settings;
    apply_to(settings);
    return settings;
}

GivenSettings GivenSettings::differences(const StepSettings &by_default,
                                         const StepSettings &settings) {
    GivenSettings given;
    for (const SettingNumber number : setting_numbers())
        if (const double value = setting_value(settings, number);
            !is_same_number(value, setting_value(by_default, number)))
            given.give(number, value);
    return given;
}

double parse_number(std::string_view text) {
    const auto slash = text.find('/');
    if (slash == std::string_view::npos)
        return parse_plain_number(trimmed(text));
    const double divisor = parse_plain_number(trimmed(text.substr(slash + 1)));
    if (divisor == 0)
        throw std::invalid_argument("division by zero in \"" + std::string(text) + "\"");
    return parse_plain_number(trimmed(text.substr(0, slash))) / divisor;
}

std::vector<SettingNumber> find_setting_numbers(std::string_view name) {
    std::vector<SettingNumber> found;
    std::vector<std::string_view> names;
    for (const SettingRow &row : setting_rows)
        names.push_back(row.name);
    for (const SettingNumber number : setting_numbers())
        if (number.setting().name == name || setting_name(number) == name)
            found.push_back(number);
    if (found.empty())
        throw std::invalid_argument("there is no setting \"" + std::string(name) + "\"; " +
                                    did_you_mean(name, names));
    return found;
}

GivenSettings parse_setting(std::string_view text) {
    const auto equals = text.find('=');
    if (equals == std::string_view::npos)
        throw std::invalid_argument("\"" + std::string(text) +
                                    "\" gives no value; write NAME=VALUE, as in substeps=8");
    const std::vector<SettingNumber> numbers =
        find_setting_numbers(trimmed(text.substr(0, equals)));
    std::vector<double> values;
    std::string_view rest = text.substr(equals + 1);
    while (true) {
        const auto comma = rest.find(',');
        values.push_back(parse_number(rest.substr(0, comma)));
        if (comma == std::string_view::npos)
            break;
        rest.remove_prefix(comma + 1);
    }
    const SettingRow &row = numbers.front().setting();
    if (values.size() != numbers.size())
        throw std::invalid_argument(
            std::string(text.substr(0, equals)) + " takes " + std::to_string(numbers.size()) +
            (numbers.size() == 1
                 ? " number, got "
                 : " numbers, as in " + std::string(row.name) + "=0,-9.81,0, got ") +
            std::to_string(values.size()));
    GivenSettings given;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (const std::string why = why_refused(numbers[i], values[i]); !why.empty())
            throw std::invalid_argument(why);
        given.give(numbers[i], values[i]);
    }
    return given;
}

std::string setting_text(const SettingRow &row, const StepSettings &settings) {
    std::string text;
    for (const SettingNumber number : setting_numbers())
        if (&number.setting() == &row) { // an array in a file holds no fractions
            const double value = setting_value(settings, number);
            text += (text.empty() ? "" : ", ") +
                    (is_vector(row) ? shortest(value) : number_or_fraction(value));
        }
    return text;
}

std::string number_or_fraction(double value) {
    const std::string digits = shortest(value);
    const double n = std::round(1 / value);
    const bool exact = n >= 2 && n <= 100'000 && is_same_number(1 / n, value);
    const std::string quotient = exact ? "1/" + shortest(n) : digits;
    constexpr std::size_t plain = 6; // "0.125" reads better than "1/8"
    return digits.size() > plain && quotient.size() < digits.size() ? quotient : digits;
}

std::string settings_as_markdown() {
    std::ostringstream out;
    out << "| setting | value | default | read by | what it is |\n|---|---|---|---|---|\n";
    for (const SettingRow &row : setting_rows) {
        std::string range = range_text(row);
        if (!row.unit.empty()) // last in the text
            range.replace(range.size() - row.unit.size(), row.unit.size(),
                          unit_for_people(row.unit));
        out << "| `" << row.name << "` | " << (is_vector(row) ? "`[x, y, z]`, each " : "") << range
            << " | " << default_for_people(row) << " | " << readers_for_people(row) << " | "
            << row.reason << " |\n";
    }
    return out.str();
}

} // namespace plumb

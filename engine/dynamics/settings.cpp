#include "engine/dynamics/settings.h"

#include "engine/core/check.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <vector>

namespace plumb {

namespace {

bool is_addition(const SettingRow &row) {
    return row.group == SettingGroup::additions || row.group == SettingGroup::order;
}

// By its name, unless it has the default of StepSettings: so these can be left out of methods that
// do not know them, and of hashes from before there were any.
void hash_unusual(StateHash &hash, const StepSettings &settings, SettingNumber number) {
    const double value = setting_value(settings, number);
    if (value == setting_value({}, number))
        return;
    for (const char c : number.setting().name)
        hash.add(static_cast<std::uint64_t>(c));
    hash.add(value);
}

// "1e-9", not "1e-09".
std::string text_of(double value) {
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    std::string text(buffer.data(), end);
    for (const std::string_view zero : {"e-0", "e+0", "e+"})
        if (const std::size_t at = text.find(zero); at != std::string::npos)
            text.replace(at, zero.size(), zero[1] == '-' ? "e-" : "e");
    return text;
}

} // namespace

std::span<const SettingNumber> setting_numbers() {
    static const std::vector<SettingNumber> all = [] {
        std::vector<SettingNumber> numbers;
        for (std::size_t row = 0; row < setting_rows.size(); ++row)
            for (int k = 0; k < (is_vector(setting_rows[row]) ? 3 : 1); ++k)
                numbers.push_back({row, k});
        return numbers;
    }();
    return all;
}

std::string setting_name(SettingNumber number) {
    const SettingRow &row = number.setting();
    std::string name(row.name);
    if (is_vector(row))
        name += {'.', "xyz"[number.component]};
    return name;
}

double setting_value(const StepSettings &settings, SettingNumber number) {
    const SettingMember &member = number.setting().member;
    if (const auto *vector = std::get_if<glm::dvec3 StepSettings::*>(&member))
        return (settings.**vector)[number.component];
    if (const auto *whole = std::get_if<int StepSettings::*>(&member))
        return settings.**whole;
    return settings.*std::get<double StepSettings::*>(member);
}

void set_setting(StepSettings &settings, SettingNumber number, double value) {
    const SettingMember &member = number.setting().member;
    if (const auto *vector = std::get_if<glm::dvec3 StepSettings::*>(&member))
        (settings.**vector)[number.component] = value;
    else if (const auto *whole = std::get_if<int StepSettings::*>(&member))
        settings.**whole = static_cast<int>(value);
    else
        settings.*std::get<double StepSettings::*>(member) = value;
}

bool is_whole(const SettingRow &row) {
    return std::holds_alternative<int StepSettings::*>(row.member);
}

bool is_vector(const SettingRow &row) {
    return std::holds_alternative<glm::dvec3 StepSettings::*>(row.member);
}

const SettingRow *find_setting(std::string_view name) {
    const auto *const found = std::ranges::find(setting_rows, name, &SettingRow::name);
    return found == setting_rows.end() ? nullptr : found;
}

std::string range_text(const SettingRow &row) {
    std::string text = is_whole(row) ? "a whole number from " : "a number from ";
    text += text_of(row.min) + " to " + text_of(row.max);
    return row.unit.empty() ? text : text + ' ' + std::string(row.unit);
}

std::string why_refused(SettingNumber number, double value) {
    const SettingRow &row = number.setting();
    const bool fits =
        value >= row.min && value <= row.max && (!is_whole(row) || value == std::floor(value));
    return fits ? std::string()
                : setting_name(number) + " must be " + range_text(row) + ", got " + text_of(value);
}

void check_settings(const StepSettings &settings) {
    for (const SettingNumber number : setting_numbers()) {
        const std::string reason = why_refused(number, setting_value(settings, number));
        PLUMB_CHECK(reason.empty(), reason);
    }
}

void hash_settings(StateHash &hash, const StepSettings &settings) {
    // Numbers first, then whole numbers, then additions to published methods.
    for (const SettingNumber number : setting_numbers())
        if (!is_whole(number.setting()) && !is_addition(number.setting()))
            hash.add(setting_value(settings, number));
    for (const SettingNumber number : setting_numbers())
        if (is_whole(number.setting()) && !is_addition(number.setting()))
            hash.add(static_cast<std::uint64_t>(setting_value(settings, number)));
    for (const SettingNumber number : setting_numbers())
        if (is_addition(number.setting()))
            hash_unusual(hash, settings, number);
}

} // namespace plumb

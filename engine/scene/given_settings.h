// Settings given explicitly: by a scene file, the command line, a sweep.
#pragma once

#include "engine/dynamics/settings.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// Values for some of the settings; the components of a vector count separately.
class GivenSettings {
  public:
    // Overrides earlier values. Not checked: see why_refused.
    void give(SettingNumber number, double value) { values_[number] = value; }
    void give(double StepSettings::*member, double value);
    void give(int StepSettings::*member, int value);
    void give(glm::dvec3 StepSettings::*member, const glm::dvec3 &value);
    void give(const GivenSettings &others);

    bool empty() const { return values_.empty(); }
    std::optional<double> find(SettingNumber number) const;
    bool has(const SettingRow &row) const; // any of its numbers

    // Drops the settings for which the predicate is true.
    template <typename Predicate> void erase_if(const Predicate &predicate) {
        std::erase_if(values_, [&](const auto &entry) { return predicate(entry.first.setting()); });
    }

    void apply_to(StepSettings &settings) const;
    StepSettings applied() const; // to StepSettings{}

    // Every setting where `settings` differs from `by_default`, bit for bit.
    static GivenSettings differences(const StepSettings &by_default, const StepSettings &settings);

    bool operator==(const GivenSettings &) const = default;

  private:
    std::map<SettingNumber, double> values_;
};

// "0.01", or a fraction such as "1/60". Throws std::invalid_argument saying what is wrong.
double parse_number(std::string_view text);

// The numbers that a name stands for: one, or three for "gravity". Throws std::invalid_argument,
// suggesting the nearest name, for an unknown one.
std::vector<SettingNumber> find_setting_numbers(std::string_view name);

// "substeps=8", "gravity=0,-3,0", "gravity.y=-3", "dt=1/120". Throws std::invalid_argument saying
// what is wrong and what would be right.
GivenSettings parse_setting(std::string_view text);

// What parse_setting reads after the "=".
std::string setting_text(const SettingRow &row, const StepSettings &settings);

// The fewest digits that round-trip, or 1/n where that is exactly the value and the digits are
// many. parse_number reads it.
std::string number_or_fraction(double value);

// The settings as a Markdown table: name, values, default, methods that read it, reason.
std::string settings_as_markdown();

} // namespace plumb

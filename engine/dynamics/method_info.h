// The description of a method for advancing a world, the same in either precision.
#pragma once

#include "engine/dynamics/settings.h"

#include <algorithm>
#include <span>
#include <string_view>
#include <vector>

namespace plumb {

struct MethodInfo {
    std::string_view name;   // in files and on the command line: "soft_step"
    std::string_view title;  // for people: "Soft step"
    std::string_view source; // where it is published
    bool contacts = false;   // can hold bodies apart
    bool joints = false;     // can hold bodies together
    bool springs = false;    // can move particles and springs
    // Whether bodies that move fast for their size are collided where they will be, and where
    // impacts sent them; otherwise all contacts are those of the start of the step.
    bool looks_ahead = false;
    std::vector<SettingGroup> reads; // setting groups, besides those that every method reads
    // Whether each island may take its own number of substeps.
    bool chooses_substeps() const {
        return std::ranges::find(reads, SettingGroup::chosen) != reads.end();
    }
    // Whether it remembers how stiff each row has become.
    bool keeps_penalties() const {
        return std::ranges::find(reads, SettingGroup::penalty) != reads.end();
    }
    // Used where nothing else is specified.
    StepSettings defaults{.substeps = 1, .iterations = 1};
};

// Whether the method's motion depends on that setting.
bool reads(const MethodInfo &method, const SettingRow &setting);

// All methods, in the registry's order (engine/dynamics/methods/registry.cpp).
std::span<const MethodInfo> method_infos();

// Null if no method has that name.
const MethodInfo *find_method_info(std::string_view name);

} // namespace plumb

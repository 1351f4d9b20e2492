// Of things with names, those that were asked for.
#pragma once

#include "engine/scene/scene_file_spelling.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// All when no names are given, else those whose name is or begins with one of them. Throws
// std::invalid_argument for what none begins with.
template <typename Named>
std::vector<Named> chosen(std::vector<Named> all, const std::vector<std::string> &names) {
    if (names.empty())
        return all;
    for (const std::string &name : names) {
        if (std::ranges::any_of(all, [&](const Named &one) { return one.name.starts_with(name); }))
            continue;
        std::vector<std::string_view> candidates;
        for (const Named &one : all)
            candidates.push_back(one.name);
        throw std::invalid_argument("there is no '" + name + "'; " +
                                    did_you_mean(name, candidates));
    }
    std::erase_if(all, [&](const Named &one) {
        return std::ranges::none_of(
            names, [&](const std::string &name) { return one.name.starts_with(name); });
    });
    return all;
}

} // namespace plumb

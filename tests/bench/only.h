// Picks named things by name.
#pragma once

#include "engine/scene/file/spelling.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// All of them if no names are given, otherwise those with one of the names. A name that matches
// nothing exactly selects everything it is a prefix of. Throws std::invalid_argument if it is not a
// prefix either.
template <typename Named>
std::vector<Named> chosen(std::vector<Named> all, const std::vector<std::string> &names) {
    if (names.empty())
        return all;
    const auto is_meant = [&](const Named &one, const std::string &name) {
        const bool is_whole =
            std::ranges::any_of(all, [&](const Named &other) { return other.name == name; });
        return is_whole ? one.name == name : one.name.starts_with(name);
    };
    for (const std::string &name : names) {
        if (std::ranges::any_of(all, [&](const Named &one) { return is_meant(one, name); }))
            continue;
        std::vector<std::string_view> candidates;
        for (const Named &one : all)
            candidates.push_back(one.name);
        throw std::invalid_argument("there is no '" + name + "'; " +
                                    did_you_mean(name, candidates));
    }
    std::vector<Named> some;
    std::ranges::copy_if(all, std::back_inserter(some), [&](const Named &one) {
        return std::ranges::any_of(names,
                                   [&](const std::string &name) { return is_meant(one, name); });
    });
    return some;
}

} // namespace plumb

// The methods under which bodies can be expected to rest.
#pragma once

#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace trial {

// All contact methods except naive_impulses, under which nothing rests; known_answers_test.cpp
// measures that.
inline std::vector<std::string> rest_methods() {
    std::vector<std::string> names = contact_methods();
    std::erase(names, "naive_impulses");
    return names;
}

} // namespace trial
} // namespace plumb::inline PLUMB_PRECISION

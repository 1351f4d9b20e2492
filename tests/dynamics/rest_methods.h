// Methods under which what rests can be asked for.
#pragma once

#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace trial {

// All that hold bodies apart but naive_impulses, under which nothing rests: what it does is in
// known_answers_test.cpp.
inline std::vector<std::string> rest_methods() {
    std::vector<std::string> names = contact_methods();
    std::erase(names, "naive_impulses");
    return names;
}

} // namespace trial
} // namespace plumb::inline PLUMB_PRECISION

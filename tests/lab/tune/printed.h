// Shared by the tuner's tests.
#pragma once

#include "app/lab/tune/tune.h"

#include <sstream>
#include <string>

namespace plumb {

inline std::string printed(const Tuning &tuning, bool explain = true) {
    std::ostringstream out;
    print(out, tuning, explain);
    return out.str();
}

} // namespace plumb

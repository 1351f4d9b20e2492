// The light beside a run: what is known to be wrong with it.
#pragma once

#include "app/sandbox/session/session.h"

#include <string>
#include <vector>

namespace plumb {

struct RunLight {
    bool is_red = false; // the run has failed; otherwise amber: a tolerance is left, or in doubt
    std::string text;    // a sentence
};

// The gravest first: red for a failure; amber for expectations that are missed, and for settings
// with which the run is not known to hold, at once and whatever it has met so far. Empty: nothing
// is wrong as far as is known.
[[nodiscard]] std::vector<RunLight> lights_of(const Session &session);

} // namespace plumb

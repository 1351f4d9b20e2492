// What a scene expects, against what was measured.
#pragma once

#include "engine/scene/scene_desc.h"

#include <limits>
#include <string>
#include <string_view>

namespace plumb {

enum class Verdict {
    pending, // its window of time has not ended, and it may still be met
    met,
    missed,
    // The run began later than its window, or than the moment its quantity counts from: a run that
    // goes on from a saved state. Nothing can be said.
    unseen,
};

[[nodiscard]] std::string_view verdict_name(Verdict verdict);

struct ExpectOutcome {
    ExpectDesc desc;
    std::string unit; // of measured, error and limit; "1" where there is none
    Verdict verdict = Verdict::pending;
    // Over the window, or as much of it as there was; NaN when that gives no number.
    double measured = std::numeric_limits<double>::quiet_NaN();
    // How wrong, >= 0, infinite when nothing could be measured (a period that never came, say); it
    // holds as long as this is at most `limit`.
    //   equals    |measured - value|, or what was measured of a curve: how far it was missed; the
    //             limit is the tolerance
    //   at_most   of a bound above zero: what was measured, or 0 if that is negative; the limit is
    //             the bound, so that a chart shows how much better than asked. Of any other bound:
    //             the excess over it; the limit is 0
    //   at_least  what is lacking; the limit is 0
    double error = std::numeric_limits<double>::infinity();
    double limit = 0;
    // The error in units of its tolerance: what errors of different quantities are compared by. At
    // most 1 if it holds and above 1 if not, always. It is error / limit; where the limit is 0, it
    // is 0 or, if there is an error, 1 + error / |value| (or / 1 in the quantity's own unit where
    // the value is 0).
    double scaled_error = std::numeric_limits<double>::infinity();

    [[nodiscard]] bool judged() const {
        return verdict == Verdict::met || verdict == Verdict::missed;
    }
};

// Met or missed, as if the window had ended.
[[nodiscard]] ExpectOutcome judge(const ExpectDesc &desc, double measured);

// "is 1.4 m within 0.01 m", "at most 0.01 m off its curve (max)", "at most 0.05 m", "at least 1
// rad"
[[nodiscard]] std::string demand(const ExpectOutcome &outcome);

} // namespace plumb

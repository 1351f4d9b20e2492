// A scene's expectations compared with the measurements.
#pragma once

#include "engine/scene/scene_desc.h"

#include <limits>
#include <string>
#include <string_view>

namespace plumb {

enum class Verdict {
    pending, // its time window has not ended, and it may still be met
    met,
    missed,
    // No verdict is possible: the run, continued from a saved state, began after the window did, or
    // after the moment its quantity counts from; or another engine ran it, which does not tell what
    // the quantity is made of.
    unseen,
};

[[nodiscard]] std::string_view verdict_name(Verdict verdict);

struct ExpectOutcome {
    ExpectDesc desc;
    std::string unit; // of measured, error and limit; "1" if dimensionless
    Verdict verdict = Verdict::pending;
    // Over the window, or the part of it that was run; NaN if that gives no number.
    double measured = std::numeric_limits<double>::quiet_NaN();
    // How far off, >= 0; infinite if nothing could be measured (say, a period that never came). The
    // expectation holds while this is at most `limit`.
    //   equals    |measured - value|, or what was measured of a curve: how far it was missed; the
    //             limit is the tolerance
    //   at_most for a bound above zero: the measured value, or 0 if negative; the limit is
    //             the bound, so that a chart shows how much better than asked. Of any other bound:
    //             the excess over it; the limit is 0
    //   at_least  what is lacking; the limit is 0
    double error = std::numeric_limits<double>::infinity();
    double limit = 0;
    // The error in units of its tolerance, to compare errors of different quantities. Always at
    // most 1 if the expectation holds and above 1 if not. It is error / limit; if the limit is 0,
    // it is 0 or, with an error, 1 + error / |value| (divided by 1 in the quantity's own unit if
    // the value is 0).
    double scaled_error = std::numeric_limits<double>::infinity();

    [[nodiscard]] bool judged() const {
        return verdict == Verdict::met || verdict == Verdict::missed;
    }
};

// Met or missed, as if the window had ended.
[[nodiscard]] ExpectOutcome judge(const ExpectDesc &desc, double measured);

// "1.4 m ± 0.01 m", "at most 0.01 m off its curve (max)", "at most 0.05 m", "at least 1 rad"
[[nodiscard]] std::string demand(const ExpectOutcome &outcome);

} // namespace plumb

// Exit codes of the commands.
#pragma once

namespace plumb {

enum class ExitCode {
    fine = 0,
    outside_tolerance = 1,
    bad_input = 2, // a scene or an argument
    diverged = 3,
    no_gl_context = 4,
    no_room = 5, // output could not be written, or memory ran out
};

// The outcome to report. Whatever makes the result worthless comes first: bad input, then no room,
// then no picture, then divergence, then a missed tolerance.
[[nodiscard]] constexpr ExitCode worse(ExitCode a, ExitCode b) {
    constexpr auto rank = [](ExitCode code) {
        switch (code) {
        case ExitCode::fine:
            return 0;
        case ExitCode::outside_tolerance:
            return 1;
        case ExitCode::diverged:
            return 2;
        case ExitCode::no_gl_context:
            return 3;
        case ExitCode::no_room:
            return 4;
        case ExitCode::bad_input:
            return 5;
        }
        return 5;
    };
    return rank(a) >= rank(b) ? a : b;
}

} // namespace plumb

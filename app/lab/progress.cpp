#include "app/lab/progress.h"

#include <algorithm>
#include <cstdio>

#include <unistd.h>

namespace plumb {

ProgressLine::ProgressLine(std::ostream &out, bool terminal)
    : out_(out), terminal_(terminal), start_(std::chrono::steady_clock::now()), last_(start_) {}

ProgressLine::~ProgressLine() {
    clear();
}

void ProgressLine::show(double fraction, const std::string &what) {
    using namespace std::chrono;
    const auto now = steady_clock::now();
    const auto pause = terminal_ ? duration<double>(0.1) : duration<double>(10);
    if (now - last_ < pause)
        return;
    last_ = now;
    char percent[16];
    std::snprintf(percent, sizeof percent, "%3.0f %%", 100 * std::clamp(fraction, 0.0, 1.0));
    std::string line = std::string(percent) + "  " + what;
    if (fraction > 0.02) {
        const double elapsed = duration<double>(now - start_).count();
        char left[32];
        std::snprintf(left, sizeof left, "  (%.0f s left)", elapsed / fraction - elapsed);
        line += left;
    }
    if (terminal_) {
        const std::size_t length = line.size();
        if (length < shown_)
            line.append(shown_ - length, ' ');
        shown_ = length;
        out_ << '\r' << line << std::flush;
    } else {
        out_ << line << std::endl;
    }
}

void ProgressLine::clear() {
    if (shown_ > 0)
        out_ << '\r' << std::string(shown_, ' ') << '\r' << std::flush;
    shown_ = 0;
}

bool stderr_is_terminal() {
    return isatty(STDERR_FILENO) != 0;
}

} // namespace plumb

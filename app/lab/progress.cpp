#include "app/lab/progress.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <utility>

#include <unistd.h>

namespace plumb {

ProgressLine::ProgressLine(std::ostream &err)
    : ProgressLine(err, &err == &std::cerr && isatty(STDERR_FILENO) != 0) {}

ProgressLine::ProgressLine(std::ostream &err, bool terminal)
    : err_(err), terminal_(terminal), ticker_([this](const std::stop_token &stop) { tick(stop); }) {
}

ProgressLine::~ProgressLine() {
    clear();
}

void ProgressLine::tick(const std::stop_token &stop) {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        wake_.wait_until(lock, stop, next_, [] { return false; });
        const Clock::time_point now = Clock::now();
        if (now < next_)
            continue;
        next_ = now + (terminal_ ? std::chrono::milliseconds(100) : std::chrono::seconds(5));
        if (showing_)
            print(now);
    }
}

void ProgressLine::show(double fraction, std::string what) {
    const std::scoped_lock lock(mutex_);
    showing_ = true;
    fraction_ = std::clamp(fraction, 0.0, 1.0);
    what_ = std::move(what);
}

void ProgressLine::print(Clock::time_point now) {
    std::string line = what_;
    if (fraction_ > 0) {
        char percent[32];
        std::snprintf(percent, sizeof percent, ", %.0f %%", 100 * fraction_);
        line += percent;
    }
    if (fraction_ > 0.02) {
        const double elapsed = std::chrono::duration<double>(now - start_).count();
        char left[32];
        std::snprintf(left, sizeof left, " (%.0f s left)", elapsed / fraction_ - elapsed);
        line += left;
    }
    if (terminal_) {
        const std::size_t length = line.size();
        if (length < printed_)
            line.append(printed_ - length, ' ');
        printed_ = length;
        err_ << '\r' << line << std::flush;
    } else {
        err_ << line << std::endl;
    }
}

void ProgressLine::clear() {
    const std::scoped_lock lock(mutex_);
    showing_ = false;
    if (printed_ > 0)
        err_ << '\r' << std::string(printed_, ' ') << '\r' << std::flush;
    printed_ = 0;
}

} // namespace plumb

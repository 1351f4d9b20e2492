#include "app/lab/interrupt.h"

namespace plumb {

namespace {

volatile std::sig_atomic_t noted_signal = 0;

extern "C" void note_signal(int signal) {
    noted_signal = signal;
}

} // namespace

InterruptGuard::InterruptGuard() {
    noted_signal = 0;
    struct sigaction action {};
    action.sa_handler = note_signal;
    action.sa_flags = static_cast<int>(SA_RESETHAND); // a second signal ends the program
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, &previous_interrupt_);
    sigaction(SIGTERM, &action, &previous_terminate_);
}

InterruptGuard::~InterruptGuard() {
    sigaction(SIGINT, &previous_interrupt_, nullptr);
    sigaction(SIGTERM, &previous_terminate_, nullptr);
}

bool InterruptGuard::requested() {
    return noted_signal != 0;
}

int InterruptGuard::exit_code() {
    return requested() ? 128 + noted_signal : 0;
}

} // namespace plumb

#include "app/lab/interrupt.h"

namespace plumb {

namespace {

volatile std::sig_atomic_t interrupt_noted = 0;

extern "C" void note_interrupt(int) {
    interrupt_noted = 1;
}

} // namespace

InterruptGuard::InterruptGuard() {
    interrupt_noted = 0;
    struct sigaction action {};
    action.sa_handler = note_interrupt;
    action.sa_flags = static_cast<int>(SA_RESETHAND); // the second ends the program
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, &previous_);
}

InterruptGuard::~InterruptGuard() {
    sigaction(SIGINT, &previous_, nullptr);
}

bool InterruptGuard::requested() {
    return interrupt_noted != 0;
}

} // namespace plumb

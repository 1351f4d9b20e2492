#include "app/sandbox/studies/background.h"

#include <pthread.h>
#include <sched.h>

namespace plumb {

void give_way_to_others() {
    const sched_param none{};
    // If this is refused, the work is done all the same.
    static_cast<void>(pthread_setschedparam(pthread_self(), SCHED_IDLE, &none));
}

void hurry(std::jthread::native_handle_type thread) {
    const sched_param none{};
    static_cast<void>(pthread_setschedparam(thread, SCHED_OTHER, &none));
}

} // namespace plumb

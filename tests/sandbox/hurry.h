// Background work yields to everything else, on a busy machine for ever: while a test waits for it,
// its threads run at normal priority.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <system_error>
#include <thread>

#include <sched.h>

namespace plumb {

// False if it took longer than any machine needs.
template <typename Work> bool wait_for(const Work &background) {
    for (int i = 0; i < 12000 && background.running(); ++i) {
        std::error_code gone; // a thread may end while it is being looked at
        for (const auto &thread : std::filesystem::directory_iterator("/proc/self/task", gone)) {
            const int id = std::stoi(thread.path().filename().string());
            const sched_param none{};
            if (sched_getscheduler(id) == SCHED_IDLE)
                sched_setscheduler(id, SCHED_OTHER, &none);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return !background.running();
}

} // namespace plumb

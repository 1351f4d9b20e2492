// What times are measured by. Only differences mean something.
#pragma once

namespace plumb {

// CPU time that the calling thread has used (s): other programs on the same machine do not add to
// it, nor do other threads of this one.
[[nodiscard]] double thread_cpu_time();

// The clock on the wall (s).
[[nodiscard]] double wall_time();

} // namespace plumb

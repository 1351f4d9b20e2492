// Clocks for timing. Only differences mean something.
#pragma once

namespace plumb {

// CPU time used by the calling thread (s): neither other programs nor other threads add to it.
[[nodiscard]] double thread_cpu_time();

// Wall-clock time (s).
[[nodiscard]] double wall_time();

} // namespace plumb

// Processor time, which other programs on the same machine do not add to.
#pragma once

namespace plumb {

// CPU time that the calling thread has used (s). Only differences mean something.
[[nodiscard]] double thread_cpu_time();

} // namespace plumb

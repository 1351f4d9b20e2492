// What produced a table: for its last columns and for pages.
#pragma once

#include <string>

namespace plumb {

// The commit built, twelve digits, followed by "-changed" if tracked files differed; "unknown" if
// there was no repository.
[[nodiscard]] std::string build_commit();

// "AMD EPYC 7763 64-Core Processor, 2 threads"; never the machine's own name.
[[nodiscard]] std::string machine();

} // namespace plumb

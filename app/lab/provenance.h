// What made a table: for its last columns and for pages.
#pragma once

#include <string>

namespace plumb {

// The commit that was built, twelve digits, with "-changed" behind it where tracked files differed;
// "unknown" where there was no repository.
[[nodiscard]] std::string build_commit();

// "AMD EPYC 7763 64-Core Processor, 2 threads"; never the machine's own name.
[[nodiscard]] std::string machine();

} // namespace plumb

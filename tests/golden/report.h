// What is left of a failed comparison for a person to look at.
#pragma once

#include "tests/golden/judge.h"

#include <filesystem>

namespace plumb::golden {

// Writes expected.png, actual.png, difference.png (as far as there are such) and index.html to a
// folder of the case's own in the build tree. Returns the page.
std::filesystem::path write_report(const Case &golden, const std::optional<Record> &record,
                                   const Rendering &present, const Verdict &verdict);
// Removes what an earlier failure of the case has left.
void remove_report(const Case &golden);

// The command that makes the present pictures the golden ones.
extern const char *const bless_command;

} // namespace plumb::golden

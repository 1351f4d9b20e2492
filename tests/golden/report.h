// What a failed comparison leaves for a person to look at.
#pragma once

#include "tests/golden/judge.h"

#include <filesystem>

namespace plumb::golden {

// Writes index.html and those of expected.png, actual.png and difference.png that exist to the
// case's own folder in the build tree. Returns the page.
std::filesystem::path write_report(const Case &golden, const std::optional<Record> &record,
                                   const Rendering &present, const Verdict &verdict);
// Removes what an earlier failure of the case left.
void remove_report(const Case &golden);

// The command that makes the current pictures the golden ones.
extern const char *const bless_command;

} // namespace plumb::golden

// The commands. Each adds itself and its options to the command line, and sets the exit code when
// called.
#pragma once

#include "app/command_options.h"
#include "app/lab/exit_code.h"

#include <functional>
#include <string>

namespace plumb {

inline int code_of(ExitCode code) {
    return static_cast<int>(code);
}

// Everything in it must outlive the parse.
struct CommandLine {
    CLI::App &app;
    CommonOptions &common;
    int &result;      // exit code
    std::string text; // as typed, for a chart's footer
};

// Returns the action of `plumb run` without options, which is also what plain `plumb` does.
std::function<int()> add_run(CommandLine &line);
void add_replay(CommandLine &line);
void add_snapshot(CommandLine &line);
void add_check(CommandLine &line);
void add_hash(CommandLine &line);
void add_list(CommandLine &line);
void add_measure(CommandLine &line);
void add_chart(CommandLine &line);
void add_merge(CommandLine &line);
void add_map(CommandLine &line);
void add_tune(CommandLine &line);
void add_reference(CommandLine &line);
void add_bench(CommandLine &line);
void add_compare(CommandLine &line);

} // namespace plumb

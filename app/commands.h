// The commands: each adds itself to the command line, with its options, and sets the exit code when
// it has been called.
#pragma once

#include "app/command_options.h"
#include "app/lab/exit_code.h"

#include <functional>
#include <string>

namespace plumb {

inline int code_of(ExitCode code) {
    return static_cast<int>(code);
}

// All of it outlives the parse.
struct CommandLine {
    CLI::App &app;
    CommonOptions &common;
    int &result;      // exit code
    std::string text; // as it was typed, for a chart's footer
};

// Returns what it does without options: what the program does without a command.
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

// The program itself, as the shell sees it.
#pragma once

#include "tests/temporary_folder.h"

#include <filesystem>
#include <string>

namespace plumb {

struct ProgramResult {
    int exit_code = -1;
    std::string out, err;
};

// Runs `plumb` with arguments as one would type them to a shell, without a display, in a folder.
// `before` stands before the program: variables of the environment, say.
ProgramResult run_program(const std::string &arguments, const std::filesystem::path &folder = ".",
                          const std::string &before = {});

// One that is still running. `folder` must be one of its own: what it prints lies there in the
// files "out" and "err".
class RunningProgram {
  public:
    RunningProgram(const std::string &arguments, std::filesystem::path folder);
    ~RunningProgram(); // kills it
    RunningProgram(const RunningProgram &) = delete;
    RunningProgram &operator=(const RunningProgram &) = delete;

    void send(int signal) const;
    // As a shell has it: 128 and the signal's number when one ended it.
    ProgramResult wait();

  private:
    std::filesystem::path folder_;
    int process_ = -1;
};

bool has(const std::string &text, const std::string &part);
// The whole of a file.
std::string text_of(const std::filesystem::path &path);

} // namespace plumb

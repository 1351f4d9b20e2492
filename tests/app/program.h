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

// Runs `plumb` in a folder, without a display, with arguments as typed into a shell. `before` goes
// in front of the program: environment variables, say.
ProgramResult run_program(const std::string &arguments, const std::filesystem::path &folder = ".",
                          const std::string &before = {});

// A program that is still running. `folder` must be its own: it receives the output, in the files
// "out" and "err".
class RunningProgram {
  public:
    RunningProgram(const std::string &arguments, std::filesystem::path folder);
    ~RunningProgram(); // kills it
    RunningProgram(const RunningProgram &) = delete;
    RunningProgram &operator=(const RunningProgram &) = delete;

    void send(int signal) const;
    // As in a shell: 128 plus the signal's number if a signal ended it.
    ProgramResult wait();

  private:
    std::filesystem::path folder_;
    int process_ = -1;
};

bool has(const std::string &text, const std::string &part);
// A file's whole text.
std::string text_of(const std::filesystem::path &path);

} // namespace plumb

// The program itself, as the shell sees it.
#pragma once

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

// A new empty folder, removed at the end.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder &) = delete;
    TemporaryFolder &operator=(const TemporaryFolder &) = delete;

    [[nodiscard]] const std::filesystem::path &path() const { return path_; }
    // Writes a file into it.
    std::filesystem::path write(const std::string &name, const std::string &text) const;

  private:
    std::filesystem::path path_;
};

} // namespace plumb

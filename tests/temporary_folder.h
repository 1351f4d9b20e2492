// A folder for one test's files, not shared with tests that run at the same time.
#pragma once

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace plumb {

// A new empty folder, removed at the end.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "plumb-test-XXXXXX").string();
        if (!mkdtemp(name.data()))
            throw std::system_error(errno, std::generic_category(), name);
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }
    TemporaryFolder(const TemporaryFolder &) = delete;
    TemporaryFolder &operator=(const TemporaryFolder &) = delete;

    [[nodiscard]] const std::filesystem::path &path() const { return path_; }

    // Writes a file into it.
    std::filesystem::path write(const std::string &name, const std::string &text) const {
        const std::filesystem::path path = path_ / name;
        std::ofstream(path) << text;
        return path;
    }

  private:
    std::filesystem::path path_;
};

} // namespace plumb

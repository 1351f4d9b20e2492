// A file that appears whole or not at all.
#pragma once

#include <filesystem>
#include <fstream>

namespace plumb {

// Written under the path of its name with ".partial" appended, and renamed when it is complete. One
// that is never finished stays under that name, with what was written, and leaves an older complete
// file alone.
class PartialFile {
  public:
    // Throws std::runtime_error with path and reason when it cannot be opened.
    explicit PartialFile(std::filesystem::path path);

    [[nodiscard]] std::ostream &stream() { return stream_; }
    [[nodiscard]] const std::filesystem::path &path() const { return path_; }
    [[nodiscard]] const std::filesystem::path &partial_path() const { return partial_; }

    // Empties it, to write a table anew.
    void restart();
    // Hands over to the file system what was written so far. Throws std::runtime_error, as below.
    void flush();
    // Closes and renames. Throws std::runtime_error when anything could not be written.
    void finish();

  private:
    void open();

    std::filesystem::path path_;
    std::filesystem::path partial_;
    std::ofstream stream_;
};

} // namespace plumb

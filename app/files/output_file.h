// Program output: files that appear whole or not at all, and standard output.
#pragma once

#include <array>
#include <filesystem>
#include <ostream>
#include <streambuf>
#include <string>

namespace plumb {

// Stream buffer that writes to a file descriptor.
class OutputBuffer final : public std::streambuf {
  public:
    // `name` is used in error messages. Takes ownership of the descriptor.
    OutputBuffer(int descriptor, std::string name);
    ~OutputBuffer() override; // closes without flushing
    OutputBuffer(const OutputBuffer &) = delete;
    OutputBuffer &operator=(const OutputBuffer &) = delete;

    [[nodiscard]] int descriptor() const { return descriptor_; }
    // Flushes and closes: some file systems report a full disk only on close. Throws as overflow
    // and sync do.
    void close();

  protected:
    // Throw std::system_error with the name and the reason, and drop the unwritten bytes. A stream
    // passes the exception on to its caller if its exceptions() include std::ios::badbit.
    int_type overflow(int_type next) override;
    int sync() override;

  private:
    void write_out();

    int descriptor_;
    std::string name_;
    std::array<char, 1U << 16U> bytes_{};
};

// All files are written through this. A regular or new file is written to a temporary beside its
// destination (an unnamed one where the file system supports it, so that nothing is left behind if
// the program is killed) and moved into place when complete. Until then an existing file stays as
// it is, and its permissions are kept. Symbolic links are followed. Anything that is not a regular
// file (a pipe, a device) and the program's own descriptors (/dev/stdout, /dev/fd/3) are written
// directly.
// All failures throw std::system_error with path and reason; those of stream() throw as they
// happen.
class OutputFile {
  public:
    // Does not create folders.
    explicit OutputFile(const std::filesystem::path &path);
    ~OutputFile(); // removes an unfinished file
    OutputFile(const OutputFile &) = delete;
    OutputFile &operator=(const OutputFile &) = delete;

    [[nodiscard]] std::ostream &stream() { return stream_; }
    [[nodiscard]] const std::filesystem::path &path() const { return path_; }

    void finish();
    // Where keep_partial() puts an incomplete file: beside the file itself, with ".partial"
    // appended to its name; links are followed here too. Empty if the output is written directly.
    [[nodiscard]] std::filesystem::path partial_place() const;
    // Moves it there. Returns that path, or path() if the output is written directly.
    std::filesystem::path keep_partial();

  private:
    struct Opened {
        int descriptor = -1;
        bool straight_through = false;
        std::filesystem::path place;  // with links followed
        std::filesystem::path beside; // the temporary's path; empty while it is unnamed
    };
    static Opened open(const std::filesystem::path &path);
    OutputFile(std::filesystem::path path, Opened opened);
    void put(const std::filesystem::path &place);

    std::filesystem::path path_;
    Opened opened_;
    OutputBuffer buffer_;
    std::ostream stream_;
};

// While one exists, std::cout throws std::system_error when a write fails. One at a time.
class StandardOutput {
  public:
    StandardOutput();
    ~StandardOutput();
    StandardOutput(const StandardOutput &) = delete;
    StandardOutput &operator=(const StandardOutput &) = delete;

    // Flushes and closes. Nothing may be written afterwards.
    void finish();

  private:
    OutputBuffer buffer_;
    std::streambuf *previous_;
    std::ostream *tied_;
};

// Creates a folder and its parents if missing. Throws as OutputFile does.
void create_folder(const std::filesystem::path &path);

} // namespace plumb

// What the program writes: files that appear whole or not at all, and standard output.
#pragma once

#include <array>
#include <filesystem>
#include <ostream>
#include <streambuf>
#include <string>

namespace plumb {

// Bytes on their way to a file descriptor.
class OutputBuffer final : public std::streambuf {
  public:
    // `name` stands in messages. Takes the descriptor over.
    OutputBuffer(int descriptor, std::string name);
    ~OutputBuffer() override; // closes without writing what is left
    OutputBuffer(const OutputBuffer &) = delete;
    OutputBuffer &operator=(const OutputBuffer &) = delete;

    [[nodiscard]] int descriptor() const { return descriptor_; }
    // Writes what is left, and closes: some file systems say only then that the disk is full.
    // Throws as overflow and sync do.
    void close();

  protected:
    // Throw std::system_error with the name and the reason, having dropped what was not written. A
    // stream hands that on to who writes when its exceptions() have std::ios::badbit.
    int_type overflow(int_type next) override;
    int sync() override;

  private:
    void write_out();

    int descriptor_;
    std::string name_;
    std::array<char, 1U << 16U> bytes_{};
};

// The one way in which files are written. A regular file, or one that does not exist yet, is
// written beside its place (without a name, where the file system can do so: nothing is left of it
// when the program is killed) and put there when it is complete. Until then an older one stays as
// it is; its permissions are kept. Symbolic links are followed. To what is no regular file (a pipe,
// a device) and to the program's own descriptors (/dev/stdout, /dev/fd/3) everything goes straight
// through.
//
// All failures throw std::system_error with path and reason, those of stream() at once.
class OutputFile {
  public:
    // Creates no folders.
    explicit OutputFile(const std::filesystem::path &path);
    ~OutputFile(); // what is not finished is removed
    OutputFile(const OutputFile &) = delete;
    OutputFile &operator=(const OutputFile &) = delete;

    [[nodiscard]] std::ostream &stream() { return stream_; }
    [[nodiscard]] const std::filesystem::path &path() const { return path_; }

    void finish();
    // Where what was written of one that will not be completed is kept: beside the file itself,
    // under its name with ".partial" appended; links are followed here, too. Empty where everything
    // goes straight through.
    [[nodiscard]] std::filesystem::path partial_place() const;
    // Puts it there. Returns where, or path() where everything went straight through.
    std::filesystem::path keep_partial();

  private:
    struct Opened {
        int descriptor = -1;
        bool straight_through = false;
        std::filesystem::path place;  // the links followed
        std::filesystem::path beside; // while it has a name
    };
    static Opened open(const std::filesystem::path &path);
    OutputFile(std::filesystem::path path, Opened opened);
    void put(const std::filesystem::path &place);

    std::filesystem::path path_;
    Opened opened_;
    OutputBuffer buffer_;
    std::ostream stream_;
};

// While one lives, std::cout throws std::system_error when it cannot write. One at a time.
class StandardOutput {
  public:
    StandardOutput();
    ~StandardOutput();
    StandardOutput(const StandardOutput &) = delete;
    StandardOutput &operator=(const StandardOutput &) = delete;

    // Writes what is left, and closes. Nothing is written to it afterwards.
    void finish();

  private:
    OutputBuffer buffer_;
    std::streambuf *previous_;
    std::ostream *tied_;
};

// Creates a folder with those above it, unless it is there. Throws as OutputFile does.
void create_folder(const std::filesystem::path &path);

} // namespace plumb

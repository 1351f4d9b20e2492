#include "app/files/output_file.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace plumb {

namespace {

namespace fs = std::filesystem;

constexpr mode_t everybody = 0666; // minus the umask

[[noreturn]] void fail(int error, const std::string &name) {
    if (name.empty())
        throw std::invalid_argument("the output has an empty name");
    throw std::system_error(error, std::generic_category(), name + ": cannot be written");
}

// The descriptor number, if the path names one of this program's own descriptors.
std::optional<int> own_descriptor(const fs::path &path) {
    std::error_code error;
    const fs::path folder = fs::canonical(path.parent_path(), error);
    if (error || folder != fs::canonical("/proc/self/fd", error) || error)
        return std::nullopt;
    return std::atoi(path.filename().c_str());
}

// A temporary name beside a file, different each time.
fs::path name_beside(const fs::path &place) {
    static std::atomic<unsigned> count{0};
    return place.parent_path() /
           (".plumb-" + std::to_string(getpid()) + "-" + std::to_string(count++));
}

bool is_link(const fs::path &path) {
    std::error_code error;
    return fs::is_symlink(fs::symlink_status(path, error));
}

// Follows a link one step.
fs::path target_of(const fs::path &link) {
    return link.parent_path() / fs::read_symlink(link); // just the target, if absolute
}

constexpr int most_links = 40; // Linux's own limit

} // namespace

OutputBuffer::OutputBuffer(int descriptor, std::string name)
    : descriptor_(descriptor), name_(std::move(name)) {
    setp(bytes_.data(), bytes_.data() + bytes_.size());
}

OutputBuffer::~OutputBuffer() {
    if (descriptor_ >= 0)
        ::close(descriptor_);
}

void OutputBuffer::write_out() {
    const char *next = pbase();
    const char *end = pptr();
    setp(bytes_.data(), bytes_.data() + bytes_.size());
    while (next < end) {
        const ssize_t written = ::write(descriptor_, next, static_cast<std::size_t>(end - next));
        // No retry on EINTR: the only signals handled ask the program to stop.
        if (written < 0)
            fail(errno, name_);
        next += written;
    }
}

OutputBuffer::int_type OutputBuffer::overflow(int_type next) {
    write_out();
    return traits_type::eq_int_type(next, traits_type::eof())
               ? traits_type::not_eof(next)
               : sputc(traits_type::to_char_type(next));
}

int OutputBuffer::sync() {
    write_out();
    return 0;
}

void OutputBuffer::close() {
    write_out();
    if (::close(std::exchange(descriptor_, -1)) != 0)
        fail(errno, name_);
}

OutputFile::Opened OutputFile::open(const fs::path &path) {
    Opened opened;
    opened.place = path;
    for (int links = 0;; ++links) {
        if (const std::optional<int> own = own_descriptor(opened.place)) {
            opened.straight_through = true;
            opened.descriptor = fcntl(*own, F_DUPFD_CLOEXEC, 0);
            if (opened.descriptor < 0)
                fail(errno, path.string());
            return opened;
        }
        if (!is_link(opened.place))
            break;
        if (links == most_links)
            fail(ELOOP, path.string());
        opened.place = target_of(opened.place);
    }

    struct stat before {};
    const bool is_new = stat(opened.place.c_str(), &before) != 0;
    if (!is_new && !S_ISREG(before.st_mode)) {
        opened.straight_through = true;
        opened.descriptor = ::open(opened.place.c_str(), O_WRONLY | O_CLOEXEC);
        if (opened.descriptor < 0)
            fail(errno, path.string());
        return opened;
    }
    if (!is_new && access(opened.place.c_str(), W_OK) != 0)
        fail(errno, path.string());
    const fs::path folder = opened.place.has_parent_path() ? opened.place.parent_path() : ".";
    opened.descriptor = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, everybody);
    if (opened.descriptor < 0 && (errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL)) {
        do {
            opened.beside = name_beside(opened.place);
            opened.descriptor =
                ::open(opened.beside.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, everybody);
        } while (opened.descriptor < 0 && errno == EEXIST);
    }
    if (opened.descriptor < 0)
        fail(errno, path.string());
    if (!is_new)
        fchmod(opened.descriptor, before.st_mode & 07777U); // best effort: may not be permitted
    return opened;
}

OutputFile::OutputFile(const fs::path &path) : OutputFile(path, open(path)) {}

OutputFile::OutputFile(fs::path path, Opened opened)
    : path_(std::move(path)), opened_(std::move(opened)),
      buffer_(opened_.descriptor, path_.string()), stream_(&buffer_) {
    stream_.exceptions(std::ios::badbit);
}

OutputFile::~OutputFile() {
    if (!opened_.beside.empty())
        unlink(opened_.beside.c_str());
}

void OutputFile::put(const fs::path &place) {
    stream_.flush();
    if (opened_.straight_through) {
        buffer_.close();
        return;
    }
    if (opened_.beside.empty()) {
        const std::string nameless = "/proc/self/fd/" + std::to_string(buffer_.descriptor());
        fs::path name = name_beside(place);
        while (linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) != 0) {
            if (errno != EEXIST)
                fail(errno, path_.string());
            name = name_beside(place);
        }
        opened_.beside = std::move(name);
    }
    buffer_.close();
    if (rename(opened_.beside.c_str(), place.c_str()) != 0)
        fail(errno, path_.string());
    opened_.beside.clear();
}

void OutputFile::finish() {
    put(opened_.place);
}

fs::path OutputFile::partial_place() const {
    if (opened_.straight_through)
        return {};
    fs::path place = opened_.place;
    place += ".partial";
    for (int links = 0; is_link(place); ++links) {
        if (links == most_links)
            fail(ELOOP, place.string());
        place = target_of(place);
    }
    return place;
}

fs::path OutputFile::keep_partial() {
    const fs::path place = partial_place();
    put(place);
    return place.empty() ? path_ : place;
}

StandardOutput::StandardOutput()
    : buffer_(STDOUT_FILENO, "standard output"), previous_(std::cout.rdbuf(&buffer_)),
      tied_(std::cerr.tie(nullptr)) { // untied: a stdout failure is reported on stderr
    std::cout.exceptions(std::ios::badbit);
}

StandardOutput::~StandardOutput() {
    std::cout.exceptions(std::ios::goodbit);
    std::cout.rdbuf(previous_);
    std::cerr.tie(tied_);
}

void StandardOutput::finish() {
    buffer_.close();
}

void create_folder(const fs::path &path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (error)
        fail(error.value(), path.string());
}

} // namespace plumb

#include "app/lab/partial_file.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace plumb {

PartialFile::PartialFile(std::filesystem::path path) : path_(std::move(path)), partial_(path_) {
    partial_ += ".partial";
    open();
}

void PartialFile::open() {
    errno = 0;
    stream_.open(partial_, std::ios::binary | std::ios::trunc);
    if (!stream_)
        throw std::runtime_error(partial_.string() + ": " +
                                 (errno != 0 ? std::strerror(errno) : "cannot be written"));
}

void PartialFile::restart() {
    stream_.close();
    stream_.clear();
    open();
}

void PartialFile::flush() {
    errno = 0;
    stream_.flush();
    if (!stream_)
        throw std::runtime_error(partial_.string() + ": " +
                                 (errno != 0 ? std::strerror(errno) : "could not be written"));
}

void PartialFile::finish() {
    flush();
    stream_.close();
    if (!stream_)
        throw std::runtime_error(partial_.string() + ": could not be written");
    std::error_code error;
    std::filesystem::rename(partial_, path_, error);
    if (error)
        throw std::runtime_error(path_.string() + ": " + error.message());
}

} // namespace plumb

#include "app/files/output_file.h"
#include "tests/temporary_folder.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace plumb {
namespace {

namespace fs = std::filesystem;

class OutputFileTest : public testing::Test {
  protected:
    static std::string text_of(const fs::path &path) {
        std::ostringstream text;
        text << std::ifstream(path).rdbuf();
        return text.str();
    }
    std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    static void write(const fs::path &path, const std::string &text) {
        OutputFile file(path);
        file.stream() << text;
        file.finish();
    }
    static std::errc error_of(const fs::path &path) {
        try {
            write(path, "text");
        } catch (const std::system_error &error) {
            EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos)
                << error.what();
            return static_cast<std::errc>(error.code().value());
        }
        return {};
    }

    TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
};

TEST_F(OutputFileTest, AppearsWhole) {
    const fs::path path = folder_ / "a.csv";
    std::ofstream(path) << "old";
    {
        OutputFile file(path);
        file.stream() << "new" << std::flush;
        EXPECT_EQ(text_of(path), "old");
        file.finish();
    }
    EXPECT_EQ(text_of(path), "new");
    EXPECT_EQ(entries(), 1U);
}

TEST_F(OutputFileTest, WhatIsNotFinishedLeavesNothing) {
    const fs::path path = folder_ / "a.csv";
    {
        OutputFile file(path);
        file.stream() << std::string(1U << 20U, 'x') << std::flush;
    }
    EXPECT_EQ(entries(), 0U);
    std::ofstream(path) << "old";
    { OutputFile file(path); }
    EXPECT_EQ(text_of(path), "old");
    EXPECT_EQ(entries(), 1U);
}

TEST_F(OutputFileTest, WhatIsInterruptedIsKeptBeside) {
    const fs::path path = folder_ / "a.csv";
    std::ofstream(path) << "old";
    OutputFile file(path);
    file.stream() << "rows";
    EXPECT_EQ(file.keep_partial(), folder_ / "a.csv.partial");
    EXPECT_EQ(text_of(folder_ / "a.csv.partial"), "rows");
    EXPECT_EQ(text_of(path), "old");
    EXPECT_EQ(entries(), 2U);
}

// The partial file lies beside the link's target; a link in its place stays one.
TEST_F(OutputFileTest, WhatIsInterruptedFollowsLinks) {
    fs::create_directory(folder_ / "below");
    fs::create_symlink("below/a.csv", folder_ / "link.csv");
    const fs::path partial = folder_ / "below" / "a.csv.partial";
    const auto interrupt = [&](const std::string &text) {
        OutputFile file(folder_ / "link.csv");
        file.stream() << text;
        const fs::path place = file.partial_place();
        EXPECT_EQ(file.keep_partial(), place);
        return place;
    };
    EXPECT_EQ(interrupt("rows"), partial);
    EXPECT_EQ(text_of(partial), "rows");
    EXPECT_TRUE(fs::is_symlink(folder_ / "link.csv"));
    EXPECT_FALSE(fs::exists(folder_ / "link.csv"));

    fs::remove(partial);
    fs::create_symlink("../elsewhere", partial);
    EXPECT_EQ(fs::weakly_canonical(interrupt("more")), fs::weakly_canonical(folder_ / "elsewhere"));
    EXPECT_TRUE(fs::is_symlink(partial));
    EXPECT_EQ(text_of(folder_ / "elsewhere"), "more");

    EXPECT_TRUE(OutputFile("/dev/null").partial_place().empty());
}

TEST_F(OutputFileTest, TwoIntoTheSameFileDoNotMeet) {
    const fs::path path = folder_ / "a.csv";
    OutputFile first(path);
    OutputFile second(path);
    first.stream() << "first";
    second.stream() << "second";
    second.finish();
    EXPECT_EQ(text_of(path), "second");
    first.finish();
    EXPECT_EQ(text_of(path), "first");
    EXPECT_EQ(entries(), 1U);
}

TEST_F(OutputFileTest, FollowsLinks) {
    fs::create_directory(folder_ / "below");
    const fs::path target = folder_ / "below" / "target";
    std::ofstream(target) << "old";
    fs::create_symlink("below/target", folder_ / "link");
    fs::create_symlink(folder_ / "link", folder_ / "link_to_link");
    write(folder_ / "link_to_link", "new");
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_TRUE(fs::is_symlink(folder_ / "link_to_link"));
    EXPECT_EQ(text_of(target), "new");

    fs::create_symlink("below/not_yet", folder_ / "dangling");
    write(folder_ / "dangling", "there");
    EXPECT_TRUE(fs::is_symlink(folder_ / "dangling"));
    EXPECT_EQ(text_of(folder_ / "below" / "not_yet"), "there");

    fs::create_symlink("circle", folder_ / "circle");
    EXPECT_EQ(error_of(folder_ / "circle"), std::errc::too_many_symbolic_link_levels);
}

TEST_F(OutputFileTest, KeepsPermissionsAndObeysTheUmask) {
    const fs::path path = folder_ / "a.csv";
    const mode_t before = umask(027);
    write(path, "new");
    umask(before);
    struct stat status {};
    ASSERT_EQ(stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777U, 0640U);
    chmod(path.c_str(), 0604);
    write(path, "newer");
    ASSERT_EQ(stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777U, 0604U);
}

TEST_F(OutputFileTest, WritesStraightThroughToDevices) {
    write("/dev/null", "text");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_EQ(error_of("/dev/full"), std::errc::no_space_on_device);
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
    fs::create_symlink("/dev/full", folder_ / "link");
    EXPECT_EQ(error_of(folder_ / "link"), std::errc::no_space_on_device);
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
}

TEST_F(OutputFileTest, WritesStraightThroughToPipes) {
    const fs::path pipe = folder_ / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::string read;
    std::thread reader([&] { read = text_of(pipe); });
    write(pipe, "through");
    reader.join();
    EXPECT_EQ(read, "through");
    EXPECT_TRUE(fs::is_fifo(pipe));
}

// /dev/stdout when standard output is a file: later output is appended after it.
TEST_F(OutputFileTest, WritesToItsOwnDescriptorsWhereTheyAre) {
    const fs::path path = folder_ / "log";
    const int log = open(path.c_str(), O_CREAT | O_WRONLY, 0600);
    ASSERT_GE(log, 0);
    ASSERT_EQ(::write(log, "before ", 7), 7);
    write("/dev/fd/" + std::to_string(log), "this ");
    write("/proc/self/fd/" + std::to_string(log), "that ");
    fs::create_symlink("/dev/fd/" + std::to_string(log), folder_ / "link");
    write(folder_ / "link", "there ");
    ASSERT_EQ(::write(log, "after", 5), 5);
    ::close(log);
    EXPECT_EQ(text_of(path), "before this that there after");
}

TEST_F(OutputFileTest, SaysWhyItCannotBegin) {
    EXPECT_EQ(error_of(folder_ / "no" / "such"), std::errc::no_such_file_or_directory);
    EXPECT_EQ(error_of(folder_), std::errc::is_a_directory);
    std::ofstream(folder_ / "file") << "text";
    EXPECT_EQ(error_of(folder_ / "file" / "below"), std::errc::not_a_directory);
    EXPECT_EQ(text_of(folder_ / "file"), "text");
}

// Simulates a full disk: files may not grow beyond a limit.
TEST_F(OutputFileTest, AFailedWriteThrowsAndLeavesTheOldFile) {
    const fs::path path = folder_ / "a.csv";
    std::ofstream(path) << "old";
    struct rlimit before {};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const struct rlimit small { 1000, before.rlim_max };
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    std::errc failure{};
    bool at_once = false;
    try {
        OutputFile file(path);
        at_once = true;
        for (int i = 0; i < 100'000; ++i)
            file.stream() << "a row of the table\n";
        at_once = false;
        file.finish();
    } catch (const std::system_error &error) {
        failure = static_cast<std::errc>(error.code().value());
    }
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(failure, std::errc::file_too_large);
    EXPECT_TRUE(at_once) << "it went on after a write had failed";
    EXPECT_EQ(text_of(path), "old");
    EXPECT_EQ(entries(), 1U);
}

TEST_F(OutputFileTest, MakesFoldersOrSaysWhyNot) {
    create_folder(folder_ / "a" / "b");
    create_folder(folder_ / "a" / "b");
    EXPECT_TRUE(fs::is_directory(folder_ / "a" / "b"));
    std::ofstream(folder_ / "file") << "text";
    EXPECT_THROW(create_folder(folder_ / "file" / "below"), std::system_error);
    EXPECT_THROW(create_folder(folder_ / "file"), std::system_error);
}

} // namespace
} // namespace plumb

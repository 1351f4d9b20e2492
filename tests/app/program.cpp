#include "tests/app/program.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <csignal>
#include <sys/wait.h>
#include <unistd.h>

namespace plumb {

bool has(const std::string &text, const std::string &part) {
    return text.find(part) != std::string::npos;
}

std::string text_of(const std::filesystem::path &path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

ProgramResult run_program(const std::string &arguments, const std::filesystem::path &folder,
                          const std::string &before) {
    const TemporaryFolder capture;
    const std::string out = (capture.path() / "out").string();
    const std::string err = (capture.path() / "err").string();
    const std::string command = "cd '" + folder.string() +
                                "' && env -u DISPLAY -u WAYLAND_DISPLAY " + before +
                                " timeout 100 '" PLUMB_PROGRAM "' >'" + out + "' 2>'" + err +
                                "' </dev/null " + arguments; // which may redirect it again
    const int status = std::system(command.c_str());
    ProgramResult result;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    result.out = text_of(out);
    result.err = text_of(err);
    return result;
}

RunningProgram::RunningProgram(const std::string &arguments, std::filesystem::path folder)
    : folder_(std::move(folder)) {
    const std::string command = "cd '" + folder_.string() +
                                "' && unset DISPLAY WAYLAND_DISPLAY && exec '" PLUMB_PROGRAM "' " +
                                arguments + " >out 2>err </dev/null";
    process_ = fork();
    if (process_ == 0) {
        execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char *>(nullptr));
        _exit(127);
    }
}

RunningProgram::~RunningProgram() {
    if (process_ > 0) {
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }
}

void RunningProgram::send(int signal) const {
    kill(process_, signal);
}

ProgramResult RunningProgram::wait() {
    int status = 0;
    waitpid(std::exchange(process_, -1), &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            text_of(folder_ / "out"), text_of(folder_ / "err")};
}

} // namespace plumb

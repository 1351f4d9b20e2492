#include "app/lab/provenance.h"

#include <fstream>
#include <thread>

namespace plumb {

extern const char *const commit_text; // written by cmake/commit.cmake

std::string build_commit() {
    return commit_text;
}

std::string machine() {
    std::string processor = "unknown processor";
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) {
            processor = line.substr(line.find(':') + 2);
            break;
        }
    return processor + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads";
}

} // namespace plumb

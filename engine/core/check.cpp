#include "engine/core/check.h"

#include <map>
#include <mutex>

namespace plumb {

void fail_check(const char *file, int line, const char *condition, const std::string &message) {
    std::ostringstream text;
    text << message << " (check `" << condition << "` failed at " << file << ":" << line << ")";
    throw CheckFailure(text.str());
}

OddityCounter &oddity(const char *name) {
    static std::mutex mutex;
    static std::map<std::string, OddityCounter> counters;
    const std::lock_guard lock(mutex);
    return counters[name];
}

} // namespace plumb

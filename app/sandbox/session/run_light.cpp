#include "app/sandbox/session/run_light.h"

#include "app/lab/run/run_text.h"

namespace plumb {

std::vector<RunLight> lights_of(const Session &session) {
    std::vector<RunLight> lights;
    if (const std::optional<Trouble> trouble = session.trouble())
        lights.push_back({true, trouble->text});
    const std::vector<ExpectDesc> &expects = session.scene().expects;
    std::string missed;
    for (std::size_t i = 0; i < expects.size(); ++i)
        if (const std::optional<double> since = session.missed_since(i))
            missed += (missed.empty() ? "Outside tolerance: " : "; ") + expects[i].name +
                      " since " + with_digits(*since, 4) + "\xC2\xA0s"; // unbroken
    if (!missed.empty())
        lights.push_back({false, missed + "."});
    if (const std::optional<std::string> doubt = session.doubt())
        lights.push_back({false, *doubt});
    return lights;
}

} // namespace plumb

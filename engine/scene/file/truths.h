// A scene file with truths that refinement found.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace plumb {

struct WrittenTruth {
    std::string expect; // its name
    double value = 0;
    double estimate = 0; // less than a tenth of its tolerance
};

// The text of a scene file with these in place of `equals` and `estimate`, which it has; all the
// rest stays byte for byte. `text` must parse without errors; `path` is as in parse_scene. Throws
// std::invalid_argument when the text is laid out so that it cannot be done.
std::string with_truths(std::string_view text, const std::string &path,
                        std::span<const WrittenTruth> truths);

} // namespace plumb

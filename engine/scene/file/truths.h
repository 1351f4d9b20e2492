// A scene file with truths that refinement found.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

struct WrittenTruth {
    std::string expect;         // its name
    std::vector<double> values; // one, or those of a curve
    double estimate = 0;        // less than a tenth of its tolerance
};

// The text of a scene file with these in place of `equals` and `estimate`, which it has; all the
// rest stays byte for byte, but for comments between the values of a curve. `text` must parse
// without errors; `path` is as in parse_scene. Throws std::invalid_argument when the text is laid
// out so that it cannot be done.
std::string with_truths(std::string_view text, const std::string &path,
                        std::span<const WrittenTruth> truths);

} // namespace plumb

// Writes truths found by refinement into a scene file.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

struct WrittenTruth {
    std::string expect;         // the expect's name
    std::vector<double> values; // one, or a curve's
    double estimate = 0;        // less than a tenth of the tolerance
};

// The scene file's text with these in place of its `equals` and `estimate`, which must exist;
// everything else stays byte for byte, except comments between a curve's values. `text` must parse
// without errors; `path` is as in parse_scene. Throws std::invalid_argument when the text's layout
// does not allow it.
std::string with_truths(std::string_view text, const std::string &path,
                        std::span<const WrittenTruth> truths);

} // namespace plumb

#include "engine/scene/file/spelling.h"

#include <algorithm>
#include <vector>

namespace plumb {

namespace {

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool begins_with(std::string_view word, std::string_view start) {
    return start.size() >= 3 && word.substr(0, start.size()) == start;
}

} // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
    // Three rows of the table d(i, j): the distance between the first i of a and the first j of b.
    std::vector<std::size_t> before(b.size() + 1);
    std::vector<std::size_t> last(b.size() + 1);
    std::vector<std::size_t> now(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        now[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::swap(before, last);
        std::swap(last, now);
        now[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = lower(a[i - 1]) == lower(b[j - 1]);
            now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
            if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                lower(a[i - 2]) == lower(b[j - 1]))
                now[j] = std::min(now[j], before[j - 2] + 1);
        }
    }
    return now[b.size()];
}

std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates) {
    // A longer word was not meant to be any of the names.
    constexpr std::size_t longest = 200;
    if (word.size() > longest)
        return {};
    const std::size_t tolerated = std::max<std::size_t>(1, word.size() / 3);
    std::string_view nearest;
    std::size_t distance = tolerated + 1;
    for (const std::string_view candidate : candidates) {
        const std::size_t difference = candidate.size() > word.size()
                                           ? candidate.size() - word.size()
                                           : word.size() - candidate.size();
        std::size_t d = distance;
        if (begins_with(candidate, word) || begins_with(word, candidate))
            d = std::min<std::size_t>(difference, tolerated);
        else if (difference < distance)
            d = edit_distance(word, candidate);
        if (d < distance && d < word.size()) {
            distance = d;
            nearest = candidate;
        }
    }
    return nearest;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
    if (const std::string_view nearest = nearest_word(word, candidates); !nearest.empty())
        return "did you mean \"" + std::string(nearest) + "\"?";
    if (candidates.empty())
        return {};
    constexpr std::size_t listed = 20;
    std::string text = candidates.size() == 1 ? "the only one is " : "choose from ";
    for (std::size_t i = 0; i < std::min(listed, candidates.size()); ++i)
        text += (i > 0 ? ", " : "") + std::string(candidates[i]);
    if (candidates.size() > listed)
        text += " and " + std::to_string(candidates.size() - listed) + " more";
    return text;
}

} // namespace plumb

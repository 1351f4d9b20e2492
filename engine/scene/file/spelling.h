// Suggestions for misspelt names.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace plumb {

// The number of insertions, deletions, substitutions and swaps of neighbours that turn one word
// into the other (optimal string alignment distance), in bytes; ignores case.
std::size_t edit_distance(std::string_view a, std::string_view b);

// The candidate nearest to `word`, the first among equals; empty when none is near, that is, within
// a third of the word's letters (at least one) with a letter in common, or one a prefix of the
// other.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates);

// A suggestion in words: the nearest candidate, or else the list of all (the first twenty).
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

} // namespace plumb

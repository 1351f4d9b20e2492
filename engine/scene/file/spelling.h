// What somebody may have meant by a misspelt name.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace plumb {

// Insertions, deletions, substitutions and swaps of neighbours that turn one word into the other
// (optimal string alignment distance), in bytes; case is ignored.
std::size_t edit_distance(std::string_view a, std::string_view b);

// The candidate nearest to `word`, the first among equals; empty when none is near: more than a
// third of the word's letters (at least one) away, no letter in common, and neither begins with the
// other.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates);

// A suggestion in words: the nearest candidate, or else the list of all (the first twenty).
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

} // namespace plumb

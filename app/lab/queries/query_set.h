// The geometric queries that are charted: what is asked, by which methods, and the truth.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

enum class QueryMethod {
    book,  // as the Game Physics Cookbook states it (book_queries.h)
    plain, // as most engines write it (plain_queries.h)
    ours   // engine/geometry
};

[[nodiscard]] std::string_view query_method_name(QueryMethod method); // "book", "plain", "plumb"

// How often a method was wrong on one family of inputs whose truth is known.
struct FamilyScore {
    std::string family;
    std::uint64_t asked = 0;
    std::uint64_t wrong = 0;
};

struct MethodOfQuery {
    QueryMethod method = QueryMethod::ours;
    // Asks each of the timed inputs once; returns how many answers were yes.
    std::function<std::uint64_t()> ask_all;
    // Asks all adversarial inputs.
    std::function<std::vector<FamilyScore>()> judge;
};

struct QueryCase {
    std::string name;        // "ray, box"
    std::uint64_t batch = 0; // how many timed inputs there are: random ones, hot in the cache
    std::vector<MethodOfQuery> methods;
};

// `adversarial` inputs for each query, drawn from `seed`. Most have whole numbers times a power of
// two for coordinates, so that floats hold them exactly, and their truth is found in whole numbers
// (query_oracle.h): touching counts as yes. Boxes turned at will are judged in long double, and
// only those whose answer does not change when they grow or shrink by 1e-4 of their size.
[[nodiscard]] std::vector<QueryCase> query_cases(std::uint64_t seed, std::size_t adversarial);

} // namespace plumb

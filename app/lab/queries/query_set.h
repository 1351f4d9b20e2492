// The charted geometric queries: inputs, methods and true answers.
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

// How often a method was wrong on one family of inputs with known answers.
struct FamilyScore {
    std::string family;
    std::uint64_t asked = 0;
    std::uint64_t wrong = 0;
};

struct MethodOfQuery {
    QueryMethod method = QueryMethod::ours;
    // Runs the query once on each timed input; returns the number of yes answers.
    std::function<std::uint64_t()> ask_all;
    // Runs the query on all adversarial inputs.
    std::function<std::vector<FamilyScore>()> judge;
};

struct QueryCase {
    std::string name;        // "ray, box"
    std::uint64_t batch = 0; // number of timed inputs: random, hot in the cache
    std::vector<MethodOfQuery> methods;
};

// `adversarial` inputs for each query, drawn from `seed`. Most have coordinates that are integers
// times a power of two, exact in floats, and are judged in integers (query_oracle.h): touching
// counts as yes. Arbitrarily rotated boxes are judged in long double, keeping only those whose
// answer does not change when they grow or shrink by 1e-4 of their size.
[[nodiscard]] std::vector<QueryCase> query_cases(std::uint64_t seed, std::size_t adversarial);

} // namespace plumb

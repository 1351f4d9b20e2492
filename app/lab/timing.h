// Times several pieces of work against each other with Google Benchmark.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace plumb {

struct TimingOptions {
    int rounds = 5;
    double least = 0.02;        // s: how long each is repeated in a round
    std::function<bool()> stop; // called before each; true ends early
    // Called after each with the fraction done (0..1) and the index of the work.
    std::function<void(double fraction, std::size_t which)> progress;
};

// CPU seconds per call of each work, in each round. Every round goes through all works, so a
// machine that slows down slows them all. Each work returns a number, so that the compiler cannot
// drop it. Unfinished rounds are missing at the end.
[[nodiscard]] std::vector<std::vector<double>>
time_interleaved(const std::vector<std::function<std::uint64_t()>> &works,
                 const TimingOptions &options);

// "median of 5 interleaved timings", "one timing"
[[nodiscard]] std::string timings_text(int rounds);

[[nodiscard]] double median(std::vector<double> values); // 0 if empty

// Median of a[i] / b[i] over the rounds.
[[nodiscard]] double median_ratio(const std::vector<double> &a, const std::vector<double> &b);

} // namespace plumb

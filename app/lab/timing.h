// Times several pieces of work against each other by Google Benchmark.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace plumb {

struct TimingOptions {
    int rounds = 5;
    double least = 0.02;        // s, for which each is repeated in a round
    std::function<bool()> stop; // asked before each; true ends early
    // After each: the fraction done (0..1), and which it was.
    std::function<void(double fraction, std::size_t which)> progress;
};

// CPU seconds of one call of each, in each round; round after round over all, so that a machine
// that slows down does so for all. Each returns a number that keeps its work from being left out.
// Rounds that were not finished are missing at the end.
[[nodiscard]] std::vector<std::vector<double>>
time_interleaved(const std::vector<std::function<std::uint64_t()>> &works,
                 const TimingOptions &options);

// "median of 5 interleaved timings", "one timing"
[[nodiscard]] std::string timings_text(int rounds);

[[nodiscard]] double median(std::vector<double> values); // 0 of none

// The median, over the rounds, of a[i] / b[i].
[[nodiscard]] double median_ratio(const std::vector<double> &a, const std::vector<double> &b);

} // namespace plumb

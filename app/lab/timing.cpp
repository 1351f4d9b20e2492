#include "app/lab/timing.h"

#include <algorithm>
#include <string>

#include <benchmark/benchmark.h>

namespace plumb {

namespace {

class Collector : public benchmark::BenchmarkReporter {
  public:
    using Take = std::function<void(std::size_t which, double seconds)>;

    explicit Collector(Take take) : take_(std::move(take)) {}

    bool ReportContext(const Context &) override { return true; }
    void ReportRuns(const std::vector<Run> &reports) override {
        for (const Run &run : reports)
            if (!run.error_occurred && run.iterations > 0)
                take_(std::stoul(run.run_name.function_name),
                      run.cpu_accumulated_time / static_cast<double>(run.iterations));
    }

  private:
    Take take_;
};

} // namespace

std::vector<std::vector<double>>
time_interleaved(const std::vector<std::function<std::uint64_t()>> &works,
                 const TimingOptions &options) {
    const auto stopped = [&] { return options.stop && options.stop(); };
    benchmark::ClearRegisteredBenchmarks();
#ifndef __clang_analyzer__ // it mistakes what Benchmark's header keeps for a leak
    for (std::size_t i = 0; i < works.size(); ++i)
        benchmark::RegisterBenchmark(std::to_string(i).c_str(), [&, i](benchmark::State &state) {
            if (stopped())
                state.SkipWithError("interrupted");
            for ([[maybe_unused]] auto iteration : state)
                benchmark::DoNotOptimize(works[i]());
        })->MinTime(options.least);
#endif
    std::vector<std::vector<double>> times(works.size());
    for (int round = 0; round < options.rounds && !stopped(); ++round) {
        Collector collector([&](std::size_t which, double seconds) {
            times[which].push_back(seconds);
            if (options.progress)
                options.progress(
                    (round + static_cast<double>(which + 1) / static_cast<double>(works.size())) /
                        options.rounds,
                    which);
        });
        benchmark::RunSpecifiedBenchmarks(&collector, ".");
    }
    benchmark::ClearRegisteredBenchmarks();
    std::size_t whole = static_cast<std::size_t>(options.rounds);
    for (const std::vector<double> &each : times)
        whole = std::min(whole, each.size());
    for (std::vector<double> &each : times)
        each.resize(whole);
    return times;
}

std::string timings_text(int rounds) {
    return rounds == 1 ? "one timing"
                       : "median of " + std::to_string(rounds) + " interleaved timings";
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.empty()           ? 0
           : values.size() % 2 == 1 ? values[half]
                                    : 0.5 * (values[half - 1] + values[half]);
}

double median_ratio(const std::vector<double> &a, const std::vector<double> &b) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        ratios.push_back(a[i] / b[i]);
    return median(std::move(ratios));
}

} // namespace plumb

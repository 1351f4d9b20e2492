// Frame rate, and simulated time against real time.
#pragma once

namespace plumb {

// Averages over the last whole half second, so that the numbers stay readable.
class Pace {
  public:
    static constexpr double interval = 0.5; // s of real time

    // A frame took `real` seconds and advanced the world by `simulated`.
    void add(double real, double simulated) {
        ++frames_;
        real_ += real;
        simulated_ += simulated;
        if (real_ < interval)
            return;
        const double passed = real_;
        *this = {frames_ / passed, simulated_ / passed};
    }
    void clear() { *this = {}; }

    // 0 before the first half second has passed.
    [[nodiscard]] double frames_per_second() const { return frames_per_second_; }
    [[nodiscard]] double of_real_time() const { return of_real_time_; }

    Pace() = default;

  private:
    Pace(double frames_per_second, double of_real_time)
        : frames_per_second_(frames_per_second), of_real_time_(of_real_time) {}

    double frames_per_second_ = 0;
    double of_real_time_ = 0;
    int frames_ = 0;
    double real_ = 0;
    double simulated_ = 0;
};

} // namespace plumb

// How fast pictures come and the world goes, against real time.
#pragma once

namespace plumb {

// The means over the last whole half second, so that they can be read.
class Pace {
  public:
    static constexpr double interval = 0.5; // s of real time

    // A frame took so much real time, and brought the world on by so much; s.
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

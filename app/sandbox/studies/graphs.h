// The last values of a quantity, one per step, for the graphs.
#pragma once

#include <cstddef>
#include <deque>

namespace plumb {

// Keeps the newest `capacity` values.
class Graph {
  public:
    static constexpr std::size_t capacity = 240;

    void clear() { values_.clear(); }
    void add(double value) {
        values_.push_back(value);
        if (values_.size() > capacity)
            values_.pop_front();
    }
    // Removes the newest value, if any.
    void take_back() {
        if (!values_.empty())
            values_.pop_back();
    }
    [[nodiscard]] std::size_t size() const { return values_.size(); }
    // 0 is the oldest.
    [[nodiscard]] double at(std::size_t i) const { return values_.at(i); }

  private:
    std::deque<double> values_;
};

} // namespace plumb

// Of all that decides what is in a table's row, but for what the row says itself: rows with another
// fingerprint are of no use to who goes on from them.
#pragma once

#include "engine/core/hash.h"
#include "engine/scene/simulation.h"

#include <string>
#include <string_view>

namespace plumb {

class Fingerprint {
  public:
    Fingerprint(); // begins with the program itself: another build may come to other results

    void add(std::string_view text);
    void add(double value) { hash_.add(value); }
    void add(const RunOptions &options); // less its method

    [[nodiscard]] std::string text() const; // 16 hexadecimal digits at most

  private:
    StateHash hash_;
};

} // namespace plumb

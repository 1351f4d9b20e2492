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
    void add(std::string_view text);
    void add(double value) { hash_.add(value); }
    void add(const RunOptions &options); // less its method

    // of_program(), "-" and 16 hexadecimal digits at most.
    [[nodiscard]] std::string text() const;

    // Of this program's file: another build may come to other results.
    [[nodiscard]] static const std::string &of_program();

  private:
    StateHash hash_;
};

} // namespace plumb

// Fingerprint of everything that decides a table row's contents, except what the row itself states.
// A command that resumes from a table cannot use rows with another fingerprint.
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
    void add(const RunOptions &options); // all but the method

    // of_program(), "-" and up to 16 hexadecimal digits.
    [[nodiscard]] std::string text() const;

    // Hash of this executable: another build may produce other results.
    [[nodiscard]] static const std::string &of_program();

  private:
    StateHash hash_;
};

} // namespace plumb

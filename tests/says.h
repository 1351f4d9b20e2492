// What a failed check must say.
#pragma once

#include "engine/core/check.h"

#include <gtest/gtest.h>

#include <string>

namespace plumb {

// Expects `call` to fail a check whose message contains `part`.
template <typename Call> void says(Call &&call, const std::string &part) {
    try {
        call();
    } catch (const CheckFailure &error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        return;
    }
    ADD_FAILURE() << "nothing failed; wanted " << part;
}

} // namespace plumb

#include "app/lab/csv.h"

#include "engine/core/random.h"
#include "tests/lab/csv_reader.h"

#include <bit>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(Csv, NumbersReadBackBitForBit) {
    Random random(3);
    for (int i = 0; i < 10000; ++i) {
        const double value = std::bit_cast<double>(random.next_u64());
        if (std::isnan(value))
            continue;
        const double back = std::strtod(exact_number(value).c_str(), nullptr);
        ASSERT_EQ(std::bit_cast<std::uint64_t>(back), std::bit_cast<std::uint64_t>(value));
    }
    EXPECT_EQ(exact_number(0.1), "0.1");
    EXPECT_EQ(exact_number(INFINITY), "inf");
}

TEST(Csv, TextsAreQuotedWhereNeeded) {
    std::ostringstream out;
    CsvWriter csv(out);
    csv.cell("plain").cell("a,b").cell("say \"no\"").cell("two\nlines").cell(true).cell(7);
    csv.end_row();
    csv.cell(0.5).cell("");
    csv.end_row();
    EXPECT_EQ(out.str(), "plain,\"a,b\",\"say \"\"no\"\"\",\"two\nlines\",1,7\n0.5,\n");
    const auto rows = read_csv(out.str());
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0],
              (std::vector<std::string>{"plain", "a,b", "say \"no\"", "two\nlines", "1", "7"}));
    EXPECT_EQ(rows[1], (std::vector<std::string>{"0.5", ""}));
}

} // namespace
} // namespace plumb

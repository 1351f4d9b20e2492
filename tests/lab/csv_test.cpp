#include "app/lab/csv.h"
#include "app/lab/partial_file.h"

#include "engine/core/random.h"
#include "tests/lab/csv_reader.h"

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

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

TEST(PartialFile, AppearsWhole) {
    namespace fs = std::filesystem;
    const fs::path path = fs::path(testing::TempDir()) / "plumb_partial_file_test.csv";
    {
        std::ofstream(path) << "old";
        PartialFile file(path);
        file.stream() << "first";
        file.restart();
        file.stream() << "second";
        file.flush();
        EXPECT_EQ(fs::file_size(path), 3U);
        EXPECT_EQ(fs::file_size(file.partial_path()), 6U);
        file.finish();
        EXPECT_FALSE(fs::exists(file.partial_path()));
    }
    std::string text;
    std::ifstream(path) >> text;
    EXPECT_EQ(text, "second");
    fs::remove(path);
    EXPECT_THROW(PartialFile("/nowhere/at/all.csv"), std::runtime_error);
}

} // namespace
} // namespace plumb

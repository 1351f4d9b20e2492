// Compares each golden picture with the current one. With PLUMB_BLESS=1 in the environment it keeps
// the current ones instead; tests/golden/bless does that.
#include "tests/golden/golden_record.h"
#include "tests/golden/judge.h"
#include "tests/golden/report.h"

#include <cstdlib>
#include <iostream>
#include <string_view>

#include <gtest/gtest.h>

namespace plumb::golden {
namespace {

class Golden : public testing::TestWithParam<Case> {};

void bless(const Case &golden, const std::optional<Record> &record, const Rendering &present,
           const Verdict &verdict) {
    remove_report(golden);
    const bool drawn_by_another = verdict.tier == Tier::another_rasterizer;
    if (verdict.kind == Verdict::Kind::same && !drawn_by_another) {
        std::cout << golden.name << ": unchanged\n";
        return;
    }
    std::cout << golden.name << ": " << (record ? "CHANGED" : "NEW") << ", state "
              << (record ? hash_text(record->state_hash) + " -> " : "")
              << hash_text(present.state_hash) << '\n'
              << verdict.text;
    write_record(golden, present);
    std::cout << "  written: " << picture_path(golden).string() << '\n';
}

TEST_P(Golden, Picture) {
    const Case &golden = GetParam();
    const Rendering present = render(golden);
    const std::optional<Record> record = read_record(golden);
    const Verdict verdict = judge(record, present);
    const char *blessing = std::getenv("PLUMB_BLESS");
    if (blessing && std::string_view(blessing) == "1") {
        bless(golden, record, present, verdict);
        return;
    }
    if (verdict.kind == Verdict::Kind::same) {
        remove_report(golden);
        std::cout << verdict.text;
        return;
    }
    const auto page = write_report(golden, record, present, verdict);
    FAIL() << golden.name << '\n'
           << verdict.text << "Expected, actual and difference: " << page.string()
           << "\nIf the new picture is right: " << bless_command;
}

INSTANTIATE_TEST_SUITE_P(All, Golden, testing::ValuesIn(cases()),
                         [](const auto &each) { return each.param.name; });

} // namespace
} // namespace plumb::golden

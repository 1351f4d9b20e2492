// Limits that let a different picture pass test nothing: everything here must fail, in both tiers.
#include "tests/golden/judge.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace plumb::golden {
namespace {

void expect_refused(const Image &expected, const Image &actual, const Image &background,
                    const std::string &what) {
    const ImageDifference d = difference(expected, actual, background);
    EXPECT_FALSE(within_limits(d, Tier::same_rasterizer)) << what << " passes for the same picture";
    EXPECT_FALSE(within_limits(d, Tier::another_rasterizer))
        << what << " passes for another rasterizer's: FLIP over the foreground " << std::fixed
        << d.flip_foreground_mean << ", percentile " << d.flip_percentile;
}

Image shifted_right(const Image &image, int by) {
    Image out(image.width, image.height);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            out.set(x, y, image.at(std::max(x - by, 0), y));
    return out;
}

class GoldenLimits : public testing::TestWithParam<Case> {};

TEST_P(GoldenLimits, RefuseEveryOtherGolden) {
    const Case &golden = GetParam();
    const std::optional<Record> record = read_record(golden);
    ASSERT_TRUE(record);
    const Image background = render(golden).background;
    for (const Case &other : cases())
        if (other.name != golden.name) {
            const std::optional<Record> other_record = read_record(other);
            ASSERT_TRUE(other_record) << other.name;
            expect_refused(record->picture, other_record->picture, background, other.name);
        }
}

TEST_P(GoldenLimits, RefuseABlankFrame) {
    const Rendering present = render(GetParam());
    const glm::ivec2 size = GetParam().size;
    const auto blank = [&](std::uint8_t grey) { return Image(size.x, size.y, glm::u8vec3(grey)); };
    expect_refused(present.picture, blank(0), present.background, "black");
    expect_refused(present.picture, blank(255), present.background, "white");
    expect_refused(present.picture, present.background, present.background, "background alone");
}

TEST_P(GoldenLimits, RefuseAPictureShiftedByOnePixel) {
    const Rendering present = render(GetParam());
    expect_refused(present.picture, shifted_right(present.picture, 1), present.background,
                   "shifted");
}

TEST_P(GoldenLimits, RefuseAPictureWithoutOneOfItsBodies) {
    const Case &golden = GetParam();
    if (golden.panels)
        return;
    const Rendering present = render(golden);
    const std::size_t count = shape_count(golden);
    ASSERT_GT(count, 0u);
    for (const std::size_t body : {std::size_t{0}, count / 2, count - 1})
        expect_refused(present.picture, render(golden, body).picture, present.background,
                       "without body " + std::to_string(body) + " of " + std::to_string(count));
}

TEST_P(GoldenLimits, AcceptThePictureItself) {
    const Rendering present = render(GetParam());
    const Rendering again = render(GetParam());
    EXPECT_EQ(present.state_hash, again.state_hash);
    EXPECT_EQ(present.picture, again.picture) << "two runs give two pictures";
    const ImageDifference d = difference(present.picture, again.picture, present.background);
    EXPECT_TRUE(within_limits(d, Tier::same_rasterizer));
    EXPECT_TRUE(within_limits(d, Tier::another_rasterizer));
}

INSTANTIATE_TEST_SUITE_P(All, GoldenLimits, testing::ValuesIn(cases()),
                         [](const auto &each) { return each.param.name; });

Record record_of(const Rendering &rendering) {
    return {rendering.state_hash, rendering.rasterizer, rendering.picture};
}

// A rendering without a renderer: a square on a plain background.
Rendering square() {
    Rendering rendering;
    rendering.state_hash = 7;
    rendering.rasterizer = {"a renderer", "1.0", "fma"};
    rendering.background = Image(32, 32, glm::u8vec3(200));
    rendering.picture = rendering.background;
    for (int y = 8; y < 24; ++y)
        for (int x = 8; x < 24; ++x)
            rendering.picture.set(x, y, {180, 40, 30});
    return rendering;
}

TEST(GoldenJudge, TheSameIsTheSame) {
    const Rendering present = square();
    const Verdict verdict = judge(record_of(present), present);
    EXPECT_EQ(verdict.kind, Verdict::Kind::same);
    EXPECT_EQ(verdict.tier, Tier::same_rasterizer);
}

TEST(GoldenJudge, NothingYetIsSaid) {
    EXPECT_EQ(judge({}, square()).kind, Verdict::Kind::no_golden);
}

TEST(GoldenJudge, AnotherStateIsSaidEvenWhenThePictureIsTheSame) {
    const Rendering present = square();
    Record record = record_of(present);
    record.state_hash = 8;
    const Verdict verdict = judge(record, present);
    EXPECT_EQ(verdict.kind, Verdict::Kind::another_state);
    EXPECT_NE(verdict.text.find("STATE"), std::string::npos) << verdict.text;
    EXPECT_EQ(verdict.text.find("RENDERER"), std::string::npos) << verdict.text;
    EXPECT_NE(verdict.text.find("0000000000000008"), std::string::npos) << verdict.text;
}

TEST(GoldenJudge, AnotherStateComesBeforeAnotherPicture) {
    const Rendering present = square();
    Record record = record_of(present);
    record.state_hash = 8;
    record.picture = present.background;
    EXPECT_EQ(judge(record, present).kind, Verdict::Kind::another_state);
}

TEST(GoldenJudge, AnotherPictureOfTheSameStateIsTheRenderer) {
    const Rendering present = square();
    Record record = record_of(present);
    record.picture = present.background;
    const Verdict verdict = judge(record, present);
    EXPECT_EQ(verdict.kind, Verdict::Kind::another_picture);
    EXPECT_NE(verdict.text.find("RENDERER"), std::string::npos) << verdict.text;
    EXPECT_EQ(verdict.text.find("STATE"), std::string::npos) << verdict.text;
}

TEST(GoldenJudge, TheSameRasterizerMayBeTwoOffAndNotThree) {
    const Rendering present = square();
    Record record = record_of(present);
    record.picture.set(0, 0, {202, 200, 200});
    EXPECT_EQ(judge(record, present).kind, Verdict::Kind::same);
    record.picture.set(0, 0, {203, 200, 200});
    EXPECT_EQ(judge(record, present).kind, Verdict::Kind::another_picture);
}

TEST(GoldenJudge, EachPartOfARasterizersNameCounts) {
    const Rendering present = square();
    Record record = record_of(present);
    // Slightly more than rounding, as another rasterizer would give.
    record.picture.set(0, 0, {203, 200, 200});
    for (std::string Rasterizer::*part :
         {&Rasterizer::renderer, &Rasterizer::version, &Rasterizer::cpu}) {
        Record other = record;
        other.rasterizer.*part += " of another kind";
        const Verdict verdict = judge(other, present);
        EXPECT_EQ(verdict.tier, Tier::another_rasterizer);
        EXPECT_EQ(verdict.kind, Verdict::Kind::same) << verdict.text;
    }
}

} // namespace
} // namespace plumb::golden

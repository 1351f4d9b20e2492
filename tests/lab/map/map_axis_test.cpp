#include "app/lab/map/map_axis.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace plumb {
namespace {

std::string complaint(const std::string &text) {
    try {
        (void)parse_map_axis(text);
    } catch (const std::invalid_argument &error) {
        return error.what();
    }
    return "";
}

TEST(MapAxis, IsLinearLogarithmicOrAList) {
    const MapAxis linear = parse_map_axis("gravity.y=-10..0:5");
    EXPECT_EQ(linear.values, (std::vector<double>{-10, -7.5, -5, -2.5, 0}));
    EXPECT_FALSE(linear.logarithmic);
    for (const char *text : {"dt=1/480..1/30:5log", "dt=1/480..1/30:5"})
        EXPECT_EQ(parse_map_axis(text).values.size(), 5U);
    const MapAxis ratios = parse_map_axis("body.a.mass=1..16:5log");
    ASSERT_EQ(ratios.values.size(), 5U);
    for (int i = 0; i < 5; ++i)
        EXPECT_NEAR(ratios.values[static_cast<std::size_t>(i)], 1 << i, 1e-12);
    EXPECT_FALSE(ratios.setting);
    EXPECT_EQ(parse_map_axis("dt=0.1..0.2").values.size(), 10U);
    EXPECT_TRUE(parse_map_axis("dt=0.1..0.2log").logarithmic);
    EXPECT_EQ(parse_map_axis("dt=0.2,0.1,0.2").values, (std::vector<double>{0.1, 0.2}));
}

TEST(MapAxis, OfWholeNumbersHasEachOnce) {
    const MapAxis axis = parse_map_axis("substeps=1..4:12");
    EXPECT_EQ(axis.values, (std::vector<double>{1, 2, 3, 4}));
    EXPECT_TRUE(axis.whole);
    EXPECT_EQ(between(axis, 1, 4), 2);
    EXPECT_THROW((void)in_whole_numbers(parse_map_axis("body.a.repeat.count=1..1.2")),
                 std::invalid_argument);
}

TEST(MapAxis, HalvesAsItIsDivided) {
    EXPECT_NEAR(between(parse_map_axis("dt=0.01..0.04log"), 0.01, 0.04), 0.02, 1e-15);
    EXPECT_EQ(between(parse_map_axis("dt=0.01..0.04"), 1, 4), 2.5);
}

TEST(MapAxis, PlacesValuesBetweenCells) {
    const MapAxis axis = parse_map_axis("body.a.mass=1..16:5log");
    EXPECT_NEAR(cell_position(axis, 1), 0, 1e-12);
    EXPECT_NEAR(cell_position(axis, 16), 4, 1e-12);
    EXPECT_NEAR(cell_position(axis, std::sqrt(2.0)), 0.5, 1e-12);
    EXPECT_NEAR(cell_position(axis, 32), 5, 1e-12);
    EXPECT_NEAR(cell_position(parse_map_axis("body.a.mass=1,2,6"), 4), 1.5, 1e-12);
}

TEST(MapAxis, LabelsAFractionOfASecondAsSuch) {
    const MapAxis axis = parse_map_axis("dt=1/60..1");
    EXPECT_EQ(value_label(axis, 1.0 / 60), "1/60");
    EXPECT_EQ(value_label(axis, 0.3), "0.3");
    EXPECT_EQ(value_label(axis, 1), "1");
    const MapAxis close = parse_map_axis("spring.coil.stiffness=20000..20010:11");
    EXPECT_EQ(value_label(close, 20001), "20001");
    const MapAxis even = parse_map_axis("particle.bob.mass=1.9..2.1:9");
    EXPECT_EQ(value_label(even, 2.025), "2.025");
    const MapAxis uneven = parse_map_axis("spring.coil.stiffness=1..1000:8log");
    EXPECT_EQ(value_label(uneven, uneven.values[1]), "2.68");
}

TEST(MapAxis, SaysWhatIsWrong) {
    EXPECT_NE(complaint("dt").find("NAME=FROM..TO"), std::string::npos);
    EXPECT_NE(complaint("gravity=0..1").find("gravity.y"), std::string::npos);
    EXPECT_NE(complaint("dt=1..0.1").find("ascend"), std::string::npos);
    EXPECT_NE(complaint("dt=0.1..2").find("to 1 s"), std::string::npos);
    EXPECT_NE(complaint("gravity.y=-1..1:5log").find("above 0"), std::string::npos);
    for (const char *text : {"dt=0.1..0.2:1", "dt=0.1..0.2:65", "dt=0.1..0.2:x",
                             "dt=0.1..0.2:", "dt=0.1", "dt=", "dt=0.1..", "=1..2"})
        EXPECT_FALSE(complaint(text).empty()) << text;
}

TEST(MapAxis, IsTitledWithItsUnit) {
    for (const auto &[text, title] :
         {std::pair{"dt=1/60..1/15:4log", "dt (s), logarithmic"},
          std::pair{"spring.coil.stiffness=1..2", "spring.coil.stiffness (N/m)"},
          std::pair{"spring.coil.frequency=1..2", "spring.coil.frequency (Hz)"},
          std::pair{"body.a.b.velocity.x=1..2", "body.a.b.velocity.x (m/s)"},
          std::pair{"particle.0.mass=1..2", "particle.0.mass (kg)"},
          std::pair{"substeps=1..4", "substeps"},
          std::pair{"material.ice.friction=0..1", "material.ice.friction"}})
        EXPECT_EQ(axis_title(parse_map_axis(text)), title);
}

// Words, not numbers, or not the scene's: one message for both, whatever the values.
TEST(MapAxis, LeavesPrecisionAndThreadsToCharts) {
    for (const char *text : {"precision=float,double", "precision=1..2", "threads=1,2"})
        EXPECT_NE(complaint(text).find("only a chart sweeps it: `plumb chart SCENE --sweep "),
                  std::string::npos)
            << complaint(text);
}

TEST(MapAxis, MayMoveSeveralNumbersAtOnce) {
    MapAxis speed = parse_map_axis("speed=1..2");
    EXPECT_EQ(changed_numbers(speed, 3).at(0).path, "speed");
    speed.numbers = {{"body.a.velocity.x", 0.6, 0}, {"body.a.velocity.z", -0.8, 1}};
    const std::vector<ChangedNumber> changed = changed_numbers(speed, 10);
    ASSERT_EQ(changed.size(), 2U);
    EXPECT_EQ(changed[0].path, "body.a.velocity.x");
    EXPECT_EQ(changed[0].value, 6);
    EXPECT_EQ(changed[1].value, -7);
    EXPECT_EQ(axis_title(speed), "speed (m/s) by body.a.velocity");
    EXPECT_TRUE(changed_numbers(parse_map_axis("dt=1/60,1/30"), 1.0 / 60).empty());
}

} // namespace
} // namespace plumb

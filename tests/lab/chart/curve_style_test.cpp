// That the curves of a chart can be told apart.
#include "app/lab/chart/curve_style.h"

#include "app/lab/chart/chart.h"
#include "tests/lab/chart/falling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

// As an eye with that type of colour blindness sees it, at full severity (Machado, Oliveira and
// Fernandes 2009), in CIE L*a*b*, where a distance of 2.3 is just noticeable.
glm::dvec3 lab_as_seen(unsigned rgb, const glm::dmat3 &rows) {
    glm::dvec3 light;
    for (int i = 0; i < 3; ++i) {
        const double c = ((rgb >> (16 - 8 * i)) & 255) / 255.0;
        light[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    }
    light = glm::clamp(light * rows, 0.0, 1.0);
    const glm::dvec3 xyz =
        light * glm::dmat3(0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505);
    const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
    const double x = f(xyz.x / 0.9505), y = f(xyz.y), z = f(xyz.z / 1.089);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

TEST(CurveStyle, ColoursDifferForEveryEye) {
    const std::array<glm::dmat3, 4> eyes{
        glm::dmat3(1),
        glm::dmat3(0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882,
                   -0.048116, 1.051998),
        glm::dmat3(0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940,
                   0.968881),
        glm::dmat3(1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733,
                   0.691367, 0.303900)};
    for (const glm::dmat3 &eye : eyes)
        for (std::size_t i = 0; i < series_colours.size(); ++i) {
            const glm::dvec3 one = lab_as_seen(series_colours.at(i), eye);
            EXPECT_LT(one.x, 75) << "too light on white";
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_GT(glm::distance(one, lab_as_seen(series_colours.at(j), eye)), 16)
                    << i << ' ' << j;
        }
}

std::size_t colour_of_style(std::size_t style) {
    return style % series_colour_count;
}
std::size_t dashes_of_style(std::size_t style) {
    return style / series_colour_count % dash_count;
}

TEST(CurveStyle, OfOneColourDifferInDashesAndShape) {
    for (std::size_t a = 0; a < style_count; ++a)
        for (std::size_t b = 0; b < a; ++b) {
            if (colour_of_style(a) != colour_of_style(b))
                continue;
            EXPECT_NE(dashes_of_style(a), dashes_of_style(b)) << a << ' ' << b;
            EXPECT_NE(a % shape_count, b % shape_count) << a << ' ' << b;
        }
}

TEST(CurveStyle, EachMethodHasItsOwnAndFurtherCurvesKeepItsColour) {
    ChartOptions options = quick(fakes());
    options.base = {};
    options.sweep = {parse_sweep("substeps=1,4")};
    options.methods.clear();
    options.repeats = 1;
    options.precisions = {Precision::f32, Precision::f64};
    const ChartContent content = chart_content(chart_scene(falling_scene(), options), "");
    ASSERT_GT(content.series.size(), 2 * method_infos().size());
    std::set<std::size_t> styles;
    std::size_t solid = 0;
    for (const ChartSeries &series : content.series) {
        styles.insert(series.style);
        solid += dashes_of_style(series.style) == 0 ? 1U : 0U;
        if (series.name.starts_with("Soft step")) {
            EXPECT_EQ(colour_of_style(series.style), 0U) << series.name;
        }
    }
    EXPECT_EQ(styles.size(), content.series.size());
    EXPECT_EQ(solid, series_colour_count);
}

float drawn(const std::vector<LinePiece> &pieces) {
    return std::accumulate(
        pieces.begin(), pieces.end(), 0.0f,
        [](float sum, const LinePiece &piece) { return sum + glm::distance(piece[0], piece[1]); });
}

TEST(CurveStyle, LinesAreSolidOrDashedRoundTheirCorners) {
    const std::vector<glm::vec2> bent{{0, 0}, {300, 0}, {300, 0}, {300, 400}};
    EXPECT_FLOAT_EQ(drawn(line_pieces(0, bent)), 700);
    EXPECT_NEAR(drawn(line_pieces(series_colour_count, bent)), 700 * 7.0 / 11, 7);
    // Steps too short to show a dash of their own still make one line of dashes.
    std::vector<glm::vec2> fine;
    for (int i = 0; i <= 70000; ++i)
        fine.emplace_back(0.01f * static_cast<float>(i), 1e4f);
    EXPECT_NEAR(drawn(line_pieces(series_colour_count, fine)), 700 * 7.0 / 11, 14);
    for (std::size_t style = 0; style < style_count; ++style) {
        EXPECT_TRUE(line_pieces(style, {}).empty());
        EXPECT_TRUE(line_pieces(style, std::span(bent).first(1)).empty());
        for (const glm::vec2 &corner : mark_outline(style, {5, 5}, 10))
            EXPECT_NEAR(glm::distance(corner, glm::vec2(5, 5)), 11, 2);
    }
}

} // namespace
} // namespace plumb

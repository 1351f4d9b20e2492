#include "app/render/compare_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/core/random.h"

namespace plumb {
namespace {

// ---- FLIP by its definition: dense kernels, double precision
// --------------------------------------

double linear_light(double s) {
    return s > 0.04045 ? std::pow((s + 0.055) / 1.055, 2.4) : s / 12.92;
}

// The published sRGB primaries and the white they add up to.
const glm::dmat3 to_xyz{{0.4123908, 0.2126390, 0.0193308},
                        {0.3575843, 0.7151687, 0.1191948},
                        {0.1804808, 0.0721923, 0.9505322}};
const glm::dvec3 white = to_xyz * glm::dvec3(1);

glm::dvec3 lab_of_linear(const glm::dvec3 &rgb) {
    const glm::dvec3 t = to_xyz * rgb / white;
    const auto f = [](double x) {
        return x > 216.0 / 24389 ? std::cbrt(x) : (24389.0 / 27 * x + 16) / 116;
    };
    const double l = 116 * f(t.y) - 16;
    return {l, 500 * (f(t.x) - f(t.y)) * l / 100, 200 * (f(t.y) - f(t.z)) * l / 100};
}

double distance_of(const glm::dvec3 &a, const glm::dvec3 &b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

double redistributed(double hyab) {
    const double top =
        std::pow(distance_of(lab_of_linear({0, 1, 0}), lab_of_linear({0, 0, 1})), 0.7);
    const double e = std::pow(hyab, 0.7) / top;
    return e < 0.4 ? 0.95 * e / 0.4 : 0.95 + 0.05 * (e - 0.4) / 0.6;
}

using Field = std::vector<double>;

Field convolve(const Field &in, int w, int h, int radius,
               const std::function<double(int, int)> &kernel) {
    Field out(in.size(), 0.0);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            for (int v = -radius; v <= radius; ++v)
                for (int u = -radius; u <= radius; ++u) {
                    const int sx = std::clamp(x + u, 0, w - 1);
                    const int sy = std::clamp(y + v, 0, h - 1);
                    out[static_cast<std::size_t>(y * w + x)] +=
                        kernel(u, v) * in[static_cast<std::size_t>(sy * w + sx)];
                }
    return out;
}

struct Oracle {
    std::vector<glm::dvec3> lab;
    Field edge, point;
};

Oracle oracle_of(const Image &image, double ppd) {
    const double pi = std::numbers::pi;
    const int w = image.width;
    const int h = image.height;
    std::array<Field, 3> channel;
    Field luminance;
    for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
        glm::dvec3 rgb;
        for (int c = 0; c < 3; ++c)
            rgb[c] = linear_light(image.pixels[i + static_cast<std::size_t>(c)] / 255.0);
        const glm::dvec3 t = to_xyz * rgb / white;
        channel[0].push_back(116 * t.y - 16);
        channel[1].push_back(500 * (t.x - t.y));
        channel[2].push_back(200 * (t.y - t.z));
        luminance.push_back(t.y);
    }
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    const double terms[3][4] = {{1, 0.0047, 0, 1}, {1, 0.0053, 0, 1}, {34.1, 0.04, 13.5, 0.025}};
    for (std::size_t c = 0; c < 3; ++c) {
        const double *t = terms[c];
        const auto g = [&](int u, int v) {
            const double z = pi * pi * (u * u + v * v) / (ppd * ppd);
            return t[0] * std::sqrt(pi / t[1]) * std::exp(-z / t[1]) +
                   t[2] * std::sqrt(pi / t[3]) * std::exp(-z / t[3]);
        };
        double total = 0;
        for (int v = -radius; v <= radius; ++v)
            for (int u = -radius; u <= radius; ++u)
                total += g(u, v);
        channel[c] =
            convolve(channel[c], w, h, radius, [&](int u, int v) { return g(u, v) / total; });
    }
    Oracle result;
    for (std::size_t i = 0; i < luminance.size(); ++i) {
        const double y = (channel[0][i] + 16) / 116;
        const glm::dvec3 t{y + channel[1][i] / 500, y, y - channel[2][i] / 200};
        result.lab.push_back(lab_of_linear(
            glm::clamp(glm::inverse(to_xyz) * (t * white), glm::dvec3(0), glm::dvec3(1))));
    }
    const double sd = 0.041 * ppd;
    const int reach = static_cast<int>(std::ceil(3 * sd));
    for (const bool edge : {true, false}) {
        const auto raw = [&](int u, int v) {
            const double g = std::exp(-(u * u + v * v) / (2 * sd * sd));
            return edge ? -u * g : (u * u / (sd * sd) - 1) * g;
        };
        double positive = 0;
        double negative = 0;
        for (int v = -reach; v <= reach; ++v)
            for (int u = -reach; u <= reach; ++u)
                (raw(u, v) > 0 ? positive : negative) += raw(u, v);
        const auto balanced = [&](int u, int v) {
            return raw(u, v) / (raw(u, v) > 0 ? positive : -negative);
        };
        const Field x = convolve(luminance, w, h, reach, balanced);
        const Field y =
            convolve(luminance, w, h, reach, [&](int u, int v) { return balanced(v, u); });
        Field &out = edge ? result.edge : result.point;
        for (std::size_t i = 0; i < x.size(); ++i)
            out.push_back(std::hypot(x[i], y[i]));
    }
    return result;
}

Image blobs(std::uint64_t seed, int width, int height) {
    Random random(seed);
    Image image(width, height, {200, 205, 210});
    for (int i = 0; i < 6; ++i) {
        const glm::u8vec3 colour(random.next_in(0, 255), random.next_in(0, 255),
                                 random.next_in(0, 255));
        const int x0 = static_cast<int>(random.next_in(0, width - 5));
        const int y0 = static_cast<int>(random.next_in(0, height - 5));
        for (int y = y0; y < y0 + 5; ++y)
            for (int x = x0; x < x0 + 5; ++x)
                image.set(x, y, colour);
    }
    return image;
}

// Single precision is off by about 1e-7 in luminance; the feature error takes its square root.
constexpr double flip_tolerance = 2e-3;

TEST(CompareImages, FlipIsItsDefinition) {
    const Image a = blobs(1, 26, 19);
    const Image b = blobs(2, 26, 19);
    for (const float ppd : {20.0f, 67.0f}) {
        const Oracle oa = oracle_of(a, static_cast<double>(ppd));
        const Oracle ob = oracle_of(b, static_cast<double>(ppd));
        const std::vector<float> error = flip_error(a, b, ppd);
        for (std::size_t i = 0; i < error.size(); ++i) {
            const double feature = std::sqrt(
                std::max(std::abs(oa.edge[i] - ob.edge[i]), std::abs(oa.point[i] - ob.point[i])) /
                std::numbers::sqrt2);
            const double expected =
                std::pow(redistributed(distance_of(oa.lab[i], ob.lab[i])), 1 - feature);
            EXPECT_NEAR(static_cast<double>(error[i]), expected, flip_tolerance);
        }
    }
}

TEST(CompareImages, FlipOfFlatPicturesIsTheColourErrorAlone) {
    const glm::u8vec3 colours[] = {{0, 0, 0},   {255, 255, 255}, {0, 255, 0},
                                   {0, 0, 255}, {120, 90, 60},   {122, 90, 60}};
    for (const glm::u8vec3 &one : colours) {
        for (const glm::u8vec3 &other : colours) {
            const auto lab = [](const glm::u8vec3 &c) {
                return lab_of_linear({linear_light(c.x / 255.0), linear_light(c.y / 255.0),
                                      linear_light(c.z / 255.0)});
            };
            const ImageDifference d = compare_images(Image(40, 30, one), Image(40, 30, other));
            EXPECT_NEAR(d.flip_mean, redistributed(distance_of(lab(one), lab(other))),
                        flip_tolerance);
        }
    }
    EXPECT_NEAR(compare_images(Image(9, 9, {0, 255, 0}), Image(9, 9, {0, 0, 255})).flip_mean, 1,
                flip_tolerance);
}

TEST(CompareImages, APictureEqualsItself) {
    const Image a = blobs(3, 40, 30);
    const ImageDifference d = compare_images(a, a);
    EXPECT_TRUE(d.same_size);
    EXPECT_EQ(d.max_difference, 0);
    EXPECT_EQ(d.mean_difference, 0);
    EXPECT_EQ(d.fraction_beyond, 0);
    EXPECT_EQ(d.flip_mean, 0);
    EXPECT_EQ(d.flip_percentile, 0);
    EXPECT_EQ(d.foreground, 1);
    EXPECT_TRUE(compare_images(Image(), Image()).same_size);
}

TEST(CompareImages, CountsPixelsMoreThanTwoOff) {
    const Image a(10, 10, {100, 100, 100});
    Image b = a;
    b.set(0, 0, {101, 100, 100});
    b.set(1, 0, {100, 98, 100});
    b.set(2, 0, {100, 100, 103});
    b.set(3, 0, {90, 110, 97});
    const ImageDifference d = compare_images(a, b);
    EXPECT_EQ(d.max_difference, 10);
    EXPECT_DOUBLE_EQ(d.mean_difference, (1 + 2 + 3 + 10 + 10 + 3) / 300.0);
    EXPECT_DOUBLE_EQ(d.fraction_beyond, 0.02);
    EXPECT_EQ(d.picture.width, 10);
}

TEST(CompareImages, OtherSizesAreTheWorst) {
    const ImageDifference d = compare_images(Image(4, 4), Image(4, 5));
    EXPECT_FALSE(d.same_size);
    EXPECT_EQ(d.fraction_beyond, 1);
    EXPECT_EQ(d.flip_percentile, 1);
}

TEST(CompareImages, AShiftIsSmallerThanABlankFrame) {
    const Image a = blobs(5, 60, 40);
    Image shifted = a;
    for (int y = 0; y < a.height; ++y)
        for (int x = 1; x < a.width; ++x)
            shifted.set(x, y, a.at(x - 1, y));
    const Image blank(60, 40, {200, 205, 210});
    const ImageDifference by_shift = compare_images(a, shifted, {.background = &blank});
    const ImageDifference by_blank = compare_images(a, blank, {.background = &blank});
    EXPECT_GT(by_shift.flip_foreground_mean, 0.02);
    EXPECT_LT(by_shift.flip_foreground_mean, 0.8 * by_blank.flip_foreground_mean);
    EXPECT_GT(by_blank.flip_percentile, 0.3);
    EXPECT_DOUBLE_EQ(by_blank.foreground_beyond, 1);
}

TEST(CompareImages, SharesAreOfThePixelsThatAreNotBackground) {
    const Image background(20, 10, {50, 60, 70});
    Image a = background;
    Image b = background;
    for (int x = 0; x < 8; ++x)
        a.set(x, 2, {200, 0, 0}); // in both images, except for two pixels
    for (int x = 2; x < 8; ++x)
        b.set(x, 2, {200, 0, 0});
    b.set(19, 9, {51, 61, 71}); // within rounding: still background
    const ImageDifference d = compare_images(a, b, {.background = &background});
    EXPECT_DOUBLE_EQ(d.foreground, 8.0 / 200);
    EXPECT_DOUBLE_EQ(d.foreground_beyond, 2.0 / 8);
    EXPECT_DOUBLE_EQ(d.fraction_beyond, 2.0 / 200);
}

TEST(CompareImages, PercentileIsByNearestRank) {
    const Image background(8, 1, {0, 0, 0});
    Image a = background;
    Image b = background;
    for (int x = 0; x < 8; ++x) {
        a.set(x, 0, {100, 100, 100});
        b.set(x, 0, glm::u8vec3(glm::ivec3(100 + 15 * x)));
    }
    std::vector<float> error = flip_error(a, b);
    std::sort(error.begin(), error.end());
    const auto at = [&](float percentile) {
        return compare_images(a, b, {.background = &background, .percentile = percentile})
            .flip_percentile;
    };
    EXPECT_EQ(at(1.0f), static_cast<double>(error[7]));
    EXPECT_EQ(at(0.5f), static_cast<double>(error[3]));
    EXPECT_EQ(at(0.01f), static_cast<double>(error[0]));
}

} // namespace
} // namespace plumb

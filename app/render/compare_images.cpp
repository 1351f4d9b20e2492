#include "app/render/compare_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/core/check.h"

namespace plumb {

namespace {

// A channel this far off can be one rasterizer's rounding.
constexpr int same_within = 2;

using Plane = std::vector<float>; // one channel, row by row

// ---- colour spaces, all for the white point D65
// ----------------------------------------------------

// IEC 61966-2-1, with the primaries' matrix in exact fractions; columns are red, green, blue.
const glm::dmat3 xyz_from_rgb{{10135552.0 / 24577794, 2613072.0 / 12288897, 1425312.0 / 73733382},
                              {8788810.0 / 24577794, 8788810.0 / 12288897, 8788810.0 / 73733382},
                              {4435075.0 / 24577794, 887015.0 / 12288897, 70074185.0 / 73733382}};
// White, the sum of the columns: XYZ below is in units of it.
const glm::dvec3 white = xyz_from_rgb * glm::dvec3(1);

glm::vec3 relative_xyz(const glm::vec3 &linear) {
    static const glm::mat3 matrix = [] {
        glm::dmat3 m = xyz_from_rgb;
        for (int c = 0; c < 3; ++c)
            m[c] /= white;
        return glm::mat3(m);
    }();
    return matrix * linear;
}

glm::vec3 linear_from_relative_xyz(const glm::vec3 &xyz) {
    static const glm::mat3 matrix = [] {
        glm::dmat3 m = xyz_from_rgb;
        for (int c = 0; c < 3; ++c)
            m[c] /= white;
        return glm::mat3(glm::inverse(m));
    }();
    return matrix * xyz;
}

// YCxCz, a linear form of CIELAB (Andersson et al. 2020, "Spatial filtering").
glm::vec3 ycxcz(const glm::vec3 &xyz) {
    return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

glm::vec3 relative_xyz_from_ycxcz(const glm::vec3 &v) {
    const float y = (v.x + 16) / 116;
    return {y + v.y / 500, y, y - v.z / 200};
}

// CIELAB with its chroma scaled by lightness for the Hunt effect (ibid., "Perceptually uniform
// colour space").
glm::vec3 hunt_lab(const glm::vec3 &linear) {
    const auto f = [](float t) {
        constexpr float delta = 6.0f / 29.0f;
        return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29.0f;
    };
    const glm::vec3 xyz = relative_xyz(linear);
    const float fy = f(xyz.y);
    const float l = 116 * fy - 16;
    return {l, 0.01f * l * 500 * (f(xyz.x) - fy), 0.01f * l * 200 * (fy - f(xyz.z))};
}

// Abasi et al. 2019: city-block in lightness, Euclidean in chroma.
float hyab(const glm::vec3 &a, const glm::vec3 &b) {
    const glm::vec3 d = a - b;
    return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

// ---- separable filters, borders repeated
// -----------------------------------------------------------

using Kernel = std::vector<float>; // 2 r + 1 weights

std::vector<int> offsets_within(int count, int i, int radius) {
    std::vector<int> result;
    for (int k = -radius; k <= radius; ++k)
        result.push_back(std::clamp(i + k, 0, count - 1));
    return result;
}

Plane filter(const Plane &in, int width, int height, const Kernel &along_x, const Kernel &along_y) {
    const int rx = static_cast<int>(along_x.size() / 2);
    const int ry = static_cast<int>(along_y.size() / 2);
    const std::size_t w = static_cast<std::size_t>(width);
    Plane middle(in.size());
    std::vector<float> row(w + 2 * static_cast<std::size_t>(rx));
    for (int y = 0; y < height; ++y) {
        const float *from = in.data() + static_cast<std::size_t>(y) * w;
        for (int x = -rx; x < width + rx; ++x)
            row[static_cast<std::size_t>(x + rx)] = from[std::clamp(x, 0, width - 1)];
        float *to = middle.data() + static_cast<std::size_t>(y) * w;
        std::fill(to, to + w, 0.0f);
        for (std::size_t k = 0; k < along_x.size(); ++k)
            for (std::size_t x = 0; x < w; ++x)
                to[x] += along_x[k] * row[x + k];
    }
    Plane out(in.size(), 0.0f);
    for (int y = 0; y < height; ++y) {
        const std::vector<int> rows = offsets_within(height, y, ry);
        float *to = out.data() + static_cast<std::size_t>(y) * w;
        for (std::size_t k = 0; k < along_y.size(); ++k) {
            const float *from = middle.data() + static_cast<std::size_t>(rows[k]) * w;
            for (std::size_t x = 0; x < w; ++x)
                to[x] += along_y[k] * from[x];
        }
    }
    return out;
}

Kernel sampled(int radius, const std::function<double(double)> &f) {
    Kernel result;
    for (int k = -radius; k <= radius; ++k)
        result.push_back(static_cast<float>(f(k)));
    return result;
}

double sum(const Kernel &kernel) {
    double result = 0;
    for (const float weight : kernel)
        result += static_cast<double>(weight);
    return result;
}

void scale(Kernel &kernel, double factor) {
    for (float &weight : kernel)
        weight = static_cast<float>(static_cast<double>(weight) * factor);
}

// Scales positive weights to sum to 1, negative ones to -1.
void balance(Kernel &kernel) {
    double positive = 0;
    double negative = 0;
    for (const float weight : kernel)
        (weight > 0 ? positive : negative) += static_cast<double>(weight);
    for (float &weight : kernel)
        weight =
            static_cast<float>(static_cast<double>(weight) / (weight > 0 ? positive : -negative));
}

// The eye's contrast sensitivity as one or two Gaussians, weights a and widths b in degrees^2
// (ibid., "Spatial filtering", after Johnson and Fairchild 2003).
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr Sensitivity achromatic{1, 0.0047, 0, 1e-5};
constexpr Sensitivity red_green{1, 0.0053, 0, 1e-5};
constexpr Sensitivity blue_yellow{34.1, 0.04, 13.5, 0.025};
constexpr double widest_spot = 0.04;

Plane filter_as_seen(const Plane &in, int width, int height, const Sensitivity &s, double ppd) {
    constexpr double pi = std::numbers::pi;
    const int radius =
        static_cast<int>(std::ceil(3 * std::sqrt(widest_spot / (2 * pi * pi)) * ppd));
    const auto gaussian = [&](double b) {
        return sampled(radius, [&](double k) {
            const double x = k / ppd;
            return std::exp(-pi * pi * x * x / b);
        });
    };
    // g(x, y) = sum of a_i sqrt(pi / b_i) exp(-pi^2 (x^2 + y^2) / b_i), scaled to a sum of 1: each
    // term is separable.
    Kernel first = gaussian(s.b1);
    const double weight1 = s.a1 * std::sqrt(pi / s.b1);
    const double total1 = weight1 * sum(first) * sum(first);
    Kernel second = gaussian(s.b2);
    const double weight2 = s.a2 * std::sqrt(pi / s.b2);
    const double total2 = weight2 * sum(second) * sum(second);
    const double total = total1 + total2;
    scale(first, std::sqrt(weight1 / total));
    Plane out = filter(in, width, height, first, first);
    if (weight2 > 0) {
        scale(second, std::sqrt(weight2 / total));
        const Plane more = filter(in, width, height, second, second);
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] += more[i];
    }
    return out;
}

// ---- what both pipelines need from one picture
// ------------------------------------------------------

struct Seen {
    std::vector<glm::vec3> colour; // Hunt-adjusted CIELAB after the eye's filter
    Plane edges;                   // magnitudes of the feature filters
    Plane points;
};

Seen see(const Image &image, double ppd) {
    static const std::array<float, 256> linear_from_byte = [] {
        std::array<float, 256> table{};
        for (std::size_t i = 0; i < table.size(); ++i) {
            const double s = static_cast<double>(i) / 255;
            table[i] =
                static_cast<float>(s > 0.04045 ? std::pow((s + 0.055) / 1.055, 2.4) : s / 12.92);
        }
        return table;
    }();
    const std::size_t count = image.pixels.size() / 3;
    const int w = image.width;
    const int h = image.height;
    std::array<Plane, 3> opponent{Plane(count), Plane(count), Plane(count)};
    Plane luminance(count);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 v = ycxcz(relative_xyz({linear_from_byte[image.pixels[3 * i]],
                                                linear_from_byte[image.pixels[3 * i + 1]],
                                                linear_from_byte[image.pixels[3 * i + 2]]}));
        opponent[0][i] = v.x;
        opponent[1][i] = v.y;
        opponent[2][i] = v.z;
        luminance[i] = (v.x + 16) / 116;
    }
    opponent[0] = filter_as_seen(opponent[0], w, h, achromatic, ppd);
    opponent[1] = filter_as_seen(opponent[1], w, h, red_green, ppd);
    opponent[2] = filter_as_seen(opponent[2], w, h, blue_yellow, ppd);

    Seen seen;
    seen.colour.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 v{opponent[0][i], opponent[1][i], opponent[2][i]};
        const glm::vec3 linear = linear_from_relative_xyz(relative_xyz_from_ycxcz(v));
        seen.colour[i] = hunt_lab(glm::clamp(linear, glm::vec3(0), glm::vec3(1)));
    }

    // First and second derivatives of a Gaussian, 0.082 degrees from peak to trough (ibid.,
    // "Feature detection").
    const double deviation = 0.5 * 0.082 * ppd;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const auto gaussian = [&](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
    Kernel smooth = sampled(radius, gaussian);
    scale(smooth, 1 / sum(smooth));
    Kernel edge = sampled(radius, [&](double x) { return -x * gaussian(x); });
    Kernel point = sampled(
        radius, [&](double x) { return (x * x / (deviation * deviation) - 1) * gaussian(x); });
    const auto magnitude = [&](Kernel &kernel) {
        balance(kernel);
        Plane x = filter(luminance, w, h, kernel, smooth);
        const Plane y = filter(luminance, w, h, smooth, kernel);
        for (std::size_t i = 0; i < count; ++i)
            x[i] = std::hypot(x[i], y[i]);
        return x;
    };
    seen.edges = magnitude(edge);
    seen.points = magnitude(point);
    return seen;
}

glm::u8vec3 heat(float t) {
    static constexpr std::array<glm::vec3, 6> stops{{{0, 0, 4},
                                                     {60, 15, 112},
                                                     {140, 41, 129},
                                                     {222, 73, 104},
                                                     {254, 159, 109},
                                                     {252, 253, 191}}};
    const float at = std::clamp(t, 0.0f, 1.0f) * static_cast<float>(stops.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(at), stops.size() - 2);
    return glm::u8vec3(glm::mix(stops[i], stops[i + 1], at - static_cast<float>(i)) + 0.5f);
}

bool beyond(const Image &a, const Image &b, std::size_t pixel) {
    for (std::size_t c = 3 * pixel; c < 3 * pixel + 3; ++c)
        if (std::abs(static_cast<int>(a.pixels[c]) - static_cast<int>(b.pixels[c])) > same_within)
            return true;
    return false;
}

} // namespace

std::vector<float> flip_error(const Image &reference, const Image &test, float pixels_per_degree) {
    PLUMB_CHECK(reference.width == test.width && reference.height == test.height,
                "pictures of different sizes: " << reference.width << " x " << reference.height
                                                << " and " << test.width << " x " << test.height);
    PLUMB_CHECK(pixels_per_degree > 0,
                "pixels per degree must be positive, got " << pixels_per_degree);
    if (reference == test)
        return std::vector<float>(reference.pixels.size() / 3, 0.0f);
    const Seen a = see(reference, static_cast<double>(pixels_per_degree));
    const Seen b = see(test, static_cast<double>(pixels_per_degree));

    // "Error redistribution": powers of HyAB up to pc of the largest fill [0, pt], the rest [pt,
    // 1].
    constexpr float qc = 0.7f;
    constexpr float pc = 0.4f;
    constexpr float pt = 0.95f;
    constexpr float qf = 0.5f;
    const float largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), qc);
    std::vector<float> error(a.colour.size());
    for (std::size_t i = 0; i < error.size(); ++i) {
        const float power = std::pow(hyab(a.colour[i], b.colour[i]), qc);
        const float colour = power < pc * largest ? pt / (pc * largest) * power
                                                  : pt + (power - pc * largest) /
                                                             (largest - pc * largest) * (1 - pt);
        const float feature = std::pow(
            std::numbers::sqrt2_v<float> / 2 *
                std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i])),
            qf);
        // "Final": the feature error raises the colour error.
        error[i] = std::clamp(std::pow(colour, 1 - feature), 0.0f, 1.0f);
    }
    return error;
}

ImageDifference compare_images(const Image &a, const Image &b, const CompareOptions &options) {
    PLUMB_CHECK(options.percentile > 0 && options.percentile <= 1,
                "a percentile must be in (0, 1], got " << options.percentile);
    ImageDifference result;
    if (a.width != b.width || a.height != b.height) {
        result.same_size = false;
        result.max_difference = 255;
        result.mean_difference = 255;
        result.fraction_beyond = result.foreground = result.foreground_beyond = 1;
        result.flip_mean = result.flip_foreground_mean = result.flip_percentile = 1;
        return result;
    }
    const Image *background = options.background;
    PLUMB_CHECK(!background || (background->width == a.width && background->height == a.height),
                "the background picture is " << background->width << " x " << background->height
                                             << ", the others " << a.width << " x " << a.height);
    const std::size_t count = a.pixels.size() / 3;
    result.picture = Image(a.width, a.height);
    if (count == 0)
        return result;

    std::uint64_t total = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const int d = std::abs(static_cast<int>(a.pixels[i]) - static_cast<int>(b.pixels[i]));
        result.max_difference = std::max(result.max_difference, d);
        total += static_cast<std::uint64_t>(d);
    }
    result.mean_difference = static_cast<double>(total) / static_cast<double>(a.pixels.size());

    const std::vector<float> error = flip_error(a, b, options.pixels_per_degree);
    std::vector<float> foreground;
    std::size_t beyond_count = 0;
    std::size_t foreground_beyond = 0;
    double flip_total = 0;
    double flip_foreground = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const bool differs = beyond(a, b, i);
        beyond_count += differs ? 1 : 0;
        flip_total += static_cast<double>(error[i]);
        if (!background || beyond(a, *background, i) || beyond(b, *background, i)) {
            foreground.push_back(error[i]);
            foreground_beyond += differs ? 1 : 0;
            flip_foreground += static_cast<double>(error[i]);
        }
        const glm::u8vec3 colour = heat(error[i]);
        for (int c = 0; c < 3; ++c)
            result.picture.pixels[3 * i + static_cast<std::size_t>(c)] = colour[c];
    }
    const double pixels = static_cast<double>(count);
    result.fraction_beyond = static_cast<double>(beyond_count) / pixels;
    result.flip_mean = flip_total / pixels;
    result.foreground = static_cast<double>(foreground.size()) / pixels;
    if (!foreground.empty()) {
        const double number = static_cast<double>(foreground.size());
        result.foreground_beyond = static_cast<double>(foreground_beyond) / number;
        result.flip_foreground_mean = flip_foreground / number;
        // Nearest rank.
        const double rank = std::ceil(static_cast<double>(options.percentile) * number);
        const auto nth = foreground.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
        std::nth_element(foreground.begin(), nth, foreground.end());
        result.flip_percentile = static_cast<double>(*nth);
    }
    return result;
}

} // namespace plumb

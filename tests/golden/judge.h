// When a picture counts as matching the golden one.
#pragma once

#include "app/render/compare_images.h"
#include "tests/golden/golden_record.h"

#include <string>

namespace plumb::golden {

// How strict to be: the rasterizer that drew the golden picture on the same kind of CPU, or another
// one.
enum class Tier { same_rasterizer, another_rasterizer };

Tier tier_of(const Rasterizer &golden, const Rasterizer &present);

// Per channel of a pixel, 0..255: what one rasterizer's rounding explains.
constexpr int same_rasterizer_limit = 2;

struct OtherRasterizerLimits {
    double flip_mean;       // over the foreground
    double flip_percentile; // over the foreground
    float percentile;
};
extern const OtherRasterizerLimits other_rasterizer_limits;

// Compares with the options that the limits hold for.
ImageDifference difference(const Image &expected, const Image &actual, const Image &background);
bool within_limits(const ImageDifference &difference, Tier tier);

struct Verdict {
    enum class Kind { same, no_golden, another_state, another_picture };
    Kind kind = Kind::same;
    Tier tier = Tier::same_rasterizer;
    ImageDifference difference; // only if both pictures exist
    std::string text;           // the message, in any case
};

// The state first: a picture difference is the renderer's doing only if the states agree.
Verdict judge(const std::optional<Record> &golden, const Rendering &present);

} // namespace plumb::golden

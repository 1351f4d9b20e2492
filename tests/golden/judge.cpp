#include "tests/golden/judge.h"

#include <sstream>

namespace plumb::golden {

// Measured over all cases against llvmpipe of Mesa 22.3.6 on 256 bits with AVX2 and FMA; worst
// case:
//
//                                               mean     99.8th percentile
//   the same, SSE2 only                         0.002    0.03
//   the same, no SSE at all                     0.006    0.11
//   softpipe of Mesa 22.3.6                     0.019    0.10
//   smallest difference that must fail (judge_test.cpp):
//     shifted by a pixel                        0.061    0.43
//     without one body                          0.004    0.63
//     another golden, or blank                  0.28     0.73
//
// One missing body out of 210 is lost in the mean but not in the percentile, as it covers more than
// 0.2 % of the foreground. Both limits lie midway, on a logarithmic scale, between the spread and
// what must fail. No case draws polygons as lines: softpipe draws them so differently that no limit
// would hold (43 % of the foreground).
const OtherRasterizerLimits other_rasterizer_limits{0.035, 0.22, 0.998f};

Tier tier_of(const Rasterizer &golden, const Rasterizer &present) {
    return golden == present ? Tier::same_rasterizer : Tier::another_rasterizer;
}

ImageDifference difference(const Image &expected, const Image &actual, const Image &background) {
    const bool comparable =
        expected.width == background.width && expected.height == background.height;
    CompareOptions options;
    options.background = comparable ? &background : nullptr;
    options.percentile = other_rasterizer_limits.percentile;
    return compare_images(expected, actual, options);
}

bool within_limits(const ImageDifference &difference, Tier tier) {
    if (!difference.same_size)
        return false;
    if (tier == Tier::same_rasterizer)
        return difference.max_difference <= same_rasterizer_limit;
    return difference.flip_foreground_mean <= other_rasterizer_limits.flip_mean &&
           difference.flip_percentile <= other_rasterizer_limits.flip_percentile;
}

namespace {

std::string text_of(const Rasterizer &rasterizer) {
    return rasterizer.renderer + ", " + rasterizer.version + ", on a CPU with " + rasterizer.cpu;
}

void print(std::ostream &out, const ImageDifference &d, Tier tier) {
    if (!d.same_size) {
        out << "The pictures differ in size.\n";
        return;
    }
    out << "Largest difference of a channel: " << d.max_difference << " of 255";
    if (tier == Tier::same_rasterizer)
        out << ", at most " << same_rasterizer_limit << " for the same rasterizer";
    out << ".\nPixels more than 2 off: " << 100 * d.fraction_beyond << " % of all, "
        << 100 * d.foreground_beyond << " % of the foreground, which is " << 100 * d.foreground
        << " % of the picture.\nFLIP over the foreground: mean " << d.flip_foreground_mean;
    if (tier == Tier::another_rasterizer)
        out << " (at most " << other_rasterizer_limits.flip_mean << ')';
    out << ", percentile " << 100 * other_rasterizer_limits.percentile << ' ' << d.flip_percentile;
    if (tier == Tier::another_rasterizer)
        out << " (at most " << other_rasterizer_limits.flip_percentile << ')';
    out << ".\n";
}

} // namespace

Verdict judge(const std::optional<Record> &golden, const Rendering &present) {
    Verdict verdict;
    std::ostringstream text;
    if (!golden) {
        verdict.kind = Verdict::Kind::no_golden;
        verdict.text = "There is no golden picture yet.\n";
        return verdict;
    }
    verdict.tier = tier_of(golden->rasterizer, present.rasterizer);
    verdict.difference = difference(golden->picture, present.picture, present.background);
    const bool close = within_limits(verdict.difference, verdict.tier);
    if (golden->state_hash != present.state_hash) {
        verdict.kind = Verdict::Kind::another_state;
        text << "STATE: the simulation has come to another state, " << hash_text(present.state_hash)
             << " instead of " << hash_text(golden->state_hash)
             << ". The engine or the scene has changed; the picture says nothing of the renderer"
             << (close ? ", though it is within the limits" : "") << ".\n";
    } else if (!close) {
        verdict.kind = Verdict::Kind::another_picture;
        text
            << "RENDERER: the state is the same, the picture is not. Renderer, shaders, panels, or "
               "colours and camera of the scene have changed.\n";
    }
    if (verdict.tier == Tier::same_rasterizer)
        text << "Drawn by the same rasterizer: " << text_of(present.rasterizer) << ".\n";
    else
        text << "Drawn by another rasterizer: " << text_of(present.rasterizer)
             << "; the golden one: " << text_of(golden->rasterizer) << ".\n";
    print(text, verdict.difference, verdict.tier);
    verdict.text = text.str();
    return verdict;
}

} // namespace plumb::golden

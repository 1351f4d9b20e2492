// How far two pictures differ, pixel by pixel and to the eye.
#pragma once

#include <vector>

#include "app/render/image.h"

namespace plumb {

struct CompareOptions {
    // A picture of the background alone, of the same size, or null. A pixel where both pictures are
    // within 2/255 of it is background; with null, no pixel is.
    const Image *background = nullptr;
    // Percentile of the perceptual error over foreground pixels, in (0, 1].
    float percentile = 0.95f;
    // How large a pixel looks. 67: a 0.7 m wide 3840 pixel monitor seen from 0.7 m, the default of
    // the FLIP paper.
    float pixels_per_degree = 67.0206f;
};

struct ImageDifference {
    bool same_size = true;      // if not, every field below is at its worst and there is no picture
    int max_difference = 0;     // of a channel, 0..255
    double mean_difference = 0; // over all channels of all pixels, 0..255
    double fraction_beyond = 0; // share of pixels with a channel more than 2 off
    double foreground = 0;      // share of pixels that are not background
    double foreground_beyond = 0;    // share of foreground pixels more than 2 off
    double flip_mean = 0;            // FLIP over all pixels, 0..1
    double flip_foreground_mean = 0; // FLIP over foreground pixels
    double flip_percentile = 0;      // FLIP at options.percentile, same pixels
    Image picture;                   // FLIP of each pixel: black is equal, then violet to yellow
};

// Symmetric in a and b except for FLIP's own rounding. Two empty pictures are equal.
[[nodiscard]] ImageDifference compare_images(const Image &a, const Image &b,
                                             const CompareOptions &options = {});

// FLIP of each pixel, row by row, 0..1 (Andersson et al. 2020, for LDR pictures). The sizes must
// match.
[[nodiscard]] std::vector<float> flip_error(const Image &reference, const Image &test,
                                            float pixels_per_degree = 67.0206f);

} // namespace plumb

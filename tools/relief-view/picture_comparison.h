// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far two pictures of one size are apart, in numbers, in words, and as a picture.
/// Tests: tests/tools/compare_options_test.cpp, tests/tools/picture_reference_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "relief/shade/image_compare.h"

namespace relief::tools {

struct PictureComparison {
    ImageDifference difference;
    FlipDifference flip;
    double peak = 1;  ///< What the largest sample stands for: 255, 65535 or 1.
};

/// A picture without alpha covers everything. \throws InvalidInput if the two do not have the same
/// size, bits and channels
PictureComparison compare_pictures(const Image& reference, const Image& picture);

/// "largest 3 of 255, mean 0.02, PSNR 58.1 dB, FLIP 0.004 (largest 0.21), 812 pixels differ"
std::string in_words(const PictureComparison& comparison);

/// "3 of 255", "0.25"
std::string with_peak(double value, double peak);

/// {"max", "mean", "rms", "psnr", "differing_pixels", "flip_mean", "flip_max"}; numbers without
/// bound (PSNR of equal pictures) are null.
nlohmann::ordered_json numbers_json(const PictureComparison& comparison);

/// The largest difference of any channel at each pixel, from 0 to 1: one float channel, data.
/// \throws InvalidInput if the two do not have the same size, bits and channels
Image largest_differences(const Image& a, const Image& b);

/// The left columns of one picture and the right ones of another, of the same kind.
/// \param split  the share of the left one, 0 to 1
Image split_picture(const Image& left, const Image& right, float split);

}  // namespace relief::tools

// SPDX-License-Identifier: Apache-2.0
/// \file
/// The figures of fidelity.h from two pictures of one view. Tests:
/// tests/shade/render/fidelity_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/image.h"
#include "render/fidelity_pictures.h"

namespace RELIEF_API relief {
namespace shade::detail {

/// The pixels of a view that are compared, and the rectangle of those that influence them.
struct ComparedPart {
    std::vector<std::uint8_t> is_compared;
    ImagePart part;
};

ComparedPart compared_part(const NormalPicture& a, const NormalPicture& b, int size);

/// Returns a part of a picture over a background, in linear float.
Image over_gray(const ColorPicture& picture, int size, const ImagePart& part, float background);

/// Returns the FLIP values of the compared pixels of a part.
std::vector<float> compared_values(const Image& map, const ComparedPart& compared, int size);

/// Returns a picture of the whole size with the values of a part, and 0 elsewhere.
Image whole_map(const Image& part_map, const ImagePart& part, int size);

/// Returns the mean; 0 if there is no value.
double mean_of(std::span<const float> values);

/// Returns the smallest value that a percentage of all do not exceed; 0 if there is none.
double percentile(std::vector<float> values, std::size_t percent);

bool is_covered_completely(float coverage);

struct AngleValues {
    std::vector<float> degrees;
    std::size_t undefined = 0;  ///< Pixels without a normal in one picture.
};

/// Compares the pixels that both pictures cover completely.
AngleValues angles_between(const NormalPicture& a, const NormalPicture& b);

/// The length of silhouettes, and the area that only one of two models covers, in pixels.
struct SilhouetteSums {
    double area = 0.0;
    double length = 0.0;

    [[nodiscard]] double width() const { return length > 0.0 ? area / length : 0.0; }
};

SilhouetteSums silhouette_sums(const NormalPicture& source, const NormalPicture& result, int size);

}  // namespace shade::detail
}  // namespace relief

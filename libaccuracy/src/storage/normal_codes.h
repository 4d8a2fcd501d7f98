// SPDX-License-Identifier: Apache-2.0
/// \file
/// Ways to store a unit normal in few bits, as maps and vertex buffers do, and what is lost; what
/// the experiments and the storage table of docs/normal-maps.md measure.
/// Tests: tests/accuracy/normal_codes_test.cpp.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/image.h"

namespace relief {

/// One way of storing the normals of a map, and of reading them back.
struct NormalCode {
    std::string name;  ///< "xyz 8 bit, blue-noise"
    std::vector<std::pair<std::string, std::string>> choices;
    double bytes = 0.0;  ///< Of a texel, in the formats that there are.
    /// Of three float channels, unit; texels keep their places, which dithering goes by.
    std::function<Image(const Image& normals)> encode;
    std::function<Image(const Image& codes)> decode;

    [[nodiscard]] Image stored(const Image& normals) const { return decode(encode(normals)); }
};

/// x, y, z in 8, 10 and 16 bits, half and float (as files hold them: (n + 1) / 2); x and y alone;
/// octahedral in 2 x 8 to 2 x 16 bits, rounded to the nearest code of each coordinate or to the
/// best of four; dithered where relief does that.
std::vector<NormalCode> normal_codes();

/// Directions as a map of `width` texels a row, rounded to float. \throws InvalidInput if rows are
/// not full
Image image_of_normals(std::span<const glm::dvec3> directions, int width);

/// A smooth surface of waves, as codes are bad at: slopes that change by a code of 8 bits every few
/// texels. Row by row, unit, y up.
std::vector<glm::dvec3> smooth_surface(int side);

/// How far sums of normals over squares of `block` texels are from the true sums, in degrees: what
/// the eye, or a mip level, makes of a patch.
/// \param truth  of the same size, which `block` divides
AngleDistribution patch_errors(const Image& normals, const Image& truth, int block);

}  // namespace relief

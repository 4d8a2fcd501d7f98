// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stores the images of a page that browsers cannot decode in less space: samples as differences,
/// normals without z, and normal maps as the heights that they were computed from. Codes of 16 bits
/// change by at most 1, and z by 4, which is 0.007 degrees. Tests:
/// tests/tools/view_page/page_images_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "common/summary.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/image.h"
#include "relief/shade/page.h"

namespace relief::tools {

/// Heights that a normal map of a page may have been computed from.
struct PageHeights {
    Image image;
    std::vector<BumpOptions> conversions;  ///< By converted_heights(), with 16 bits.
};

/// The data that replaces a texture's samples in a page.
struct PackedImage {
    std::vector<std::uint8_t> bytes;
    Json fields;  ///< Changes of the texture's description.
};

/// Returns samples as their differences from the left neighbor, modulo the largest code plus 1:
/// first all lower bytes, then the upper ones of 16 bits. Rows begin with their first samples.
std::vector<std::uint8_t> packed_samples(std::span<const std::uint8_t> samples, std::size_t row,
                                         std::size_t channels);
std::vector<std::uint8_t> packed_samples(std::span<const std::uint16_t> samples, std::size_t row,
                                         std::size_t channels);

/// The codes of unit normals with 16 bits: n = (code - zero) / steps.
struct NormalCodes {
    double zero = 0.0;
    double steps = 1.0;
};

/// Returns the codes of a map of three channels if z follows from x and y: within four codes, it is
/// the positive one of a unit normal.
std::optional<NormalCodes> unit_normal_codes(std::span<const std::uint16_t> samples);

/// Returns what replaces the samples of textures, by section.
std::map<std::size_t, PackedImage> packed_images(const shade::PageDescription& page,
                                                 const std::optional<PageHeights>& heights);

}  // namespace relief::tools

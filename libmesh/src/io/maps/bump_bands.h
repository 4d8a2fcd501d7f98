// SPDX-License-Identifier: Apache-2.0
/// \file
/// Bands of a file's samples from rows of heights: codes of normals with what is to be beside them,
/// or moments of slopes. Tests: tests/mesh/io/maps/bump_file_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "image/bump/bump_rows.h"
#include "relief/mesh/bump_file.h"

namespace relief {

/// What a band is made of.
struct BumpBandSource {
    HeightRows heights;
    /// The alpha of a row, if the map has one, and its bits.
    std::function<const void*(int row)> alpha;
    int alpha_bits = 8;
    /// 1 for each transparent texel of a row, if the map has any.
    std::function<const std::uint8_t*(int row)> transparent;
};

/// The image that a format asks for.
ImageShape shape_of(const BumpFileFormat& format, int width, int height);

/// Makes rows [first, last) of the file on all threads.
///
/// \param rows    as many as there are, tightly packed
/// \param report  counts heights and alphas that had to be clamped
/// \return false where a height that counts is not finite: then nothing of the result does, and
///         nothing was reported
bool make_bump_band(const BumpBandSource& source, const BumpOptions& options,
                    const BumpFileFormat& format, int first, int last, std::span<std::byte> rows,
                    Report& report);

}  // namespace relief

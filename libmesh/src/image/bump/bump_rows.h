// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rows of a normal map from rows of heights, wherever these are: in an image, or in a window that
/// moves over a file.
#pragma once

#include <functional>

#include "relief/mesh/bump.h"

namespace relief {

/// Of a map whose rows are made on all threads.
inline constexpr std::size_t bump_texels_per_piece = 1 << 16;

/// \throws InvalidInput if the strength, the texel or the radius is out of range
void check_bump(const BumpOptions& options);

/// A height map by rows.
struct HeightRows {
    int width = 0;
    int height = 0;
    int bits = 32;  ///< 8 or 16: whole numbers, standing for value / 255 and / 65535. 32: float.
    /// The first sample of a row in [0, height); asked for rows within the kernel's radius of the
    /// one that is made, by the wrap rule where those lie outside. Called from several threads.
    std::function<const void*(int row)> row;
};

/// What is made of the slopes.
enum class BumpResult {
    slopes,   ///< Two floats: dh/dx to the right, dh/dy upwards.
    normals,  ///< Three floats, unit.
    codes,    ///< Three samples as a NormalMapFormat says.
};

struct BumpTarget {
    BumpResult result = BumpResult::normals;
    NormalMapFormat format{};
    /// Where the first sample of a row goes.
    std::function<void*(int row)> row;
};

/// Makes rows [first, last), on the calling thread.
///
/// \param options  settled
/// \return false where a height that counts is not finite: then nothing of the result does
bool make_bump_rows(const HeightRows& heights, const BumpOptions& options, const BumpTarget& target,
                    int first, int last);

}  // namespace relief

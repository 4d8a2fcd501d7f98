// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rows of a normal map from rows of heights, which may be in an image or in a moving window of a
/// file.
#pragma once

#include <functional>

#include "relief/export.h"
#include "relief/mesh/bump.h"

namespace RELIEF_API relief {

/// The grain size of parallel loops over rows.
inline constexpr std::size_t bump_texels_per_piece = 1 << 16;

/// \throws InvalidInput if the strength, the texel size or the radius is out of range
void check_bump(const BumpOptions& options);

/// Access to a height map by rows.
struct HeightRows {
    int width = 0;
    int height = 0;
    int bits = 32;  ///< 8 or 16: integers for value / 255 and value / 65535; 32: float.
    /// Returns the first sample of a row in [0, height). It is called from several threads, for
    /// rows within the radius of the kernel, after wrapping.
    std::function<const void*(int row)> row;
};

/// The kind of result.
enum class BumpResult {
    slopes,   ///< Two floats: dh/dx to the right, dh/dy upwards.
    normals,  ///< Three floats, unit.
    codes,    ///< Three samples in a NormalMapFormat.
};

struct BumpTarget {
    BumpResult result = BumpResult::normals;
    NormalMapFormat format{};
    /// Returns the address of the first sample of a row.
    std::function<void*(int row)> row;
};

/// Computes rows [first, last) on the calling thread.
///
/// \param options  without unset fields; see resolve_options()
/// \return false if a height that contributes is not finite, which makes the result invalid
bool make_bump_rows(const HeightRows& heights, const BumpOptions& options, const BumpTarget& target,
                    int first, int last);

}  // namespace relief

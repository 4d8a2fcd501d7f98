// SPDX-License-Identifier: Apache-2.0
/// \file
/// Filling of holes in height fields, before slopes are computed.
#pragma once

#include <span>
#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {

/// Texels that are no part of the surface.
struct Transparency {
    std::span<const unsigned char> texels{};  ///< 1 for each such texel; or none at all.
    /// How far from the surface they get a height, so that a kernel finds one there; 0 beyond.
    int reach = 0;
};

/// The heights of an image with every non-finite one replaced, and those of transparent texels.
///
/// \param height  one float channel
/// \param report  counts non-finite heights
/// \return empty where all heights are finite already (the common case takes no memory); else a
///         copy in which each hole is the mean of the finite heights in the smallest square around
///         it that has any (beyond the border by `wrap`: the tiled plane, or nothing), or 0 where
///         no height of the image is finite
std::vector<float> filled_holes(const Image& height, const Wraps& wrap, Report& report,
                                const Transparency& transparency = {});

}  // namespace relief

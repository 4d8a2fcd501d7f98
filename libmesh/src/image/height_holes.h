// SPDX-License-Identifier: Apache-2.0
/// \file
/// Filling of holes in height fields, before slopes are computed.
#pragma once

#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {
namespace detail {

/// Texels that are not part of the surface.
struct Transparency {
    std::span<const unsigned char>
        texels{};  ///< 1 for each transparent texel; empty if there are none.
    /// Transparent texels up to this distance from the surface get a height, because a kernel reads
    /// them; texels farther away become 0.
    int reach = 0;
};

/// Replaces all non-finite heights of an image, and those of transparent texels.
///
/// \param height  one float channel
/// \param report  counts non-finite heights
/// \return empty if all heights are finite, so that the common case needs no memory; otherwise a
///         copy in which each hole is the mean of the finite heights in the smallest square around
///         it that has any, or 0 if the image has no finite height. `wrap` defines what lies beyond
///         the border: the tiled plane, or nothing.
std::vector<float> filled_holes(const Image& height, const Wraps& wrap, Report& report,
                                const Transparency& transparency = {});

}  // namespace detail
}  // namespace relief

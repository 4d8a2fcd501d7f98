// SPDX-License-Identifier: Apache-2.0
/// \file
/// Relief mapping: the methods that intersect a ray with a height map.
#pragma once

#include <array>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"

namespace RELIEF_API relief {

/// How the point of a height map is found that a ray of view hits, from least to most accurate.
///
/// Texel space: x and y are texture coordinates times the size of the map; depth s is in texels
/// below the surface of white, from 0 to the depth D of black. The ray is at p(s) = p(0) + k s.
enum class HeightMethod {
    parallax,            ///< One step, by the depth at p(0) [Kaneko 2001].
    parallax_occlusion,  ///< Layers of equal depth, then one secant step [Tatarchuk 2006].
    relief_mapping,      ///< Layers of equal depth, then bisection [Policarpo et al. 2005].
    relaxed_cones,  ///< Steps within a cone for each texel, then bisection [Policarpo and Oliveira
                    ///< 2007]; needs a cone map.
    maximum_mipmaps,  ///< Descent through a pyramid of maximum heights, then the exact bilinear
                      ///< patch [Tevs et al. 2008].
};

/// A method with its settings. Those that the method does not use are ignored.
struct HeightMarch {
    HeightMethod method = HeightMethod::maximum_mipmaps;
    int layers = 16;      ///< Of parallax occlusion and relief mapping; steps of relaxed cones.
                          ///< From 1 to 512.
    int bisections = 6;   ///< Of relief mapping and relaxed cones. From 0 to 16.
    int max_steps = 128;  ///< Of maximum mipmaps. From 1 to 1024.
};

template <>
inline constexpr auto enum_names<HeightMethod> =
    std::to_array<EnumName<HeightMethod>>({{"parallax", HeightMethod::parallax},
                                           {"parallax_occlusion", HeightMethod::parallax_occlusion},
                                           {"relief_mapping", HeightMethod::relief_mapping},
                                           {"relaxed_cones", HeightMethod::relaxed_cones},
                                           {"maximum_mipmaps", HeightMethod::maximum_mipmaps}});

}  // namespace relief

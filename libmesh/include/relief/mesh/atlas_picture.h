// SPDX-License-Identifier: Apache-2.0
/// \file
/// Draws texture coordinates: their charts, density or stretch.
/// Tests: tests/mesh/atlas/atlas_picture_test.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"

namespace RELIEF_API relief {

enum class AtlasPicture {
    charts,   ///< A color for each chart.
    density,  ///< Blue at half of the mean density or less, gray at the mean, red at double or
              ///< more.
    stretch,  ///< From gray to red: the ratio of both singular values, from 1 to 4 or more.
};

template <>
inline constexpr auto enum_names<AtlasPicture> =
    std::to_array<EnumName<AtlasPicture>>({{"charts", AtlasPicture::charts},
                                           {"density", AtlasPicture::density},
                                           {"stretch", AtlasPicture::stretch}});

/// Draws charts with dark borders on black.
///
/// \param mesh  valid (mesh.h)
/// \param corner_texcoords  three for each triangle, in corner order
/// \param chart  for each triangle; those without one are not drawn
/// \param size  of the picture, 1 to 16384 pixels each. It shows the square [0,1]; what is outside
///         of it is not drawn
/// \return sRGB, 8 bits. Where triangles overlap, the last one is seen
/// \throws InvalidInput if the mesh is not valid, a length differs, or the size is out of range
Image draw_atlas(const Mesh& mesh, std::span<const glm::vec2> corner_texcoords,
                 std::span<const std::optional<std::uint32_t>> chart, const glm::ivec2& size,
                 AtlasPicture picture = AtlasPicture::charts);

}  // namespace relief

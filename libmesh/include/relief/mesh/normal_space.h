// SPDX-License-Identifier: Apache-2.0
/// \file
/// Converts normal maps between the tangent space and the object space of a mesh.
/// Tests: tests/mesh/bake/map_convention_test.cpp.
#pragma once

#include <glm/glm.hpp>

#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/texel_coverage.h"

namespace relief {

/// The part of texture space that the map shows.
struct MapRegion {
    glm::ivec2 tile{0, 0};  ///< As in CoverageOptions.
    bool repeat = false;
};

/// A converted map.
struct ConvertedNormals {
    Image normals;  ///< Three float channels, unit.
    Coverage coverage;
};

/// Converts a tangent-space map to object space as shaders do: x t + y b + z n, normalized, where
/// n, t and w are the mesh's normal and tangent, interpolated linearly without normalization, and b
/// = w cross(n, t).
///
/// \param normals  three float channels, y up, as from decode_normal_map()
/// \param mesh  with normals, tangents and texture coordinates
/// \param report  counts the findings of cover_texels(), and texels without a valid frame (normal
///         parallel to tangent, w near 0, values that are not finite) or whose normal in the map is
///         zero or not finite: they become (0, 0, 1)
/// \return object space, x y z as in the mesh; (0, 0, 1) in texels that no triangle overlaps
///         (`coverage.empty` of them). A texel whose center is outside of all charts, but whose
///         square is not, has the frame of the nearest point (texel_coverage.h)
/// \throws InvalidInput if the image is empty or not three float channels, or if the mesh is not
///         valid or lacks normals, tangents or texture coordinates
///
/// Computed in double precision; the same for any number of threads. This is the basis that
/// [Mikkelsen 2008] specifies, so maps that were baked for it reproduce the baked surface.
ConvertedNormals object_from_tangent(const Image& normals, const Mesh& mesh,
                                     const MapRegion& placement, Report& report);

/// Converts an object-space map to tangent space: the components in the basis (t, b, n) above,
/// normalized.
///
/// \param report  counts as above, and texels whose normal lies behind the surface (unchanged),
///         which do not occur if the map belongs to the mesh
ConvertedNormals tangent_from_object(const Image& normals, const Mesh& mesh,
                                     const MapRegion& placement, Report& report);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Normal maps from tangent space to the object space of a mesh, and back.
/// Tests: tests/mesh/bake/normal_space_test.cpp.
#pragma once

#include <glm/glm.hpp>

#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/texel_coverage.h"

namespace relief {

/// Where the mesh lies on the map; its size is the map's.
struct MapPlacement {
    glm::ivec2 tile{0, 0};  ///< As in CoverageOptions.
    bool repeat = false;
};

/// A map in the other space.
struct ConvertedNormals {
    Image normals;  ///< Three float channels, unit.
    Coverage coverage;
};

/// What a shader makes of a tangent-space map: x t + y b + z n, made unit, where n, t and w are the
/// mesh's normal and tangent interpolated linearly and not made unit again, and b = w cross(n, t).
///
/// \param normals  three float channels, y up, as from decode_normal_map()
/// \param mesh     with normals, tangents and texture coordinates
/// \param report   counts what cover_texels() does, and texels where the frame is none (normal
/// along
///                 tangent, w near 0, not finite) or the map's normal is zero or not finite: these
///                 are (0, 0, 1)
/// \return object space, x y z as in the mesh; (0, 0, 1) where no triangle has a part in a texel
///         (`coverage.empty` of them). A texel whose centre is outside the mesh's charts
/// but
///         whose square is not has the frame of the nearest point (texel_coverage.h)
/// \throws InvalidInput if the image is empty or not of three float channels, the mesh is not valid
///         or lacks normals, tangents or texture coordinates
///
/// In double; the same for any number of threads. [Mikkelsen 2008] asks for exactly this basis, so
/// that maps baked by its contract come out as the surface that was baked.
ConvertedNormals object_from_tangent(const Image& normals, const Mesh& mesh,
                                     const MapPlacement& placement, Report& report);

/// The inverse: components in the basis (t, b, n) above, made unit.
///
/// \param report  counts as above, and texels whose normal lies behind the surface (kept), of which
///                there are none where the map belongs to the mesh
ConvertedNormals tangent_from_object(const Image& normals, const Mesh& mesh,
                                     const MapPlacement& placement, Report& report);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// The surroundings as a cube map, from six images, a panorama or a light probe.
///
/// World space, right-handed, y up. Looked up by a world direction, outwards: texture(cube, d).
/// Faces +x -x +y -y +z -z, each with OpenGL's orientation (environment/cube_faces.h).
///
/// In a panorama, direction d stands at u = 0.5 + atan2(d.x, -d.z) / 2 pi from the left and
/// v = acos(d.y) / pi from the top: its centre is -z, its top row +y, +x right of the centre. Light
/// probes are as in environment/angular_map.h.
/// Tests: tests/shade/gl/cube_map_test.cpp, cube_map_projection_test.cpp.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "gl/handle.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief::gl {

struct CubeMap {
    Texture texture;  ///< GL_TEXTURE_CUBE_MAP, complete, linear light at lookup.
    int size = 0;     ///< Texels along a side of a face.
    int levels = 0;   ///< All, down to 1x1.
};

/// A cube map of six images of one size, +x -x +y -y +z -z.
///
/// \return 8-bit colour faces as SRGB8 where the images are sRGB; everything else as RGBA16F
/// \param report  counts texels that are clamped to 65504, the largest half float, and those that
///                are not finite: infinity counts as 65504, minus infinity and NaN as 0
/// \throws InvalidInput naming the face if there are not six, one is not square, or they differ in
///         size or kind
/// \throws GpuError if they are larger than the context's limit, or memory runs out
CubeMap make_cube_map(const Api& api, std::span<const Image> faces, std::string_view name,
                      Report& report);

/// A cube map of a panorama by longitude and latitude.
///
/// \param size  of a face; 0 takes a quarter of the panorama's width, rounded up, which keeps its
///              resolution at the horizon
/// \return RGBA16F. Each texel is the mean of a grid of bilinear lookups, 2 x 2 or, where the faces
///         are coarser than the panorama, as many as it takes to miss no texel. There is no seam
///         where the panorama wraps.
/// \param report  as above
/// \throws InvalidInput if the panorama is empty or size is negative
/// \throws GpuError as above
///
/// Restores the framebuffer binding and the viewport; leaves no program or vertex array bound.
CubeMap make_cube_map_from_panorama(const Api& api, const Image& panorama, std::string_view name,
                                    Report& report, int size = 0);

/// A cube map of a light probe, in the same way. There is no seam at the rim: the outermost two
/// texels, which the rim may cut, give way to those within.
///
/// \param size  of a face; 0 takes half the map's width, rounded up, which keeps its resolution
///              everywhere up to a right angle from its middle
/// \throws InvalidInput also if the map is not square
CubeMap make_cube_map_from_angular_map(const Api& api, const Image& map, std::string_view name,
                                       Report& report, int size = 0);

/// One level of the six faces in linear light: three float channels.
std::vector<Image> read_faces(const Api& api, const CubeMap& cube, int level);

/// GL_TEXTURE_CUBE_MAP_POSITIVE_X and the five after it.
GLenum cube_face_target(std::size_t face);

/// How many levels it takes from this size down to 1x1.
int level_count(int size);

/// \throws GpuError if faces of this size are larger than the context's limit
void check_cube_size(const Api& api, int size, std::string_view name);

}  // namespace relief::gl

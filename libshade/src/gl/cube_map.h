// SPDX-License-Identifier: Apache-2.0
/// \file
/// The environment as a cube map, from six images, a panorama or a light probe, and its blurred
/// levels for rough reflections.
///
/// World space, right-handed, y up. Lookups take a world direction, outwards: texture(cube, d).
/// Faces +x -x +y -y +z -z have OpenGL's orientation (environment/environment_images.h).
///
/// In a panorama, direction d is at u = 0.5 + atan2(d.x, -d.z) / 2 pi from the left and v =
/// acos(d.y) / pi from the top: its center is -z, its top row +y, +x right of the center. Light
/// probes are as in environment/environment_images.h.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "gl/api.h"
#include "gl/resources.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief::shade::gl {

struct CubeMap {
    Texture texture;  ///< GL_TEXTURE_CUBE_MAP, complete, linear light at lookup.
    int size = 0;     ///< Texels along a side of a face.
    int levels = 0;   ///< All levels, down to 1x1.
    /// The format of float radiance: half, unless a sample is beyond half floats.
    FloatStorage storage = FloatStorage::half;
};

/// Returns a cube map of six images of one size, +x -x +y -y +z -z.
///
/// \return 8-bit color faces as SRGB8 where the images are sRGB; everything else as RGBA16F, or as
///         RGBA32F if a sample is beyond half floats, so that a sun keeps its energy
/// \param report  counts texels that are clamped or not finite, as storable_radiance() does
/// \throws InvalidInput naming the face if there are not six, one is not square, or they differ in
///         size or kind
/// \throws GpuError if they are larger than the context's limit, or memory runs out
CubeMap make_cube_map(const Api& api, std::span<const Image> faces, std::string_view name,
                      Report& report);

/// Returns a cube map of a panorama by longitude and latitude.
///
/// \param size  of a face; 0 means a quarter of the panorama's width, rounded up, which keeps its
///              resolution at the horizon
/// \return RGBA16F or RGBA32F, as above. Each texel is the mean of a grid of bilinear lookups, 2 x
/// 2 or, if the faces
///         are coarser than the panorama, enough to use every texel. There is no seam where the
///         panorama wraps.
/// \param report  as above
/// \throws InvalidInput if the panorama is empty or size is negative
/// \throws GpuError as above
///
/// Restores the framebuffer binding and the viewport; leaves no program or vertex array bound.
CubeMap make_cube_map_from_panorama(const Api& api, const Image& panorama, std::string_view name,
                                    Report& report, int size = 0);

/// Returns a cube map of a light probe, in the same way. There is no seam at the rim: the outermost
/// two texels, which the rim may cut, are replaced by their inner neighbors.
///
/// \param size  of a face; 0 means half the map's width, rounded up, which keeps its resolution
///              everywhere up to a right angle from its center
/// \throws InvalidInput also if the map is not square
CubeMap make_cube_map_from_angular_map(const Api& api, const Image& map, std::string_view name,
                                       Report& report, int size = 0);

/// Returns one level of the six faces in linear light: three float channels.
std::vector<Image> read_faces(const Api& api, const CubeMap& cube, int level);

/// Returns GL_TEXTURE_CUBE_MAP_POSITIVE_X or one of the five after it.
GLenum cube_face_target(std::size_t face);

/// Returns the number of levels from this size down to 1x1.
int level_count(int size);

/// \throws GpuError if faces of this size are larger than the context's limit
void check_cube_size(const Api& api, int size, std::string_view name);

/// Returns a cube map for rough reflections: level i of n is blurred by GGX of roughness i / (n -
/// 1), alpha = roughness^2, as seen at normal incidence (environment/convolution.h).
///
/// \param environment  with all of its levels
/// \return in the storage of the environment, 256 texels along a face and 6 levels, or 128 and 5 if
///         the environment is smaller than 256; the last level has 8. Level 0 is the sharp
///         reflection. The lookup is textureLod(cube, mirrored direction, roughness * (levels -
///         1)), seamless.
/// \throws GpuError
///
/// The cost is 0.1 s on two processor cores, which compute all levels but the first. Restores the
/// framebuffer binding and the viewport; leaves no program or vertex array bound.
CubeMap make_prefiltered(const Api& api, const CubeMap& environment);

}  // namespace relief::shade::gl

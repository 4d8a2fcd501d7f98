// SPDX-License-Identifier: Apache-2.0
/// \file
/// The images of an environment: six faces of a cube, crosses, and light probes as angular maps;
/// and radiance that can be stored.
///
/// Faces are +x -x +y -y +z -z. A face point (s, t) is from -1 to 1 along the image's rows and down
/// its columns; its direction in world space is, as in OpenGL 3.3 core, table 3.10,
///
///     +x (1, -t, -s)   -x (-1, -t, s)   +y (s, 1, t)   -y (s, -1, -t)   +z (s, -t, 1)
///     -z (-s, -t, -1)
///
/// An angular map shows the whole sphere in a disk, by the angle from its center. With u to the
/// right and v upwards in the image, both from -1 to 1, the direction (x, y, z) in world space is
/// at (u, v) = r (x, y) / |(x, y)| with r = acos(-z) / pi: the center is -z, and the whole rim is
/// +z. Nothing is defined outside the rim. Source: [Debevec 1998], whose probes have this form.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {
namespace shade::detail {

// Cube faces

inline constexpr std::array<const char*, 6> cube_face_names{"+x", "-x", "+y", "-y", "+z", "-z"};

/// For each face a matrix whose columns are the world directions along s, along t and outwards.
const std::array<glm::mat3, 6>& world_from_face();

/// Returns the world direction of a face point; not unit.
glm::dvec3 face_direction(std::size_t face, double s, double t);

/// A point of a face.
struct FacePoint {
    std::size_t face = 0;
    double s = 0;
    double t = 0;
};

/// Returns the face point in a direction of any length; on an edge, that of the face whose axis
/// comes first.
FacePoint face_point(const glm::dvec3& direction);

/// Returns the solid angle of the part of a face between two points, in steradians; a face has 4 pi
/// / 6.
double solid_angle(const glm::dvec2& from, const glm::dvec2& to);

/// \throws InvalidInput naming the face if there are not six, one is empty or not square, or they
///         differ in size, channels, bits or color space
void check_faces(std::span<const Image> faces, std::string_view name);

/// Returns the six faces of a cross, copied as they are:
///
///     horizontal (4:3)         vertical (3:4)
///          +y                       +y
///     -x   +z   +x   -z        -x   +z   +x
///          -y                       -y
///                                   -z, rotated by 180 degrees
///
/// Both are unfoldings of the cube, so that neighboring faces fit together.
///
/// \throws InvalidInput if the image has neither shape
std::vector<Image> faces_of_cross(const Image& cross, std::string_view name);

/// Converts a set between a left-handed and a right-handed world by reversing x: each face is
/// mirrored, and +x and -x are exchanged. Applied twice, it gives the original set.
std::vector<Image> other_handed(std::span<const Image> faces);

// Angular maps

/// The number of texels left out at the rim: the rim cuts texels, and a bilinear lookup reaches the
/// diagonal neighbor.
inline constexpr double angular_map_rim = 1.5 * 1.41421356237309505;

/// Returns the largest r, at least 0, that is looked up in a map of this width. Directions farther
/// out get its value.
double angular_map_reach(int width);

/// Returns the texture coordinates of a direction of any length; (0, 0) is the upper left corner.
glm::dvec2 angular_map_place(const glm::dvec3& direction, int width);

/// \throws InvalidInput if the image is empty or not square
void check_angular_map(const Image& image, std::string_view name);

// Radiance

inline constexpr float max_half = 65504.0F;

/// Returns the image as linear float, with every sample finite and within max_light, so that sums
/// of them are finite, too. An alpha channel is treated alike, since nothing looks it up.
///
/// \param report  counts texels that are clamped to max_light, and those that are not finite:
///                infinity counts as 65504, the largest half float, since images of half floats
///                overflow to it; minus infinity and NaN count as 0
Image storable_radiance(const Image& image, Report& report);

/// Returns true if half floats can hold every sample, rounded.
bool fits_half_floats(const Image& radiance);

}  // namespace shade::detail
}  // namespace relief

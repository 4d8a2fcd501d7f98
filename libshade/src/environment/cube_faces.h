// SPDX-License-Identifier: Apache-2.0
/// \file
/// Six images around a point: which way each looks, how much of the sphere a texel covers, and sets
/// that come in other shapes.
///
/// Faces are +x -x +y -y +z -z. A face point (s, t) is from -1 to 1 along the image's rows and down
/// its columns; its direction in world space is, as in OpenGL 3.3 core, table 3.10,
///
///     +x (1, -t, -s)   -x (-1, -t, s)   +y (s, 1, t)   -y (s, -1, -t)   +z (s, -t, 1)
///     -z (-s, -t, -1)
///
/// Tests: tests/shade/environment/cube_faces_test.cpp.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "relief/mesh/image.h"

namespace relief {

inline constexpr std::array<const char*, 6> cube_face_names{"+x", "-x", "+y", "-y", "+z", "-z"};

/// For each face, the world directions along s, along t and outwards as columns.
const std::array<glm::mat3, 6>& world_from_face();

/// The world direction of a face point; not unit.
glm::dvec3 face_direction(std::size_t face, double s, double t);

/// A point of a face.
struct FacePoint {
    std::size_t face = 0;
    double s = 0;
    double t = 0;
};

/// Where a direction of any length meets the faces; on an edge, the face whose axis comes first.
FacePoint face_point(const glm::dvec3& direction);

/// What part of a face between two points covers of the sphere, in steradians; a face has 4 pi / 6.
double solid_angle(const glm::dvec2& from, const glm::dvec2& to);

/// \throws InvalidInput naming the face if there are not six, one is empty or not square, or they
///         differ in size, channels, bits or colour space
void check_faces(std::span<const Image> faces, std::string_view name);

/// The six faces of a cross, copied as they are:
///
///     horizontal (4:3)         vertical (3:4)
///          +y                       +y
///     -x   +z   +x   -z        -x   +z   +x
///          -y                       -y
///                                   -z, turned by 180 degrees
///
/// Both are what comes of cutting the cube open along its edges, so that neighbours fit together.
///
/// \throws InvalidInput if the image has neither shape
std::vector<Image> faces_of_cross(const Image& cross, std::string_view name);

/// A set that was drawn for a world with the other hand: x is turned round. Each face is mirrored,
/// and +x and -x change places; twice gives the set back.
std::vector<Image> other_handed(std::span<const Image> faces);

}  // namespace relief

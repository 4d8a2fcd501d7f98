// SPDX-License-Identifier: Apache-2.0
/// \file
/// Displacement: makes the surface that a height map describes, as triangles. Part of the library
/// relief::topology.
/// Tests: tests/mesh/topology/displace_test.cpp.
#pragma once

#include <cstddef>

#include "relief/export.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// Options of displaced().
struct DisplaceOptions {
    /// The length by which the value 1.0 (white) moves the surface along its normal, object space.
    /// Negative lengths move it inwards.
    double height = 0.0;
    /// The value that does not move the surface: 0 for heights above it, 0.5 for both directions.
    double zero = 0.0;
    Wraps wrap = Wrap::repeat;  ///< Of texture coordinates outside of [0,1]; clamp continues the
                                ///< border texel.
    /// Triangles are divided while the displaced surface is farther than this from them at a
    /// sample, object space. Above 0.
    double max_error = 0.0;
    /// Dividing ends before there are more triangles. At least 1.
    std::size_t max_triangles = 20'000'000;
};

/// A displaced mesh, and its distances from the surface that the heights describe, object space.
struct DisplacedMesh {
    Mesh mesh;
    double max_error = 0.0;  ///< The largest distance at a sample.
    double rms_error = 0.0;  ///< Over the samples.
    /// Triangles that are farther than the limit at a sample: those of half a texel, and
    /// those that `max_triangles` left.
    std::size_t above_limit = 0;
    bool is_complete = true;  ///< False if `max_triangles` ended the division.
};

/// Displaces a mesh by a height map.
///
/// \param mesh  with texture coordinates. Its normals give the direction; vertices without a usable
///         one get that of NormalWeight::angle
/// \param heights  one channel of 8, 16 or 32 bits, as from height_map(). Heights that are not
///         finite are filled as in normals_from_height(), and counted
/// \param report  counts collapsed triangles, which are left out; triangles with a corner or
///         texture coordinate that is not finite, which stay as they are; non-manifold edges, whose
///         surfaces are displaced one by one; and triangles of which the displacement turns parts
///         over
/// \return triangles in the order of those that they divide, with material ranges and smoothing
///         groups. Texture coordinates and colors are linear on each triangle of the mesh. Normals
///         are those of the heights: n - height (h_u grad u + h_v grad v), where the gradients of
///         the texture coordinates are means at the vertices of the mesh and linear between. There
///         are no tangents. A mesh without triangles gives an empty one
/// \throws InvalidInput if the mesh is not valid or has no texture coordinates, the image is empty
///         or has more than one channel, or an option is out of range
///
/// The described surface is p + height (h(u,v) - zero) n, where p, n and (u,v) are linear on each
/// triangle of the mesh, n has unit length, and h is bilinear between the centers of texels.
/// Triangles with an edge of more than half a texel are divided at the middle of their longest
/// edge, and so are their neighbors there, which leaves no gap [Rivara 1984]. Vertices with equal
/// positions on both sides of a texture seam or a hard edge move together, by the mean height along
/// the mean normal, so that the surface stays closed. Samples are the centers of texels and
/// the middles of edges.
///
/// The same input gives the same bits for any order of triangles and number of threads. Memory: 250
/// bytes per triangle of the result.
DisplacedMesh displaced(const Mesh& mesh, const Image& heights, const DisplaceOptions& options,
                        Report& report = IgnoredReport());

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Changes the number of triangles of a mesh: decimation and subdivision; and measures the distance
/// between surfaces. Part of the library relief::topology.
/// Tests: tests/mesh/topology/decimate_test.cpp, decimate_hard_cases_test.cpp,
/// surface_distance_test.cpp, subdivide_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// Weights of differences of attributes relative to distances; at least 0. The error of a collapse
/// is the root of the sum of the squared weighted differences.
struct AttributeWeights {
    double texcoord = 1.0;  ///< In lengths on the surface that the texture moves by.
    /// The distance, relative to the size of the mesh, for which a difference of 1 between normals
    /// counts. Only kept normals count. Where only distances matter, 0 is best.
    double normal = 0.02;
    double color = 0.01;  ///< The same for a difference of 1 between colors.
    double joint = 0.01;  ///< The same for a difference of 1 between weights of joints.
    double target = 1.0;  ///< Of displacements by morph targets, which are lengths.
};

/// The property of the input that a result keeps, which selects the next collapse: the smallest
/// error to the power of 1.5 times area, so that pictures of all surfaces differ little; or the
/// smallest squared error times area, so that distances from the input are small in the mean. For
/// the largest distance, collapses that move the surface far in a small place wait, unless
/// `max_error` limits them.
enum class DecimateGoal { picture, distance, largest_distance };

template <>
inline constexpr auto enum_names<DecimateGoal> =
    std::array{EnumName<DecimateGoal>{"picture", DecimateGoal::picture},
               EnumName<DecimateGoal>{"distance", DecimateGoal::distance},
               EnumName<DecimateGoal>{"largest-distance", DecimateGoal::largest_distance}};

/// The limits of a decimation; at least one must be given, and the first one that is reached ends
/// it.
struct DecimateOptions {
    std::optional<std::size_t> triangles;  ///< Target number of triangles, at least 1.
    /// The maximum distance between the surfaces in both directions, in object space, at least 0.
    /// It is measured (surface_distance()), and it holds up to the rounding of positions.
    std::optional<double> max_error;
    /// The frames of the result. With NormalMode::keep, the remaining vertices keep their normals,
    /// and hard edges are preserved like seams. Other modes ignore the normals of the input. If the
    /// input has tangents, they are recomputed unless the mode is none.
    FrameOptions frames;
    AttributeWeights weights = {};
    DecimateGoal goal = DecimateGoal::picture;
    /// The maximum angle, in radians, above 0, between a triangle that changes and the input at
    /// each of its vertices: one of the input's triangles at the vertex must be within it.
    std::optional<double> max_normal_error = std::nullopt;
    bool keep_borders = false;  ///< Boundaries do not change.
    bool keep_seams = false;    ///< Texture seams, hard edges and material borders do not change.
    /// Moves the vertices that remain to where the result fits the input best, which about halves
    /// the distance on curved surfaces. Boundaries, and vertices that could not be removed, stay.
    /// With `triangles`, vertices move at up to four larger numbers of triangles, too, and errors
    /// are those from the surface there, plus what it had.
    bool fit_positions = false;
    /// Connected parts whose bounding box has a diagonal shorter than this length are removed
    /// first, and their triangles are counted as a finding; the largest part of each material of a
    /// mesh stays. Default: none is removed.
    double drop_parts = 0.0;
};

/// Removes vertices by edge collapses in order of increasing error until a limit is reached.
///
/// \param mesh  valid (mesh.h); vertices at equal positions count as one
/// \param report  counts omitted elements (collapsed and repeated triangles, isolated vertices),
///         double-sided triangles, non-manifold edges, triangles with a non-finite corner, which
///         are not simplified, and a target number of triangles that could not be reached
/// \param deformation  how the vertices move, by vertex; where it differs between vertices at one
///         position, there is a seam
/// \return a subset of the vertices with all attributes, in their order; with `fit_positions`, at
///         other positions; and the remaining triangles in the original order, with their material
///         ranges and smoothing groups. `source_vertex` holds the input's index of each vertex. If
///         `frames` does not keep normals, vertices may be split in addition
/// \throws InvalidInput if the mesh is not valid, no limit is given or one is out of range, or as
///         with_frames() does
///
/// Boundaries, texture seams, and borders between colors and materials are feature lines: they are
/// simplified along themselves and never torn or crossed, and their junctions are kept. Closed
/// meshes stay closed, no triangle is inverted in the texture or in space (at each corner of a
/// triangle that changes, one of the input's triangles is within 90 degrees), and separate
/// components neither merge nor vanish, and keep their shapes: no vertex moves away from its
/// component by more than a fifth of its size, and no error exceeds 3 % of it. Triangles at the
/// same positions, such as the two sides of a wall, are reduced as one, and each keeps its
/// attributes. Sheets that meet at non-manifold edges change there together or not at all. The
/// target number of triangles is met to within one collapse unless that would violate these rules.
/// The same input gives the same bits for any order of triangles and vertices and any first corner
/// of triangles, except that computed tangents depend on the latter (tangents.h). Collapsed
/// triangles have no influence. The time is linear for all shapes, except for sorting.
///
/// Source: [Garland and Heckbert 1997], [Hoppe 1999], [Lindstrom and Turk 1998].
FramedMesh decimated(const Mesh& mesh, const DecimateOptions& options,
                     Report& report = IgnoredReport(), const Deformation& deformation = {});

/// A mesh of a scene. The referenced objects must outlive it.
struct SceneMesh {
    const Mesh& mesh;
    const Deformation& deformation;
    double scale = 1.0;  ///< The length of a unit of the mesh in the scene; finite, above 0.
};

/// Decimates the meshes of a scene in one order of increasing error, so that triangles are left
/// where they are needed most. Lengths, such as `max_error`, are those of the scene, and
/// `triangles` is the number for all meshes.
///
/// \param reports       by mesh, what the overload for one mesh counts
/// \param scene_report  a target number of triangles that could not be reached
/// \return by mesh, as from the overload for one mesh, whose result is the same bits for a scene of
///         one mesh
/// \throws InvalidInput as the overload for one mesh, or if there are not as many reports as meshes
std::vector<FramedMesh> decimated(std::span<const SceneMesh> meshes, const DecimateOptions& options,
                                  std::span<Report> reports, Report& scene_report);

/// Measures what DecimateOptions::max_normal_error limits.
///
/// \param original  valid (mesh.h)
/// \param result  that of decimated() for it
/// \return the maximum, over the corners of `result`, of the angle between the triangle and the
///         nearest normal of the original's triangles at that position, in radians; 0 if there is
///         none. Triangles without area, non-finite ones and positions where more than 64 triangles
///         of the original meet are ignored
double max_corner_angle(const Mesh& original, const FramedMesh& result);

/// The distances of the points of a surface from another one, and the angles between the normals
/// of the triangles there.
struct DistanceStats {
    double mean = 0.0;          ///< Over area, of samples; in the unit of the meshes.
    double rms = 0.0;           ///< Over area, of samples.
    double p95 = 0.0;           ///< 95 % of the samples do not exceed it.
    double max = 0.0;           ///< At the examined points.
    double mean_degrees = 0.0;  ///< Over area, of samples.
    double max_degrees = 0.0;   ///< Of samples.
    double area = 0.0;
    std::size_t samples = 0;
    /// The vertices and triangles that were not examined for the maximum, because that would take
    /// too long: more than 0 only for many long triangles that cross each other.
    std::size_t omitted = 0;
};

struct SurfaceDistance {
    DistanceStats from_a;  ///< The distances of the points of a from b.
    DistanceStats from_b;
};

/// Measures the distance between two surfaces.
///
/// \param a, b  valid (mesh.h). Triangles with a non-finite corner are ignored
/// \return zeros if one of the surfaces has no triangle. Samples are evenly spread over the area,
///         and their number is that of the triangles, from 20,000 to 50,000. For the maximum, the
///         distances of all vertices are computed, and triangles are divided up to 6 times (fewer
///         if there are many) where a distance between their corners may be larger. The work has a
///         limit: beyond it, fewer points are examined, which `omitted` counts
SurfaceDistance surface_distance(const Mesh& a, const Mesh& b);

/// Measures the distance between two surfaces at random points only, which is faster than
/// surface_distance(). max_farther_part() states how much of the area may be farther.
///
/// \param a, b  valid (mesh.h). Triangles with a non-finite corner are ignored
/// \param samples_a, samples_b  the number of samples on each surface: one in each of as many equal
///         parts of the area. If many long triangles cross each other, fewer are examined
/// \param seed  of the random numbers; the same seed gives the same result. The parts of a surface
///         that is measured in parts need different ones
/// \return zeros if one of the surfaces has no triangle. A surface without area has no samples
SurfaceDistance sampled_distance(const Mesh& a, const Mesh& b, std::size_t samples_a,
                                 std::size_t samples_b, std::uint32_t seed = 0);

/// Returns the largest distance of a vertex from the other surface, or `least` if all vertices are
/// within it. It is many times faster than surface_distance(), which also measures inside
/// triangles: a point there can be farther, for example where a triangle spans a hole of the other
/// surface.
///
/// \param a, b  valid (mesh.h). Triangles with a non-finite corner are ignored
/// \param least  at least 0; the result if one of the surfaces has no triangle
/// \throws InvalidInput if `least` is negative or not a number
double largest_vertex_distance(const Mesh& a, const Mesh& b, double least);

/// Returns the largest part p of the area that is farther than the maximum of random samples, with
/// a confidence: 1 - p = (1 - confidence)^(1 / samples), because all samples are outside of a part
/// p with a probability of at most (1 - p)^samples.
///
/// \param samples  independent and uniformly distributed, or one in each of as many equal parts of
///         the area; 0: the result is 1
/// \param confidence  between 0 and 1, for example 0.95
/// \throws InvalidInput if the confidence is out of range
double max_farther_part(std::size_t samples, double confidence);

/// Applies Loop subdivision: each level splits every triangle into four and smooths all positions.
///
/// \param mesh  valid (mesh.h); vertices at equal positions count as one
/// \param levels  at least 1; each multiplies the number of triangles by four, which must stay
///         below 2^32 / 3
/// \param frames  of the result. The normals of the input are ignored, because the surface is
///         smooth everywhere: NormalMode::keep means angle if the input has normals, and none
///         otherwise. If the input has tangents, they are recomputed unless the mode is none
/// \param report  counts collapsed triangles, which are omitted; triangles with a non-finite
///         corner, which do not change; and non-manifold edges
/// \return the input's vertices in their order, then the new vertices at edge midpoints. Triangles
///         keep the order of their source triangles, with material ranges and smoothing groups
/// \throws InvalidInput if the mesh is not valid, or `levels` is out of range
///
/// Texture coordinates and colors of a new vertex are the mean of those at the ends of its edge,
/// separately for each side of a seam. So each triangle keeps its texture mapping, and seams
/// neither tear nor blur, while positions are smooth across them. Boundaries become cubic splines
/// of their own vertices. Surfaces that meet at a non-manifold edge or vertex are smoothed
/// separately and joined at the mean of their results. The same input gives the same bits.
///
/// Source: [Loop 1987].
Mesh subdivided(const Mesh& mesh, int levels, const FrameOptions& frames,
                Report& report = IgnoredReport());

}  // namespace relief

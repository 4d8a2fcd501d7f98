// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes tangent frames from texture coordinates by MikkTSpace and two other weightings, and
/// identifies the method with which stored tangents were computed.
/// Tests: tests/mesh/geometry/tangents_test.cpp, tests/mesh/geometry/tangent_basis_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/buffers.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace RELIEF_API relief {

/// The source of tangents.
enum class TangentMethod {
    keep,           ///< The mesh's tangents, or none; recomputed (mikktspace) if normals change.
    none,           ///< Tangents are removed.
    mikktspace,     ///< mikktspace_tangents()
    area_weighted,  ///< area_weighted_tangents()
    lengyel,        ///< lengyel_tangents()
    /// The gradient of each triangle, without averaging: faceted. identify_tangents() recognizes
    /// it; with_frames() does not compute it.
    triangle,
};

template <>
inline constexpr auto enum_names<TangentMethod> =
    std::to_array<EnumName<TangentMethod>>({{"keep", TangentMethod::keep},
                                            {"none", TangentMethod::none},
                                            {"mikktspace", TangentMethod::mikktspace},
                                            {"area-weighted", TangentMethod::area_weighted},
                                            {"lengyel", TangentMethod::lengyel},
                                            {"triangle", TangentMethod::triangle}});

/// Returns true if this method computes tangents, which requires texture coordinates.
constexpr bool computes_tangents(TangentMethod method) {
    return method != TangentMethod::keep && method != TangentMethod::none;
}

/// Computes a tangent frame for every triangle corner, as MikkTSpace defines it.
///
/// \param positions  object space, any unit of length
/// \param normals  object space, one per position; any length
/// \param texcoords  one per position, upper left origin, v down (see mesh.h)
/// \param triangles  vertex indices, counter-clockwise seen from outside
/// \param report  counts every fallback below
/// \return three per triangle, in corner order: xyz is unit and perpendicular to the corner's
///         normal, w is exactly +1 or -1 and equal for all corners of a triangle; bitangent = w *
///         cross(normal, xyz). If the texture has no gradient (equal or collinear coordinates, a
///         triangle without area), the frame is that of adjacent triangles. If two corners of a
///         triangle coincide, or a value is not finite, it is that of another triangle at the
///         vertex. Without one, the tangent is the x axis (the y axis if the normal is near x),
///         projected into the plane of the normal, with w = -1, as in the reference implementation.
///         With a normal without direction (zero, not finite), the tangent depends on the texture
///         alone. If u runs along the normal, the corner gets the frame of other corners at its
///         vertex. If averaged tangents cancel, each corner keeps the tangent of its own triangle
/// \throws InvalidInput if array lengths differ or a triangle names a vertex that does not exist
///
/// The same input gives the same bits for any order of triangles and vertices, number of threads,
/// compiler and instruction set. Vertices with equal position, normal and texture coordinate count
/// as one, and identical triangles count once.
///
/// Rotated corners of a triangle can change tangents, because gradients are computed in float from
/// the first corner, as in the reference implementation. If all triangles at a position are certain
/// in the sense of identify_tangents(), and seen from the front along the normal, the tangents
/// there turn by less than 0.001 degrees. On thinner triangles the first corner can decide whether
/// there is a gradient; see docs/tangents.md.
///
/// The time is nearly linear for every shape; the memory is at most
/// half that of input and result.
///
/// The corners of one vertex may differ (mirrored texture, hard texture seams): use frames.h to
/// convert corners to vertices. Do not use the result with the original index list.
///
/// On valid meshes the result equals that of the reference implementation at every corner where the
/// latter does not depend on the order of triangles. It differs where the guarantees above require
/// it: different w within a degenerate triangle, and tangents parallel to their normals. It also
/// differs where the reference implementation depends on the order of triangles, and a fixed rule
/// is used instead (tangent_signs.cpp): at edges of three or more triangles, and around the last
/// bucket that its sorting of edges omits.
///
/// Source: [Mikkelsen 2008]; deviations from the reference implementation are marked in the code.
std::vector<glm::vec4> mikktspace_tangents(StridedSpan<const glm::vec3> positions,
                                           StridedSpan<const glm::vec3> normals,
                                           StridedSpan<const glm::vec2> texcoords,
                                           TriangleSpan triangles,
                                           Report& report = IgnoredReport());

/// Writes the tangents of mikktspace_tangents() into the caller's memory.
///
/// \param tangents  three per triangle, in corner order; must not overlap the inputs
/// \param execution  threads, progress and cancellation; the tangents do not depend on it
/// \throws InvalidInput as mikktspace_tangents(), and if there are not three tangents per triangle;
///         Cancelled, and then the tangents are undefined
void corner_tangents(StridedSpan<const glm::vec3> positions, StridedSpan<const glm::vec3> normals,
                     StridedSpan<const glm::vec2> texcoords, TriangleSpan triangles,
                     std::span<glm::vec4> tangents, Report& report = IgnoredReport(),
                     const ExecutionOptions& execution = {});

/// Writes one tangent per vertex into the caller's memory, for meshes whose vertices are already
/// split where the texture is mirrored or has a seam.
///
/// \param tangents  one per position; must not overlap the inputs. If the corners at a vertex
///         differ, it is the most frequent one (ties: the first by value), and the vertex is
///         reported: split such vertices by frames.h instead. Vertices without a triangle get a
///         tangent perpendicular to their normal with w = -1
/// \param execution  threads, progress and cancellation; the tangents do not depend on it
/// \throws InvalidInput as mikktspace_tangents(), and if there are not as many tangents as
///         positions; Cancelled
void vertex_tangents(StridedSpan<const glm::vec3> positions, StridedSpan<const glm::vec3> normals,
                     StridedSpan<const glm::vec2> texcoords, TriangleSpan triangles,
                     StridedSpan<glm::vec4> tangents, Report& report = IgnoredReport(),
                     const ExecutionOptions& execution = {});

/// Computes the same frames with weights by the area of a triangle instead of its angle at the
/// corner: thin bevels, whose corners have angles like any other, then do not affect large adjacent
/// faces.
///
/// This is not MikkTSpace: a map that was baked for one of the two shows seams with the other.
std::vector<glm::vec4> area_weighted_tangents(StridedSpan<const glm::vec3> positions,
                                              StridedSpan<const glm::vec3> normals,
                                              StridedSpan<const glm::vec2> texcoords,
                                              TriangleSpan triangles,
                                              Report& report = IgnoredReport());

/// Computes the same, but averages all triangles of the same handedness at a vertex, adjacent or
/// not, weighted by the stretch of the texture along u: the sum of the gradients of position along
/// u, made perpendicular to the normal and normalized. The original method has one tangent for a
/// vertex with triangles of both handednesses; this one has one for each.
///
/// Source: [Lengyel 2001].
std::vector<glm::vec4> lengyel_tangents(StridedSpan<const glm::vec3> positions,
                                        StridedSpan<const glm::vec3> normals,
                                        StridedSpan<const glm::vec2> texcoords,
                                        TriangleSpan triangles, Report& report = IgnoredReport());

// A normal map is correct only with the tangents that its baker assumed, but files do not name the
// method. Therefore the tangents are computed by all known methods and compared with the stored
// ones.

/// The methods that can be identified, in the order of their agreements.
inline constexpr std::array identifiable_tangent_methods = {
    TangentMethod::mikktspace, TangentMethod::area_weighted, TangentMethod::lengyel,
    TangentMethod::triangle};

/// The agreement of stored tangents with one method, over all corners that can be compared.
///
/// The directions within the plane of the normal are compared; diagnose() reports tangents outside
/// of this plane. Stored frames may be rotated by multiples of 90 degrees, if a program uses
/// another axis as the tangent or flipped texture coordinates.
struct TangentAgreement {
    TangentMethod method = TangentMethod::mikktspace;
    /// Number of corners within the tolerance of the method's tangent, its bitangent (rotated by 90
    /// degrees), and the opposites of both.
    std::array<std::size_t, 4> within{};
    int quarter_turns = 0;  ///< The rotation with the most corners, in units of 90 degrees.
    ErrorStats angles;      ///< The angles to that direction.
    /// Number of the corners within the tolerance of that direction whose w is opposite to the
    /// method's.
    std::size_t negated = 0;
    /// The mean angle in degrees; angles above the tolerance count as the tolerance.
    double mean_clamped = 0.0;

    [[nodiscard]] std::size_t agreeing() const {
        return within[static_cast<std::size_t>(quarter_turns)];
    }
    /// The agreeing corners as a fraction of all, 0 to 1.
    [[nodiscard]] double fraction() const;
};

struct IdentifiedTangents {
    /// The identified method; absent if no known method agrees.
    std::optional<TangentMethod> method;
    /// Other methods with the same result on this mesh, such as all methods on a plane.
    std::vector<TangentMethod> equivalent_methods;
    /// The agreement with each of identifiable_tangent_methods; empty if nothing can be
    /// compared, because there are no tangents, normals or texture coordinates.
    std::vector<TangentAgreement> agreements;
    std::size_t corners = 0;  ///< Number of compared corners.
    /// Number of corners of triangles that are too degenerate for a reliable direction.
    std::size_t left_out = 0;
    std::size_t undefined = 0;  ///< Number of corners whose stored tangent has no direction.
    double tolerance = 0.0;     ///< In degrees.
    /// 8 or 16 if all values are multiples of what this number of bits can store; 0 for floats.
    int stored_bits = 0;

    /// The agreement with `method`, or with the method of the smallest mean if no method was
    /// identified; null if there is none.
    [[nodiscard]] const TangentAgreement* best() const;
    /// Returns true if the means of all other methods are at least 1.5 times as large. If no method
    /// was identified, the tangents then probably come from this method and different input
    /// (unrounded positions, other normals) or were stored with low precision.
    [[nodiscard]] bool is_clearly_best() const;
};

/// Compares the tangents of a mesh with every known method.
///
/// \param mesh  with the texture coordinates that belong to the tangents
/// \return a method is identified if 95% of the corners agree with it within the tolerance: 0.1
///         degrees, which covers float arithmetic in another order, or half a degree for 8-bit
///         storage. Of several methods it is the one with the smallest mean; methods that are
///         equally good are listed too
/// \throws InvalidInput if the mesh is not valid
///
/// Corners are omitted if their triangle is so small, in space or in the image, that rounding of
/// its corners changes the gradient: its height is less than 1000 times the spacing of floats at
/// its position, or less than 1e-6 of its longest side.
IdentifiedTangents identify_tangents(const Mesh& mesh);

/// Describes a rotation by multiples of 90 degrees and a sign: "", "w negated", ...
std::string_view variant_text(int quarter_turns, bool is_negated);

}  // namespace relief

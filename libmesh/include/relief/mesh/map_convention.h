// SPDX-License-Identifier: Apache-2.0
/// \file
/// Converts normal maps between the tangent space and the object space of a mesh, and finds the
/// convention with which a map matches known normals. Part of the library relief::bake.
/// Tests: tests/mesh/bake/map_convention_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/report.h"
#include "relief/mesh/tangents.h"
#include "relief/mesh/texel_coverage.h"

namespace RELIEF_API relief {

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
                                     const MapRegion& placement, Report& report = IgnoredReport());

/// Converts an object-space map to tangent space: the components in the basis (t, b, n) above,
/// normalized.
///
/// \param report  counts as above, and texels whose normal lies behind the surface (unchanged),
///         which do not occur if the map belongs to the mesh
ConvertedNormals tangent_from_object(const Image& normals, const Mesh& mesh,
                                     const MapRegion& placement, Report& report = IgnoredReport());

/// The interpolation of tangent frames from vertices to fragments.
enum class FrameInterpolation {
    /// Interpolated without normalization, with the bitangent computed from them, as in MikkTSpace
    /// and relief.
    interpolated,
    unit,              ///< Normal and tangent are normalized first.
    orthonormal,       ///< In addition, the tangent is made perpendicular to the normal.
    vertex_bitangent,  ///< The bitangent is interpolated too, and all three are normalized.
};

/// The orientation of the image.
enum class ImageOrientation { upright, upside_down, mirrored, half_turn };

/// An interpretation of a map.
struct MapConvention {
    StoredCurve curve = StoredCurve::none;
    FlatCode flat = FlatCode::middle;
    ImageOrientation turn = ImageOrientation::upright;
    /// The source of x, y and z among the components of the stored vectors, with y up.
    AxisMapping axes = same_axes;
    VectorSpace space = VectorSpace::tangent;
    /// The method of the tangents. If absent, the tangents of the renderer: those of the low mesh,
    /// or MikkTSpace's without any.
    std::optional<TangentMethod> basis{};
    FrameInterpolation frame = FrameInterpolation::interpolated;
    bool ignores_mirroring = false;  ///< The handedness w counts as +1 everywhere.

    bool operator==(const MapConvention&) const = default;
};

/// A texel whose exact normal is known.
struct KnownTexel {
    int x = 0;
    int y = 0;
    std::uint32_t triangle = 0;
    glm::dvec3 weights{0.0};    ///< Barycentric weights of the triangle's corners.
    glm::dvec3 reference{0.0};  ///< The exact normal in the space of the meshes, unit.
    double expected = 0.0;      ///< The expected error of a correct map in degrees.
};

/// A part of a convention that can differ from the given one.
enum class ConventionPart { curve, flat, turn, axes, space, basis, frame, mirroring };

struct ConventionFit {
    /// True if the error of the map was so large that other conventions were tried.
    bool was_searched = false;
    /// True if a convention explains the error: it reduces it to less than half, and by more than
    /// 0.02 degrees.
    bool is_explained = false;
    MapConvention convention;  ///< The convention with the smallest error.
    /// RMS error with the given convention; this and the next two without the largest 2% of the
    /// errors.
    double given_degrees = 0.0;
    double best_degrees = 0.0;      ///< RMS error with `convention`.
    double expected_degrees = 0.0;  ///< Expected RMS error of a correct map.
    std::size_t tried = 0;          ///< Number of conventions that were tried.
    /// The parts in which `convention` differs from the given one.
    std::vector<ConventionPart> changes;
};

/// The known facts of a search. The meshes must live until find_convention() returns.
struct ConventionSearch {
    const Mesh* low = nullptr;    ///< With the tangent frames of the renderer.
    const Mesh* given = nullptr;  ///< The low mesh as it was read, with its own tangents, if any.
    MapConvention stated;
    Green green = Green::up;  ///< Of the map, as given.
    /// The transform from the meshes' space to the low mesh's object space.
    glm::dmat3 object_from_mesh{1.0};
};

/// Finds the convention that explains a map.
///
/// \param map  three or four channels, the whole image
/// \param texels  some hundreds to thousands, spread over the map
/// \return the stated convention if the error of the map is at most twice the expected one,
///         or exceeds it by at most 0.02 degrees. Otherwise the convention with the smallest error
///         from a greedy search: all conventions are tried that differ in one part, or in two parts
///         that can hide each other (orientation and axes, space and axes); the best one becomes
///         the start of the next round, for up to three rounds. Ties: the first one in the order of
///         the enumerations
///
/// A wrong convention can also reduce errors that have other causes. Therefore an explanation must
/// reduce the error to less than half.
ConventionFit find_convention(const Image& map, std::span<const KnownTexel> texels,
                              const ConventionSearch& search);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the numbers of a normal map may mean on a mesh, and which of that explains a given map.
/// In the library relief::bake. Tests: tests/mesh/bake/map_convention_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/normal_map_operations.h"

namespace relief {

/// In which axes the vectors of a map are.
enum class MapAxes {
    tangent,
    object,  ///< Of the low mesh.
    world,   ///< In which the meshes are given.
};

/// Whose tangents.
enum class MapBasis {
    used,  ///< Those that the map is seen with: the low mesh's own, else MikkTSpace's.
    mikktspace,
    area_weighted,
    lengyel,
};

/// How a fragment gets its axes from those of the vertices.
enum class MapFrame {
    interpolated,  ///< As they come, and the bitangent from them: MikkTSpace's contract, relief's.
    unit,          ///< Normal and tangent made unit first.
    orthonormal,   ///< And the tangent turned into the plane of the normal.
    vertex_bitangent,  ///< The bitangent interpolated too, all three made unit.
};

/// How the image lies.
enum class MapTurn { upright, upside_down, mirrored, half_turn };

/// A reading of a map.
struct MapConvention {
    StoredCurve curve = StoredCurve::none;
    FlatCode flat = FlatCode::middle;
    MapTurn turn = MapTurn::upright;
    /// What x, y and z are, in terms of the vectors as stored with y up.
    AxisMapping axes = same_axes;
    MapAxes space = MapAxes::tangent;
    MapBasis basis = MapBasis::used;
    MapFrame frame = MapFrame::interpolated;
    bool ignores_mirroring = false;  ///< w is taken for +1 everywhere.

    bool operator==(const MapConvention&) const = default;
};

/// A texel whose true normal is known.
struct KnownTexel {
    int x = 0;
    int y = 0;
    std::uint32_t triangle = 0;
    glm::dvec3 weights{0.0};  ///< Of its corners.
    glm::dvec3 truth{0.0};    ///< In the axes of the meshes, unit.
    double expected = 0.0;    ///< Degrees that a faithful map would be off.
};

/// One thing about a reading that is other than it was told.
enum class ConventionPart { curve, flat, turn, axes, space, basis, frame, mirroring };

struct ConventionFit {
    /// Whether the map was so far off that others were tried.
    bool was_searched = false;
    /// Whether one explains it: less than half as far off, by more than 0.02 degrees.
    bool is_explained = false;
    MapConvention convention;       ///< The one that fits best.
    double told_degrees = 0.0;      ///< Root of the mean square, the worst 2% left out: as told,
    double found_degrees = 0.0;     ///< by `convention`,
    double expected_degrees = 0.0;  ///< and of a faithful map.
    std::size_t tried = 0;          ///< How many readings were tried.
    /// In which parts `convention` is another than told.
    std::vector<ConventionPart> changes;
};

struct ConventionSearch {
    const Mesh* low = nullptr;    ///< With the frames that the map is seen with.
    const Mesh* given = nullptr;  ///< As it was given, which may have tangents of its own.
    MapConvention told;
    Green green = Green::up;           ///< Of the map, as told.
    glm::dmat3 object_from_mesh{1.0};  ///< The low mesh's own axes.
};

/// Which reading explains a map.
///
/// \param map     three or four channels, whole
/// \param texels  some hundreds to thousands of them, all over the map
/// \return `told` itself where the map is as good as can be expected (within 0.02 degrees of it, or
///         twice); else the reading with the least error, found part by part: all readings that
///         differ in one part (or in two that hide each other: how the image lies and its axes, the
///         space and its axes), the best of these taken, and again, up to three times. Of readings
///         that fit alike, the first in the order of the enumerations
///
/// Reading a map as another may also shrink errors that have other reasons; so an explanation must
/// more than halve them.
ConventionFit find_convention(const Image& map, std::span<const KnownTexel> texels,
                              const ConventionSearch& search);

}  // namespace relief

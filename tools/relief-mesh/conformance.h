// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reads the conformance kit and compares a program's tangents with it, by the rules of
/// conformance/README.md. Tests: tests/tools/conformance_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "relief/mesh/enum_names.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/statistics.h"

namespace relief::tools {

/// The criteria for a mesh.
enum class KitGroup {
    conformance,  ///< Each corner is compared with the reference if that is unambiguous.
    /// The same for meshes on which the reference has a defect. The result is reported, but not
    /// required.
    defect,
    stability,  ///< Tangents must only be finite, unit and perpendicular.
};

}  // namespace relief::tools

namespace relief {

template <>
inline constexpr auto enum_names<tools::KitGroup> =
    std::to_array<EnumName<tools::KitGroup>>({{"conformance", tools::KitGroup::conformance},
                                              {"defect", tools::KitGroup::defect},
                                              {"stability", tools::KitGroup::stability}});

}  // namespace relief

namespace relief::tools {

struct KitMesh {
    std::string name;
    KitGroup group = KitGroup::conformance;
    std::string about;
    Mesh mesh;
    /// Three per triangle, in glTF's convention; w is 0 if the corner is not compared. Empty in the
    /// stability group.
    std::vector<glm::vec4> expected;
};

/// \param folder  holds kit.json, NAME.glb and, outside of the stability group, NAME.f32
/// \throws FileError if a file is missing or is not as conformance/README.md specifies
std::vector<KitMesh> read_kit(const std::filesystem::path& folder);

/// Returns all triangles of a glTF file as one mesh in object space, with the stored normals and
/// tangents, or zeros.
/// \throws FileError if it cannot be read
Mesh read_triangles(const std::filesystem::path& file);

/// The comparison of a program's tangents with the kit.
struct Judgment {
    std::size_t corners = 0;  ///< In the mesh of the kit.
    std::size_t judged = 0;   ///< In the program's mesh, and not excluded by the kit.
    std::size_t missing = 0;  ///< Of triangles that are missing in the program's mesh.
    /// The corners of missing triangles without area, which a program may omit.
    std::size_t omitted = 0;
    std::size_t extra = 0;  ///< Of triangles that are not in the kit's mesh.

    // Counts of judged corners.
    std::size_t not_finite = 0;
    std::size_t not_unit = 0;
    std::size_t not_perpendicular = 0;  ///< To the kit's normal, if that has a direction.
    std::size_t invalid_sign = 0;       ///< w is neither 1 nor -1.
    std::size_t mixed_signs = 0;        ///< The corners of the triangle differ in w.

    // Differences from the reference, except in the stability group.
    std::size_t other_sign = 0;
    std::size_t too_far = 0;
    ErrorStats degrees;
    std::size_t worst_corner = 0;  ///< In the kit's mesh: 3 * triangle + 0, 1 or 2.

    [[nodiscard]] bool passes(KitGroup group) const;

    friend bool operator==(const Judgment&, const Judgment&) = default;
};

/// The largest error of a conforming corner, in degrees.
constexpr double conforming_degrees = 0.01;

/// Returns the tolerance of lengths and cosines.
double tolerance_of(KitGroup group);

/// Compares the mesh of a program, from read_triangles(). match_corners() matches triangles without
/// tolerance.
Judgment judge(const KitMesh& kit, const Mesh& mesh);

}  // namespace relief::tools

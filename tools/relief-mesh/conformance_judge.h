// SPDX-License-Identifier: Apache-2.0
/// \file
/// Judges a program's tangents for a mesh of the conformance kit. The rule is that of
/// conformance/README.md. Tests: tests/tools/conformance_test.cpp.
#pragma once

#include <cstddef>
#include <string>

#include "conformance_kit.h"
#include "relief/mesh/angle_distribution.h"

namespace relief::tools {

struct Judgement {
    std::size_t corners = 0;  ///< Of the kit's mesh.
    std::size_t judged = 0;   ///< Found in the program's mesh, and not excused by the kit.
    std::size_t missing = 0;  ///< Of triangles that the program's mesh lacks.
    /// Missing, but of triangles without area in space, which a program may leave out.
    std::size_t left_out = 0;
    std::size_t extra = 0;  ///< Of triangles that the kit's mesh lacks.

    // Of those judged.
    std::size_t not_finite = 0;
    std::size_t not_unit = 0;
    std::size_t leaning =
        0;  ///< Not perpendicular to the kit's normal, where that has a direction.
    std::size_t unhanded = 0;  ///< w is neither 1 nor -1.
    std::size_t mixed = 0;     ///< Of triangles whose corners do not share one w.

    // Against the expected, outside of the stability group.
    std::size_t other_sign = 0;
    std::size_t too_far = 0;
    AngleDistribution degrees;
    std::size_t worst_corner = 0;  ///< Of the kit's mesh: 3 * triangle + 0, 1 or 2.

    [[nodiscard]] bool passes(KitGroup group) const;

    friend bool operator==(const Judgement&, const Judgement&) = default;
};

/// How far a corner may be off.
constexpr double conforming_degrees = 0.01;

/// How far a length or a cosine may be off, by group.
double tolerance_of(KitGroup group);

/// \param theirs  what read_triangles() made of the program's file; triangles are found by
///                match_corners() without tolerance
Judgement judge(const KitMesh& kit, const Mesh& theirs);

}  // namespace relief::tools

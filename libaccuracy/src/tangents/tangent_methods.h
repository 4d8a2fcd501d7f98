// SPDX-License-Identifier: Apache-2.0
/// \file
/// Every way that relief has of getting tangent frames, and how far what a shader makes of them is
/// from the truth; what the experiments and the tables of docs/tangents.md measure.
/// Tests: tests/accuracy/tangent_methods_test.cpp.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "relief/mesh/angle_distribution.h"
#include "tangents/bases.h"

namespace relief {

/// One way of getting frames.
struct TangentMethod {
    std::string name;
    std::function<CornerTangents(const Mesh&)> tangents;  ///< Or nothing.
    ShaderBasis basis = ShaderBasis::as_interpolated;

    /// None where the shader derives its frames.
    [[nodiscard]] CornerTangents tangents_of(const Mesh& mesh) const;
};

/// mikktspace, area-weighted, lengyel; screen-space, which is derived.
std::vector<TangentMethod> tangent_methods();

/// The same method, read by shaders that make normal and tangent unit.
TangentMethod made_unit(TangentMethod method);

/// Texels tilted by 30 degrees: to the right, to the left, up and down.
inline constexpr std::array<glm::dvec3, 4> tilted_texels = {
    glm::dvec3(0.5, 0.0, 0.8660254037844386), glm::dvec3(-0.5, 0.0, 0.8660254037844386),
    glm::dvec3(0.0, 0.5, 0.8660254037844386), glm::dvec3(0.0, -0.5, 0.8660254037844386)};

/// Of the normals that tilted texels stand for, inside of triangles, in degrees.
AngleDistribution texel_errors(const TexturedMesh& truth, const CornerTangents& tangents,
                               ShaderBasis basis);

/// Of tangents inside of triangles.
AngleDistribution inner_tangent_errors(const TexturedMesh& truth, const CornerTangents& tangents,
                                       ShaderBasis basis);

/// Of tangents at the corners of inner vertices.
AngleDistribution corner_tangent_errors(const TexturedMesh& truth, const CornerTangents& tangents);

/// What becomes of a true normal, tilted as above, that is baked in one basis, exactly, and read in
/// another.
AngleDistribution mismatch_errors(const TexturedMesh& truth, const TangentMethod& baker,
                                  const TangentMethod& reader);

}  // namespace relief

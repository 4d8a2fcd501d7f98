// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tangent methods, the basis that a fragment shader makes of their tangents, and the errors of
/// both on textured analytic surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/statistics.h"

namespace relief {

/// Three tangents per triangle; empty if the shader derives its frame.
using CornerTangents = std::vector<glm::vec4>;

/// The basis that a fragment shader computes from interpolated vectors.
enum class ShaderBasis {
    as_interpolated,  ///< Without normalization, as in shaders/tangent_frame.glsl#stored.
    made_unit,        ///< Normalizes normal and tangent first, as many shaders do.
    derived,          ///< From screen-space derivatives: shaders/tangent_frame.glsl#derivatives.
};

/// A point in a triangle.
struct Sample {
    std::uint32_t triangle = 0;
    glm::dvec3 barycentric{1.0 / 3.0};
};

/// Four points in each triangle whose three vertices are inner vertices.
std::vector<Sample> samples_of(const TexturedMesh& ground_truth);

/// Tangent, bitangent and normal as columns.
glm::dmat3 basis_at(const Mesh& mesh, const CornerTangents& tangents, ShaderBasis basis,
                    const Sample& sample);

/// The exact basis of the surface.
glm::dmat3 exact_basis_at(const TexturedMesh& ground_truth, const Sample& sample);

/// The exact tangents of the surface, rounded to float: the best that a method can compute.
CornerTangents exact_tangents(const TexturedMesh& ground_truth);

/// One way to compute tangent frames.
struct TangentFrameMethod {
    std::string name;
    std::function<CornerTangents(const Mesh&)> tangents;  ///< Empty if the shader derives frames.
    ShaderBasis basis = ShaderBasis::as_interpolated;

    /// Returns no tangents if the shader derives its frames.
    [[nodiscard]] CornerTangents tangents_of(const Mesh& mesh) const;
};

/// mikktspace, area-weighted, lengyel, and the derived frames of screen-space.
std::vector<TangentFrameMethod> tangent_methods();

/// The same method with a shader that normalizes normal and tangent.
TangentFrameMethod made_unit(TangentFrameMethod method);

/// Texels tilted by 30 degrees to the right, left, up and down.
inline constexpr std::array<glm::dvec3, 4> tilted_texels = {
    glm::dvec3(0.5, 0.0, 0.8660254037844386), glm::dvec3(-0.5, 0.0, 0.8660254037844386),
    glm::dvec3(0.0, 0.5, 0.8660254037844386), glm::dvec3(0.0, -0.5, 0.8660254037844386)};

/// The errors of the normals of tilted texels inside the triangles, in degrees.
ErrorStats texel_errors(const TexturedMesh& ground_truth, const CornerTangents& tangents,
                        ShaderBasis basis);

/// The errors of tangents inside the triangles.
ErrorStats inner_tangent_errors(const TexturedMesh& ground_truth, const CornerTangents& tangents,
                                ShaderBasis basis);

/// The errors of tangents at the corners of inner vertices.
ErrorStats corner_tangent_errors(const TexturedMesh& ground_truth, const CornerTangents& tangents);

/// The errors of tilted normals that are baked without rounding in one basis and read in another.
ErrorStats mismatch_errors(const TexturedMesh& ground_truth, const TangentFrameMethod& baker,
                           const TangentFrameMethod& reader);

struct TexturedCase {
    std::string id;    ///< "torus-jittered-mirrored"
    std::string name;  ///< "torus, jittered, image mirrored"
    /// Absent if the case has no cells to refine.
    std::optional<Triangulation> triangulation{};
    bool is_quick = false;  ///< Whether quick runs include the case.
    std::function<TexturedMesh(int cells)> mesh;
};

/// Every surface with regular, jittered and anisotropic cells; the jittered torus with a sheared
/// and with a mirrored texture; and a plate with thin bevels, which has no cells.
std::vector<TexturedCase> textured_cases();

}  // namespace relief

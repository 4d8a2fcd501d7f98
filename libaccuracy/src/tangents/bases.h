// SPDX-License-Identifier: Apache-2.0
/// \file
/// The bases in which a fragment shader reads a normal map, by every way of getting them, at points
/// of triangles; in double. Tests: tests/accuracy/bases_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "relief/mesh/analytic_surfaces.h"
#include "relief/mesh/mesh.h"

namespace relief {

/// Three tangents a triangle; none: the shader derives its frame.
using CornerTangents = std::vector<glm::vec4>;

/// What a fragment shader makes of interpolated vectors.
enum class ShaderBasis {
    as_interpolated,  ///< As it should be: shaders/tangent_frame.glsl#stored.
    made_unit,        ///< Normal and tangent made unit first, as many shaders do.
    derived,          ///< From derivatives: shaders/tangent_frame.glsl#derivatives.
};

/// A point of a triangle.
struct Sample {
    std::uint32_t triangle = 0;
    glm::dvec3 barycentric{1.0 / 3.0};
};

/// Four points in each triangle all of whose vertices are inner ones.
std::vector<Sample> samples_of(const TexturedMesh& truth);

/// Tangent, bitangent and normal, as columns.
glm::dmat3 basis_at(const Mesh& mesh, const CornerTangents& tangents, ShaderBasis basis,
                    const Sample& sample);

/// The surface's own.
glm::dmat3 true_basis_at(const TexturedMesh& truth, const Sample& sample);

/// The surface's own tangents, rounded to float: what a method could do at best.
CornerTangents true_tangents(const TexturedMesh& truth);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// The tangent frame at a point of a triangle, as the shader computes it: normal and tangent are
/// interpolated linearly and not renormalized, and b = w cross(n, t). Source: [Mikkelsen 2008].
/// Tests: tests/mesh/bake/map_convention_test.cpp.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "relief/mesh/mesh.h"

namespace relief::detail {

/// The axes of tangent space, in object space, in double.
struct TexelFrame {
    static constexpr double min_volume = 1e-6;  ///< Relative to the lengths of the axes.

    glm::dvec3 tangent, bitangent, normal;
    double volume;

    /// \param weights  barycentric
    TexelFrame(const Mesh& mesh, std::uint32_t triangle, const glm::dvec3& weights)
        : TexelFrame(mesh, mesh.triangles[triangle], weights) {}

    /// \param corners  of a triangle, in the order of the weights
    TexelFrame(const Mesh& mesh, const glm::uvec3& corners, const glm::dvec3& weights) {
        glm::dvec4 t(0.0);
        normal = glm::dvec3(0.0);
        for (int i = 0; i < 3; ++i) {
            normal += weights[i] * glm::dvec3(mesh.normals[corners[i]]);
            t += weights[i] * glm::dvec4(mesh.tangents[corners[i]]);
        }
        set_tangent(t);
    }

    /// Returns the frame of a map whose texture coordinates a material transforms.
    [[nodiscard]] TexelFrame transformed_by(const GltfTextureTransform& transform) const {
        const double handedness = glm::dot(bitangent, glm::cross(normal, tangent)) < 0.0 ? -1 : 1;
        const glm::vec4 unit(glm::vec3(glm::normalize(tangent)), handedness);
        TexelFrame result = *this;
        result.set_tangent(
            glm::dvec4(transformed(transform, unit, glm::vec3(glm::normalize(normal)))));
        return result;
    }

    [[nodiscard]] bool is_usable() const {
        const double lengths = glm::length(tangent) * glm::length(normal);
        // The bitangent has the length of tangent times normal times w; w near 0 makes it short.
        return std::isfinite(volume) && std::abs(volume) > min_volume * lengths * lengths &&
               lengths > 0.0;
    }
    [[nodiscard]] glm::dvec3 to_object(const glm::dvec3& n) const {
        return n.x * tangent + n.y * bitangent + n.z * normal;
    }
    [[nodiscard]] glm::dvec3 to_tangent(const glm::dvec3& n) const {
        return glm::dvec3(glm::dot(n, glm::cross(bitangent, normal)),
                          glm::dot(n, glm::cross(normal, tangent)),
                          glm::dot(n, glm::cross(tangent, bitangent))) /
               volume;
    }

  private:
    void set_tangent(const glm::dvec4& t) {
        tangent = glm::dvec3(t);
        bitangent = t.w * glm::cross(normal, tangent);
        volume = glm::dot(tangent, glm::cross(bitangent, normal));
    }
};

}  // namespace relief::detail

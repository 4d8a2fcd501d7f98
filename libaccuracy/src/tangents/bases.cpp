// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/bases_test.cpp.
#include "tangents/bases.h"

#include <cmath>

namespace relief {
namespace {

template <typename Values>
auto interpolated(const Values& values, const glm::uvec3& corners, const glm::dvec3& weights) {
    using Value = std::decay_t<decltype(values[0])>;
    using Double = glm::vec<Value::length(), double>;
    return Double(values[corners.x]) * weights.x + Double(values[corners.y]) * weights.y +
           Double(values[corners.z]) * weights.z;
}

/// The formula of shaders/tangent_frame.glsl#derivatives, with two edges of the triangle in place
/// of "right" and "up" on the screen: any two directions in its plane give the same.
glm::dmat3 derived_basis(const Mesh& mesh, const glm::uvec3& corners, const glm::dvec3& normal) {
    const auto edge = [&](std::uint32_t to) {
        return glm::dvec3(mesh.positions[to]) - glm::dvec3(mesh.positions[corners.x]);
    };
    const auto step = [&](std::uint32_t to) {
        return glm::dvec2(mesh.texcoords[to]) - glm::dvec2(mesh.texcoords[corners.x]);
    };
    const glm::dvec3 right = edge(corners.y), up = edge(corners.z);
    const glm::dvec2 right_texture = step(corners.y), up_texture = step(corners.z);
    const double area = right_texture.x * up_texture.y - right_texture.y * up_texture.x;
    const double sign = area < 0.0 ? -1.0 : 1.0;
    const glm::dvec3 n = glm::normalize(normal);
    const glm::dvec3 along_u = (right * up_texture.y - up * right_texture.y) * sign;
    const glm::dvec3 tangent = glm::normalize(along_u - n * glm::dot(n, along_u));
    const double turned = sign * (glm::dot(n, glm::cross(right, up)) < 0.0 ? -1.0 : 1.0);
    return {tangent, -turned * glm::cross(n, tangent), n};
}

glm::dmat3 matrix_of(const SurfaceFrame& frame) {
    return {frame.tangent, frame.handedness * glm::cross(frame.normal, frame.tangent),
            frame.normal};
}

}  // namespace

std::vector<Sample> samples_of(const TexturedMesh& truth) {
    std::vector<Sample> samples;
    const auto count = static_cast<std::uint32_t>(truth.mesh.triangles.size());
    for (std::uint32_t t = 0; t < count; ++t) {
        const glm::uvec3& corners = truth.mesh.triangles[t];
        if (truth.inner[corners.x] + truth.inner[corners.y] + truth.inner[corners.z] < 3) continue;
        samples.push_back({t, glm::dvec3(1.0 / 3.0)});
        for (int corner = 0; corner < 3; ++corner) {
            Sample sample{t, glm::dvec3(1.0 / 6.0)};
            sample.barycentric[corner] = 2.0 / 3.0;
            samples.push_back(sample);
        }
    }
    return samples;
}

glm::dmat3 basis_at(const Mesh& mesh, const CornerTangents& tangents, ShaderBasis basis,
                    const Sample& sample) {
    const glm::uvec3& corners = mesh.triangles[sample.triangle];
    glm::dvec3 normal = interpolated(mesh.normals, corners, sample.barycentric);
    if (basis == ShaderBasis::derived) return derived_basis(mesh, corners, normal);
    const glm::uvec3 first = glm::uvec3(0, 1, 2) + 3 * sample.triangle;
    const glm::dvec4 stored = interpolated(tangents, first, sample.barycentric);
    glm::dvec3 tangent(stored);
    if (basis == ShaderBasis::made_unit) {
        normal = glm::normalize(normal);
        tangent = glm::normalize(tangent);
    }
    return {tangent, stored.w * glm::cross(normal, tangent), normal};
}

glm::dmat3 true_basis_at(const TexturedMesh& truth, const Sample& sample) {
    const glm::uvec3& corners = truth.mesh.triangles[sample.triangle];
    return matrix_of(truth.frame_at(interpolated(truth.parameters, corners, sample.barycentric)));
}

CornerTangents true_tangents(const TexturedMesh& truth) {
    CornerTangents tangents;
    for (std::uint32_t t = 0; t < truth.mesh.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            // A little inside of the triangle: both sides of a mirrored image's edge have their
            // own.
            Sample sample{t, glm::dvec3(1e-9)};
            sample.barycentric[corner] = 1.0 - 2e-9;
            const glm::uvec3& corners = truth.mesh.triangles[t];
            const SurfaceFrame frame =
                truth.frame_at(interpolated(truth.parameters, corners, sample.barycentric));
            tangents.emplace_back(glm::vec3(frame.tangent), static_cast<float>(frame.handedness));
        }
    }
    return tangents;
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Meshes that morph targets and joints deform, on the CPU: the displacements of targets are added
// to the mesh at rest, and each vertex is then moved by the weighted mean of the matrices of its
// joints (linear blend skinning). Source: glTF 2.0, sections 3.7.2.2 and 3.7.3.3.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "parallel.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "scene/scene_parts.h"

namespace relief {

namespace {

glm::vec3 unit_or_rest(const glm::vec3& vector, const glm::vec3& fallback) {
    const float length = glm::length(vector);
    return length > 0.0F && std::isfinite(length) ? vector / length : fallback;
}

/// Adds the displacements of the targets.
void morph(const DeformedMesh& deformed, std::span<const float> weights, Mesh& mesh) {
    const GltfDeformation& how = deformed.deformation;
    const auto add = [](const std::vector<glm::vec3>& displacements, float weight, auto& values) {
        const std::size_t count = std::min(displacements.size(), values.size());
        parallel_for(count, 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                for (int k = 0; k < 3; ++k)
                    values[i][k] += weight * displacements[i][k];
            }
        });
    };
    for (std::size_t i = 0; i < std::min(how.targets.size(), weights.size()); ++i) {
        if (weights[i] == 0.0F) continue;
        add(how.targets[i].positions, weights[i], mesh.positions);
        add(how.targets[i].normals, weights[i], mesh.normals);
        add(how.targets[i].tangents, weights[i], mesh.tangents);
    }
}

/// Moves vertices by the matrices of their joints.
class Skinning {
  public:
    Skinning(const GltfDeformation& how, std::vector<glm::mat4> matrices)
        : how_(how), matrices_(std::move(matrices)) {}

    /// A vertex without weights follows the first joint, like glTF's default of joint 0.
    [[nodiscard]] glm::mat4 matrix_of(std::size_t vertex) const {
        glm::mat4 sum(0.0F);
        float total = 0.0F;
        for (const GltfJoints& set : how_.joints) {
            for (int k = 0; k < 4; ++k) {
                const float weight = set.weights[vertex][k];
                const std::size_t joint = set.joints[vertex][k];
                if (!(weight > 0.0F) || joint >= matrices_.size()) continue;
                sum += weight * matrices_[joint];
                total += weight;
            }
        }
        return total > 0.0F ? sum / total : matrices_.front();
    }

    void move(std::size_t vertex, Mesh& mesh) const {
        const glm::mat4 matrix = matrix_of(vertex);
        mesh.positions[vertex] = glm::vec3(matrix * glm::vec4(mesh.positions[vertex], 1.0F));
        const glm::mat3 axes(matrix);
        if (!mesh.normals.empty()) {
            // Cofactors keep normals perpendicular; a mirroring matrix would turn them inside out.
            const glm::mat3 cofactors(glm::cross(axes[1], axes[2]), glm::cross(axes[2], axes[0]),
                                      glm::cross(axes[0], axes[1]));
            const float side = glm::dot(axes[0], cofactors[0]) < 0.0F ? -1.0F : 1.0F;
            mesh.normals[vertex] = side * (cofactors * mesh.normals[vertex]);
        }
        if (!mesh.tangents.empty()) {
            const glm::vec3 tangent = axes * glm::vec3(mesh.tangents[vertex]);
            mesh.tangents[vertex] = glm::vec4(tangent, mesh.tangents[vertex].w);
        }
    }

  private:
    const GltfDeformation& how_;
    std::vector<glm::mat4> matrices_;
};

/// Makes directions unit; one without a length is that at rest.
void normalize_directions(const Mesh& rest, Mesh& mesh) {
    parallel_for(mesh.positions.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!mesh.normals.empty())
                mesh.normals[i] = unit_or_rest(mesh.normals[i], rest.normals[i]);
            if (mesh.tangents.empty()) continue;
            const glm::vec3 tangent =
                unit_or_rest(glm::vec3(mesh.tangents[i]), glm::vec3(rest.tangents[i]));
            mesh.tangents[i] = glm::vec4(tangent, mesh.tangents[i].w);
        }
    });
}

/// Gives all vertices the normal of their triangle; no vertex belongs to two triangles.
void set_flat_normals(Mesh& mesh) {
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 a = mesh.positions[t.x];
        const glm::vec3 across = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
        for (int k = 0; k < 3; ++k)
            mesh.normals[t[k]] = unit_or_rest(across, mesh.normals[t[k]]);
    }
}

std::vector<glm::mat4> joint_matrices(const DeformedMesh& deformed,
                                      std::span<const glm::mat4> world_from_node) {
    std::vector<glm::mat4> matrices;
    for (std::size_t i = 0; i < deformed.joints.size(); ++i) {
        const std::size_t node = deformed.joints[i];
        if (node >= world_from_node.size() || i >= deformed.joint_from_mesh.size())
            throw InvalidInput(fmt::format("joint {} of a deformed mesh has no node or matrix", i));
        matrices.push_back(world_from_node[node] * deformed.joint_from_mesh[i]);
    }
    return matrices;
}

}  // namespace

void deform(SceneGraph& graph, std::span<const glm::mat4> world_from_node,
            std::span<const NodeWeights> weights) {
    for (const DeformedMesh& deformed : graph.deformed) {
        Mesh mesh = deformed.rest;
        // Materials may have been assigned since.
        mesh.material_ranges = graph.scene.meshes.at(deformed.mesh)->material_ranges;
        std::span<const float> now = deformed.weights;
        for (const NodeWeights& animated : weights) {
            if (animated.node == deformed.node) now = animated.weights;
        }
        morph(deformed, now, mesh);
        if (!deformed.joints.empty()) {
            const Skinning skinning(deformed.deformation,
                                    joint_matrices(deformed, world_from_node));
            parallel_for(mesh.positions.size(), 1024, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    skinning.move(i, mesh);
            });
        }
        normalize_directions(deformed.rest, mesh);
        if (deformed.has_flat_normals) set_flat_normals(mesh);
        if (deformed.skinned_instance)
            graph.scene.instances.at(*deformed.skinned_instance).world_from_object =
                glm::mat4(1.0F);
        if (deformed.mesh < graph.mesh_bounds.size())
            graph.mesh_bounds[deformed.mesh] = bounds_of(mesh);
        graph.scene.meshes.at(deformed.mesh) = std::move(mesh);
    }
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// The poses of meshes that morph targets and joints deform, and the deformed vertices on the CPU,
// for everything but drawing with OpenGL (vertex.glsl): the displacements of targets are added to
// the mesh at rest, and each vertex is then moved by the weighted mean of the matrices of its
// joints (linear blend skinning). Source: glTF 2.0, sections 3.7.2.2 and 3.7.3.3.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "parallel.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_graph.h"
#include "scene/scene_parts.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::detail;

namespace {

glm::vec3 unit_or_rest(const glm::vec3& vector, const glm::vec3& fallback) {
    const float length = glm::length(vector);
    return length > 0.0F && std::isfinite(length) ? vector / length : fallback;
}

/// The vertices of a mesh, and those of the deformation of which they were made.
class SourceVertices {
  public:
    explicit SourceVertices(std::span<const std::uint32_t> source) : source_(source) {}

    std::size_t operator()(std::size_t vertex) const {
        return source_.empty() ? vertex : source_[vertex];
    }

  private:
    std::span<const std::uint32_t> source_;  ///< Empty: the same.
};

/// Adds the displacements of the targets.
void morph(const MeshPose& pose, const SourceVertices& source, Mesh& mesh) {
    const std::vector<GltfMorphTarget>& targets = pose.deformation->targets;
    const auto add = [&](const std::vector<glm::vec3>& displacements, float weight, auto& values) {
        if (displacements.empty()) return;
        parallel_for(values.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                for (int k = 0; k < 3; ++k)
                    values[i][k] += weight * displacements[source(i)][k];
            }
        });
    };
    for (std::size_t i = 0; i < std::min(targets.size(), pose.weights.size()); ++i) {
        const float weight = pose.weights[i];
        if (weight == 0.0F) continue;
        add(targets[i].positions, weight, mesh.positions);
        add(targets[i].normals, weight, mesh.normals);
        add(targets[i].tangents, weight, mesh.tangents);
    }
}

/// Returns the axes of a matrix scaled to a largest element of 1, so that products of them stay in
/// the range of float. The identity does not change by a bit.
glm::mat3 scaled_axes(const glm::mat4& matrix) {
    const glm::mat3 axes(matrix);
    float largest = 0.0F;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(axes[column][row]));
    }
    return largest > 0.0F ? axes / largest : axes;
}

/// Moves vertices by the matrices of their joints.
class Skinning {
  public:
    Skinning(const MeshPose& pose, const SourceVertices& source)
        : joints_(pose.deformation->joints), matrices_(pose.joint_matrices), source_(source) {}

    void move(std::size_t vertex, Mesh& mesh) const {
        const glm::mat4 matrix = matrix_of(source_(vertex));
        mesh.positions[vertex] = glm::vec3(matrix * glm::vec4(mesh.positions[vertex], 1.0F));
        const glm::mat3 axes = scaled_axes(matrix);
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
    /// A vertex without weights follows the first joint, like glTF's default of joint 0.
    [[nodiscard]] glm::mat4 matrix_of(std::size_t vertex) const {
        glm::mat4 sum(0.0F);
        float total = 0.0F;
        for (const GltfJoints& set : joints_) {
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

    const std::vector<GltfJoints>& joints_;
    const std::vector<glm::mat4>& matrices_;
    SourceVertices source_;
};

/// Makes directions unit; one without a length is that at rest.
template <typename Direction>
void normalize_directions(const std::vector<Direction>& rest, std::vector<Direction>& moved) {
    parallel_for(moved.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3 unit = unit_or_rest(glm::vec3(moved[i]), glm::vec3(rest[i]));
            for (int k = 0; k < 3; ++k)
                moved[i][k] = unit[k];
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

std::vector<glm::mat4> joint_matrices(const DeformedInstance& deformed,
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

template <typename Value>
void take_vertices(std::span<const std::uint32_t> source, std::vector<Value>& values) {
    if (values.empty()) return;
    std::vector<Value> taken;
    taken.reserve(source.size());
    for (const std::uint32_t vertex : source)
        taken.push_back(values[vertex]);
    values = std::move(taken);
}

/// Gives each triangle vertices of its own. \return the vertex that each new one copies
std::vector<std::uint32_t> separate_triangles(Mesh& mesh) {
    std::vector<std::uint32_t> source;
    for (glm::uvec3& triangle : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            source.push_back(triangle[k]);
            triangle[k] = static_cast<std::uint32_t>(source.size() - 1);
        }
    }
    const auto copy = [&](auto& values) {
        if (values.empty()) return;
        auto copies = values;
        copies.clear();
        for (const std::uint32_t vertex : source)
            copies.push_back(values[vertex]);
        values = std::move(copies);
    };
    copy(mesh.positions);
    copy(mesh.normals);
    copy(mesh.tangents);
    copy(mesh.texcoords);
    copy(mesh.texcoords_2);
    copy(mesh.colors);
    return source;
}

}  // namespace

bool is_morphed(const MeshPose& pose) {
    const std::size_t count = std::min(pose.deformation->targets.size(), pose.weights.size());
    return std::any_of(pose.weights.begin(),
                       pose.weights.begin() + static_cast<std::ptrdiff_t>(count),
                       [](float weight) { return weight != 0.0F; });
}

bool is_skinned(const MeshPose& pose) {
    return std::any_of(pose.joint_matrices.begin(), pose.joint_matrices.end(),
                       [](const glm::mat4& matrix) { return matrix != glm::mat4(1.0F); });
}

void detail::deform(const MeshPose& pose, std::span<const std::uint32_t> source_vertex,
                    Mesh& mesh) {
    const std::vector<glm::vec3> rest_normals = mesh.normals;
    const std::vector<glm::vec4> rest_tangents = mesh.tangents;
    const SourceVertices source(source_vertex);
    morph(pose, source, mesh);
    if (!pose.joint_matrices.empty()) {
        const Skinning skinning(pose, source);
        parallel_for(mesh.positions.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                skinning.move(i, mesh);
        });
    }
    normalize_directions(rest_normals, mesh.normals);
    normalize_directions(rest_tangents, mesh.tangents);
    if (pose.has_flat_normals && !mesh.normals.empty()) set_flat_normals(mesh);
}

Shared<Mesh> deformed_mesh(const Scene& scene, std::size_t instance) {
    const Instance& placed = scene.instances.at(instance);
    Shared<Mesh> mesh = scene.meshes.at(placed.mesh);
    if (is_deformed(placed)) deform(*placed.pose, {}, mesh.edit());
    return mesh;
}

GltfDeformation detail::of_vertices(GltfDeformation deformation,
                                    std::span<const std::uint32_t> source_vertex) {
    for (GltfMorphTarget& target : deformation.targets) {
        take_vertices(source_vertex, target.positions);
        take_vertices(source_vertex, target.normals);
        take_vertices(source_vertex, target.tangents);
    }
    for (GltfJoints& joints : deformation.joints) {
        take_vertices(source_vertex, joints.joints);
        take_vertices(source_vertex, joints.weights);
    }
    return deformation;
}

FramedMesh detail::with_separate_frames(Mesh mesh, const FrameOptions& options, Report& report) {
    const std::vector<std::uint32_t> source = separate_triangles(mesh);
    FramedMesh framed = with_frames(std::move(mesh), options, report);
    for (std::uint32_t& vertex : framed.source_vertex)
        vertex = source[vertex];
    return framed;
}

void detail::set_poses(SceneGraph& graph, std::span<const glm::mat4> world_from_node,
                       std::span<const NodeWeights> weights) {
    for (const DeformedInstance& deformed : graph.deformed) {
        Instance& instance = graph.scene.instances.at(deformed.instance);
        if (!instance.pose) continue;
        instance.pose->weights = deformed.weights;
        for (const NodeWeights& animated : weights) {
            if (animated.node == deformed.node) instance.pose->weights = animated.weights;
        }
        if (deformed.joints.empty()) continue;
        instance.pose->joint_matrices = joint_matrices(deformed, world_from_node);
        instance.world_from_object = glm::mat4(1.0F);
    }
}

}  // namespace relief::shade

// SPDX-License-Identifier: Apache-2.0
#include "tools/tangent_definition.h"

#include <array>
#include <cmath>
#include <map>

namespace relief::test {
namespace {

/// The vertices of all corners, those equal in position, normal and texture coordinate as one.
std::vector<std::size_t> welded_corners(const Mesh& mesh) {
    std::map<std::array<float, 8>, std::size_t> known;
    std::vector<std::size_t> vertices;
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            // Adding zero turns -0 into 0.
            const glm::vec3 p = mesh.positions[triangle[i]] + 0.0F;
            const glm::vec3 n = mesh.normals[triangle[i]] + 0.0F;
            const glm::vec2 t = mesh.texcoords[triangle[i]] + 0.0F;
            const auto found =
                known.try_emplace({p.x, p.y, p.z, n.x, n.y, n.z, t.x, t.y}, known.size());
            vertices.push_back(found.first->second);
        }
    }
    return vertices;
}

struct Gradient {
    glm::dvec3 along_u;
    double sign;  ///< 1 where the image is upright.
    double area;
};

/// From the plane equations of u and v up over a triangle.
Gradient gradient_of(const Mesh& mesh, const glm::uvec3& triangle) {
    const auto position = [&](int i) { return glm::dvec3(mesh.positions[triangle[i]]); };
    const auto texcoord = [&](int i) {
        return glm::dvec2(mesh.texcoords[triangle[i]]) * glm::dvec2(1, -1);
    };
    const glm::dvec3 p1 = position(1) - position(0);
    const glm::dvec3 p2 = position(2) - position(0);
    const glm::dvec2 t1 = texcoord(1) - texcoord(0);
    const glm::dvec2 t2 = texcoord(2) - texcoord(0);
    const double determinant = t1.x * t2.y - t1.y * t2.x;
    return {(t2.y * p1 - t1.y * p2) / determinant, determinant > 0.0 ? 1.0 : -1.0,
            glm::length(glm::cross(p1, p2))};
}

glm::dvec3 in_plane(const glm::dvec3& vector, const glm::dvec3& normal) {
    return glm::normalize(vector - normal * glm::dot(normal, vector));
}

std::size_t next_of(std::size_t corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

class Definition {
  public:
    Definition(const Mesh& mesh, Twist twist)
        : mesh_(mesh), twist_(twist), vertices_(welded_corners(mesh)) {
        for (const glm::uvec3& triangle : mesh.triangles)
            gradients_.push_back(gradient_of(mesh, triangle));
        for (std::size_t corner = 0; corner < vertices_.size(); ++corner)
            around_[vertices_[corner]].push_back(corner);
    }

    [[nodiscard]] glm::vec4 tangent(std::size_t corner) const {
        const glm::dvec3 normal = glm::normalize(glm::dvec3(mesh_.normals[mesh_vertex(corner)]));
        glm::dvec3 sum(0.0);
        for (const std::size_t member : group_of(corner)) {
            sum += weight(member, normal) * in_plane(gradients_[member / 3].along_u, normal);
        }
        return {glm::vec3(in_plane(sum, normal)), static_cast<float>(gradients_[corner / 3].sign)};
    }

  private:
    [[nodiscard]] std::uint32_t mesh_vertex(std::size_t corner) const {
        return mesh_.triangles[corner / 3][static_cast<int>(corner % 3)];
    }

    /// Across the edge from `a` to its next corner stands the triangle of `b`, the other way round.
    [[nodiscard]] bool follows(std::size_t a, std::size_t b) const {
        return vertices_[next_of(a)] == vertices_[next_of(next_of(b))] &&
               (twist_ == Twist::across_mirrors ||
                gradients_[a / 3].sign == gradients_[b / 3].sign);
    }

    [[nodiscard]] std::vector<std::size_t> group_of(std::size_t corner) const {
        std::vector<std::size_t> group = {corner};
        std::vector<std::size_t> open = around_.at(vertices_[corner]);
        std::erase(open, corner);
        for (std::size_t i = 0; i < group.size(); ++i) {
            const std::size_t member = group[i];
            std::erase_if(open, [&](std::size_t other) {
                const bool joins = follows(member, other) || follows(other, member);
                if (joins) group.push_back(other);
                return joins;
            });
        }
        return group;
    }

    [[nodiscard]] double weight(std::size_t corner, const glm::dvec3& normal) const {
        if (twist_ == Twist::area_weights) return gradients_[corner / 3].area;
        const auto position = [&](std::size_t c) {
            return glm::dvec3(mesh_.positions[mesh_vertex(c)]);
        };
        const glm::dvec3 here = position(corner);
        const glm::dvec3 a = in_plane(position(next_of(corner)) - here, normal);
        const glm::dvec3 b = in_plane(position(next_of(next_of(corner))) - here, normal);
        return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    }

    const Mesh& mesh_;
    Twist twist_;
    std::vector<std::size_t> vertices_;
    std::vector<Gradient> gradients_;
    std::map<std::size_t, std::vector<std::size_t>> around_;
};

}  // namespace

std::vector<glm::vec4> tangents_by_definition(const Mesh& mesh, Twist twist) {
    const Definition definition(mesh, twist);
    std::vector<glm::vec4> tangents;
    for (std::size_t corner = 0; corner < 3 * mesh.triangles.size(); ++corner)
        tangents.push_back(definition.tangent(corner));
    return tangents;
}

}  // namespace relief::test

// SPDX-License-Identifier: Apache-2.0
// Merging corners into indexed vertices: first equal values, then index triples.
//
// Bits are compared, so NaN equals itself and +0 differs from -0. Corners must be complete and in
// range.
#include "io/mesh/vertex_dedup.h"

#include <array>
#include <cassert>
#include <limits>

#include "geometry/weld.h"
#include "large_memory.h"
#include "progress_stage.h"

namespace relief {
namespace {

/// Merges positions; if they have colors, both must be equal.
std::vector<std::uint32_t> first_equal_vertex(const ObjStatements& statements) {
    if (statements.colors.empty()) return weld_bits<glm::vec3>(statements.positions);
    std::vector<std::array<float, 7>> rows;
    rows.reserve(statements.positions.size());
    for (std::size_t i = 0; i < statements.positions.size(); ++i) {
        const glm::vec3& p = statements.positions[i];
        const glm::vec4& c = statements.colors[i];
        rows.push_back({p.x, p.y, p.z, c.r, c.g, c.b, c.a});
    }
    return weld_bits<std::array<float, 7>>(rows);
}

/// Numbers combinations in order of first use. A position nearly always has few of them, which are
/// searched linearly; from the seventeenth on they are hashed.
class VertexNumbers {
  public:
    struct Vertex {
        std::uint32_t position, texcoord, normal;
    };

    explicit VertexNumbers(std::size_t position_count) : newest_(position_count, none), hashed_(0) {
        vertices_.reserve(position_count);
        previous_.reserve(position_count);
    }

    std::uint32_t number_of(const Vertex& vertex) {
        std::uint32_t& newest = newest_[vertex.position];
        std::uint32_t steps = 0;
        for (std::uint32_t at = newest; at != none; at = previous_[at]) {
            const Vertex& known = vertices_[at];
            if (known.texcoord == vertex.texcoord && known.normal == vertex.normal) return at;
            if (++steps == max_steps) return hashed_number_of(vertex);
        }
        previous_.push_back(newest);
        newest = added(vertex);
        return newest;
    }

    /// All combinations, indexed by their number.
    [[nodiscard]] const std::vector<Vertex>& vertices() const { return vertices_; }

  private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    static constexpr std::uint32_t max_steps = 16;

    std::uint32_t added(const Vertex& vertex) {
        vertices_.push_back(vertex);
        return static_cast<std::uint32_t>(vertices_.size() - 1);
    }

    std::uint32_t hashed_number_of(const Vertex& vertex) {
        const std::uint32_t known =
            hashed_.number_of({vertex.position, vertex.texcoord, vertex.normal});
        if (known == number_of_hashed_.size()) {
            previous_.push_back(none);  // Hashed combinations are in no chain.
            number_of_hashed_.push_back(added(vertex));
        }
        return number_of_hashed_[known];
    }

    std::vector<Vertex> vertices_;
    std::vector<std::uint32_t>
        previous_;                       ///< The previous vertex with the same position, by vertex.
    std::vector<std::uint32_t> newest_;  ///< The newest vertex, by position.
    KeyNumbers<3> hashed_;
    std::vector<std::uint32_t> number_of_hashed_;
};

}  // namespace

std::vector<std::uint32_t> unify_vertices(const ObjStatements& statements, Mesh& mesh) {
    ProgressStage stage("joining vertices", statements.corners.size());
    const std::vector<std::uint32_t> positions = first_equal_vertex(statements);
    const std::vector<std::uint32_t> texcoords = weld_bits<glm::vec2>(statements.texcoords);
    const std::vector<std::uint32_t> normals = weld_bits<glm::vec3>(statements.normals);
    const bool has_texcoords = !statements.corners.empty() && statements.corners[0].texcoord >= 0;
    const bool has_normals = !statements.corners.empty() && statements.corners[0].normal >= 0;
    VertexNumbers numbers(statements.positions.size());
    std::vector<std::uint32_t> vertex_of_corner;
    reserve_to_fill(vertex_of_corner, statements.corners.size());
    for (const ObjCorner& corner : statements.corners) {
        stage.at(vertex_of_corner.size());
        assert((corner.texcoord >= 0) == has_texcoords && (corner.normal >= 0) == has_normals);
        vertex_of_corner.push_back(numbers.number_of(
            {positions[static_cast<std::uint32_t>(corner.position)],
             has_texcoords ? texcoords[static_cast<std::uint32_t>(corner.texcoord)] : 0,
             has_normals ? normals[static_cast<std::uint32_t>(corner.normal)] : 0}));
    }
    const std::vector<VertexNumbers::Vertex>& vertices = numbers.vertices();
    const auto gather = [&](const auto& values, std::uint32_t VertexNumbers::Vertex::*index,
                            auto& gathered) {
        check_cancelled();
        gathered.reserve(vertices.size());
        for (const VertexNumbers::Vertex& vertex : vertices)
            gathered.push_back(values[vertex.*index]);
    };
    gather(statements.positions, &VertexNumbers::Vertex::position, mesh.positions);
    if (!statements.colors.empty())
        gather(statements.colors, &VertexNumbers::Vertex::position, mesh.colors);
    if (has_texcoords)
        gather(statements.texcoords, &VertexNumbers::Vertex::texcoord, mesh.texcoords);
    if (has_normals) gather(statements.normals, &VertexNumbers::Vertex::normal, mesh.normals);
    return vertex_of_corner;
}

}  // namespace relief

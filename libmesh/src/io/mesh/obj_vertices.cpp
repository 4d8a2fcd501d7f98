// SPDX-License-Identifier: Apache-2.0
// Unifying OBJ corners into indexed vertices by hashing: first equal values, then index triples.
//
// Bits decide, so NaN equals itself and +0 differs from -0. Corners must be complete and in range
// (obj_parser.h, obj_reader.cpp see to it). Tests: tests/mesh/io/mesh/obj_test.cpp.
#include "io/mesh/obj_vertices.h"

#include <array>
#include <bit>
#include <cassert>

#include "io/mesh/polygon_key_numbers.h"

namespace relief {
namespace {

/// For every value the first one with the same bits.
template <typename Value>
std::vector<std::uint32_t> first_equal(const std::vector<Value>& values) {
    KeyNumbers<sizeof(Value) / 4> numbers(values.size());
    std::vector<std::uint32_t> first_of_number;
    std::vector<std::uint32_t> result;
    result.reserve(values.size());
    for (const Value& value : values) {
        const auto number =
            numbers.number_of(std::bit_cast<typename KeyNumbers<sizeof(Value) / 4>::Key>(value));
        if (number == first_of_number.size()) {
            first_of_number.push_back(static_cast<std::uint32_t>(result.size()));
        }
        result.push_back(first_of_number[number]);
    }
    return result;
}

/// The same for positions that carry colours: both must agree.
std::vector<std::uint32_t> first_equal_vertex(const ObjStatements& statements) {
    if (statements.colors.empty()) return first_equal(statements.positions);
    std::vector<std::array<float, 7>> rows;
    rows.reserve(statements.positions.size());
    for (std::size_t i = 0; i < statements.positions.size(); ++i) {
        const glm::vec3& p = statements.positions[i];
        const glm::vec4& c = statements.colors[i];
        rows.push_back({p.x, p.y, p.z, c.r, c.g, c.b, c.a});
    }
    return first_equal(rows);
}

}  // namespace

std::vector<std::uint32_t> unify_vertices(const ObjStatements& statements, Mesh& mesh) {
    const std::vector<std::uint32_t> positions = first_equal_vertex(statements);
    const std::vector<std::uint32_t> texcoords = first_equal(statements.texcoords);
    const std::vector<std::uint32_t> normals = first_equal(statements.normals);
    const bool has_texcoords = !statements.corners.empty() && statements.corners[0].texcoord >= 0;
    const bool has_normals = !statements.corners.empty() && statements.corners[0].normal >= 0;
    KeyNumbers<3> vertices(statements.positions.size());
    std::vector<std::uint32_t> vertex_of_corner;
    vertex_of_corner.reserve(statements.corners.size());
    for (const ObjCorner& corner : statements.corners) {
        assert((corner.texcoord >= 0) == has_texcoords && (corner.normal >= 0) == has_normals);
        vertex_of_corner.push_back(vertices.number_of(
            {positions[static_cast<std::uint32_t>(corner.position)],
             has_texcoords ? texcoords[static_cast<std::uint32_t>(corner.texcoord)] : 0,
             has_normals ? normals[static_cast<std::uint32_t>(corner.normal)] : 0}));
    }
    for (const auto& [position, texcoord, normal] : vertices.keys()) {
        mesh.positions.push_back(statements.positions[position]);
        if (!statements.colors.empty()) mesh.colors.push_back(statements.colors[position]);
        if (has_texcoords) mesh.texcoords.push_back(statements.texcoords[texcoord]);
        if (has_normals) mesh.normals.push_back(statements.normals[normal]);
    }
    return vertex_of_corner;
}

}  // namespace relief

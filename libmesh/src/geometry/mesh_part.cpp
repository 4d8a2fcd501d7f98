// SPDX-License-Identifier: Apache-2.0
// Tests: tests/mesh/geometry/mesh_part_test.cpp.
#include "relief/mesh/mesh_part.h"

#include <fmt/format.h>

#include <algorithm>

#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr std::uint32_t not_in_part = 0xffffffff;

/// The new number of each vertex, in the order of the old ones.
std::vector<std::uint32_t> numbered(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
    std::vector<std::uint32_t> numbers(mesh.positions.size(), not_in_part);
    for (const std::uint32_t triangle : triangles) {
        if (triangle >= mesh.triangles.size())
            throw InvalidInput(fmt::format("there is no triangle {}", triangle));
        for (int corner = 0; corner < 3; ++corner)
            numbers[mesh.triangles[triangle][corner]] = 0;
    }
    std::uint32_t next = 0;
    for (std::uint32_t& number : numbers) {
        if (number != not_in_part) number = next++;
    }
    return numbers;
}

template <typename Value>
std::vector<Value> used(const std::vector<Value>& values,
                        const std::vector<std::uint32_t>& numbers) {
    std::vector<Value> result;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (numbers[i] != not_in_part) result.push_back(values[i]);
    }
    return result;
}

/// The materials of the triangles, runs of the same one joined.
std::vector<MaterialRange> ranges_of(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
    std::vector<MaterialRange> result;
    if (mesh.material_ranges.empty()) return result;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const auto after =
            std::upper_bound(mesh.material_ranges.begin(), mesh.material_ranges.end(), triangles[i],
                             [](std::uint32_t triangle, const MaterialRange& range) {
                                 return triangle < range.first_triangle + range.triangle_count;
                             });
        if (result.empty() || result.back().material != after->material)
            result.push_back({i, 0, after->material});
        ++result.back().triangle_count;
    }
    return result;
}

}  // namespace

Mesh part_of(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
    validate(mesh);
    const std::vector<std::uint32_t> numbers = numbered(mesh, triangles);
    Mesh part;
    part.name = mesh.name;
    part.positions = used(mesh.positions, numbers);
    part.normals = used(mesh.normals, numbers);
    part.texcoords = used(mesh.texcoords, numbers);
    part.tangents = used(mesh.tangents, numbers);
    part.colors = used(mesh.colors, numbers);
    part.triangles.reserve(triangles.size());
    for (const std::uint32_t triangle : triangles) {
        const glm::uvec3 corners = mesh.triangles[triangle];
        part.triangles.emplace_back(numbers[corners.x], numbers[corners.y], numbers[corners.z]);
        if (!mesh.smoothing_groups.empty())
            part.smoothing_groups.push_back(mesh.smoothing_groups[triangle]);
    }
    part.material_ranges = ranges_of(mesh, triangles);
    return part;
}

}  // namespace relief

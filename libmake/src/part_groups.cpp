// SPDX-License-Identifier: Apache-2.0
// The parts of a dense mesh that a bake keeps apart. Tests: tests/make/part_matching_test.cpp.
#include "part_groups.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "geometry/weld.h"

namespace relief::make::detail {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

}  // namespace

NamedParts separate_parts(const Mesh& mesh, const NamedParts& parts) {
    if (parts.names.empty()) return {};
    relief::detail::DisjointSets sets(parts.names.size());
    std::map<std::string, std::uint32_t> first_of_name;
    for (std::uint32_t part = 0; part < parts.names.size(); ++part)
        sets.join(first_of_name.try_emplace(parts.names[part], part).first->second, part);
    const std::vector<std::uint32_t> place_of = relief::detail::weld_positions(mesh.positions);
    std::vector<std::uint32_t> part_at(mesh.positions.size(), none);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            std::uint32_t& part = part_at[place_of[mesh.triangles[i][corner]]];
            if (part == none) part = parts.part_of[i];
            sets.join(part, parts.part_of[i]);
        }
    }
    NamedParts result;
    std::vector<std::uint32_t> number_of(parts.names.size(), none);
    for (std::uint32_t part = 0; part < parts.names.size(); ++part) {
        const std::uint32_t set = sets.find(part);
        if (number_of[set] == none) {
            number_of[set] = static_cast<std::uint32_t>(result.names.size());
            result.names.push_back(parts.names[part]);
        } else if (first_of_name.at(parts.names[part]) == part) {
            result.names[number_of[set]] += " + " + parts.names[part];
        }
    }
    result.part_of.reserve(parts.part_of.size());
    for (const std::uint32_t part : parts.part_of)
        result.part_of.push_back(number_of[sets.find(part)]);
    return result;
}

std::vector<std::uint32_t> parts_of_copy(const Mesh& before, std::span<const std::uint32_t> part_of,
                                         const FramedMesh& after) {
    std::vector<std::uint32_t> part_of_vertex(before.positions.size(), 0);
    for (std::size_t i = 0; i < before.triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner)
            part_of_vertex[before.triangles[i][corner]] = part_of[i];
    }
    std::vector<std::uint32_t> result;
    result.reserve(after.mesh.triangles.size());
    for (const glm::uvec3& triangle : after.mesh.triangles)
        result.push_back(part_of_vertex[after.source_vertex[triangle.x]]);
    return result;
}

std::vector<MaterialRange> ranges_of(std::span<const std::uint32_t> part_of) {
    std::vector<MaterialRange> ranges;
    for (std::uint32_t i = 0; i < part_of.size(); ++i) {
        if (ranges.empty() || ranges.back().material != part_of[i])
            ranges.push_back({i, 0, part_of[i]});
        ++ranges.back().triangle_count;
    }
    return ranges;
}

std::vector<std::uint32_t> parts_of_ranges(const Mesh& mesh) {
    std::vector<std::uint32_t> part_of(mesh.triangles.size(), 0);
    for (const MaterialRange& range : mesh.material_ranges) {
        std::fill_n(part_of.begin() + range.first_triangle, range.triangle_count,
                    range.material.value_or(0));
    }
    return part_of;
}

BakedParts divided(const Mesh& high, const NamedParts& high_parts,
                   std::span<const std::uint32_t> low_parts) {
    const std::size_t count = high_parts.names.size();
    std::vector<std::vector<std::uint32_t>> triangles(count);
    for (std::uint32_t i = 0; i < high_parts.part_of.size(); ++i)
        triangles[high_parts.part_of[i]].push_back(i);
    BakedParts result;
    result.meshes.reserve(count);
    result.parts.resize(count);
    for (std::size_t part = 0; part < count; ++part) {
        result.meshes.push_back(part_of(high, triangles[part]));
        result.parts[part].high = std::span(&result.meshes[part], 1);
        result.parts[part].name = high_parts.names[part];
    }
    for (std::uint32_t i = 0; i < low_parts.size(); ++i)
        result.parts[low_parts[i]].triangles.push_back(i);
    std::erase_if(result.parts, [](const BakePart& part) { return part.triangles.empty(); });
    return result;
}

}  // namespace relief::make::detail

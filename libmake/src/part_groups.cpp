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

std::vector<std::uint32_t> pairs_of(std::span<const std::uint32_t> parts,
                                    std::span<const AlphaMode> alpha) {
    std::vector<std::uint32_t> pairs(std::max(parts.size(), alpha.size()), 0);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!parts.empty()) pairs[i] += alpha_count * parts[i];
        if (!alpha.empty()) pairs[i] += static_cast<std::uint32_t>(alpha[i]);
    }
    return pairs;
}

namespace {

std::string pair_name(std::uint32_t pair, const NamedParts& parts, bool has_alpha) {
    const std::string part = parts.names.empty() ? "" : parts.names[pair / alpha_count];
    if (!has_alpha) return part;
    const auto mode = std::string(enum_name(static_cast<AlphaMode>(pair % alpha_count)));
    return part.empty() ? mode : part + " (" + mode + ")";
}

}  // namespace

RayGroups ray_groups(const NamedParts& high_parts, std::span<const std::uint32_t> low_parts,
                     std::span<const AlphaMode> high_alpha, std::span<const AlphaMode> low_alpha) {
    const std::vector<std::uint32_t> none_of_high;
    const bool has_parts = !high_parts.names.empty() && !low_parts.empty();
    const bool has_alpha = !high_alpha.empty() && !low_alpha.empty();
    RayGroups groups;
    if (!has_parts && !has_alpha) return groups;
    const auto numbered = [&](bool with_alpha) {
        groups.of_high =
            pairs_of(has_parts ? std::span(high_parts.part_of) : std::span(none_of_high),
                     with_alpha ? high_alpha : std::span<const AlphaMode>());
        groups.of_low = pairs_of(has_parts ? low_parts : std::span<const std::uint32_t>(),
                                 with_alpha ? low_alpha : std::span<const AlphaMode>());
        std::map<std::uint32_t, std::uint32_t> number_of;
        for (const std::uint32_t pair : groups.of_high)
            number_of.try_emplace(pair, 0);
        groups.names.clear();
        for (auto& [pair, number] : number_of) {
            number = static_cast<std::uint32_t>(groups.names.size());
            groups.names.push_back(pair_name(pair, high_parts, with_alpha));
        }
        for (std::uint32_t& pair : groups.of_high)
            pair = number_of.at(pair);
        for (std::uint32_t& pair : groups.of_low) {
            const auto found = number_of.find(pair);
            if (found == number_of.end()) return false;
            pair = found->second;
        }
        return true;
    };
    if (has_alpha && numbered(true)) return groups;
    if (!has_parts || !numbered(false)) return {};
    return groups;
}

KeyedVertices::KeyedVertices(const Mesh& mesh, std::span<const std::uint32_t> keys,
                             std::size_t count)
    : counts_(count, 0) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  // Of vertices and keys.
    std::vector<std::uint32_t> last(mesh.positions.size(), none);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = mesh.triangles[i][corner];
            if (last[vertex] == keys[i]) continue;
            last[vertex] = keys[i];
            pairs.emplace_back(vertex, keys[i]);
        }
    }
    std::ranges::sort(pairs);
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    first_.assign(mesh.positions.size() + 1, 0);
    uses_.reserve(pairs.size());
    for (const auto& [vertex, key] : pairs) {
        ++first_[vertex + 1];
        uses_.push_back({key, counts_[key]++});
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        first_[v + 1] += first_[v];
}

std::uint32_t KeyedVertices::number(std::uint32_t vertex, std::uint32_t key) const {
    return std::ranges::find(of(vertex), key, &Use::key)->number;
}

std::vector<Mesh> divided(const Mesh& mesh, std::span<const std::uint32_t> keys,
                          std::size_t count) {
    const KeyedVertices vertices(mesh, keys, count);
    std::vector<Mesh> parts(count);
    const auto divide = [&](auto attribute) {
        const auto& values = mesh.*attribute;
        if (values.empty()) return;
        for (std::uint32_t key = 0; key < count; ++key)
            (parts[key].*attribute).reserve(vertices.vertex_count(key));
        for (std::uint32_t v = 0; v < values.size(); ++v) {
            for (const KeyedVertices::Use& use : vertices.of(v))
                (parts[use.key].*attribute).push_back(values[v]);
        }
    };
    divide(&Mesh::positions);
    divide(&Mesh::normals);
    divide(&Mesh::texcoords);
    divide(&Mesh::texcoords_2);
    divide(&Mesh::tangents);
    divide(&Mesh::colors);
    const auto add = [&](std::uint32_t triangle) {
        const glm::uvec3& t = mesh.triangles[triangle];
        const std::uint32_t key = keys[triangle];
        parts[key].triangles.emplace_back(vertices.number(t.x, key), vertices.number(t.y, key),
                                          vertices.number(t.z, key));
    };
    if (mesh.material_ranges.empty()) {
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
            add(i);
    }
    for (const MaterialRange& range : mesh.material_ranges) {
        for (std::uint32_t i = 0; i < range.triangle_count; ++i) {
            const std::uint32_t triangle = range.first_triangle + i;
            Mesh& part = parts[keys[triangle]];
            std::vector<MaterialRange>& ranges = part.material_ranges;
            if (ranges.empty() || ranges.back().material != range.material)
                ranges.push_back(
                    {static_cast<std::uint32_t>(part.triangles.size()), 0, range.material});
            ++ranges.back().triangle_count;
            add(triangle);
        }
    }
    for (Mesh& part : parts)
        part.name = mesh.name;
    return parts;
}

BakedParts divided(const Mesh& high, std::span<const std::uint32_t> high_keys,
                   std::span<const std::uint32_t> low_keys, std::span<const std::string> names) {
    BakedParts result;
    result.meshes = divided(high, high_keys, names.size());
    result.parts.resize(names.size());
    for (std::size_t part = 0; part < names.size(); ++part) {
        result.parts[part].high = std::span(&result.meshes[part], 1);
        result.parts[part].name = names[part];
    }
    for (std::uint32_t i = 0; i < low_keys.size(); ++i)
        result.parts[low_keys[i]].triangles.push_back(i);
    std::erase_if(result.parts, [](const BakePart& part) { return part.triangles.empty(); });
    return result;
}

}  // namespace relief::make::detail

// SPDX-License-Identifier: Apache-2.0
// Names of ids. Tests: tests/make/asset_ids_test.cpp.
#include "asset_ids.h"

#include <algorithm>
#include <set>

namespace relief::make::detail {

std::vector<NamedTriangles> asset_ids(const Mesh& mesh, const NamedParts& parts,
                                      std::span<const std::string> material_names) {
    std::vector<NamedTriangles> by_material = names_by_material(mesh, material_names);
    if (parts.names.size() < 2) return by_material;
    std::set<std::string> known;
    for (const MaterialRange& range : mesh.material_ranges) {
        if (range.material && range.triangle_count > 0) {
            const auto named = std::ranges::find(by_material, range.first_triangle,
                                                 &NamedTriangles::first_triangle);
            known.insert(named->name);
        }
    }
    std::vector<NamedTriangles> result;
    const auto add_parts = [&](std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t i = first; i < last; ++i) {
            if (i > first && parts.part_of[i] == parts.part_of[i - 1]) continue;
            const std::string& name = parts.names[parts.part_of[i]];
            result.push_back({i, known.contains(name) ? name + " (part)" : name});
        }
    };
    if (mesh.material_ranges.empty())
        add_parts(0, static_cast<std::uint32_t>(mesh.triangles.size()));
    std::size_t next = 0;  // Of `by_material`, which has an entry for each range with triangles.
    for (const MaterialRange& range : mesh.material_ranges) {
        if (range.triangle_count == 0) continue;
        if (range.material) {
            result.push_back(by_material[next]);
        } else {
            add_parts(range.first_triangle, range.first_triangle + range.triangle_count);
        }
        ++next;
    }
    return result;
}

std::vector<std::vector<NamedTriangles>> divided(std::span<const NamedTriangles> ids,
                                                 std::span<const std::uint32_t> keys,
                                                 std::size_t count) {
    std::vector<std::vector<NamedTriangles>> result(count);
    std::vector<std::uint32_t> triangles(count, 0);
    std::size_t id = 0;
    for (std::uint32_t i = 0; i < keys.size(); ++i) {
        while (id + 1 < ids.size() && ids[id + 1].first_triangle <= i)
            ++id;
        std::vector<NamedTriangles>& names = result[keys[i]];
        if (names.empty() || names.back().name != ids[id].name)
            names.push_back({triangles[keys[i]], ids[id].name});
        ++triangles[keys[i]];
    }
    return result;
}

}  // namespace relief::make::detail

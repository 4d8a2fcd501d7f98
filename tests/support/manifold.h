// SPDX-License-Identifier: Apache-2.0
/// \file
/// Counts of the places at which a mesh is not an oriented 2-manifold. Equal positions count as
/// one. Written independently of the library.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief::test {

struct ManifoldFaults {
    std::size_t boundary_edges = 0;
    std::size_t crowded_edges = 0;  ///< Of three or more triangles.
    std::size_t twisted_edges = 0;  ///< Of two triangles in the same direction.
    std::size_t fans = 0;           ///< Fans of triangles at a position beyond the first.
    std::size_t collapsed = 0;      ///< Triangles with two corners at one position.

    [[nodiscard]] bool is_manifold() const {
        return crowded_edges + twisted_edges + fans + collapsed == 0;
    }
    [[nodiscard]] bool is_watertight() const { return is_manifold() && boundary_edges == 0; }
};

inline ManifoldFaults manifold_faults(const Mesh& mesh) {
    ManifoldFaults faults;
    std::map<std::tuple<float, float, float>, std::uint32_t> numbers;
    std::vector<glm::uvec3> triangles;
    for (const glm::uvec3& triangle : mesh.triangles) {
        glm::uvec3 welded(0);
        for (int k = 0; k < 3; ++k) {
            const glm::vec3& p = mesh.positions[triangle[k]];
            welded[k] =
                numbers.try_emplace({p.x, p.y, p.z}, std::uint32_t(numbers.size())).first->second;
        }
        if (welded.x == welded.y || welded.y == welded.z || welded.z == welded.x)
            ++faults.collapsed;
        else
            triangles.push_back(welded);
    }
    // For each edge from its smaller end: the triangles, and whether they run along it.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::pair<std::size_t, bool>>>
        edges;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = triangles[t][k];
            const std::uint32_t b = triangles[t][(k + 1) % 3];
            edges[std::minmax({a, b})].emplace_back(t, a < b);
        }
    }
    // Sets of triangle corners that are joined across edges.
    std::vector<std::size_t> parent(3 * triangles.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t i) {
        while (parent[i] != i)
            i = parent[i] = parent[parent[i]];
        return i;
    };
    const auto corner_at = [&](std::size_t t, std::uint32_t vertex) {
        std::size_t k = 0;
        while (triangles[t][int(k)] != vertex)
            ++k;
        return 3 * t + k;
    };
    for (const auto& [ends, users] : edges) {
        faults.boundary_edges += users.size() == 1 ? 1 : 0;
        faults.crowded_edges += users.size() > 2 ? 1 : 0;
        faults.twisted_edges += users.size() == 2 && users[0].second == users[1].second ? 1 : 0;
        for (const auto& user : users) {
            for (const std::uint32_t end : {ends.first, ends.second})
                parent[root(corner_at(user.first, end))] = root(corner_at(users[0].first, end));
        }
    }
    std::vector<std::pair<std::uint32_t, std::size_t>> fans;
    for (std::size_t c = 0; c < parent.size(); ++c)
        fans.emplace_back(triangles[c / 3][int(c % 3)], root(c));
    std::sort(fans.begin(), fans.end());
    fans.erase(std::unique(fans.begin(), fans.end()), fans.end());
    for (std::size_t i = 1; i < fans.size(); ++i)
        faults.fans += fans[i].first == fans[i - 1].first ? 1 : 0;
    return faults;
}

}  // namespace relief::test

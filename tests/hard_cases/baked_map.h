// SPDX-License-Identifier: Apache-2.0
/// \file
/// A whole map for the hard cases of the baker, and what can be wrong with it in words.
#pragma once

#include <fmt/format.h>

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "relief/mesh/bake.h"
#include "relief/mesh/direction_error.h"

namespace relief::test {

/// Texels along each side, where a case says nothing else.
inline constexpr int bake_side = 16;
inline constexpr std::size_t bake_texels = std::size_t{bake_side} * bake_side;

inline const glm::dvec3 flat_normal(0, 0, 1);

struct HardBake {
    std::vector<float> normals, heights;
    std::vector<TexelState> states;
    BakeResult result;
    Report report;

    [[nodiscard]] double degrees(std::size_t texel, const glm::dvec3& expected) const {
        return degrees_between({normals[3 * texel], normals[3 * texel + 1], normals[3 * texel + 2]},
                               expected);
    }
};

/// \param options  their layers are set here
inline HardBake baked(const std::vector<Mesh>& high, const Mesh& low, BakeOptions options) {
    HardBake map;
    options.layers.heights = true;
    map.result = bake_normals(
        high, low, options,
        [&](const BakedRows& rows) {
            map.normals.insert(map.normals.end(), rows.normals.begin(), rows.normals.end());
            map.heights.insert(map.heights.end(), rows.heights.begin(), rows.heights.end());
            map.states.insert(map.states.end(), rows.states.begin(), rows.states.end());
        },
        map.report);
    return map;
}

/// A map of 16 x 16 texels.
inline HardBake baked(const std::vector<Mesh>& high, const Mesh& low, int padding = 0) {
    BakeOptions options;
    options.width = bake_side;
    options.height = bake_side;
    options.padding = padding;
    return baked(high, low, options);
}

inline Mesh moved(Mesh mesh, const glm::vec3& by) {
    for (glm::vec3& position : mesh.positions)
        position += by;
    return mesh;
}

/// Every texel baked, this direction and this height.
inline std::string not_all(const HardBake& map, const glm::dvec3& normal, double height) {
    for (std::size_t i = 0; i < map.states.size(); ++i) {
        if (map.states[i] != TexelState::baked) return fmt::format("texel {} is not baked", i);
        if (!(map.degrees(i, normal) < 0.001))
            return fmt::format("texel {} is {} degrees off", i, map.degrees(i, normal));
        if (!(std::abs(map.heights[i] - height) < 1e-5))
            return fmt::format("texel {} is {} high", i, map.heights[i]);
    }
    return "";
}

}  // namespace relief::test

// SPDX-License-Identifier: Apache-2.0
/// \file
/// A whole baked map in memory, for the tests of the baker.
#pragma once

#include <algorithm>
#include <vector>

#include "relief/mesh/bake.h"
#include "relief/mesh/mesh.h"

namespace relief::test {

struct BakedImage {
    std::vector<float> normals, heights, occlusion, curvature, positions, colors, opacity, surface,
        emission, bent_normals, thickness, ids;
    std::vector<TexelState> states;
    BakeResult result;
    Report report;

    [[nodiscard]] glm::dvec3 normal(std::size_t texel) const {
        return {normals[3 * texel], normals[3 * texel + 1], normals[3 * texel + 2]};
    }
    [[nodiscard]] glm::dvec3 bent_normal(std::size_t texel) const {
        return {bent_normals[3 * texel], bent_normals[3 * texel + 1], bent_normals[3 * texel + 2]};
    }
    [[nodiscard]] std::size_t count(TexelState state) const {
        return static_cast<std::size_t>(std::count(states.begin(), states.end(), state));
    }
};

inline void append(BakedImage& image, const BakedRows& rows) {
    const auto add = [](auto& all, const auto& more) {
        all.insert(all.end(), more.begin(), more.end());
    };
    add(image.normals, rows.normals);
    add(image.heights, rows.heights);
    add(image.occlusion, rows.occlusion);
    add(image.curvature, rows.curvature);
    add(image.positions, rows.positions);
    add(image.colors, rows.colors);
    add(image.opacity, rows.opacity);
    add(image.surface, rows.surface);
    add(image.emission, rows.emission);
    add(image.bent_normals, rows.bent_normals);
    add(image.thickness, rows.thickness);
    add(image.ids, rows.ids);
    add(image.states, rows.states);
}

inline BakedImage bake(const std::vector<Mesh>& high, const Mesh& low, const BakeOptions& options) {
    BakedImage image;
    image.result = bake_normals(
        high, low, options, [&](const BakedRows& rows) { append(image, rows); }, image.report);
    return image;
}

/// Options for a map of this size with heights and otherwise default values.
inline BakeOptions sized(int width, int height) {
    BakeOptions options;
    options.map.width = width;
    options.map.height = height;
    options.map.layers.heights = true;
    return options;
}

inline Mesh moved(Mesh mesh, float scale, const glm::vec3& by) {
    for (glm::vec3& position : mesh.positions)
        position = position * scale + by;
    return mesh;
}

/// A square with waves along x, and their normals.
inline Mesh waves(int cells, double frequency) {
    Mesh mesh = make_quad(cells);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        glm::vec3& p = mesh.positions[i];
        const double x = frequency * p.x;
        p.z = static_cast<float>(0.3 / frequency * std::sin(x));
        mesh.normals[i] = glm::normalize(glm::vec3(-0.3 * std::cos(x), 0.0, 1.0));
    }
    return mesh;
}

}  // namespace relief::test

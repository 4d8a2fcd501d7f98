// SPDX-License-Identifier: Apache-2.0
/// \file
/// A whole baked map in memory, for the tests of the baker.
#pragma once

#include <algorithm>
#include <vector>

#include "relief/mesh/bake.h"

namespace relief::test {

struct BakedImage {
    std::vector<float> normals, heights, occlusion, curvature, positions, colors;
    std::vector<TexelState> states;
    BakeResult result;
    Report report;

    [[nodiscard]] glm::dvec3 normal(std::size_t texel) const {
        return {normals[3 * texel], normals[3 * texel + 1], normals[3 * texel + 2]};
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
    add(image.states, rows.states);
}

inline BakedImage bake(const std::vector<Mesh>& high, const Mesh& low, const BakeOptions& options) {
    BakedImage image;
    image.result = bake_normals(
        high, low, options, [&](const BakedRows& rows) { append(image, rows); }, image.report);
    return image;
}

/// A map of so many texels, with heights; all else as usual.
inline BakeOptions sized(int width, int height) {
    BakeOptions options;
    options.width = width;
    options.height = height;
    options.layers.heights = true;
    return options;
}

}  // namespace relief::test

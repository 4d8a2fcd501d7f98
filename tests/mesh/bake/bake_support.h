// SPDX-License-Identifier: Apache-2.0
/// \file
/// A whole baked map in memory, for the tests of the baker.
#pragma once

#include <algorithm>
#include <vector>

#include "relief/mesh/bake.h"

namespace relief::test {

struct BakedImage {
    std::vector<float> normals, heights;
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
    image.normals.insert(image.normals.end(), rows.normals.begin(), rows.normals.end());
    image.heights.insert(image.heights.end(), rows.heights.begin(), rows.heights.end());
    image.states.insert(image.states.end(), rows.states.begin(), rows.states.end());
}

inline BakedImage bake(const std::vector<Mesh>& high, const Mesh& low, const BakeOptions& options) {
    BakedImage image;
    image.result = bake_normals(
        high, low, options, [&](const BakedRows& rows) { append(image, rows); }, image.report);
    return image;
}

/// A map of so many texels; all else as usual.
inline BakeOptions sized(int width, int height) {
    BakeOptions options;
    options.width = width;
    options.height = height;
    return options;
}

}  // namespace relief::test

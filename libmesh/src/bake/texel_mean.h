// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a texel that is filled becomes: the mean of others, of directions the mean direction.
/// Tests: tests/mesh/bake/dilation_test.cpp, border_fill_test.cpp.
#pragma once

#include <cstddef>
#include <span>

#include "bake/baked_layers.h"
#include "geometry/direction.h"

namespace relief {

/// \param values  of a layer, all of its channels for each texel
/// \param from    at least one
/// \param to      gets the mean; in the same layer or another place
inline void average(const BakedLayer& layer, std::span<const float> values,
                    std::span<const std::size_t> from, float* to) {
    if (!layer.has_directions) {
        for (std::size_t channel = 0; channel < layer.channels; ++channel) {
            double sum = 0.0;
            for (const std::size_t texel : from)
                sum += values[layer.channels * texel + channel];
            to[channel] = static_cast<float>(sum / static_cast<double>(from.size()));
        }
        return;
    }
    const auto direction = [&](std::size_t texel) {
        return glm::dvec3(values[3 * texel], values[3 * texel + 1], values[3 * texel + 2]);
    };
    glm::dvec3 sum(0.0);
    for (const std::size_t texel : from)
        sum += direction(texel);
    const bool cancels = glm::length(sum) < 1e-6 * static_cast<double>(from.size());
    const glm::vec3 mean = rounded(cancels ? direction(from.front()) : direction_or_zero(sum));
    for (int axis = 0; axis < 3; ++axis)
        to[axis] = mean[axis];
}

}  // namespace relief

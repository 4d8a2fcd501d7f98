// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the vectors of a map are like, counted in one pass.
/// Tests: tests/mesh/image/check/normal_map_check_test.cpp.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "image/check/map_vectors.h"

namespace relief {

/// Sums over a map. A texel whose three samples are the same is black, white or grey, a background
/// or a height, and no vector.
struct MapStatistics {
    std::size_t texels = 0;   ///< That were looked at.
    std::size_t equal = 0;    ///< Whose samples are all the same.
    std::size_t vectors = 0;  ///< The others, if finite: what all the rest is about.
    std::size_t upwards = 0;  ///< z above 0.
    std::size_t in_disk = 0;  ///< x and y within the unit disk, to within 5 %.
    glm::dvec3 mean{};
    VectorLengths lengths;
    std::array<bool, 4> constant{};  ///< By channel.
    /// Of these `equal`, not as long as a normal, nor without direction: 0.75 to 1.25.
    std::size_t background = 0;
    FoundMapCondition not_finite{MapCondition::texel_not_finite, 0, {}};
    FoundMapCondition without_direction{MapCondition::texel_without_direction, 0, {}};
    FoundMapCondition facing_back{MapCondition::texel_facing_back, 0, {}};

    [[nodiscard]] double share(std::size_t count) const {
        return vectors == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(vectors);
    }
};

/// \param step  looks at every step-th texel only
MapStatistics map_statistics(const Image& map, const SampleMeaning& meaning, std::size_t step = 1);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/map_errors_test.cpp.
#include "map_errors.h"

#include <fmt/format.h>

#include "parallel.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/error.h"

namespace relief {

Image angles_of(const Image& normals, std::span<const glm::dvec3> truth) {
    if (normals.channels != 3 || normals.bits() != 32 ||
        normals.sample_count() != 3 * truth.size()) {
        throw InvalidInput(fmt::format("a map of {} x {} texels of {} channels has no {} normals",
                                       normals.width, normals.height, normals.channels,
                                       truth.size()));
    }
    Image angles = make_image(normals.width, normals.height, 1, 32, ColorSpace::data);
    const std::span<const float> n = normals.as<float>();
    const std::span<float> degrees = angles.as<float>();
    parallel_for(degrees.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 found(n[3 * i], n[3 * i + 1], n[3 * i + 2]);
            degrees[i] = static_cast<float>(degrees_between(found, truth[i]));
        }
    });
    return angles;
}

std::vector<float> inner_angles(const Image& normals, std::span<const glm::dvec3> truth,
                                int margin) {
    const Image angles = angles_of(normals, truth);
    const std::span<const float> all = angles.as<float>();
    std::vector<float> counted;
    for (int y = margin; y < angles.height - margin; ++y) {
        const auto row = static_cast<std::ptrdiff_t>(y) * angles.width;
        counted.insert(counted.end(), all.begin() + row + margin,
                       all.begin() + row + angles.width - margin);
    }
    return counted;
}

AngleDistribution map_errors(const Image& normals, std::span<const glm::dvec3> truth, int margin) {
    return angle_distribution(inner_angles(normals, truth, margin));
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "support/random_frames.h"

#include <random>

namespace relief::test {
namespace {

glm::dvec3 random_direction(std::mt19937_64& random) {
    // Standard distributions differ between libraries; the generator does not.
    const auto coordinate = [&] { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1.0; };
    while (true) {
        // The order of evaluation of function arguments is unspecified, so each value has its own
        // statement.
        const double x = coordinate();
        const double y = coordinate();
        const glm::dvec3 vector(x, y, coordinate());
        const double length = glm::length(vector);
        if (length > 0.1 && length < 1.0) return vector / length;
    }
}

}  // namespace

void ReferenceFrames::add(const glm::dvec3& normal, const glm::dvec3& tangent, float w) {
    normals.push_back(normal);
    tangents.push_back(tangent);
    float_normals.emplace_back(normal);
    float_tangents.emplace_back(glm::vec3(tangent), w);
}

ReferenceFrames random_frames(std::size_t count) {
    std::mt19937_64 random(1);
    ReferenceFrames frames;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 normal = random_direction(random);
        const glm::dvec3 other = random_direction(random);
        frames.add(normal, glm::normalize(other - normal * glm::dot(normal, other)),
                   i % 2 == 0 ? 1.0F : -1.0F);
    }
    return frames;
}

}  // namespace relief::test

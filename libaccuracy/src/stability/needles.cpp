// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/needles_test.cpp.
#include "stability/needles.h"

#include <array>
#include <random>

namespace relief {
namespace {

/// Evenly spread over the ball of radius 1, away from its middle; the same on every machine.
class Directions {
  public:
    explicit Directions(std::uint32_t seed) : numbers_(seed) {}

    glm::dvec3 next() {
        for (;;) {
            const glm::dvec3 v(coordinate(), coordinate(), coordinate());
            const double length = glm::length(v);
            if (length > 0.3 && length < 1.0) return v;
        }
    }

  private:
    double coordinate() { return static_cast<double>(numbers_()) * 0x1p-31 - 1.0; }

    std::mt19937 numbers_;
};

}  // namespace

Needles make_needles(std::size_t count, double width, std::uint32_t seed) {
    Needles needles;
    Directions directions(seed);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 along = glm::normalize(directions.next());
        const glm::dvec3 across = glm::normalize(glm::cross(along, directions.next()));
        const glm::vec3 b(along);
        const glm::vec3 a(width * directions.next());
        const glm::vec3 c(glm::dvec3(a) + width * across);
        // (b - a) x (c - a): only a and c, which are equally small, lie near each other. Over the
        // width, so that no product is too small for doubles.
        const glm::dvec3 side = (glm::dvec3(c) - glm::dvec3(a)) / width;
        const glm::dvec3 normal = glm::normalize(glm::cross(glm::dvec3(b) - glm::dvec3(a), side));
        const auto first = static_cast<std::uint32_t>(3 * i);
        const std::array corners = {a, b, c};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            needles.mesh.positions.push_back(corners.at((corner + i) % 3));
            needles.normals.push_back(normal);
        }
        needles.mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return needles;
}

}  // namespace relief

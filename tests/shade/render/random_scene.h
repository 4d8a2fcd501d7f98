// SPDX-License-Identifier: Apache-2.0
/// \file
/// Random scenes for property-based tests: a few meshes under a few lights, with random
/// combinations of the members of Material. The same seed gives the same scene on every machine.
#pragma once

#include <cstdint>
#include <random>

#include "relief/shade/scene.h"

namespace relief::test {

/// Random numbers. The distributions of the standard library differ between machines.
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}

    float between(float low, float high) {
        const double share = static_cast<double>(engine_() >> 11) * 0x1p-53;
        return static_cast<float>(low + (high - low) * share);
    }
    bool chance(double probability) {
        return between(0.0F, 1.0F) < static_cast<float>(probability);
    }
    std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
    glm::vec3 color(float low = 0.0F, float high = 1.0F) {
        const float red = between(low, high);
        const float green = between(low, high);
        return {red, green, between(low, high)};
    }
    glm::vec3 direction();

  private:
    std::mt19937_64 engine_;
};

/// A smooth image of random colors. It has float samples, so that OpenGL filters them at full
/// precision.
Image random_image(Dice& dice, int channels, ColorSpace space);

/// A height field with moderate slopes at strength 1.
Image random_heights(Dice& dice);

/// Normals with angles of up to 40 degrees to (0, 0, 1), as 16-bit codes.
Image random_normals(Dice& dice);

/// Six faces of a smooth random environment. By default they are so coarse that their reflection in
/// a sphere is magnified.
shade::Environment random_environment(Dice& dice, int face_size = 6);

shade::Scene random_scene(std::uint64_t seed);

}  // namespace relief::test

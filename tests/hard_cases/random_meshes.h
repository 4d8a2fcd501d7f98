// SPDX-License-Identifier: Apache-2.0
/// \file
/// Random meshes in which many things are wrong at once.
#pragma once

#include <cstdint>
#include <random>

#include "relief/mesh/mesh.h"

namespace relief::test {

/// Random values. The standard distributions differ between libraries, so the class has its own.
/// The order of calls determines the values; braced initializers keep it.
class Dice {
  public:
    explicit Dice(std::uint32_t seed) : generator_(seed) {}

    std::uint32_t below(std::uint32_t limit) {
        return static_cast<std::uint32_t>(generator_()) % limit;
    }
    bool one_in(std::uint32_t n) { return below(n) == 0; }

    /// Returns a multiple of 1/4 from -1 to 1, so that values often coincide and cancel.
    float common() { return 0.25F * static_cast<float>(below(9)) - 1.0F; }

    /// Returns a value from -1 to 1 with random digits.
    float any_digits() { return static_cast<float>(generator_()) * 0x1p-31F - 1.0F; }

    /// Returns a huge, tiny or non-finite value.
    float special();

    /// \param rarity  one value in `rarity` is special
    float value(std::uint32_t rarity, bool is_common) {
        if (one_in(rarity)) return special();
        return is_common ? common() : any_digits();
    }

  private:
    std::mt19937 generator_;
};

/// Up to 12 vertices and 24 triangles with any positions, normals and texture coordinates: many
/// coincide, and some are huge, tiny or not finite.
Mesh hostile_mesh(std::uint32_t seed);

/// A finite mesh with normals and texture coordinates, and often with smoothing groups: a sphere of
/// 5 to 20 segments with collapsed triangles at its poles, a wavy grid with a mirrored texture,
/// needles, or triangles between the points of a lattice (non-manifold, on lines, duplicates).
Mesh random_mesh(std::uint32_t seed);

}  // namespace relief::test

// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a ray came by on its way to a colour: every discrete decision (which texel, which side of a
/// lamp), and every place in a texture. Rays whose decisions differ may differ by a jump, so that
/// rounding may decide what is seen; places that lie far apart mean a texture that OpenGL averages.
/// Tests: tests/shade/reference/edges_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace relief::reference {

class Trace {
  public:
    void decide(std::int64_t decision) {
        constexpr std::uint64_t fnv_prime = 0x100000001B3ULL;
        hash_ = (hash_ ^ static_cast<std::uint64_t>(decision)) * fnv_prime;
        hash_ ^= hash_ >> 29;
    }

    /// \param texels  where a texture is looked up, in texels; of a cube map, a direction as long
    ///                as texels pass by in a radian
    void look_up(const glm::dvec3& texels) { places_.push_back(texels); }

    [[nodiscard]] bool decided_like(const Trace& other) const {
        return hash_ == other.hash_ && places_.size() == other.places_.size();
    }
    [[nodiscard]] const std::vector<glm::dvec3>& places() const { return places_; }

  private:
    std::uint64_t hash_ = 0xCBF29CE484222325ULL;
    std::vector<glm::dvec3> places_;
};

}  // namespace relief::reference

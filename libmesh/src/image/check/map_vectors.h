// SPDX-License-Identifier: Apache-2.0
/// \file
/// The vectors that the texels of a map hold, whatever their length: for those who judge a map
/// before they take it for normals. Tests: tests/mesh/image/check/normal_map_check_test.cpp.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <span>
#include <type_traits>
#include <vector>

#include "image/largest_sample.h"
#include "image/normals/normal_coding.h"
#include "image/texel_loops.h"
#include "relief/mesh/image.h"
#include "relief/mesh/normal_map_check.h"

namespace relief {

/// How samples are to be understood.
struct SampleMeaning {
    FlatCode flat = FlatCode::middle;
    StoredCurve curve = StoredCurve::none;
    bool is_signed = false;   ///< Float samples hold the component itself.
    bool z_is_stored = true;  ///< Else it is rebuilt, upwards.
};

/// One component, from the sample as it is stored.
template <typename Sample>
float component_of(Sample sample, const SampleMeaning& meaning) {
    if constexpr (std::is_same_v<Sample, float>) {
        if (meaning.is_signed) return sample;
    }
    if (meaning.curve == StoredCurve::none)
        return static_cast<float>(NormalCoding<Sample>{meaning.flat}.decoded(sample));
    const float stored = static_cast<float>(sample) / static_cast<float>(largest_sample<Sample>);
    const float meant = meaning.curve == StoredCurve::srgb_encoded ? linear_from_srgb(stored)
                                                                   : srgb_from_linear(stored);
    return 2.0F * meant - 1.0F;
}

/// Reads texels as vectors; y as it is stored, up or down. Codes go through a table.
template <typename Sample>
class MapVectors {
  public:
    MapVectors(const Image& map, const SampleMeaning& meaning)
        : samples_(map.as<Sample>()),
          channels_(static_cast<std::size_t>(map.channels)),
          meaning_(meaning) {
        if constexpr (!std::is_same_v<Sample, float>) {
            for (std::size_t code = 0; code <= std::numeric_limits<Sample>::max(); ++code)
                table_.push_back(component_of(static_cast<Sample>(code), meaning));
        }
    }

    [[nodiscard]] float component(std::size_t texel, std::size_t channel) const {
        const Sample sample = samples_[texel * channels_ + channel];
        if constexpr (std::is_same_v<Sample, float>)
            return component_of(sample, meaning_);
        else
            return table_[sample];
    }
    [[nodiscard]] glm::vec3 operator[](std::size_t texel) const {
        const float x = component(texel, 0);
        const float y = component(texel, 1);
        if (meaning_.z_is_stored) return {x, y, component(texel, 2)};
        return {x, y, std::sqrt(std::max(0.0F, 1.0F - x * x - y * y))};
    }
    [[nodiscard]] std::size_t channels() const { return channels_; }

  private:
    std::span<const Sample> samples_;
    std::size_t channels_;
    SampleMeaning meaning_;
    std::vector<float> table_;
};

}  // namespace relief

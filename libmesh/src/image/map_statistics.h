// SPDX-License-Identifier: Apache-2.0
/// \file
/// Statistics of a map whose kind is not known yet: its vectors in one pass, the direction of
/// green, and the code of flat texels.
///
/// The direction of green follows from a property of surfaces: the derivative in y of the slope
/// along x equals the derivative in x of the slope along y. With inverted green, the two have
/// opposite signs. The same test tells whether alpha holds heights.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <type_traits>
#include <vector>

#include "image/normal_coding.h"
#include "image/texel_loops.h"
#include "relief/mesh/image.h"
#include "relief/mesh/normal_map_check.h"

namespace relief::detail {
/// The meaning of samples.
struct SampleMeaning {
    FlatCode flat = FlatCode::middle;
    StoredCurve curve = StoredCurve::none;
    bool is_signed = false;   ///< Float samples hold the component itself.
    bool z_is_stored = true;  ///< Otherwise z is computed from x and y and points upwards.
};

/// Returns the component that a stored sample means.
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

/// Reads texels as vectors, with y as stored, up or down. Codes are decoded by a table.
template <typename Sample>
class MapVectors {
  public:
    MapVectors(const ImageView& map, const SampleMeaning& meaning)
        : map_(map),
          samples_(map.contiguous<Sample>()),
          channels_(static_cast<std::size_t>(map.channels)),
          meaning_(meaning) {
        if constexpr (!std::is_same_v<Sample, float>) {
            for (std::size_t code = 0; code <= std::numeric_limits<Sample>::max(); ++code)
                table_.push_back(component_of(static_cast<Sample>(code), meaning));
        }
    }

    [[nodiscard]] float component(std::size_t texel, std::size_t channel) const {
        const Sample sample = samples_ != nullptr ? samples_[texel * channels_ + channel]
                                                  : map_.texel<Sample>(texel)[channel];
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
    ImageView map_;
    const Sample* samples_;  ///< Null if the rows are not contiguous.
    std::size_t channels_;
    SampleMeaning meaning_;
    std::vector<float> table_;
};

/// Sums over a map. A texel with three equal samples is black, white or gray: a background or a
/// height, not a vector.
struct MapStatistics {
    std::size_t texels = 0;   ///< The number of evaluated texels.
    std::size_t equal = 0;    ///< Texels with equal samples.
    std::size_t vectors = 0;  ///< All other finite texels. The fields below refer to these.
    std::size_t upwards = 0;  ///< Vectors with z above 0.
    std::size_t in_disk = 0;  ///< Vectors with x and y within the unit disk, to within 5%.
    glm::dvec3 mean{};
    VectorLengths lengths;
    std::array<bool, 4> constant{};  ///< By channel: whether all samples are equal.
    /// The number of `equal` texels that have a direction, but whose length is not within 0.75 to
    /// 1.25.
    std::size_t background = 0;
    MapConditionCount not_finite{MapCondition::texel_not_finite, 0, {}};
    MapConditionCount without_direction{MapCondition::texel_without_direction, 0, {}};
    MapConditionCount facing_back{MapCondition::texel_facing_back, 0, {}};

    [[nodiscard]] double share(std::size_t count) const {
        return vectors == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(vectors);
    }
};

/// \param step  only every step-th texel is evaluated
MapStatistics map_statistics(const ImageView& map, const SampleMeaning& meaning,
                             std::size_t step = 1);

struct SurfaceEvidence {
    GreenEvidence green;
    std::optional<double> alpha_correlation;  ///< The correlation of the slopes of alpha with those
                                              ///< of the normals; none without alpha.
};

/// \param map  at least two channels; y as stored
///
/// Texels that are not finite, face back or are steeper than 10 do not contribute, nor do their
/// neighbors. The map is evaluated as it is and averaged over 2, 4 and 8 texels, which reduces the
/// noise of few bits. The scale with the highest significance determines the result.
SurfaceEvidence surface_evidence(const ImageView& map, const SampleMeaning& meaning);

/// Counts of texels whose x and y both have one of the two codes below or the two codes above 127.5
/// (32767.5).
struct FlatEvidence {
    std::size_t near = 0;   ///< All of these texels.
    std::size_t lower = 0;  ///< Those of them with the lower code of zero, 127, for both x and y.

    /// A smooth surface contains all sixteen pairs of codes equally often; if texels are flat by
    /// intention, one pair is much more frequent. The criterion is at least 64 texels, and more
    /// than half of the near ones.
    [[nodiscard]] bool is_half() const { return lower >= 64 && 2 * lower > near; }
};

/// \param map  at least three channels; a map of 32 bits gives no evidence
FlatEvidence flat_evidence(const ImageView& map);

}  // namespace relief::detail

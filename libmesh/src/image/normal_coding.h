// SPDX-License-Identifier: Apache-2.0
/// \file
/// Encoding and decoding of one component of a unit normal. All encoders and decoders use these
/// formulas.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

#include "portable_math.h"
#include "relief/mesh/normal_map.h"

namespace relief::detail {

/// \param what  "normal map"
/// \throws InvalidInput if the memory for a result does not have `min_channels` to `max_channels`
///         of these bits and the size of the input
void check_target(const MutableImageView& target, const ImageView& input, int bits,
                  int min_channels, int max_channels, const char* what);

/// Copies texels of three samples to texels of two or four; the fourth is 1 (opaque). Integers are
/// copied as words, which takes a fifth of the time of single samples.
///
/// \param threes  followed by one more sample, whose value does not matter
template <typename Sample>
void spread_samples(const Sample* threes, std::size_t count, int channels, Sample* texels) {
    if (channels == 2) {
        for (std::size_t i = 0; i < count; ++i)
            std::memcpy(texels + 2 * i, threes + 3 * i, 2 * sizeof(Sample));
    } else if constexpr (std::is_same_v<Sample, float>) {
        for (std::size_t i = 0; i < count; ++i) {
            std::memcpy(texels + 4 * i, threes + 3 * i, 3 * sizeof(Sample));
            texels[4 * i + 3] = 1.0F;
        }
    } else {
        using Word = std::conditional_t<sizeof(Sample) == 1, std::uint32_t, std::uint64_t>;
        constexpr Sample largest = std::numeric_limits<Sample>::max();
        constexpr Word alpha = std::bit_cast<Word>(std::array<Sample, 4>{0, 0, 0, largest});
        for (std::size_t i = 0; i < count; ++i) {
            Word word;
            std::memcpy(&word, threes + 3 * i, sizeof(Word));
            word |= alpha;
            std::memcpy(texels + 4 * i, &word, sizeof(Word));
        }
    }
}

/// Codes of 8 or 16 bits with one of the two meanings of zero. Real is the type of the arithmetic.
template <typename Code, typename Real = double>
struct NormalCoding {
    static constexpr Real largest = std::numeric_limits<Code>::max();
    static constexpr Real middle = (largest + 1) / 2;
    FlatCode flat;

    /// Returns the number of code steps of a component of 1.
    static constexpr Real steps(FlatCode flat) {
        return flat == FlatCode::half ? largest / 2 : middle - 1;
    }

    // The cast truncates, which gives the nearest code after adding one half. There are no
    // branches, and codes are not narrowed, so that loops are vectorized. Loops also encode values
    // that are replaced afterwards: std::max() turns NaN into a number, because a cast of NaN is
    // undefined.
    RELIEF_INLINE static std::int32_t from_half_steps(Real steps) {
        // Zero lies between two codes, at largest / 2, so only the sum can be rounded.
        return static_cast<std::int32_t>(std::max(Real(0), middle + steps));
    }
    RELIEF_INLINE static std::int32_t from_middle_steps(Real steps) {
        return static_cast<std::int32_t>(middle) +
               static_cast<std::int32_t>(
                   std::max(-middle, steps + std::copysign(static_cast<Real>(0.5), steps)));
    }
    RELIEF_INLINE static Code to_half(Real component) {
        return static_cast<Code>(from_half_steps(largest / 2 * component));
    }
    RELIEF_INLINE static Code to_middle(Real component) {
        return static_cast<Code>(from_middle_steps((middle - 1) * component));
    }

    [[nodiscard]] Code encoded(Real component) const {
        return flat == FlatCode::half ? to_half(component) : to_middle(component);
    }

    /// Returns one of the two codes around the component: the one farther from zero (with
    /// FlatCode::half, the upper one) if the fraction exceeds the threshold, which lies in (0,1).
    /// Opposite components have mirrored codes; a value that a code represents exactly has that
    /// code.
    [[nodiscard]] RELIEF_INLINE Code dithered(Real component, Real threshold) const {
        const bool is_middle = flat == FlatCode::middle;
        const Real place = std::max(Real(0), is_middle ? (middle - 1) * std::abs(component)
                                                       : largest / 2 + largest / 2 * component);
        const auto below = static_cast<std::int32_t>(place);
        const std::int32_t code = below + (place - static_cast<Real>(below) > threshold ? 1 : 0);
        if (!is_middle) return static_cast<Code>(code);
        return static_cast<Code>(static_cast<std::int32_t>(middle) +
                                 (component < 0 ? -code : code));
    }

    [[nodiscard]] Real decoded(Code code) const {
        if (flat == FlatCode::middle) return std::max((code - middle) / (middle - 1), Real{-1});
        return 2 * code / largest - 1;
    }
};

/// Float samples are scaled to [0,1]. Zero is exactly 0.5, so there is no choice of a flat code.
template <typename Real>
struct NormalCoding<float, Real> {
    FlatCode flat;

    RELIEF_INLINE static float encoded(Real component) {
        return static_cast<float>((component + 1) / 2);
    }
    RELIEF_INLINE static float dithered(Real component, Real) { return encoded(component); }
    [[nodiscard]] static Real decoded(float sample) {
        return Real{2} * static_cast<Real>(sample) - 1;
    }
};

/// Decodes many samples: codes of 8 bits by a table.
template <typename Sample>
class SampleDecoder {
  public:
    explicit SampleDecoder(FlatCode flat) : coding_{flat} {
        if constexpr (sizeof(Sample) == 1) {
            for (std::size_t code = 0; code < table_.size(); ++code)
                table_[code] = coding_.decoded(static_cast<Sample>(code));
        }
    }
    [[nodiscard]] double operator()(Sample sample) const {
        if constexpr (sizeof(Sample) == 1)
            return table_[sample];
        else
            return coding_.decoded(sample);
    }

  private:
    NormalCoding<Sample> coding_;
    std::array<double, sizeof(Sample) == 1 ? 256 : 1> table_{};
};

/// Identifies the texels of a map that are read as exactly flat, see FlatTexels.
template <typename Sample>
class ExactFlat {
  public:
    /// \param codes  the codes of x and y, see flat_texel_codes()
    explicit ExactFlat(const std::optional<std::array<std::uint16_t, 2>>& codes) : codes_(codes) {}
    ExactFlat(const ImageView& map, FlatCode flat, FlatTexels texels, int x, int y) {
        if (texels == FlatTexels::exact && flat == FlatCode::half)
            codes_ = flat_texel_codes(map, x, y);
    }

    [[nodiscard]] bool is_flat(Sample x, Sample y) const {
        if constexpr (std::is_same_v<Sample, float>)
            return false;
        else
            return codes_ && x == (*codes_)[0] && y == (*codes_)[1];
    }

  private:
    std::optional<std::array<std::uint16_t, 2>> codes_;
};

}  // namespace relief::detail

// SPDX-License-Identifier: Apache-2.0
// Mip levels with a box filter, see image.h. 8-bit codes are converted to 16-bit light (or
// 16-bit numbers), which stays the format of all levels, and are encoded again for the result;
// floats stay floats. Even sizes, which are usual, average four texels. An odd size distributes its
// 2m + 1 texels over m, which takes three texels with weights that sum to 1.
#include "relief/mesh/image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "image/mip_rows.h"
#include "parallel.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr std::size_t samples_per_piece = 1 << 16;

/// An intermediate level: samples of 16 bits or float, linear.
template <typename Value>
struct Level {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<Value> values;
};

/// The source texels of one result along a row or column: up to three values, from `first` on.
struct Taps {
    std::size_t first = 0;
    std::array<float, 3> weights{};
    std::size_t count = 0;
};

/// \param size  the size of the level above; the result has max(size / 2, 1) texels
Taps taps_of(std::size_t size, std::size_t i) {
    if (size == 1) return {0, {1.0F}, 1};
    if (size % 2 == 0) return {2 * i, {0.5F, 0.5F}, 2};
    const auto m = static_cast<float>(size / 2);
    const auto at = static_cast<float>(i);
    const auto all = static_cast<float>(size);
    return {2 * i, {(m - at) / all, m / all, (at + 1.0F) / all}, 3};
}

template <typename Value>
Value rounded(float mean) {
    if constexpr (std::is_same_v<Value, float>) return mean;
    return static_cast<Value>(mean + 0.5F);
}

/// Computes one row of the result if a size is odd or 1.
/// \param down, rows  the rows that are averaged
template <int Channels, typename Value, typename Sample, typename Decode>
void halve_row(const Sample* rows, std::size_t width, const Taps& down, Decode decode, Value* row) {
    for (std::size_t x = 0; x < std::max<std::size_t>(width / 2, 1); ++x) {
        const Taps across = taps_of(width, x);
        for (std::size_t c = 0; c < Channels; ++c) {
            float sum = 0.0F;
            for (std::size_t j = 0; j < down.count; ++j) {
                const Sample* from = rows + (j * width + across.first) * Channels;
                for (std::size_t i = 0; i < across.count; ++i) {
                    sum += down.weights[j] * across.weights[i] *
                           static_cast<float>(decode(from[i * Channels + c], c));
                }
            }
            row[x * Channels + c] = rounded<Value>(sum);
        }
    }
}

/// Computes one row of the result if both sizes are even: means of four texels.
template <int Channels, typename Value, typename Sample, typename Decode>
void halve_even_row(const Sample* upper, std::size_t width, Decode decode, Value* row) {
    const Sample* lower = upper + width * Channels;
    for (std::size_t x = 0; x < width / 2; ++x) {
        for (std::size_t c = 0; c < Channels; ++c) {
            const std::size_t left = 2 * x * Channels + c;
            const std::size_t right = left + Channels;
            const auto sum = decode(upper[left], c) + decode(upper[right], c) +
                             decode(lower[left], c) + decode(lower[right], c);
            if constexpr (std::is_same_v<Value, float>) {
                row[x * Channels + c] = sum * 0.25F;
            } else {
                row[x * Channels + c] = static_cast<Value>((sum + 2U) >> 2U);
            }
        }
    }
}

/// \param decode  decode(sample, channel) gives a float, or a uint32_t within 16 bits
template <int Channels, typename Value, typename Sample, typename Decode>
Level<Value> halved(const Sample* above, std::size_t width, std::size_t height, Decode decode) {
    Level<Value> level{
        std::max<std::size_t>(width / 2, 1), std::max<std::size_t>(height / 2, 1), {}};
    const std::size_t row_size = level.width * Channels;
    level.values.resize(row_size * level.height);
    const bool is_even = width % 2 == 0 && height % 2 == 0;
    parallel_for(
        level.height, samples_per_piece / row_size + 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t y = begin; y < end; ++y) {
                Value* row = level.values.data() + y * row_size;
                if (is_even) {
                    halve_even_row<Channels>(above + 2 * y * width * Channels, width, decode, row);
                } else {
                    const Taps down = taps_of(height, y);
                    halve_row<Channels>(above + down.first * width * Channels, width, down, decode,
                                        row);
                }
            }
        });
    return level;
}

/// Computes all levels: the first from samples by `decode`, each other one from the level above.
template <int Channels, typename Value, typename Sample, typename Decode, typename Encode>
std::vector<Image> levels_of(const Image& image, Decode decode, Encode encode) {
    using Number = std::conditional_t<std::is_same_v<Value, float>, float, std::uint32_t>;
    const auto keep = [](Value value, std::size_t) { return static_cast<Number>(value); };
    std::vector<Image> result;
    auto width = static_cast<std::size_t>(image.width);
    auto height = static_cast<std::size_t>(image.height);
    Level<Value> level;
    while (width > 1 || height > 1) {
        level = result.empty()
                    ? halved<Channels, Value>(image.as<Sample>().data(), width, height, decode)
                    : halved<Channels, Value>(level.values.data(), width, height, keep);
        width = level.width;
        height = level.height;
        Image coded{
            static_cast<int>(width), static_cast<int>(height), Channels, image.color_space, {}};
        coded.samples = encode(level.values);
        result.push_back(std::move(coded));
    }
    return result;
}

// ---------------------------------------------------------------------------------------------
// Codes

/// 16-bit linear values of all 8-bit sRGB codes, and the inverse: the code with the nearest linear
/// value.
struct SrgbTables {
    std::array<std::uint16_t, 256> light{};
    std::vector<std::uint8_t> code = std::vector<std::uint8_t>(65536);

    SrgbTables() {
        const auto light_at = [](float coded) {
            return linear_from_srgb(coded / 255.0F) * 65535.0F;
        };
        std::size_t filled = 0;
        for (std::size_t c = 0; c < 256; ++c) {
            light[c] = static_cast<std::uint16_t>(light_at(static_cast<float>(c)) + 0.5F);
            const auto end =
                c == 255
                    ? code.size()
                    : static_cast<std::size_t>(std::ceil(light_at(static_cast<float>(c) + 0.5F)));
            for (; filled < end; ++filled)
                code[filled] = static_cast<std::uint8_t>(c);
        }
    }
};

std::uint8_t to_8_bits(std::uint16_t value) {
    return static_cast<std::uint8_t>((value + 128U) / 257U);
}

template <int Channels>
std::vector<Image> srgb_levels(const Image& image) {
    static const SrgbTables tables;
    constexpr std::size_t alpha = Channels % 2 == 0 ? Channels - 1 : Channels;
    const auto decode = [](std::uint8_t code, std::size_t channel) -> std::uint32_t {
        return channel == alpha ? code * 257U : tables.light[code];
    };
    const auto encode = [](const std::vector<std::uint16_t>& values) {
        std::vector<std::uint8_t> codes(values.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            codes[i] = i % Channels == alpha ? to_8_bits(values[i]) : tables.code[values[i]];
        return codes;
    };
    return levels_of<Channels, std::uint16_t, std::uint8_t>(image, decode, encode);
}

template <int Channels>
std::vector<Image> levels(const Image& image) {
    const auto same = [](const auto& values) { return values; };
    if (image.bits() == 32) {
        const auto keep = [](float value, std::size_t) { return value; };
        return levels_of<Channels, float, float>(image, keep, same);
    }
    if (image.bits() == 8 && image.color_space == ColorSpace::srgb) {
        return srgb_levels<Channels>(image);
    }
    if (image.bits() == 8) {
        const auto widen = [](std::uint8_t value, std::size_t) { return value * 257U; };
        const auto encode = [](const std::vector<std::uint16_t>& values) {
            std::vector<std::uint8_t> codes(values.size());
            std::transform(values.begin(), values.end(), codes.begin(), to_8_bits);
            return codes;
        };
        return levels_of<Channels, std::uint16_t, std::uint8_t>(image, widen, encode);
    }
    const auto keep = [](std::uint16_t value, std::size_t) { return std::uint32_t{value}; };
    return levels_of<Channels, std::uint16_t, std::uint16_t>(image, keep, same);
}

template <int Channels>
void halve_floats(std::size_t width, std::size_t height, std::size_t y, const float* rows,
                  float* row) {
    const auto keep = [](float value, std::size_t) { return value; };
    if (width % 2 == 0 && height % 2 == 0) {
        halve_even_row<Channels>(rows, width, keep, row);
    } else {
        halve_row<Channels>(rows, width, taps_of(height, y), keep, row);
    }
}

}  // namespace

MipSourceRows detail::mip_source_rows(std::size_t height, std::size_t y) {
    const Taps taps = taps_of(height, y);
    return {taps.first, taps.count};
}

void detail::halve_float_rows(int channels, std::size_t width, std::size_t height, std::size_t y,
                              const float* rows, float* row) {
    switch (channels) {
        case 1:
            return halve_floats<1>(width, height, y, rows, row);
        case 2:
            return halve_floats<2>(width, height, y, rows, row);
        case 3:
            return halve_floats<3>(width, height, y, rows, row);
        default:
            return halve_floats<4>(width, height, y, rows, row);
    }
}

std::vector<Image> mip_levels(const Image& image) {
    if (image.empty()) throw InvalidInput("the image is empty");
    if (image.bits() == 16 && image.color_space == ColorSpace::srgb) {
        // 16 bits of linear light do not resolve the darkest codes.
        std::vector<Image> result = mip_levels(to_linear(image));
        for (Image& level : result)
            level = to_srgb(level, 16);
        return result;
    }
    switch (image.channels) {
        case 1:
            return levels<1>(image);
        case 2:
            return levels<2>(image);
        case 3:
            return levels<3>(image);
        default:
            return levels<4>(image);
    }
}

}  // namespace relief

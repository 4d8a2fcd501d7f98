// SPDX-License-Identifier: Apache-2.0
// BC1 and BC3: encodes and decodes blocks of colors.
//
// A block has two endpoints of 5, 6 and 5 bits, and 2 bits per texel that select one of four
// colors: the endpoints and two colors between them or, in the other order of the endpoints, one
// color between them and transparent black. BC3 adds a block of BC4 with alpha, and has the first
// order only. Encoding fits a line to the exact colors, rounds its endpoints, chooses indices, and
// fits again by least squares. Source: [Khronos Data Format].
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "image/color_blocks.h"
#include "image/texel_loops.h"
#include "parallel.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr std::size_t texels_of_block = 16;
constexpr std::size_t color_block_bytes = 8;

using Color = std::array<float, 3>;

/// The exact colors of a block in codes of 8 bits, and which of them count.
struct ColorTexels {
    std::array<Color, texels_of_block> color;
    std::array<bool, texels_of_block> is_opaque;
    std::size_t opaque_count = 0;
};

/// The bits of an endpoint: red, green and blue.
using Endpoint = std::array<unsigned, 3>;
constexpr Endpoint endpoint_bits = {5, 6, 5};

/// Widens a number to 8 bits by repeating its highest bits.
constexpr unsigned widened(unsigned value, unsigned bits) {
    const unsigned high = value << (8 - bits);
    return high | high >> bits;
}

Color color_of(const Endpoint& endpoint) {
    Color color;
    for (std::size_t c = 0; c < 3; ++c)
        color[c] = static_cast<float>(widened(endpoint[c], endpoint_bits[c]));
    return color;
}

std::uint16_t packed(const Endpoint& endpoint) {
    return static_cast<std::uint16_t>(endpoint[0] << 11U | endpoint[1] << 5U | endpoint[2]);
}

Endpoint unpacked(unsigned code) {
    return {code >> 11U, code >> 5U & 63U, code & 31U};
}

Endpoint rounded_endpoint(const Color& color) {
    Endpoint endpoint;
    for (std::size_t c = 0; c < 3; ++c) {
        const auto largest = static_cast<float>((1U << endpoint_bits[c]) - 1U);
        const float code = color[c] * largest / 255.0F + 0.5F;
        endpoint[c] = static_cast<unsigned>(std::clamp(code, 0.0F, largest));
    }
    return endpoint;
}

/// Two endpoints with the steps of the texels between them.
struct ColorFit {
    std::array<Endpoint, 2> ends{};
    std::array<std::uint8_t, texels_of_block> step{};
    unsigned steps = 3;  ///< 3, or 2 with one color between the endpoints.
    float error = 1e30F;
};

/// Chooses the step of each texel that counts, and computes the squared error.
ColorFit with_steps(const ColorTexels& texels, const std::array<Endpoint, 2>& ends,
                    unsigned steps) {
    ColorFit fit;
    fit.ends = ends;
    fit.steps = steps;
    fit.error = 0.0F;
    const Color first = color_of(ends[0]);
    const Color last = color_of(ends[1]);
    Color direction;
    float squares = 0.0F;
    for (std::size_t c = 0; c < 3; ++c) {
        direction[c] = last[c] - first[c];
        squares += direction[c] * direction[c];
    }
    const auto all = static_cast<float>(steps);
    const float scale = squares > 0.0F ? all / squares : 0.0F;
    for (std::size_t t = 0; t < texels_of_block; ++t) {
        const Color& color = texels.color[t];
        float along = 0.0F;
        for (std::size_t c = 0; c < 3; ++c)
            along += direction[c] * (color[c] - first[c]);
        const float step =
            static_cast<float>(static_cast<int>(std::clamp(along * scale, 0.0F, all) + 0.5F));
        float error = 0.0F;
        for (std::size_t c = 0; c < 3; ++c) {
            const float rest = color[c] - first[c] - direction[c] * (step / all);
            error += rest * rest;
        }
        fit.step[t] = static_cast<std::uint8_t>(step);
        fit.error += texels.is_opaque[t] ? error : 0.0F;
    }
    return fit;
}

/// Two colors between which all others lie, not rounded.
using ColorSegment = std::array<Color, 2>;

/// The line through the mean along the direction of largest variance, as long as the colors.
ColorSegment principal_segment(const ColorTexels& texels) {
    Color mean{};
    const auto count = static_cast<float>(texels.opaque_count);
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t t = 0; t < texels_of_block; ++t)
            mean[c] += texels.is_opaque[t] ? texels.color[t][c] : 0.0F;
        mean[c] /= count;
    }
    float covariance[3][3] = {};
    for (std::size_t t = 0; t < texels_of_block; ++t) {
        if (!texels.is_opaque[t]) continue;
        for (std::size_t a = 0; a < 3; ++a) {
            for (std::size_t b = 0; b < 3; ++b)
                covariance[a][b] += (texels.color[t][a] - mean[a]) * (texels.color[t][b] - mean[b]);
        }
    }
    std::size_t largest = 0;
    for (std::size_t c = 1; c < 3; ++c) {
        if (covariance[c][c] > covariance[largest][largest]) largest = c;
    }
    Color axis = {covariance[largest][0], covariance[largest][1], covariance[largest][2]};
    for (int round = 0; round < 5; ++round) {
        Color next{};
        float size = 0.0F;
        for (std::size_t a = 0; a < 3; ++a) {
            for (std::size_t b = 0; b < 3; ++b)
                next[a] += covariance[a][b] * axis[b];
            size = std::max(size, std::abs(next[a]));
        }
        if (!(size > 1e-12F)) break;
        for (std::size_t c = 0; c < 3; ++c)
            axis[c] = next[c] / size;
    }
    const float squares = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2];
    if (!(squares > 1e-12F)) return {mean, mean};
    float least = 0.0F;
    float greatest = 0.0F;
    for (std::size_t t = 0; t < texels_of_block; ++t) {
        if (!texels.is_opaque[t]) continue;
        float along = 0.0F;
        for (std::size_t c = 0; c < 3; ++c)
            along += axis[c] * (texels.color[t][c] - mean[c]);
        along /= squares;
        least = std::min(least, along);
        greatest = std::max(greatest, along);
    }
    ColorSegment segment;
    for (std::size_t c = 0; c < 3; ++c) {
        segment[0][c] = mean[c] + least * axis[c];
        segment[1][c] = mean[c] + greatest * axis[c];
    }
    return segment;
}

/// The endpoints that are best for the steps, by least squares.
ColorSegment refitted_segment(const ColorTexels& texels, const ColorFit& fit,
                              const ColorSegment& segment) {
    float first_squares = 0.0F;
    float products = 0.0F;
    float last_squares = 0.0F;
    Color first_sum{}, last_sum{};
    for (std::size_t t = 0; t < texels_of_block; ++t) {
        if (!texels.is_opaque[t]) continue;
        const float last = static_cast<float>(fit.step[t]) / static_cast<float>(fit.steps);
        const float first = 1.0F - last;
        first_squares += first * first;
        products += first * last;
        last_squares += last * last;
        for (std::size_t c = 0; c < 3; ++c) {
            first_sum[c] += first * texels.color[t][c];
            last_sum[c] += last * texels.color[t][c];
        }
    }
    const float determinant = first_squares * last_squares - products * products;
    if (!(determinant > 1e-3F)) return segment;
    ColorSegment result;
    for (std::size_t c = 0; c < 3; ++c) {
        result[0][c] = (last_squares * first_sum[c] - products * last_sum[c]) / determinant;
        result[1][c] = (first_squares * last_sum[c] - products * first_sum[c]) / determinant;
    }
    return result;
}

int rounds_of_bc1(BlockQuality quality) {
    if (quality == BlockQuality::fast) return 1;
    return quality == BlockQuality::normal ? 3 : 6;
}

/// For each code of 8 bits, the two numbers of 5 or 6 bits whose color at a third is the nearest.
template <unsigned bits>
struct ThirdCodes {
    std::array<std::array<std::uint8_t, 2>, 256> pair{};

    constexpr ThirdCodes() {
        for (int code = 0; code < 256; ++code) {
            int least = 1 << 20;
            for (unsigned first = 0; first < 1U << bits; ++first) {
                // The nearest second number, and its neighbors.
                const int wanted = 3 * code - 2 * static_cast<int>(widened(first, bits));
                const int nearest = wanted >> (8 - static_cast<int>(bits));
                for (int second = nearest - 1; second <= nearest + 1; ++second) {
                    if (second < 0 || second >= 1 << bits) continue;
                    const int rest =
                        wanted - static_cast<int>(widened(static_cast<unsigned>(second), bits));
                    const int error = rest < 0 ? -rest : rest;
                    if (error >= least) continue;
                    least = error;
                    pair[static_cast<std::size_t>(code)] = {static_cast<std::uint8_t>(first),
                                                            static_cast<std::uint8_t>(second)};
                }
            }
        }
    }
};
constexpr ThirdCodes<5> third_codes_5;
constexpr ThirdCodes<6> third_codes_6;

/// A block whose texels all have nearly the same color: that of the first third.
ColorFit single_color_fit(const ColorTexels& texels, const Color& color) {
    ColorFit fit;
    for (std::size_t c = 0; c < 3; ++c) {
        const auto code = static_cast<std::size_t>(color[c] + 0.5F);
        const auto& pair = c == 1 ? third_codes_6.pair[code] : third_codes_5.pair[code];
        fit.ends[0][c] = pair[0];
        fit.ends[1][c] = pair[1];
    }
    fit.step.fill(1);
    const Color first = color_of(fit.ends[0]);
    const Color last = color_of(fit.ends[1]);
    fit.error = 0.0F;
    for (std::size_t t = 0; t < texels_of_block; ++t) {
        if (!texels.is_opaque[t]) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const float rest = texels.color[t][c] - first[c] - (last[c] - first[c]) / 3.0F;
            fit.error += rest * rest;
        }
    }
    return fit;
}

/// Moves the numbers of the endpoints by one, as long as that reduces the error.
void move_endpoints(const ColorTexels& texels, int rounds, ColorFit& fit) {
    for (int round = 0; round < rounds; ++round) {
        const float before = fit.error;
        for (std::size_t i = 0; i < 12; ++i) {
            std::array<Endpoint, 2> ends = fit.ends;
            unsigned& number = ends[i / 6][i / 2 % 3];
            const unsigned largest = (1U << endpoint_bits[i / 2 % 3]) - 1U;
            if (i % 2 == 0 ? number == 0 : number == largest) continue;
            number = i % 2 == 0 ? number - 1 : number + 1;
            const ColorFit moved = with_steps(texels, ends, fit.steps);
            if (moved.error < fit.error) fit = moved;
        }
        if (fit.error == before) return;
    }
}

/// \param steps  3, or 2 with one color between the endpoints
ColorFit fit_colors(const ColorTexels& texels, BlockQuality quality, unsigned steps) {
    ColorSegment segment = principal_segment(texels);
    ColorFit best;
    best.steps = steps;
    if (steps == 3) {
        Color mean;
        for (std::size_t c = 0; c < 3; ++c)
            mean[c] = std::clamp((segment[0][c] + segment[1][c]) / 2.0F, 0.0F, 255.0F);
        best = single_color_fit(texels, mean);
    }
    const int rounds = rounds_of_bc1(quality);
    for (int round = 0; round < rounds; ++round) {
        const ColorFit fit =
            with_steps(texels, {rounded_endpoint(segment[0]), rounded_endpoint(segment[1])}, steps);
        if (fit.error < best.error) best = fit;
        segment = refitted_segment(texels, fit, segment);
    }
    if (quality != BlockQuality::fast && best.error > 0.0F)
        move_endpoints(texels, quality == BlockQuality::best ? 8 : 1, best);
    return best;
}

void store_fit(const ColorTexels& texels, ColorFit fit, std::byte* block) {
    constexpr std::array<std::uint8_t, 4> index_of_thirds = {0, 2, 3, 1};
    constexpr std::array<std::uint8_t, 3> index_of_halves = {0, 2, 1};
    const bool has_thirds = fit.steps == 3;
    unsigned first = packed(fit.ends[0]);
    unsigned last = packed(fit.ends[1]);
    if (has_thirds ? first < last : first > last) {
        std::swap(first, last);
        for (std::uint8_t& step : fit.step)
            step = static_cast<std::uint8_t>(fit.steps - step);
    }
    std::uint32_t indices = 0;
    for (std::size_t t = 0; t < texels_of_block; ++t) {
        unsigned index = has_thirds ? index_of_thirds[fit.step[t]] : index_of_halves[fit.step[t]];
        // Equal endpoints select the order with transparent black.
        if (first == last) index = 0;
        if (!texels.is_opaque[t]) index = 3;
        indices |= index << (2 * t);
    }
    const std::uint64_t bits = first | std::uint64_t{last} << 16U | std::uint64_t{indices} << 32U;
    for (std::size_t i = 0; i < color_block_bytes; ++i)
        block[i] = static_cast<std::byte>(bits >> (8 * i) & 255U);
}

/// \param has_both_orders  whether the block may have one color between its endpoints
void encode_bc1_block(const ColorTexels& texels, BlockQuality quality, bool has_both_orders,
                      std::byte* block) {
    const bool is_transparent = texels.opaque_count < texels_of_block;
    if (texels.opaque_count == 0) return store_fit(texels, {.steps = 2}, block);
    ColorFit best = fit_colors(texels, quality, is_transparent ? 2 : 3);
    if (has_both_orders && !is_transparent && quality == BlockQuality::best) {
        const ColorFit other = fit_colors(texels, quality, 2);
        if (other.error < best.error) best = other;
    }
    store_fit(texels, best, block);
}

/// Returns a sample in codes of 8 bits, clamped; 0 if it is not finite.
template <typename Sample>
float color_code(Sample sample, bool& is_finite) {
    if constexpr (std::is_same_v<Sample, float>) {
        is_finite = std::isfinite(sample);
        return is_finite ? std::clamp(255.0F * sample, 0.0F, 255.0F) : 0.0F;
    } else {
        is_finite = true;
        return static_cast<float>(sample) * (255.0F / static_cast<float>(largest_sample<Sample>));
    }
}

template <typename Sample>
void encode_color_rows(const ImageView& image, BlockFormat format, BlockQuality quality,
                       std::size_t begin, std::size_t end, std::span<std::byte> blocks,
                       Report& report) {
    const std::size_t columns = (static_cast<std::size_t>(image.width) + 3) / 4;
    const std::size_t stride = bytes_per_block(format);
    const std::size_t offset = stride - color_block_bytes;
    for (std::size_t row = begin; row < end; ++row) {
        for (std::size_t column = 0; column < columns; ++column) {
            ColorTexels texels;
            for (std::size_t t = 0; t < texels_of_block; ++t) {
                const int place_x = static_cast<int>(4 * column + t % 4);
                const int place_y = static_cast<int>(4 * row + t / 4);
                const int x = std::min(place_x, image.width - 1);
                const int y = std::min(place_y, image.height - 1);
                const Sample* const sample =
                    image.row<Sample>(y) + static_cast<std::ptrdiff_t>(x) * image.channels;
                bool all_finite = true;
                for (std::size_t c = 0; c < 3; ++c) {
                    bool is_finite = true;
                    texels.color[t][c] = color_code(sample[c], is_finite);
                    all_finite = all_finite && is_finite;
                }
                texels.is_opaque[t] = true;
                if (format == BlockFormat::bc1a && image.channels == 4) {
                    bool is_finite = true;
                    texels.is_opaque[t] = color_code(sample[3], is_finite) >= 127.5F;
                    all_finite = all_finite && is_finite;
                }
                texels.opaque_count += texels.is_opaque[t] ? 1 : 0;
                if (!all_finite && x == place_x && y == place_y) {
                    report.add("sample that is not finite", "texel",
                               static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                   static_cast<std::size_t>(x),
                               "stored as 0");
                }
            }
            encode_bc1_block(texels, quality, format != BlockFormat::bc3,
                             &blocks[(row * columns + column) * stride + offset]);
        }
    }
}

/// Stores the alpha of BC3 in the first half of each block.
void encode_alpha(const ImageView& image, BlockQuality quality, std::span<std::byte> blocks,
                  Report& report) {
    Image alpha = make_image(image.width, image.height, 1, 32, ColorSpace::data);
    const std::span<float> values = alpha.as<float>();
    with_sample_type(image, [&]<typename Sample>(Sample) {
        const auto scale = static_cast<float>(1.0 / largest_sample<Sample>);
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] =
                image.channels == 4 ? static_cast<float>(image.texel<Sample>(i)[3]) * scale : 1.0F;
        }
    });
    const std::vector<std::byte> halves = encode_blocks(alpha, BlockFormat::bc4, quality, report);
    for (std::size_t i = 0; i < halves.size() / 8; ++i)
        std::copy_n(&halves[8 * i], 8, &blocks[16 * i]);
}

using DecodedColor = std::array<std::uint8_t, 4>;

/// Decodes a block of colors. \param has_order  whether the order of the endpoints has a meaning
std::array<DecodedColor, texels_of_block> decode_bc1_block(const std::byte* block, bool has_order) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < color_block_bytes; ++i)
        bits |= std::to_integer<std::uint64_t>(block[i]) << (8 * i);
    const auto first = static_cast<unsigned>(bits & 0xFFFFU);
    const auto last = static_cast<unsigned>(bits >> 16U & 0xFFFFU);
    const bool has_thirds = first > last || !has_order;
    std::array<DecodedColor, 4> palette{};
    for (std::size_t c = 0; c < 3; ++c) {
        const unsigned a = widened(unpacked(first)[c], endpoint_bits[c]);
        const unsigned b = widened(unpacked(last)[c], endpoint_bits[c]);
        palette[0][c] = static_cast<std::uint8_t>(a);
        palette[1][c] = static_cast<std::uint8_t>(b);
        palette[2][c] = static_cast<std::uint8_t>(has_thirds ? (2 * a + b + 1) / 3 : (a + b) / 2);
        palette[3][c] = static_cast<std::uint8_t>(has_thirds ? (a + 2 * b + 1) / 3 : 0);
    }
    for (std::size_t i = 0; i < 4; ++i)
        palette[i][3] = i == 3 && !has_thirds ? 0 : 255;
    std::array<DecodedColor, texels_of_block> colors;
    for (std::size_t t = 0; t < texels_of_block; ++t)
        colors[t] = palette[bits >> (32 + 2 * t) & 3U];
    return colors;
}

}  // namespace

std::vector<std::byte> detail::encode_color_blocks(const ImageView& image, BlockFormat format,
                                                   BlockQuality quality, Report& report) {
    const bool has_channels =
        image.channels == 3 || (image.channels == 4 && format != BlockFormat::bc1);
    if (!has_channels) {
        throw InvalidInput(fmt::format("{} has {} channels, not {}", enum_name(format),
                                       channels_of(format), image.channels));
    }
    std::vector<std::byte> blocks(block_data_size(format, image.width, image.height));
    if (format == BlockFormat::bc3) encode_alpha(image, quality, blocks, report);
    const std::size_t rows = (static_cast<std::size_t>(image.height) + 3) / 4;
    const std::size_t grain = texels_per_piece / 16 / static_cast<std::size_t>(image.width) + 1;
    parallel_for_reporting(
        rows, grain, report, [&](std::size_t begin, std::size_t end, Report& found) {
            with_sample_type(image, [&]<typename Sample>(Sample) {
                encode_color_rows<Sample>(image, format, quality, begin, end, blocks, found);
            });
        });
    return blocks;
}

Image detail::decode_color_blocks(std::span<const std::byte> blocks, BlockFormat format, int width,
                                  int height) {
    const auto channels = static_cast<std::size_t>(channels_of(format));
    Image image = make_image(width, height, channels_of(format), 8, ColorSpace::data);
    const std::span<std::uint8_t> samples = image.as<std::uint8_t>();
    const auto columns = static_cast<std::size_t>(width);
    const auto rows = static_cast<std::size_t>(height);
    const std::size_t block_columns = (columns + 3) / 4;
    const std::size_t stride = bytes_per_block(format);
    std::vector<std::byte> halves;
    if (format == BlockFormat::bc3) {
        halves.resize(blocks.size() / 2);
        for (std::size_t i = 0; i < halves.size() / 8; ++i)
            std::copy_n(&blocks[16 * i], 8, &halves[8 * i]);
    }
    const std::size_t grain = texels_per_piece / 4 / columns + 1;
    parallel_for((rows + 3) / 4, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * block_columns; i < end * block_columns; ++i) {
            const auto colors = decode_bc1_block(&blocks[i * stride + stride - color_block_bytes],
                                                 format != BlockFormat::bc3);
            for (std::size_t t = 0; t < texels_of_block; ++t) {
                const std::size_t x = i % block_columns * 4 + t % 4;
                const std::size_t y = i / block_columns * 4 + t / 4;
                if (x >= columns || y >= rows) continue;
                std::copy_n(colors[t].begin(), channels, &samples[(y * columns + x) * channels]);
            }
        }
    });
    if (format != BlockFormat::bc3) return image;
    const Image alpha = decode_blocks(halves, BlockFormat::bc4, width, height);
    const std::span<const std::uint16_t> values = alpha.as<std::uint16_t>();
    for (std::size_t i = 0; i < values.size(); ++i)
        samples[4 * i + 3] = static_cast<std::uint8_t>((values[i] + 128U) / 257U);
    return image;
}

}  // namespace relief

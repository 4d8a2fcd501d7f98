// SPDX-License-Identifier: Apache-2.0
// Images in memory: sizes, samples, channels, parts, false colors, and the sRGB transfer function
// [IEC 61966-2-1].
//
// The transfer function is evaluated in double precision by the standard's formula and rounded once
// to float, so that every 8 and 16-bit code survives decoding and encoding exactly. Invalid sizes
// and bit depths throw. NaN is encoded as 0.
#include "relief/mesh/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <string_view>
#include <type_traits>

#include "image/texel_loops.h"
#include "large_memory.h"
#include "parallel.h"
#include "portable_math.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr std::size_t converted_per_piece = 1 << 14;

// The constants are those of the standard. The two branches differ by 1e-7 at the code 0.04045
// (light 0.0031308), which no 16-bit code resolves.
double decoded(double coded) {
    return coded <= 0.04045 ? coded / 12.92 : portable::pow((coded + 0.055) / 1.055, 2.4);
}

double encoded(double light) {
    return light <= 0.0031308 ? 12.92 * light : 1.055 * portable::pow(light, 1.0 / 2.4) - 0.055;
}

/// Returns the linear value of every 8- or 16-bit code.
template <typename Code>
std::vector<float> decoding_table() {
    constexpr std::size_t largest = std::numeric_limits<Code>::max();
    std::vector<float> table(largest + 1);
    for (std::size_t code = 0; code <= largest; ++code)
        table[code] =
            static_cast<float>(decoded(static_cast<double>(code) / static_cast<double>(largest)));
    return table;
}

float light_of(std::uint8_t code) {
    static const std::vector<float> table = decoding_table<std::uint8_t>();
    return table[code];
}

float light_of(std::uint16_t code) {
    static const std::vector<float> table = decoding_table<std::uint16_t>();
    return table[code];
}

float light_of(float coded) {
    return linear_from_srgb(coded);
}

template <typename Code>
float unit_of(Code code) {
    return static_cast<float>(code) / static_cast<float>(std::numeric_limits<Code>::max());
}

float unit_of(float value) {
    return value;
}

/// Returns a value as a code. NaN fails every comparison and so becomes 0.
template <typename Code>
Code code_of(double value) {
    constexpr double largest = std::numeric_limits<Code>::max();
    if (!(value > 0.0)) return 0;
    return static_cast<Code>(std::min(value, 1.0) * largest + 0.5);
}

/// Applies `alpha` to samples of the alpha channel, and `color` to all others.
template <typename To, typename From, typename Color, typename Alpha>
std::vector<To> converted(const Image& image, const std::vector<From>& from, Color color,
                          Alpha alpha) {
    std::vector<To> to(from.size());
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t alpha_channel = has_alpha(image) ? channels - 1 : channels;
    parallel_for(from.size(), converted_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            to[i] = i % channels == alpha_channel ? alpha(from[i]) : color(from[i]);
    });
    return to;
}

template <typename Sample>
std::vector<Sample> zeros(std::size_t count) {
    std::vector<Sample> samples;
    reserve_to_fill(samples, count);
    constexpr std::size_t step = std::size_t{1} << 20;  // Memory that is used first takes time.
    for (std::size_t size = step; size < count; size += step) {
        check_cancelled();
        samples.resize(size);
    }
    samples.resize(count);
    return samples;
}

Image::Samples zeros(int bits, std::size_t count) {
    switch (bits) {
        case 8:
            return zeros<std::uint8_t>(count);
        case 16:
            return zeros<std::uint16_t>(count);
        case 32:
            return zeros<float>(count);
        default:
            throw InvalidInput(fmt::format("{} bits: a sample has 8, 16 or 32", bits));
    }
}

}  // namespace

int Image::bits() const {
    return std::visit([](const auto& all) { return static_cast<int>(sizeof(all[0]) * 8); },
                      samples);
}

Image make_image(int width, int height, int channels, int bits, ColorSpace color_space) {
    if (width < 1 || height < 1 || channels < 1 || channels > 4) {
        throw InvalidInput(
            fmt::format("an image of {} x {} texels with {} channels: sizes start "
                        "at 1, and channels end at 4",
                        width, height, channels));
    }
    Image image{width, height, channels, color_space, {}};
    require_memory(image.sample_count(), static_cast<std::uint64_t>(bits / 8));
    image.samples = zeros(bits, image.sample_count());
    return image;
}

Image to_float(const Image& image) {
    Image result{image.width, image.height, image.channels, image.color_space, {}};
    result.samples = std::visit(
        [&](const auto& from) {
            const auto same = [](auto sample) { return unit_of(sample); };
            return converted<float>(image, from, same, same);
        },
        image.samples);
    return result;
}

Image to_linear(const Image& image) {
    if (image.color_space != ColorSpace::srgb) return to_float(image);
    Image result{image.width, image.height, image.channels, ColorSpace::linear, {}};
    result.samples = std::visit(
        [&](const auto& from) {
            return converted<float>(
                image, from, [](auto sample) { return light_of(sample); },
                [](auto sample) { return unit_of(sample); });
        },
        image.samples);
    return result;
}

Image to_srgb(const Image& linear, int bits) {
    if (linear.color_space != ColorSpace::linear || linear.bits() != 32)
        throw InvalidInput("only linear float images can be encoded as sRGB");
    if (bits != 8 && bits != 16)
        throw InvalidInput(fmt::format("sRGB of {} bits: there are 8 and 16", bits));
    Image result{linear.width, linear.height, linear.channels, ColorSpace::srgb, {}};
    const auto encode_as = [&]<typename Code>(std::type_identity<Code>) {
        result.samples = converted<Code>(
            linear, std::get<std::vector<float>>(linear.samples),
            [](float light) { return code_of<Code>(encoded(light)); },
            [](float alpha) { return code_of<Code>(alpha); });
    };
    if (bits == 8) encode_as(std::type_identity<std::uint8_t>{});
    if (bits == 16) encode_as(std::type_identity<std::uint16_t>{});
    return result;
}

float srgb_from_linear(float linear) {
    return static_cast<float>(std::copysign(encoded(std::abs(linear)), linear));
}

float linear_from_srgb(float coded) {
    return static_cast<float>(std::copysign(decoded(std::abs(coded)), coded));
}

namespace {

template <typename Sample>
Sample sample_of(float value) {
    if constexpr (std::is_same_v<Sample, float>) {
        return value;
    } else {
        const float inside = value > 0.0F ? std::min(value, 1.0F) : 0.0F;
        return static_cast<Sample>(
            std::lround(inside * static_cast<float>(largest_sample<Sample>)));
    }
}

}  // namespace

Image channel_of(const Image& image, int channel) {
    if (channel < 0 || channel >= image.channels) {
        throw InvalidInput(
            fmt::format("there is no channel {}, but only {}", channel + 1, image.channels));
    }
    Image result = make_image(image.width, image.height, 1, 32, ColorSpace::data);
    const std::span<float> values = result.as<float>();
    const auto channels = static_cast<std::size_t>(image.channels);
    with_sample_type(image, [&]<typename Sample>(Sample) {
        const Sample* const samples = image.as<Sample>().data() + channel;
        Report unused;
        for_each_texel(values.size(), unused, [&](std::size_t texel, Report&) {
            values[texel] = static_cast<float>(samples[texel * channels]) /
                            static_cast<float>(largest_sample<Sample>);
        });
    });
    return result;
}

Image with_alpha(const Image& image, const Image& alpha) {
    check_floats(alpha, 1, "alphas");
    if (image.channels != 3)
        throw InvalidInput(fmt::format("alpha goes with 3 channels, not {}", image.channels));
    if (image.width != alpha.width || image.height != alpha.height) {
        throw InvalidInput(fmt::format("an alpha of {} x {} does not go with an image of {} x {}",
                                       alpha.width, alpha.height, image.width, image.height));
    }
    Image result = make_image(image.width, image.height, 4, image.bits(), image.color_space);
    const std::span<const float> values = alpha.as<float>();
    with_sample_type(image, [&]<typename Sample>(Sample) {
        const Sample* const from = image.as<Sample>().data();
        Sample* const to = result.as<Sample>().data();
        Report unused;
        for_each_texel(values.size(), unused, [&](std::size_t texel, Report&) {
            std::copy_n(from + texel * 3, 3, to + texel * 4);
            to[texel * 4 + 3] = sample_of<Sample>(values[texel]);
        });
    });
    return result;
}

void drop_alpha(Image& image) {
    if (image.channels != 4)
        throw InvalidInput(fmt::format("no alpha to drop from {} channels", image.channels));
    with_sample_type(image, [&]<typename Sample>(Sample) {
        std::vector<Sample>& samples = std::get<std::vector<Sample>>(image.samples);
        for (std::size_t texel = 1; texel < samples.size() / 4; ++texel)
            std::copy_n(samples.begin() + static_cast<std::ptrdiff_t>(texel * 4), 3,
                        samples.begin() + static_cast<std::ptrdiff_t>(texel * 3));
        samples.resize(samples.size() / 4 * 3);
    });
    image.channels = 3;
}

Image part_of(const ImageView& image, const ImagePart& part) {
    const bool is_within = part.x >= 0 && part.y >= 0 && part.width > 0 && part.height > 0 &&
                           part.width <= image.width - part.x &&
                           part.height <= image.height - part.y;
    if (!is_within) {
        throw InvalidInput(
            fmt::format("{} x {} texels at ({}, {}) are not inside the image of {} x {}",
                        part.width, part.height, part.x, part.y, image.width, image.height));
    }
    Image result =
        make_image(part.width, part.height, image.channels, image.bits(), ColorSpace::data);
    with_sample_type(image, [&]<typename Sample>(Sample) {
        const auto channels = static_cast<std::size_t>(image.channels);
        const std::size_t row = static_cast<std::size_t>(part.width) * channels;
        for (int y = 0; y < part.height; ++y) {
            const Sample* const from =
                image.row<Sample>(part.y + y) + static_cast<std::size_t>(part.x) * channels;
            std::copy_n(from, row, result.as<Sample>().data() + static_cast<std::size_t>(y) * row);
        }
    });
    return result;
}

Image part_of(const Image& image, const ImagePart& part) {
    Image result = part_of(ImageView(image), part);
    result.color_space = image.color_space;
    return result;
}

void detail::check_floats(const ImageView& image, int channels, const char* what) {
    if (image.empty()) throw InvalidInput(fmt::format("the image of {} is empty", what));
    if (image.channels != channels || image.bits() != 32) {
        throw InvalidInput(fmt::format("{} have {} float channels, not {} of {} bits", what,
                                       channels, image.channels, image.bits()));
    }
}

namespace {

/// Five colors from black to pale yellow that follow matplotlib's map "magma".
const std::array<glm::dvec3, 5> heat{
    {{0, 0, 4}, {81, 18, 124}, {183, 55, 121}, {252, 137, 97}, {252, 253, 191}}};
/// NaN becomes green, which no other value has.
const glm::dvec3 no_number{0, 255, 0};

/// \param share  the ratio to the brightest value
glm::dvec3 color_of(double share) {
    if (std::isnan(share)) return no_number;
    const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(heat.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), heat.size() - 2);
    return glm::mix(heat.at(below), heat.at(below + 1), place - static_cast<double>(below));
}

}  // namespace

Image false_color_image(const Image& values, double brightest) {
    if (values.empty() || values.channels != 1 || values.bits() != 32)
        throw InvalidInput("only an image of one float channel can be shown as heat");
    if (!(brightest > 0.0))
        throw InvalidInput(
            fmt::format("the brightest value is {}, but must be above 0", brightest));
    Image picture = make_image(values.width, values.height, 3, 8, ColorSpace::srgb);
    const auto from = values.as<float>();
    const auto to = picture.as<std::uint8_t>();
    for (std::size_t i = 0; i < from.size(); ++i) {
        const glm::dvec3 color = color_of(static_cast<double>(from[i]) / brightest);
        for (std::size_t c = 0; c < 3; ++c)
            to[3 * i + c] = static_cast<std::uint8_t>(std::lround(color[static_cast<int>(c)]));
    }
    return picture;
}

std::string name_of(const Wraps& wraps) {
    const std::string x = enum_name(wraps.x);
    return wraps.x == wraps.y ? x : x + "," + enum_name(wraps.y);
}

}  // namespace relief

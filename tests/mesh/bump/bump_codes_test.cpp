// SPDX-License-Identifier: Apache-2.0
// Codes of normal maps against a plain loop, byte for byte, with registers of every width.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <vector>

#include "relief/mesh/bump.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/report.h"
#include "support/images.h"
#include "support/vector_bits.h"

namespace relief {
namespace {

using test::rough;

constexpr std::array register_widths = {"128", "256", "512"};

Image map_with(const char* bits, const Image& heights, const BumpOptions& options,
               const NormalMapFormat& format) {
    const test::VectorBits width(bits);
    Report report;
    return normal_map_from_height(heights, options, format, report);
}

/// Widths below, at and beyond those of registers and blocks.
std::vector<int> image_widths() {
    std::vector<int> widths(40);
    std::iota(widths.begin(), widths.end(), 1);
    widths.insert(widths.end(), {63, 64, 65, 66, 67, 127, 128, 129, 130, 131, 193, 194, 195});
    return widths;
}

std::vector<NormalMapFormat> code_formats() {
    std::vector<NormalMapFormat> formats;
    for (const int bits : {8, 16}) {
        for (const FlatCode flat : {FlatCode::half, FlatCode::middle}) {
            for (const Green green : {Green::up, Green::down})
                formats.push_back({.bits = bits, .green = green, .flat = flat});
        }
    }
    return formats;
}

/// The nearest code of a component in code steps.
int plain_code(float steps, const NormalMapFormat& format) {
    const int middle = format.bits == 8 ? 128 : 32768;
    if (format.flat == FlatCode::half)
        return static_cast<int>(std::floor(steps + static_cast<float>(middle)));
    return middle + static_cast<int>(steps + std::copysign(0.5F, steps));
}

/// The weights of a 3x3 kernel whose sum is multiplied by `scale`.
struct Plain3x3 {
    Kernel kernel;
    float own, beside, scale;
};

/// A loop over texels with borders that repeat and the order of sums of the library.
std::vector<int> plain_codes(const Image& heights, const Plain3x3& weights,
                             const NormalMapFormat& format) {
    const int columns = heights.width;
    const int rows = heights.height;
    const auto at = [&](int x, int y) {
        const int row = (y + rows) % rows;
        return heights
            .as<float>()[static_cast<std::size_t>(row * columns + (x + columns) % columns)];
    };
    const float own = weights.own * weights.scale;
    const float beside = weights.beside * weights.scale;
    const float green = format.green == Green::up ? -1.0F : 1.0F;
    const float largest = format.bits == 8 ? 255.0F : 65535.0F;
    const float steps = format.flat == FlatCode::half ? largest / 2 : (largest - 1) / 2;
    std::vector<int> codes;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            const float rising = at(x + 1, y - 1) - at(x - 1, y + 1);
            const float falling = at(x + 1, y + 1) - at(x - 1, y - 1);
            const float right = own * (at(x + 1, y) - at(x - 1, y)) + beside * (rising + falling);
            const float up = own * (at(x, y - 1) - at(x, y + 1)) + beside * (rising - falling);
            const float scale = steps / std::sqrt(right * right + up * up + 1.0F);
            codes.push_back(plain_code(-right * scale, format));
            codes.push_back(plain_code(green * up * scale, format));
            codes.push_back(plain_code(scale, format));
        }
    }
    return codes;
}

std::vector<int> codes_of(const Image& map) {
    if (map.bits() == 8) return {map.as<std::uint8_t>().begin(), map.as<std::uint8_t>().end()};
    return {map.as<std::uint16_t>().begin(), map.as<std::uint16_t>().end()};
}

TEST(BumpCodeBytes, AreThoseOfAPlainLoop) {
    const Plain3x3 kernels[] = {{Kernel::sobel3, 2.0F, 1.0F, 1.0F},
                                {Kernel::central3, 1.0F, 0.0F, 4.0F},
                                {Kernel::scharr3, 10.0F, 3.0F, 0.25F}};
    for (const int width : image_widths()) {
        const Image heights = rough(width, 5, 4321);
        for (const Plain3x3& plain : kernels) {
            // The strength cancels the divisor of the kernel.
            const double divisor = gradient_kernel(plain.kernel).divisor;
            const BumpOptions options{plain.kernel, Wrap::repeat,
                                      divisor * static_cast<double>(plain.scale)};
            for (const NormalMapFormat& format : code_formats()) {
                const std::vector<int> expected = plain_codes(heights, plain, format);
                for (const char* bits : register_widths) {
                    ASSERT_EQ(codes_of(map_with(bits, heights, options, format)), expected)
                        << bits << ' ' << width << ' ' << format.bits;
                }
            }
        }
    }
}

TEST(BumpCodeBytes, OfExtremeHeightsAreTheSameForEveryRegisterWidth) {
    constexpr std::array extremes = {1e25F,
                                     -1e38F,
                                     1e15F,
                                     std::numeric_limits<float>::denorm_min(),
                                     std::numeric_limits<float>::quiet_NaN(),
                                     -std::numeric_limits<float>::infinity()};
    for (const int width : image_widths()) {
        for (const float extreme : extremes) {
            Image heights = rough(width, 4, 4321);
            heights.as<float>()[static_cast<std::size_t>(2 * width - 1)] = extreme;
            heights.as<float>()[static_cast<std::size_t>(2 * width + width / 2)] = extreme;
            for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror}) {
                const BumpOptions options{Kernel::sobel3, wrap, 5.0};
                for (const NormalMapFormat& format :
                     {NormalMapFormat{}, NormalMapFormat{.bits = 8, .flat = FlatCode::middle}}) {
                    const Image expected = map_with("128", heights, options, format);
                    for (const char* bits : {"256", "512"}) {
                        ASSERT_TRUE(map_with(bits, heights, options, format).samples ==
                                    expected.samples)
                            << bits << ' ' << width << ' ' << extreme;
                    }
                }
            }
        }
    }
}

TEST(BumpCodeBytes, OfEveryKernelAndDepthAreTheSameForEveryRegisterWidth) {
    for (const int width : {1, 2, 7, 15, 33, 64, 65, 130}) {
        const Image floats = rough(width, 6, 4321);
        Image codes = make_image(width, 6, 1, 16, ColorSpace::data);
        std::transform(floats.as<float>().begin(), floats.as<float>().end(),
                       codes.as<std::uint16_t>().begin(),
                       [](float height) { return static_cast<std::uint16_t>(65535.0F * height); });
        for (const auto& kernel : enum_names<Kernel>) {
            for (const Image* heights : {&floats, static_cast<const Image*>(&codes)}) {
                for (const Arithmetic arithmetic : {Arithmetic::float32, Arithmetic::float64}) {
                    BumpOptions options{kernel.value, Wrap::mirror, 5.0};
                    options.arithmetic = arithmetic;
                    for (const NormalMapFormat& format : code_formats()) {
                        const Image expected = map_with("128", *heights, options, format);
                        for (const char* bits : {"256", "512"}) {
                            ASSERT_TRUE(map_with(bits, *heights, options, format).samples ==
                                        expected.samples)
                                << bits << ' ' << width << ' ' << kernel.name;
                        }
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace relief

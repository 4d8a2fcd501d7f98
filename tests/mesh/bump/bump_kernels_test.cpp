// SPDX-License-Identifier: Apache-2.0
// Every gradient kernel: its closed form, and whole images against plain sums at every border, in
// every arithmetic and vector width.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/vec2.hpp>
#include <numbers>

#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/report.h"
#include "support/images.h"
#include "support/labels.h"
#include "support/vector_bits.h"

namespace relief {
using namespace relief::accuracy;

namespace {

using std::numbers::pi;
using test::all_wraps;
using test::heights_of;
using test::rough;

struct Known {
    Kernel kernel;
    int order;
    int radius;
    double noise;       ///< Computed by hand from the weights.
    double anisotropy;  ///< Degrees at a wavelength of 8 texels.
};

const Known kernel_table[] = {
    {Kernel::forward, 1, 1, std::sqrt(2.0), 0.37},
    {Kernel::central3, 2, 1, std::sqrt(0.5), 1.54},
    {Kernel::prewitt3, 2, 1, std::sqrt(6.0) / 6.0, 1.56},
    {Kernel::sobel3, 2, 1, std::sqrt(12.0) / 8.0, 0.75},
    {Kernel::scharr3, 2, 1, std::sqrt(236.0) / 32.0, 0.16},
    {Kernel::sobel5, 2, 2, std::sqrt(10.0 * 70.0) / 128.0, 0.75},
    {Kernel::scharr5, 2, 2, 0.2825, 0.003},
    {Kernel::central5, 4, 2, std::sqrt(130.0) / 12.0, 0.17},
    {Kernel::central7, 6, 3, std::sqrt(2.0 * (2025.0 + 81.0 + 1.0)) / 60.0, 0.02},
};

TEST(GradientKernel, EachHasTheOrderNoiseAndAnisotropyOfTheTable) {
    for (const Known& known : kernel_table) {
        const GradientKernel kernel = gradient_kernel(known.kernel);
        EXPECT_EQ(kernel.order, known.order);
        EXPECT_EQ(kernel.radius, known.radius);
        EXPECT_NEAR(noise_gain(kernel), known.noise, 5e-5);
        // Half of the last digit in the header.
        const double half_digit = known.kernel == Kernel::scharr5 ? 0.0005 : 0.005;
        EXPECT_NEAR(anisotropy(kernel, 8.0) * 180.0 / pi, known.anisotropy, half_digit);
    }
}

TEST(GradientKernel, EveryKernelHasUnitGainOnAPlane) {
    for (int kernel = 0; kernel <= static_cast<int>(Kernel::gaussian); ++kernel) {
        for (const int radius : {1, 2, 5, 64}) {
            const GradientKernel found = gradient_kernel(static_cast<Kernel>(kernel), radius);
            EXPECT_NEAR(slope_response(found, {0.0, 0.0}), 1.0, 1e-14);
        }
    }
}

TEST(GradientKernel, ResponseToAWaveHasTheKnownForms) {
    const double w = 2.0 * pi / 8.0;
    EXPECT_NEAR(slope_response(gradient_kernel(Kernel::central3), {w, 0.3}), std::sin(w) / w,
                1e-15);
    EXPECT_NEAR(slope_response(gradient_kernel(Kernel::sobel3), {w, w}),
                std::sin(w) / w * std::pow(std::cos(w / 2.0), 2.0), 1e-15);
    EXPECT_NEAR(slope_response(gradient_kernel(Kernel::central5), {w, 0.0}),
                (8.0 * std::sin(w) - std::sin(2.0 * w)) / (6.0 * w), 1e-15);
    // Half a texel further, forward is a central difference of half the width.
    EXPECT_NEAR(slope_response(gradient_kernel(Kernel::forward), {w, 0.0}),
                std::sin(w / 2.0) / (w / 2.0), 1e-15);
}

/// The gradients of forward differences in plane waves of 8 texels, in many directions and phases:
/// the largest angles to the exact gradient in degrees.
struct ForwardErrors {
    double half_texel_on = 0.0;  ///< The difference begins half a texel before the point.
    double at_texel = 0.0;       ///< The difference begins at the point.
};

ForwardErrors measured_forward_errors() {
    ForwardErrors largest;
    for (int i = 0; i <= 720; ++i) {
        const double direction = pi / 2.0 * i / 720.0;
        const glm::dvec2 w = 2.0 * pi / 8.0 * glm::dvec2(std::cos(direction), std::sin(direction));
        for (int k = 0; k < 97; ++k) {
            const double phase = 2.0 * pi * k / 97.0;
            const auto error_from = [&](double start) {
                const auto height = [&](double x, double y) {
                    return std::sin(w.x * x + w.y * y + phase);
                };
                const glm::dvec2 found(height(start + 1.0, 0.0) - height(start, 0.0),
                                       height(0.0, start + 1.0) - height(0.0, start));
                const glm::dvec2 reference = std::cos(phase) * w;
                return std::abs(std::atan2(found.x * reference.y - found.y * reference.x,
                                           found.x * reference.x + found.y * reference.y)) *
                       180.0 / pi;
            };
            largest.half_texel_on = std::max(largest.half_texel_on, error_from(-0.5));
            largest.at_texel = std::max(largest.at_texel, error_from(0.0));
        }
    }
    return largest;
}

TEST(GradientKernel, TheDirectionErrorOfForwardIsCountedHalfATexelFartherOn) {
    const GradientKernel forward = gradient_kernel(Kernel::forward);
    const ForwardErrors measured = measured_forward_errors();
    EXPECT_NEAR(measured.half_texel_on, anisotropy(forward, 8.0) * 180.0 / pi, 1e-9);
    EXPECT_NEAR(anisotropy(forward, 8.0) * 180.0 / pi, 0.3725, 5e-5);
    EXPECT_NEAR(anisotropy(forward, 16.0) * 180.0 / pi, 0.0923, 5e-5);
    EXPECT_GT(measured.at_texel, 90.0);
}

TEST(GradientKernel, TheErrorOfTheResponseFallsWithTheOrder) {
    for (const Known& known : kernel_table) {
        if (known.kernel == Kernel::forward) continue;  // Its first-order error is its position.
        const GradientKernel kernel = gradient_kernel(known.kernel);
        const auto error = [&](double length) {
            return 1.0 - slope_response(kernel, {2.0 * pi / length, 0.0});
        };
        EXPECT_NEAR(std::log2(error(32.0) / error(64.0)), known.order, 0.05);
    }
}

TEST(GradientKernel, GaussianIsTheLeastSquaresPlane) {
    // With radius 1, the weights beside the center are exp(-2). The slope of h(1) = 1 is g / (2 g).
    const GradientKernel one = gradient_kernel(Kernel::gaussian, 1);
    const double g = std::exp(-2.0);
    EXPECT_DOUBLE_EQ(one.differences[0].weight, g);
    EXPECT_DOUBLE_EQ(one.divisor, 2.0 * g * (1.0 + 2.0 * g));
    // The residual of the weighted fit is orthogonal to x: the kernel ignores a parabola in x, and
    // x^3 gives the weighted mean ratio sum g x^4 / sum g x^2.
    const GradientKernel four = gradient_kernel(Kernel::gaussian, 4);
    double cubes = 0.0;
    double x4 = 0.0;
    double x2 = 0.0;
    for (int x = -4; x <= 4; ++x) {
        const double weight = std::exp(-x * x / 8.0);
        x4 += weight * std::pow(x, 4);
        x2 += weight * x * x;
    }
    double sum = 1.0;
    for (std::size_t i = 1; i < four.smoothing.size(); ++i)
        sum += 2.0 * four.smoothing[i];
    for (const auto& [before, after, weight] : four.differences)
        cubes += weight * (std::pow(after, 3) - std::pow(before, 3));
    EXPECT_NEAR(cubes * sum / four.divisor, x4 / x2, 1e-12);
    EXPECT_THROW(gradient_kernel(Kernel::gaussian, 0), InvalidInput);
    EXPECT_THROW(gradient_kernel(Kernel::gaussian, 65), InvalidInput);
    EXPECT_NO_THROW(gradient_kernel(Kernel::sobel3, 0));
}

constexpr Kernel all_kernels[] = {
    Kernel::forward, Kernel::central3, Kernel::prewitt3, Kernel::sobel3,   Kernel::scharr3,
    Kernel::sobel5,  Kernel::scharr5,  Kernel::central5, Kernel::central7, Kernel::gaussian};

BumpOptions options_of(Kernel kernel, Wraps wrap, double strength = 1.0) {
    BumpOptions options{kernel, wrap, strength};
    options.gaussian_radius = 3;
    return options;
}

glm::dvec2 slope_at(const Image& slopes, int column, int row) {
    const std::size_t texel = static_cast<std::size_t>(row * slopes.width + column);
    return {slopes.as<float>()[2 * texel], slopes.as<float>()[2 * texel + 1]};
}

Image slopes_of(const Image& height, const BumpOptions& options) {
    Report report;
    Image slopes = slopes_from_height(height, options, report);
    EXPECT_TRUE(report.empty());
    return slopes;
}

Image normals_from(const Image& height, const BumpOptions& options) {
    Report report;
    return normals_from_height(height, options, report);
}

/// Returns the height at any point. `reflects_x` and `reflects_y` name the axes of the differences,
/// along which a clamped map continues as its point reflection.
double height_at(const Image& image, const Wraps& wrap, int column, int row, bool reflects_x) {
    const std::function<double(int, int)> at = [&](int x, int y) -> double {
        const auto period = [](int place, int count, Wrap rule) {
            if (rule == Wrap::repeat) return ((place % count) + count) % count;
            const int folded = ((place % (2 * count)) + 2 * count) % (2 * count);
            return folded < count ? folded : 2 * count - 1 - folded;
        };
        const auto clamped = [&](int place, int count) {
            return place < 0 ? 0 : place >= count ? count - 1 : place;
        };
        if (wrap.x != Wrap::clamp)
            x = period(x, image.width, wrap.x);
        else if (!reflects_x || image.width == 1)
            x = clamped(x, image.width);
        if (wrap.y != Wrap::clamp)
            y = period(y, image.height, wrap.y);
        else if (reflects_x || image.height == 1)
            y = clamped(y, image.height);
        if (x < 0) return 2.0 * at(0, y) - at(-x, y);
        if (x >= image.width) return 2.0 * at(image.width - 1, y) - at(2 * image.width - 2 - x, y);
        if (y < 0) return 2.0 * at(x, 0) - at(x, -y);
        if (y >= image.height)
            return 2.0 * at(x, image.height - 1) - at(x, 2 * image.height - 2 - y);
        return image.as<float>()[static_cast<std::size_t>(y * image.width + x)];
    };
    return at(column, row);
}

/// Returns the slope by definition: the sum of every weight of the product times its height.
glm::dvec2 plain_slope(const Image& image, const GradientKernel& kernel, const Wraps& wrap,
                       int column, int row) {
    glm::dvec2 slope(0.0);
    const int lines = static_cast<int>(kernel.smoothing.size()) - 1;
    for (int line = -lines; line <= lines; ++line) {
        const double share = kernel.smoothing[static_cast<std::size_t>(std::abs(line))];
        for (const auto& [before, after, weight] : kernel.differences) {
            slope.x += share * weight *
                       (height_at(image, wrap, column + after, row + line, true) -
                        height_at(image, wrap, column + before, row + line, true));
            slope.y -= share * weight *
                       (height_at(image, wrap, column + line, row + after, false) -
                        height_at(image, wrap, column + line, row + before, false));
        }
    }
    return slope / kernel.divisor;
}

TEST(BumpKernels, SlopesAreThePlainSumsAtEveryBorderAndSize) {
    const glm::ivec2 sizes[] = {{1, 1}, {1, 5}, {6, 1}, {2, 2}, {3, 4}, {7, 2}, {13, 9}};
    for (const glm::ivec2 size : sizes) {
        const Image image = rough(size.x, size.y, 4321);
        for (const Kernel kernel : all_kernels) {
            const GradientKernel weights = gradient_kernel(kernel, 3);
            for (const Wrap x : all_wraps) {
                for (const Wrap y : all_wraps) {
                    const Image slopes = slopes_of(image, options_of(kernel, {x, y}));
                    for (int row = 0; row < size.y; ++row) {
                        for (int column = 0; column < size.x; ++column) {
                            const glm::dvec2 found = slope_at(slopes, column, row);
                            const glm::dvec2 plain =
                                plain_slope(image, weights, {x, y}, column, row);
                            // Sums of up to 20 heights times weights in double, stored in float.
                            ASSERT_NEAR(found.x, plain.x, 1e-6)
                                << size.x << " x " << size.y << ", kernel "
                                << static_cast<int>(kernel);
                            ASSERT_NEAR(found.y, plain.y, 1e-6);
                        }
                    }
                }
            }
        }
    }
}

TEST(BumpKernels, ResponseToAPeakIsTheMirroredKernel) {
    const Image peak = heights_of(9, 9, [](int x, int y) { return x == 4 && y == 4 ? 1.0 : 0.0; });
    const auto expect = [&](Kernel kernel, int x, int y, double right, double up) {
        const glm::dvec2 found = slope_at(slopes_of(peak, options_of(kernel, Wrap::repeat)), x, y);
        EXPECT_NEAR(found.x, right, 1e-7) << static_cast<int>(kernel);
        EXPECT_NEAR(found.y, up, 1e-7) << static_cast<int>(kernel);
    };
    // To the left of the peak, the surface rises to the right; below it (greater y), upwards.
    expect(Kernel::forward, 3, 4, 1.0, 0.0);
    expect(Kernel::forward, 4, 4, -1.0, 1.0);
    expect(Kernel::central3, 3, 4, 0.5, 0.0);
    expect(Kernel::central3, 4, 5, 0.0, 0.5);
    expect(Kernel::prewitt3, 3, 5, 1.0 / 6.0, 1.0 / 6.0);
    expect(Kernel::sobel3, 3, 4, 2.0 / 8.0, 0.0);
    expect(Kernel::scharr3, 3, 4, 10.0 / 32.0, 0.0);
    expect(Kernel::scharr3, 5, 3, -3.0 / 32.0, -3.0 / 32.0);
    expect(Kernel::sobel5, 2, 4, 1.0 * 6.0 / 128.0, 0.0);
    expect(Kernel::sobel5, 3, 6, 2.0 * 1.0 / 128.0, 1.0 * 4.0 / 128.0);
    expect(Kernel::scharr5, 3, 4, 0.3327 * 0.4704 / (0.9998 * 1.0), 0.0);
    expect(Kernel::central5, 3, 4, 8.0 / 12.0, 0.0);
    expect(Kernel::central5, 2, 4, -1.0 / 12.0, 0.0);
    expect(Kernel::central7, 4, 5, 0.0, 45.0 / 60.0);
    expect(Kernel::central7, 4, 6, 0.0, -9.0 / 60.0);
    expect(Kernel::central7, 1, 4, 1.0 / 60.0, 0.0);
}

TEST(BumpKernels, APlaneHasItsSlopeUpToTheBorderInEveryDepthAndArithmetic) {
    // 3 codes per texel to the right and 5 upwards: the sums of integers are exact.
    const auto code = [](int x, int y) { return 3 * x + 5 * (8 - y); };
    for (const int bits : {8, 16, 32}) {
        Image plane = make_image(11, 9, 1, bits, ColorSpace::data);
        const double unit = bits == 8 ? 255.0 : bits == 16 ? 65535.0 : 1.0;
        std::visit(
            [&](auto& samples) {
                for (int texel = 0; texel < 99; ++texel)
                    samples[static_cast<std::size_t>(texel)] =
                        static_cast<std::decay_t<decltype(samples[0])>>(
                            code(texel % 11, texel / 11));
            },
            plane.samples);
        for (const Kernel kernel : all_kernels) {
            for (const Arithmetic arithmetic : {Arithmetic::float64, Arithmetic::float32}) {
                BumpOptions options = options_of(kernel, Wrap::clamp, unit);
                options.arithmetic = arithmetic;
                const Image slopes = slopes_of(plane, options);
                for (int texel = 0; texel < 99; ++texel) {
                    const glm::dvec2 found = slope_at(slopes, texel % 11, texel / 11);
                    // The scale has one rounding. Only the weights of the Gaussian are not
                    // integers.
                    const double tolerance =
                        arithmetic == Arithmetic::float64 && kernel != Kernel::gaussian ? 0.0
                                                                                        : 6e-6;
                    ASSERT_NEAR(found.x, 3.0, tolerance) << static_cast<int>(kernel) << bits;
                    ASSERT_NEAR(found.y, 5.0, tolerance) << static_cast<int>(kernel) << bits;
                }
            }
        }
    }
}

TEST(BumpKernels, ConstantMapsAreFlatToTheBitInEveryKernelAndArithmetic) {
    for (const Kernel kernel : all_kernels) {
        for (const Wrap wrap : all_wraps) {
            for (const Arithmetic arithmetic : {Arithmetic::float64, Arithmetic::float32}) {
                BumpOptions options = options_of(kernel, wrap, -1e9);
                options.arithmetic = arithmetic;
                const Image normals =
                    normals_from(heights_of(9, 6, [](int, int) { return 0.3; }), options);
                for (std::size_t i = 0; i < normals.sample_count(); ++i) {
                    const std::uint32_t expected =
                        std::bit_cast<std::uint32_t>(i % 3 == 2 ? 1.0F : 0.0F);
                    ASSERT_EQ(std::bit_cast<std::uint32_t>(normals.as<float>()[i]), expected);
                }
            }
        }
    }
}

TEST(BumpBorders, AMirroredMapIsTheMiddleOfItsMirroredSelvesBitForBit) {
    const Image image = rough(12, 7, 4321);
    for (const Kernel kernel : all_kernels) {
        if (kernel == Kernel::forward) continue;
        const Image mirrored = slopes_of(image, options_of(kernel, Wrap::mirror));
        const Image unfolded = heights_of(24, 14, [&](int x, int y) {
            const int column = x < 12 ? x : 23 - x;
            const int row = y < 7 ? y : 13 - y;
            return image.as<float>()[static_cast<std::size_t>(row * 12 + column)];
        });
        const Image tiled = slopes_of(unfolded, options_of(kernel, Wrap::repeat));
        for (int row = 0; row < 7; ++row) {
            for (int column = 0; column < 12; ++column)
                EXPECT_EQ(slope_at(mirrored, column, row), slope_at(tiled, column, row));
        }
    }
}

TEST(BumpBorders, EachAxisHasItsOwnRule) {
    const Image image = rough(16, 16, 4321);
    const auto slope = [&](Wraps wrap, int x, int y) {
        return slope_at(slopes_of(image, options_of(Kernel::central3, wrap)), x, y);
    };
    const Wraps mixed{Wrap::repeat, Wrap::clamp};
    EXPECT_EQ(slope(mixed, 0, 8), slope(Wrap::repeat, 0, 8));
    EXPECT_EQ(slope(mixed, 8, 0), slope(Wrap::clamp, 8, 0));
    EXPECT_NE(slope(mixed, 8, 0), slope(Wrap::repeat, 8, 0));
    EXPECT_EQ(slope(mixed, 8, 8), slope(Wrap::mirror, 8, 8));
}

TEST(BumpBorders, HolesAreFilledByTheRuleOfTheirAxis) {
    Image image = heights_of(4, 1, [](int x, int) { return x == 3 ? 1.0 : 0.5; });
    image.as<float>()[0] = std::nanf("");
    const auto filled = [&](Wraps wrap) {
        Report report;
        // The height of the hole shows in the slope of its neighbor: (0.5 - hole) / 2.
        const Image slopes = slopes_from_height(image, options_of(Kernel::central3, wrap), report);
        EXPECT_EQ(report.count("non-finite height"), 1U);
        return 0.5 - 2.0 * slope_at(slopes, 1, 0).x;
    };
    EXPECT_FLOAT_EQ(static_cast<float>(filled({Wrap::repeat, Wrap::clamp})), 0.75F);
    EXPECT_FLOAT_EQ(static_cast<float>(filled({Wrap::clamp, Wrap::repeat})), 0.5F);
    EXPECT_FLOAT_EQ(static_cast<float>(filled({Wrap::mirror, Wrap::clamp})), 0.5F);
}

TEST(BumpBorders, TexelsThatAreNotSquareScaleEachAxis) {
    const Image image = rough(9, 9, 4321);
    BumpOptions options = options_of(Kernel::sobel3, Wrap::repeat, 3.0);
    const Image square = slopes_of(image, options);
    options.texel = {2.0, 0.25};
    const Image oblong = slopes_of(image, options);
    for (int row = 0; row < 9; ++row) {
        for (int column = 0; column < 9; ++column) {
            const glm::dvec2 one = slope_at(square, column, row);
            EXPECT_EQ(slope_at(oblong, column, row), glm::dvec2(one.x / 2.0, one.y * 4.0));
        }
    }
    Report report;
    for (const glm::dvec2 texel : {glm::dvec2(0, 1), glm::dvec2(1, -1), glm::dvec2(1, 1e31)}) {
        options.texel = texel;
        EXPECT_THROW(slopes_from_height(image, options, report), InvalidInput);
    }
}

/// The steepest slope is 1; crests run across (2, 1).
BumpField oblique_wave(double wavelength, int side) {
    const double k = 2.0 * pi / wavelength;
    const HeightWave wave{1.0 / k, k * glm::normalize(glm::dvec2(2.0, 1.0)), 0.0};
    return wave_heights(side, side, std::span(&wave, 1));
}

constexpr int margin = 4;

double wave_error(Kernel kernel, double wavelength, int bits) {
    const BumpField field = oblique_wave(wavelength, wavelength < 64.0 ? 40 : 520);
    BumpOptions options{kernel, Wrap::clamp, 1.0};
    if (bits == 32) return normal_error(normals_from(field.heights, options), field, margin).rms;
    const CodedHeights coded = coded_heights(field.heights, bits);
    options.strength = coded.strength;
    return normal_error(normals_from(coded.codes, options), field, margin).rms;
}

struct WaveErrors {
    Kernel kernel;
    double long_wave, short_wave, long_8_bit, long_16_bit;
};

TEST_LABELS(not_sanitized);
TEST(BumpAccuracy, TheErrorsOnWavesAreTheKnownOnes) {
    // RMS errors in degrees for wavelengths 32 and 8 in float, and 256 in 8 and 16 bits. The values
    // come from a separate study without this code, except those of prewitt3 and scharr5.
    const WaveErrors table[] = {
        {Kernel::forward, 2.77, 10.9, 8.11, 0.345},
        {Kernel::central3, 0.116, 1.85, 4.30, 0.0163},
        {Kernel::prewitt3, 0.210, 3.35, 1.80, 0.0078},
        {Kernel::sobel3, 0.181, 2.89, 1.98, 0.0083},
        {Kernel::scharr3, 0.161, 2.57, 2.40, 0.0097},
        {Kernel::central5, 0.0007, 0.175, 5.86, 0.022},
        {Kernel::central7, 1e-5, 0.018, 6.73, 0.025},
        {Kernel::sobel5, 0.412, 6.42, 0.95, 0.0075},
        {Kernel::scharr5, 0.311, 4.85, 1.25, 0.0069},
    };
    for (const WaveErrors& known : table) {
        const auto expect = [&](double wavelength, int bits, double expected, double share) {
            const double found = wave_error(known.kernel, wavelength, bits);
            EXPECT_NEAR(found, expected, share * expected)
                << "kernel " << static_cast<int>(known.kernel) << ", " << wavelength << " texels, "
                << bits << " bits";
        };
        // The part of the wave in the window changes the result by 2 %, and the position of the
        // steps of a staircase by 5 %. Errors of 1e-5 degrees contain those of float heights.
        if (known.kernel != Kernel::central7) expect(32.0, 32, known.long_wave, 0.04);
        expect(8.0, 32, known.short_wave, 0.02);
        expect(256.0, 8, known.long_8_bit, 0.05);
        expect(256.0, 16, known.long_16_bit, 0.05);
    }
    EXPECT_LT(wave_error(Kernel::central7, 32.0, 32), 2e-5);
    EXPECT_GT(wave_error(Kernel::sobel3, 32.0, 32) / wave_error(Kernel::central5, 32.0, 32), 250.0);
    EXPECT_GT(wave_error(Kernel::central5, 256.0, 8) / wave_error(Kernel::sobel3, 256.0, 8), 2.8);
}

TEST(BumpAccuracy, KernelsHaveTheirDocumentedOrder) {
    for (const Kernel kernel : all_kernels) {
        const int order = gradient_kernel(kernel).order;
        // A wavelength at which the error is far above the rounding of heights to float, and the
        // next order is small.
        const double wavelength = order == 6 ? 10.0 : order == 4 ? 12.0 : 20.0;
        const double found =
            std::log2(wave_error(kernel, wavelength, 32) / wave_error(kernel, 2 * wavelength, 32));
        EXPECT_NEAR(found, order, 0.15) << static_cast<int>(kernel);
    }
}

TEST(BumpAccuracy, NoiseInTheHeightsComesThroughByTheKernelsGain) {
    // Uniform noise of deviation sqrt(1/12) over 250,000 texels has a statistical error of 0.3 %.
    const Image noise = rough(500, 500, 4321);
    for (const Kernel kernel : all_kernels) {
        const Image slopes = slopes_of(noise, options_of(kernel, Wrap::repeat));
        double squares = 0.0;
        for (const float slope : slopes.as<float>())
            squares += static_cast<double>(slope) * static_cast<double>(slope);
        const double found = std::sqrt(squares / 500000.0) / std::sqrt(1.0 / 12.0);
        const double gain = noise_gain(gradient_kernel(kernel, 3));
        EXPECT_NEAR(found, gain, 0.01 * gain) << static_cast<int>(kernel);
    }
}

TEST(BumpAccuracy, SumsOfTilingWavesTileAndTheHighOrderKernelIsBest) {
    const std::vector<HeightWave> waves = tiling_waves(128, 96, 24, 16.0, 0.4, 3);
    const BumpField field = wave_heights(128, 96, waves);
    const auto error = [&](Kernel kernel) {
        return normal_error(normals_from(field.heights, {kernel, Wrap::repeat, 1.0}), field);
    };
    // There is no margin: the border is as accurate as the middle.
    EXPECT_LT(error(Kernel::central7).max, 0.01);
    EXPECT_LT(error(Kernel::central5).rms, 0.05 * error(Kernel::central3).rms);
    EXPECT_LT(error(Kernel::central3).rms, error(Kernel::sobel3).rms);
}

NormalMapFormat format_of(int bits, FlatCode flat, Green green) {
    return {.bits = bits, .green = green, .flat = flat};
}

Image map_of(const Image& height, const BumpOptions& options, const NormalMapFormat& format) {
    Report report;
    return normal_map_from_height(height, options, format, report);
}

/// Returns the largest difference of two maps in codes, and the number of samples that differ.
template <typename Code>
std::pair<int, std::size_t> code_difference(const Image& a, const Image& b) {
    int greatest = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.sample_count(); ++i) {
        const int difference = std::abs(int{a.as<Code>()[i]} - int{b.as<Code>()[i]});
        greatest = std::max(greatest, difference);
        if (difference != 0) ++count;
    }
    return {greatest, count};
}

TEST(BumpCodes, AreThoseOfTheNormalsInEveryFormat) {
    const Image image = rough(1500, 40, 4321);  // A row has more than one piece.
    for (const Arithmetic arithmetic : {Arithmetic::float64, Arithmetic::float32}) {
        for (const FlatCode flat : {FlatCode::middle, FlatCode::half}) {
            for (const Green green : {Green::up, Green::down}) {
                BumpOptions options = options_of(Kernel::sobel3, Wrap::mirror, 4.0);
                const Image normals = normals_from(image, options);
                options.arithmetic = arithmetic;
                Report report;
                const auto wide = format_of(16, flat, green);
                const auto [greatest, count] = code_difference<std::uint16_t>(
                    map_of(image, options, wide), encode_normal_map(normals, wide, report));
                // With double, the rounding to float before coding decides; with float, 1e-7 of
                // 1.5e-5.
                EXPECT_LE(greatest, 1);
                EXPECT_LT(count, arithmetic == Arithmetic::float64 ? 1000U : 3000U);
                const auto narrow = format_of(8, flat, green);
                EXPECT_LE(code_difference<std::uint8_t>(map_of(image, options, narrow),
                                                        encode_normal_map(normals, narrow, report))
                              .second,
                          10U);
                const auto floats = format_of(32, flat, green);
                const Image scaled = encode_normal_map(normals, floats, report);
                const Image direct = map_of(image, options, floats);
                for (std::size_t i = 0; i < scaled.sample_count(); ++i)
                    ASSERT_NEAR(direct.as<float>()[i], scaled.as<float>()[i], 3e-7);
            }
        }
    }
}

TEST(BumpCodes, InFloatTheyAreThoseInDoubleAtEveryBorderAndSize) {
    const glm::ivec2 sizes[] = {{1, 1}, {1, 4}, {5, 1}, {2, 2}, {3, 3}, {17, 6}, {1025, 3}};
    for (const glm::ivec2 size : sizes) {
        const CodedHeights wide = coded_heights(rough(size.x, size.y, 4321), 16);
        const CodedHeights narrow = coded_heights(rough(size.x, size.y, 4321), 8);
        const Image floats = rough(size.x, size.y, 4321);
        for (const Image* image :
             std::initializer_list<const Image*>{&floats, &wide.codes, &narrow.codes}) {
            for (const Kernel kernel : all_kernels) {
                for (const Wrap x : all_wraps) {
                    for (const Wrap y : all_wraps) {
                        BumpOptions options = options_of(kernel, {x, y}, 3.0);
                        options.texel = {1.0, 0.5};
                        options.arithmetic = Arithmetic::float32;
                        const Image found = map_of(*image, options, {});
                        options.arithmetic = Arithmetic::float64;
                        const auto [greatest, count] =
                            code_difference<std::uint16_t>(found, map_of(*image, options, {}));
                        ASSERT_LE(greatest, 1) << static_cast<int>(kernel) << size.x << size.y;
                        ASSERT_LE(count, 2U + found.sample_count() / 50);
                    }
                }
            }
        }
    }
}

TEST(BumpCodes, AConstantMapIsExactlyTheFlatCode) {
    const Image image = heights_of(1030, 3, [](int, int) { return 0.7; });
    const Image map = map_of(image, {}, {});
    for (std::size_t i = 0; i < map.sample_count(); ++i)
        ASSERT_EQ(map.as<std::uint16_t>()[i], i % 3 == 2 ? 65535 : 32768);
}

TEST(BumpCodes, MemoryOfTheRightShapeIsUsedAgain) {
    const Image image = rough(20, 10, 4321);
    Report report;
    Image map;
    normal_map_from_height(image, {}, {}, map, report);
    const std::uint16_t* const first = map.as<std::uint16_t>().data();
    normal_map_from_height(image, {}, {}, map, report);
    EXPECT_EQ(map.as<std::uint16_t>().data(), first);
    normal_map_from_height(image, {}, format_of(8, FlatCode::middle, Green::up), map, report);
    EXPECT_EQ(map.bits(), 8);
}

TEST(BumpCodes, HolesAreFilledAndCountedOnTheWayToCodesToo) {
    Image image = rough(30, 20, 4321);
    image.as<float>()[77] = std::numeric_limits<float>::infinity();
    Report report;
    const Image map = normal_map_from_height(image, {}, {}, report);
    EXPECT_EQ(report.count("non-finite height"), 1U);
    double sum = 0.0;
    for (const std::size_t around : {46U, 47U, 48U, 76U, 78U, 106U, 107U, 108U})
        sum += static_cast<double>(image.as<float>()[around]);
    image.as<float>()[77] = static_cast<float>(sum / 8.0);
    EXPECT_EQ(map.samples, map_of(image, {}, {}).samples);
}

TEST(BumpCodes, PiecesTooSteepForFloatAreDoneInDouble) {
    // The square of 1e25 exceeds float. The second piece of the row is steep, and the first is not.
    const Image image =
        heights_of(2048, 4, [](int x, int) { return x < 1100 ? 0.5 * x : 1e25 * x; });
    BumpOptions options = options_of(Kernel::sobel3, Wrap::clamp);
    options.arithmetic = Arithmetic::float64;
    const Image exact = map_of(image, options, {});
    options.arithmetic = Arithmetic::float32;
    const Image found = map_of(image, options, {});
    EXPECT_LE(code_difference<std::uint16_t>(found, exact).first, 1);
    EXPECT_EQ(found.as<std::uint16_t>()[3 * 2000], 0);          // x is -1: the surface is vertical.
    EXPECT_EQ(found.as<std::uint16_t>()[3 * 2000 + 2], 32768);  // z is 0.
}

TEST(BumpCodes, StrengthsBeyondFloatAreDoneInDouble) {
    const Image image = heights_of(8, 8, [](int x, int) { return 1e-35 * x; });
    BumpOptions options = options_of(Kernel::sobel3, Wrap::clamp, 1e30);
    options.texel = {1e-5, 1e-5};
    options.arithmetic = Arithmetic::float32;
    const glm::dvec2 slope = slope_at(slopes_of(image, options), 3, 3);
    EXPECT_NEAR(slope.x, 1.0, 1e-6);
}

TEST(BumpBits, AreTheSameForEveryWidthOfRegistersAndNumberOfThreads) {
    const Image floats = rough(2500, 60, 4321);
    Image codes = make_image(2500, 60, 1, 16, ColorSpace::data);
    for (std::size_t i = 0; i < codes.sample_count(); ++i)
        codes.as<std::uint16_t>()[i] = static_cast<std::uint16_t>(floats.as<float>()[i] * 65535.0F);
    for (const Kernel kernel : all_kernels) {
        for (const Image* image : std::initializer_list<const Image*>{&floats, &codes}) {
            for (const Arithmetic arithmetic : {Arithmetic::float64, Arithmetic::float32}) {
                BumpOptions options = options_of(kernel, {Wrap::mirror, Wrap::clamp}, 5.0);
                options.arithmetic = arithmetic;
                const test::VectorBits narrow("128");
                set_thread_limit(1);
                const Image map = map_of(*image, options, {});
                const Image normals = normals_from(*image, options);
                for (const char* bits : {"256", "512"}) {
                    const test::VectorBits width(bits);
                    set_thread_limit(3);
                    EXPECT_TRUE(map_of(*image, options, {}).samples == map.samples) << bits;
                    EXPECT_TRUE(normals_from(*image, options).samples == normals.samples) << bits;
                }
                set_thread_limit(0);
            }
        }
    }
}

TEST(BumpBits, HeightsOf8And16BitsAreThoseOfTheirFloats) {
    for (const int bits : {8, 16}) {
        const CodedHeights coded = coded_heights(rough(40, 30, 4321), bits);
        for (const Kernel kernel : all_kernels) {
            const BumpOptions options = options_of(kernel, Wrap::repeat, 3.0);
            const Image direct = slopes_of(coded.codes, options);
            const Image floats = slopes_of(height_field(coded.codes), options);
            for (std::size_t i = 0; i < direct.sample_count(); ++i)
                ASSERT_NEAR(direct.as<float>()[i], floats.as<float>()[i], 2e-6);
        }
    }
}

}  // namespace
}  // namespace relief

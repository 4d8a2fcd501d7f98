// SPDX-License-Identifier: Apache-2.0
// Heights integrated from normals by every kernel and border, and the Fourier transforms that they
// use.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "image/fft.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/report.h"
#include "support/images.h"
#include "support/invariants.h"

namespace relief {
using namespace relief::accuracy;
using namespace relief::detail;

namespace {

constexpr std::size_t rows_at_once = RealTransform::lanes;

class Lengths : public testing::TestWithParam<std::size_t> {};

std::vector<double> noise(std::size_t count) {
    std::mt19937 random(3);
    std::vector<double> values(count);
    for (double& value : values)
        value = static_cast<double>(random()) / 4294967296.0 - 0.5;
    return values;
}

double basis(TransformKind kind, std::size_t j, std::size_t k, std::size_t n) {
    if (kind == TransformKind::hartley) {
        const double angle =
            2.0 * std::numbers::pi * static_cast<double>(j * k % n) / static_cast<double>(n);
        return std::cos(angle) + std::sin(angle);
    }
    const double steps = static_cast<double>((2 * j + 1) * k % (4 * n));
    return std::cos(std::numbers::pi * steps / (2.0 * static_cast<double>(n)));
}

TEST_P(Lengths, AreTransformedAsDefinedAndBack) {
    const std::size_t n = GetParam();
    for (const TransformKind kind : {TransformKind::hartley, TransformKind::cosine}) {
        const RealTransform transform(kind, n);
        const std::vector<double> before = noise(n * rows_at_once);
        std::vector<double> samples = before, scratch;
        transform.forward(samples.data(), scratch);
        double worst = 0.0;
        for (const std::size_t lane : {0UL, 3UL, 4UL, 7UL}) {
            for (std::size_t k = 0; k < n; k += 1 + n / 64) {
                double sum = 0.0;
                for (std::size_t j = 0; j < n; ++j)
                    sum += before[j * rows_at_once + lane] * basis(kind, j, k, n);
                worst = std::max(worst, std::abs(sum - samples[k * rows_at_once + lane]));
            }
        }
        EXPECT_LT(worst, 2e-12);
        transform.inverse(samples.data(), scratch);
        worst = 0.0;
        for (std::size_t i = 0; i < samples.size(); ++i)
            worst = std::max(worst, std::abs(samples[i] - before[i]));
        EXPECT_LT(worst, 1e-14);
    }
}

INSTANTIATE_TEST_SUITE_P(All, Lengths,
                         testing::Values(1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 16, 17, 60, 97, 128, 490,
                                         1000, 1001, 1009, 2048));

TEST(RealTransform, KnowsItsFrequencies) {
    EXPECT_DOUBLE_EQ(RealTransform(TransformKind::hartley, 8).frequency(2), std::numbers::pi / 2);
    EXPECT_DOUBLE_EQ(RealTransform(TransformKind::cosine, 8).frequency(2), std::numbers::pi / 4);
}

constexpr std::array kernels = {
    Kernel::forward, Kernel::central3, Kernel::prewitt3, Kernel::sobel3, Kernel::scharr3,
    Kernel::scharr5, Kernel::central5, Kernel::central7, Kernel::sobel5, Kernel::gaussian};

BumpField hills(int width, int height, double shortest = 8.0) {
    return wave_heights(width, height, tiling_waves(width, height, 12, shortest, 0.5, 3));
}

Image normals_of_heights(const Image& heights, Kernel kernel, Wraps wrap,
                         glm::dvec2 texel = {1.0, 1.0}) {
    BumpOptions bump{kernel, wrap, 1.0, texel};
    bump.arithmetic = Arithmetic::float64;
    Report report;
    return normals_from_height(heights, bump, report);
}

/// Returns the root mean square difference after subtraction of the means.
double height_error(const Image& heights, const Image& reference) {
    const std::span<const float> a = heights.as<float>();
    const std::span<const float> b = reference.as<float>();
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = static_cast<double>(a[i]) - static_cast<double>(b[i]);
        sum += difference;
        squares += difference * difference;
    }
    const auto count = static_cast<double>(a.size());
    return std::sqrt(std::max(0.0, squares / count - sum / count * (sum / count)));
}

double largest_angle(const Image& a, const Image& b) {
    double largest = 0.0;
    for (std::size_t i = 0; i + 2 < a.sample_count(); i += 3) {
        const auto normal = [i](const Image& image) {
            return glm::dvec3(image.as<float>()[i], image.as<float>()[i + 1],
                              image.as<float>()[i + 2]);
        };
        largest = std::max(largest, degrees_between(normal(a), normal(b)));
    }
    return largest;
}

TEST(HeightsFromNormals, GiveTheNormalsBackByTheSameKernel) {
    for (const Wraps wrap : {Wraps(Wrap::repeat), Wraps(Wrap::mirror), Wraps(Wrap::clamp),
                             Wraps(Wrap::repeat, Wrap::mirror), Wraps(Wrap::clamp, Wrap::repeat)}) {
        for (const Kernel kernel : kernels) {
            const bool is_clamped = wrap.x == Wrap::clamp || wrap.y == Wrap::clamp;
            // These two kernels are almost blind to waves of 3 texels, which clamped borders
            // introduce.
            if (is_clamped && (kernel == Kernel::sobel5 || kernel == Kernel::gaussian)) continue;
            SCOPED_TRACE(fmt::format("kernel {} wrap {},{}", static_cast<int>(kernel),
                                     static_cast<int>(wrap.x), static_cast<int>(wrap.y)));
            for (const auto& [width, height] : {std::pair{64, 48}, {61, 37}}) {
                const Image heights = hills(width, height).heights;
                const Image normals = normals_of_heights(heights, kernel, wrap);
                Report report;
                IntegrationOptions options;
                options.kernel = kernel;
                options.wrap = wrap;
                const IntegratedHeights result = heights_from_normals(normals, options, report);
                EXPECT_TRUE(report.empty());
                // 16-bit codes of a normal are 0.003 degrees apart.
                EXPECT_LT(result.residual.max, is_clamped ? 8e-3 : 3e-3);
                EXPECT_LT(result.residual.rms, is_clamped ? 5e-4 : 4e-4);
                EXPECT_LT(largest_angle(normals_of_heights(result.heights, kernel, wrap), normals),
                          result.residual.max + 2e-4);
                EXPECT_LT(height_error(result.heights, heights), 1e-3);
            }
        }
    }
}

TEST(HeightsFromNormals, AreThoseOfFieldsKnownInClosedForm) {
    // Exact normals, and kernels of different accuracy. In texels.
    const BumpField field = hills(128, 96, 12.0);
    Image normals = make_image(128, 96, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < normals.sample_count(); ++i)
        normals.as<float>()[i] = static_cast<float>(field.normals[i / 3][static_cast<int>(i % 3)]);
    const auto error = [&](Kernel kernel) {
        Report report;
        IntegrationOptions options;
        options.kernel = kernel;
        return height_error(heights_from_normals(normals, options, report).heights, field.heights);
    };
    EXPECT_LT(error(Kernel::central7), 3e-6);
    EXPECT_LT(error(Kernel::central5), 2e-4);
    EXPECT_LT(error(Kernel::central3), 2e-2);
    EXPECT_GT(error(Kernel::central3), 50 * error(Kernel::central5));
}

TEST(HeightsFromNormals, KeepAPlaneWithClampedBorders) {
    const Image plane = test::heights_of(33, 20, [](int x, int y) { return 0.25 * x - 0.5 * y; });
    Report report;
    IntegrationOptions options;
    options.wrap = Wrap::clamp;
    const IntegratedHeights result = heights_from_normals(
        normals_of_heights(plane, Kernel::central7, Wrap::clamp), options, report);
    EXPECT_LT(height_error(result.heights, plane), 1e-3);
    EXPECT_NEAR(result.highest, 0.25 * 32 + 0.5 * 19, 2e-3);
    EXPECT_NEAR(result.rms_slope, std::hypot(0.25, 0.5), 1e-6);
    EXPECT_NEAR(result.mean_slope.x, 0.25, 1e-6);
    EXPECT_NEAR(result.mean_slope.y, 0.5, 1e-6);
    options.level = true;
    EXPECT_LT(heights_from_normals(normals_of_heights(plane, Kernel::central7, Wrap::clamp),
                                   options, report)
                  .highest,
              1e-5);
}

TEST(HeightsFromNormals, HaveAResidualIfNoSurfaceFits) {
    // A vortex: slopes (-sin y, sin x) have no heights. They are added to hills.
    constexpr int side = 64;
    constexpr double turn = 2.0 * 3.14159265358979 / side;
    const Image heights = hills(side, side).heights;
    const Image plain = normals_of_heights(heights, Kernel::central7, Wrap::repeat);
    Image normals = plain;
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            float* n = &normals.as<float>()[static_cast<std::size_t>(row * side + column) * 3];
            n[0] = n[0] / n[2] + 0.1F * static_cast<float>(std::sin(turn * 4 * row));
            n[1] = n[1] / n[2] + 0.1F * static_cast<float>(std::sin(turn * 4 * column));
            n[2] = 1.0F;
        }
    }
    Report report;
    const IntegratedHeights result = heights_from_normals(normals, {}, report);
    EXPECT_LT(height_error(result.heights, heights), 1e-4);
    // sin^2 has the mean 1/2, and 1 over both axes.
    EXPECT_NEAR(result.residual_slope, 0.1, 1e-4);
    EXPECT_NEAR(result.residual.rms, 5.0, 1.0);
}

TEST(HeightsFromNormals, CountInvalidSlopes) {
    Image normals = normals_of_heights(hills(16, 16).heights, Kernel::central7, Wrap::repeat);
    const std::span<float> n = normals.as<float>();
    n[5 * 3] = std::numeric_limits<float>::quiet_NaN();
    n[7 * 3] = n[7 * 3 + 1] = n[7 * 3 + 2] = 0.0F;
    n[9 * 3] = 1.0F;
    n[9 * 3 + 1] = n[9 * 3 + 2] = 0.0F;
    n[20 * 3 + 2] = -0.5F;
    n[30 * 3] = 0.9F;
    n[30 * 3 + 2] = 0.01F;
    Report report;
    const IntegratedHeights result = heights_from_normals(normals, {}, report);
    EXPECT_EQ(report.count("normal without direction"), 2U);
    EXPECT_EQ(report.count("normal facing sideways or back"), 2U);
    EXPECT_EQ(report.count("normal too steep"), 1U);
    for (const float height : result.heights.as<float>())
        EXPECT_TRUE(std::isfinite(height) && height >= 0.0F && height < 100.0F);
}

TEST(HeightsFromNormals, KnowTexelsThatAreNotSquare) {
    const Image heights = hills(48, 40).heights;
    const glm::dvec2 texel(0.5, 2.0);
    Report report;
    IntegrationOptions options;
    options.texel = texel;
    const IntegratedHeights result = heights_from_normals(
        normals_of_heights(heights, Kernel::central7, Wrap::repeat, texel), options, report);
    EXPECT_LT(height_error(result.heights, heights), 1e-4);
}

TEST(HeightsFromNormals, TakeAnySizeAndAreTheSameForAnyNumberOfThreads) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 7}, {9, 1}, {2, 2}, {3, 5}}) {
        for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
            Image flat = make_image(width, height, 3, 32, ColorSpace::data);
            for (std::size_t i = 2; i < flat.sample_count(); i += 3)
                flat.as<float>()[i] = 1.0F;
            Report report;
            IntegrationOptions options;
            options.wrap = wrap;
            const IntegratedHeights result = heights_from_normals(flat, options, report);
            for (const float one : result.heights.as<float>())
                EXPECT_EQ(one, 0.0F);
            EXPECT_EQ(result.residual.max, 0.0);
        }
    }
    const Image normals = normals_of_heights(test::rough(150, 70), Kernel::sobel3, Wrap::clamp);
    IntegrationOptions options;
    options.wrap = Wraps(Wrap::clamp, Wrap::repeat);
    Report report;
    set_thread_limit(1);
    const IntegratedHeights one = heights_from_normals(normals, options, report);
    set_thread_limit(0);
    const IntegratedHeights many = heights_from_normals(normals, options, report);
    EXPECT_TRUE(std::ranges::equal(one.heights.as<float>(), many.heights.as<float>()));
    EXPECT_EQ(one.residual_slope, many.residual_slope);
}

TEST(HeightsFromNormals, RefuseInvalidMaps) {
    Report report;
    const auto message = [&](const Image& image, const IntegrationOptions& options = {}) {
        return test::message_of<InvalidInput>(
            [&] { heights_from_normals(image, options, report); });
    };
    EXPECT_EQ(message(Image{}), "the normal map is empty");
    EXPECT_EQ(message(make_image(2, 2, 3, 8, ColorSpace::data)),
              "normals have 3 float channels, not 3 of 8 bits");
    IntegrationOptions options;
    options.max_slope = 0.0;
    EXPECT_EQ(message(make_image(2, 2, 3, 32, ColorSpace::data), options),
              "the maximum slope is 0, but must be within [0.001, 1e6]");
}

}  // namespace
}  // namespace relief

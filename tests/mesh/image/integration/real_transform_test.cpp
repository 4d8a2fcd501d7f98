// SPDX-License-Identifier: Apache-2.0
// Transforms against their definition, for lengths of every kind: powers of two, each radix, mixed,
// and primes that go by a chirp.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "image/fft.h"

namespace relief {
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

}  // namespace
}  // namespace relief

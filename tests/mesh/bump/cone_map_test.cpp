// SPDX-License-Identifier: Apache-2.0
// Cone maps: hand-computed cones, and that no step within a cone passes by the first hit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "portable_math.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/height_march.h"
#include "relief/mesh/report.h"
#include "support/images.h"

namespace relief {
namespace {

using detail::Random;
using test::all_wraps;
using test::heights_of;
using test::rough;
using test::samples_of;

/// The roots of all texels, as fractions.
std::vector<double> roots_of(const Image& cones) {
    const std::vector<float> samples = samples_of<float>(to_float(cones));
    std::vector<double> roots;
    for (std::size_t i = 1; i < samples.size(); i += 2)
        roots.push_back(samples[i]);
    return roots;
}

HeightField cone_field(const HeightField& field, const Image& cones) {
    return {channel_of(cones, 1), field.wraps()};
}

TEST(ConeMaps, EndAtTheFallingSideOfAPole) {
    const HeightField field(heights_of(64, 1, [](int x, int) { return x == 20 ? 1.0 : 0.0; }),
                            Wrap::repeat);
    const std::vector<double> roots = roots_of(relaxed_cones(field, 32));
    // Beyond its center the pole falls away from texel 10. The nearest apex is at 11, so the radius
    // is 9 texels of 64 where the height is 1.
    EXPECT_FLOAT_EQ(static_cast<float>(roots[10]), std::sqrt(9.0F / 64));
    EXPECT_FLOAT_EQ(static_cast<float>(roots[30]), std::sqrt(9.0F / 64));
    // The top is above everything.
    EXPECT_GT(roots[20], 0.0);
}

TEST(ConeMaps, AreWidestOnFlatMapsAndOnPlateaus) {
    for (const Wrap wrap : all_wraps) {
        const HeightField flat(heights_of(5, 3, [](int, int) { return 0.25; }), wrap);
        for (const double root : roots_of(relaxed_cones(flat, 16)))
            EXPECT_EQ(root, 1.0);
    }
    const HeightField step(heights_of(300, 1, [](int x, int) { return x < 150 ? 0.0 : 1.0; }),
                           Wrap::clamp);
    const std::vector<double> roots = roots_of(relaxed_cones(step, 32));
    // A step that rises and never falls does not matter, but radii end at 128 texels.
    EXPECT_FLOAT_EQ(static_cast<float>(roots[100]), std::sqrt(128.0F / 300));
    EXPECT_EQ(roots[250], 1.0);
}

TEST(ConeMaps, NeverPassByTheFirstHit) {
    const auto blocks = [](int x, int y) { return (x / 5 + y / 4) % 3 == 0 ? 0.9 : 0.1; };
    for (const Wrap wrap : all_wraps) {
        for (const Image& image : {rough(24, 17), rough(1, 9), heights_of(40, 32, blocks)}) {
            const HeightField field(image, wrap);
            for (const int bits : {8, 16, 32}) {
                const HeightField cones = cone_field(field, relaxed_cones(field, bits));
                HeightMarch march{HeightMethod::relaxed_cones, 512, 16, 1};
                Random random(31);
                int misses = 0;
                for (int i = 0; i < 300; ++i) {
                    HeightRay ray;
                    ray.texcoord = {random.between(-1.0, 2.0), random.between(-1.0, 2.0)};
                    ray.direction = {random.between(-8.0, 8.0), random.between(-8.0, 8.0), 1.0};
                    ray.black_depth = 10.0;
                    const double exact = field.first_hit(ray).depth;
                    const double depth = field.march(ray, march, &cones).depth;
                    // Bisection ends below the surface, within 2^-16 of its interval.
                    EXPECT_LE(depth, exact + 10.0 * 0x1p-16 + 1e-9);
                    if (depth < exact - 0.1) ++misses;
                    march.layers = 8;
                    EXPECT_LE(field.march(ray, march, &cones).depth, exact + 10.0 * 0x1p-16 + 1e-9);
                    march.layers = 512;
                }
                // Some rays along the surface do not arrive in 512 steps.
                EXPECT_LE(misses, bits == 8 ? 150 : 9);
            }
        }
    }
}

TEST(ConeMaps, MoveWithMapsThatRepeat) {
    const Image image = rough(31, 20, 5);
    const Image moved = heights_of(31, 20, [&](int x, int y) {
        return image.as<float>()[static_cast<std::size_t>((y + 4) % 20 * 31 + (x + 7) % 31)];
    });
    const Image cones = relaxed_cones(HeightField(image, Wrap::repeat), 16);
    const Image other = relaxed_cones(HeightField(moved, Wrap::repeat), 16);
    for (int y = 0; y < 20; ++y) {
        for (int x = 0; x < 31; ++x) {
            const auto at = static_cast<std::size_t>(2 * (y * 31 + x));
            const auto from = static_cast<std::size_t>(2 * ((y + 4) % 20 * 31 + (x + 7) % 31));
            EXPECT_EQ(other.as<std::uint16_t>()[at], cones.as<std::uint16_t>()[from]);
            EXPECT_EQ(other.as<std::uint16_t>()[at + 1], cones.as<std::uint16_t>()[from + 1]);
        }
    }
}

TEST(ConeMaps, AreTheSameForAnyNumberOfThreads) {
    const HeightField field(rough(80, 50), Wrap::mirror);
    set_thread_limit(1);
    const Image alone = relaxed_cones(field, 16);
    set_thread_limit(0);
    EXPECT_EQ(alone.samples, relaxed_cones(field, 16).samples);
}

TEST(ConeMaps, CoverLongThinMaps) {
    const HeightField field(
        heights_of(16384, 4, [](int x, int) { return x % 1000 == 7 ? 1.0 : 0.0; }), Wrap::clamp);
    const std::vector<double> roots = roots_of(relaxed_cones(field, 32));
    EXPECT_FLOAT_EQ(static_cast<float>(roots[8000]), std::sqrt(6.0F / 16384));
    EXPECT_THROW(relaxed_cones(field, 12), InvalidInput);
}

}  // namespace
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// The fields that kernels are judged by: their truth in a second way, and that they are stored as
// they say.
#include "relief/mesh/bump_fields.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "relief/mesh/error.h"
#include "relief/mesh/height_statistics.h"

namespace relief {
namespace {

FieldRecipe recipe_of(FieldShape shape, FieldCoding coding = FieldCoding::float32,
                      double noise = 0.0) {
    return {"", shape, 40.0, 0.3, coding, noise, 9};
}

/// Texels whose true normal is farther than so many degrees from that of finite differences.
double share_beyond(double degrees, const BumpField& field) {
    BumpOptions options = field.options;
    options.kernel = Kernel::central7;
    Report report;
    const Image found = normals_from_height(field.heights, options, report);
    const std::span<const float> n = found.as<float>();
    double beyond = 0.0;
    double all = 0.0;
    for (std::size_t i = 0; i < field.normals.size(); ++i) {
        if (std::isnan(field.normals[i].x)) continue;
        all += 1.0;
        const glm::dvec3 normal(n[3 * i], n[3 * i + 1], n[3 * i + 2]);
        if (degrees_between(normal, field.normals[i]) > degrees) beyond += 1.0;
    }
    return beyond / all;
}

TEST(BumpFields, TheirNormalsAreThoseOfDifferencesOfHighOrder) {
    for (const FieldShape shape : {FieldShape::waves, FieldShape::mixed}) {
        EXPECT_EQ(share_beyond(2e-3, make_bump_field(recipe_of(shape), 160, 128)), 0.0);
    }
    // Bent at their rims, folded at ridges, open at the border: there alone differences are off.
    EXPECT_EQ(share_beyond(0.5, make_bump_field(recipe_of(FieldShape::domes), 160, 128)), 0.0);
    EXPECT_LT(share_beyond(2e-3, make_bump_field(recipe_of(FieldShape::domes), 160, 128)), 0.35);
    EXPECT_LT(share_beyond(2e-3, make_bump_field(recipe_of(FieldShape::open), 160, 128)), 0.1);
    const double near_ridges = 1.0 - std::pow(1.0 - 12.0 / 40.0, 2) + 1e-12;
    EXPECT_LE(share_beyond(2e-3, make_bump_field(recipe_of(FieldShape::creases), 160, 160)),
              near_ridges);
    EXPECT_LT(share_beyond(2e-3, make_bump_field(recipe_of(FieldShape::terraces), 160, 160)), 0.5);
}

TEST(BumpFields, AFieldOfItsOwnIsSampledWithTheSlopeOfItsFormula) {
    const AnalyticHeights field = sampled_heights(5, 4, [](const glm::dvec2& p) {
        return HeightSample{p.x * p.x * 0.25 - 2.0 * p.y, {0.5 * p.x, -2.0}};
    });
    EXPECT_EQ(field.heights.as<float>()[1 * 5 + 4], 2.0F);
    EXPECT_LT(glm::length(field.normals[1 * 5 + 4] - glm::normalize(glm::dvec3(-2.0, -2.0, 1.0))),
              1e-15);
}

TEST(BumpFields, TerracesHaveNoNormalBesideWallsAndOneElsewhere) {
    const BumpField field = make_bump_field(recipe_of(FieldShape::terraces), 160, 160);
    const std::span<const float> heights = field.heights.as<float>();
    std::size_t without = 0;
    for (std::size_t y = 0; y < 160; ++y) {
        for (std::size_t x = 0; x + 1 < 160; ++x) {
            const std::size_t i = y * 160 + x;
            // Walls are 1.2 texels high, the ground rises by less than 0.9 in a texel.
            if (std::abs(heights[i + 1] - heights[i]) > 0.9F) {
                EXPECT_TRUE(std::isnan(field.normals[i].x) && std::isnan(field.normals[i + 1].x));
            }
            without += std::isnan(field.normals[i].x) ? 1 : 0;
        }
    }
    EXPECT_GT(without, 300U);
    EXPECT_LT(without, 160U * 160U / 4U);
}

TEST(BumpFields, AreStoredAsTheySay) {
    const auto stored = [](FieldCoding coding) {
        return make_bump_field(recipe_of(FieldShape::waves, coding), 128, 128);
    };
    EXPECT_EQ(height_depth(stored(FieldCoding::float32).heights).bits, 0);
    EXPECT_EQ(height_depth(stored(FieldCoding::bits16).heights).bits, 16);
    EXPECT_EQ(height_depth(stored(FieldCoding::bits8).heights).bits, 8);
    const BumpField wide = stored(FieldCoding::bits8_in_16);
    EXPECT_EQ(wide.heights.bits(), 16);
    EXPECT_EQ(height_depth(wide.heights).bits, 8);
    EXPECT_EQ(wide.options.strength, stored(FieldCoding::bits8).options.strength);
    const BumpField dim = stored(FieldCoding::bits8_dim);
    const auto codes = dim.heights.as<std::uint8_t>();
    EXPECT_EQ((std::set<int>(codes.begin(), codes.end()).size()), 25U);
    EXPECT_EQ(*std::min_element(codes.begin(), codes.end()), 100);
    // 24 codes of 255 over the range that float heights have.
    EXPECT_NEAR(dim.options.strength * 24.0 / 255.0, wide.options.strength, 1e-9);
    const BumpField half = stored(FieldCoding::float16);
    for (const float height : half.heights.as<float>()) {
        int exponent = 0;
        const double times = std::frexp(static_cast<double>(height), &exponent) * 2048.0;
        ASSERT_EQ(times, std::round(times));
    }
}

TEST(BumpFields, NoiseHasItsDeviationAndTheTruthHasNone) {
    const BumpField clean = make_bump_field(recipe_of(FieldShape::waves), 128, 128);
    const BumpField noisy =
        make_bump_field(recipe_of(FieldShape::waves, FieldCoding::float32, 0.2), 128, 128);
    double squares = 0.0;
    for (std::size_t i = 0; i < clean.normals.size(); ++i) {
        const double noise = static_cast<double>(noisy.heights.as<float>()[i]) -
                             static_cast<double>(clean.heights.as<float>()[i]);
        squares += noise * noise;
        ASSERT_EQ(noisy.normals[i], clean.normals[i]);
    }
    EXPECT_NEAR(std::sqrt(squares / static_cast<double>(clean.normals.size())), 0.2, 0.003);
}

TEST(BumpFields, TheSetsHaveEveryShapeAndCodingAndAreApart) {
    std::set<std::string> names;
    std::set<std::uint32_t> seeds;
    for (const auto& set : {tuning_fields(), evaluation_fields()}) {
        std::set<FieldShape> shapes;
        std::set<FieldCoding> codings;
        int noisy = 0;
        for (const FieldRecipe& recipe : set) {
            EXPECT_TRUE(names.insert(recipe.name).second) << recipe.name;
            EXPECT_TRUE(seeds.insert(recipe.seed).second) << recipe.name;
            shapes.insert(recipe.shape);
            codings.insert(recipe.coding);
            noisy += recipe.noise > 0.0 ? 1 : 0;
        }
        EXPECT_EQ(shapes.size(), 6U);
        EXPECT_EQ(codings.size(), 6U);
        EXPECT_GE(noisy, 7);
    }
}

TEST(BumpFields, SizesThatDoNotFitAreRefused) {
    EXPECT_THROW(make_bump_field(recipe_of(FieldShape::waves), 7, 64), InvalidInput);
    const BumpField field = make_bump_field(recipe_of(FieldShape::waves), 16, 16);
    EXPECT_THROW(field_error(make_image(16, 15, 3, 32, ColorSpace::data), field), InvalidInput);
}

}  // namespace
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Blended normals: the sum of two height fields where that is what a method claims, the rotation
// where it claims that, hand-computed values for the others; sizes that differ; back faces.
#include "relief/mesh/normal_blend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "relief/mesh/analytic_heights.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/error.h"
#include "relief/mesh/threads.h"
#include "support/message_of.h"
#include "support/samples.h"

namespace relief {
namespace {

using test::samples_of;
using testing::ElementsAre;

Image image_of(int width, const std::vector<glm::dvec3>& directions) {
    Image image =
        make_image(width, static_cast<int>(directions.size()) / width, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        for (int c = 0; c < 3; ++c)
            image.as<float>()[i * 3 + static_cast<std::size_t>(c)] =
                static_cast<float>(glm::normalize(directions[i])[c]);
    }
    return image;
}

std::vector<glm::dvec3> directions_of(const Image& image) {
    std::vector<glm::dvec3> result;
    for (std::size_t i = 0; i < image.sample_count(); i += 3)
        result.emplace_back(image.as<float>()[i], image.as<float>()[i + 1],
                            image.as<float>()[i + 2]);
    return result;
}

glm::dvec3 blend_of(const glm::dvec3& base, const glm::dvec3& detail, NormalBlend method) {
    Image image = image_of(1, {base});
    Report report;
    blend_normals(image, image_of(1, {detail}), method, report);
    const glm::dvec3 result = directions_of(image)[0];
    EXPECT_EQ(report.count("blend without direction"), 0U);
    EXPECT_EQ(report.count("detail facing back on its base"),
              base.z >= 0 && result.z < 0 ? 1U : 0U);
    return result;
}

/// What float of a unit vector resolves.
constexpr double resolved_degrees = 1e-5;

std::vector<glm::dvec3> outward_directions() {
    std::vector<glm::dvec3> result;
    for (int i = 0; i < 40; ++i) {
        const double z = 1.0 - i / 40.0;
        const double across = std::sqrt(1.0 - z * z);
        result.emplace_back(across * std::cos(2.4 * i), across * std::sin(2.4 * i), z);
    }
    return result;
}

TEST(BlendNormals, PartialDerivativeIsTheSumOfTheHeights) {
    constexpr int side = 48;
    const std::vector<HeightWave> base_waves = tiling_waves(side, side, 4, 16, 1.0, 1);
    const std::vector<HeightWave> detail_waves = tiling_waves(side, side, 5, 6, 0.7, 2);
    std::vector<HeightWave> both = base_waves;
    both.insert(both.end(), detail_waves.begin(), detail_waves.end());
    Image image = image_of(side, wave_heights(side, side, base_waves).normals);
    const Image detail = image_of(side, wave_heights(side, side, detail_waves).normals);
    Report report;
    blend_normals(image, detail, NormalBlend::partial_derivative, report);
    EXPECT_LT(normal_error(image, wave_heights(side, side, both)).max, resolved_degrees);
    EXPECT_TRUE(report.empty());
}

TEST(BlendNormals, ReorientedIsTheShortestRotation) {
    for (const glm::dvec3& base : outward_directions()) {
        for (const glm::dvec3& detail : outward_directions()) {
            const glm::dquat turn(glm::dvec3(0, 0, 1), base);
            EXPECT_LT(
                degrees_between(blend_of(base, detail, NormalBlend::reoriented), turn * detail),
                resolved_degrees);
        }
    }
}

TEST(BlendNormals, UnityTurnsTheDetailsAxesOneByOne) {
    const glm::dvec3 b = glm::normalize(glm::dvec3(0.3, -0.2, 0.9));
    // The axes of the frame, as what they make of the axes of the detail.
    EXPECT_LT(degrees_between(blend_of(b, {0, 0, 1}, NormalBlend::unity), b), resolved_degrees);
    EXPECT_LT(degrees_between(blend_of(b, {1, 0, 0}, NormalBlend::unity), {b.z, b.y, -b.x}),
              resolved_degrees);
    EXPECT_LT(degrees_between(blend_of(b, {0, 1, 0}, NormalBlend::unity), {b.x, b.z, -b.y}),
              resolved_degrees);
}

TEST(BlendNormals, TheOthersAreTheirFormulas) {
    const glm::dvec3 base(0.6, 0.0, 0.8);
    const glm::dvec3 detail(0.0, -0.28, 0.96);
    const auto expect = [&](NormalBlend method, const glm::dvec3& expected) {
        EXPECT_LT(degrees_between(blend_of(base, detail, method), expected), resolved_degrees);
    };
    expect(NormalBlend::whiteout, {0.6, -0.28, 0.768});
    expect(NormalBlend::udn, {0.6, -0.28, 0.8});
    expect(NormalBlend::linear, {0.6, -0.28, 1.76});
    // (0.8, 0.5, 0.9) over (0.5, 0.36, 0.98): 1 - 2 * 0.2 * 0.5, 1 - 2 * 0.5 * 0.64, ...
    expect(NormalBlend::overlay, {0.6, -0.28, 0.992});
    // Where the base is dark: 2 * 0.2 * 0.5.
    EXPECT_LT(degrees_between(blend_of({-0.6, 0, 0.8}, detail, NormalBlend::overlay),
                              {-0.6, -0.28, 0.992}),
              resolved_degrees);
}

TEST(BlendNormals, FlatIsNeutralWhereThatIsPromised) {
    const glm::dvec3 flat(0, 0, 1);
    for (const NormalBlend method : all_normal_blends) {
        EXPECT_EQ(blend_of(flat, flat, method), flat);
        const bool halves = method == NormalBlend::linear || method == NormalBlend::overlay;
        for (const glm::dvec3& n : outward_directions()) {
            if (n.z < 0.5) continue;
            if (halves) continue;
            EXPECT_LT(degrees_between(blend_of(n, flat, method), n), resolved_degrees);
            if (method == NormalBlend::udn) continue;
            EXPECT_LT(degrees_between(blend_of(flat, n, method), n), resolved_degrees);
        }
    }
    EXPECT_LT(degrees_between(blend_of({0.6, 0, 0.8}, flat, NormalBlend::linear), {0.6, 0, 1.8}),
              resolved_degrees);
    EXPECT_LT(degrees_between(blend_of(flat, {0.6, 0, 0.8}, NormalBlend::udn), {0.6, 0, 1}),
              resolved_degrees);
}

TEST(BlendNormals, ASmallerDetailIsRepeatedAndALargerOneCutOff) {
    const Image detail = image_of(2, {{0.6, 0, 0.8}, {0, 0.6, 0.8}, {-0.6, 0, 0.8}, {0, 0, 1}});
    const std::vector<glm::dvec3> pattern = directions_of(detail);
    Image base = image_of(5, std::vector<glm::dvec3>(15, {0, 0, 1}));
    Report report;
    blend_normals(base, detail, NormalBlend::whiteout, report);
    const std::vector<glm::dvec3> result = directions_of(base);
    for (std::size_t y = 0; y < 3; ++y) {
        for (std::size_t x = 0; x < 5; ++x)
            EXPECT_LT(degrees_between(result[y * 5 + x], pattern[y % 2 * 2 + x % 2]),
                      resolved_degrees);
    }
    Image small = image_of(1, {{0, 0, 1}});
    blend_normals(small, detail, NormalBlend::whiteout, report);
    EXPECT_LT(degrees_between(directions_of(small)[0], {0.6, 0, 0.8}), resolved_degrees);
}

TEST(BlendNormals, WhereThereIsNoDirectionTheBaseStaysAndIsCounted) {
    for (const auto& [method, base, detail] :
         {std::tuple{NormalBlend::reoriented, glm::dvec3(0, 0, -1), glm::dvec3(0.6, 0, 0.8)},
          std::tuple{NormalBlend::linear, glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0)},
          std::tuple{NormalBlend::whiteout, glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0)},
          std::tuple{NormalBlend::partial_derivative, glm::dvec3(1, 0, 0), glm::dvec3(1, 0, 0)}}) {
        Image image = image_of(2, {{0, 0, 1}, base});
        Report report;
        blend_normals(image, image_of(2, {{0, 0, 1}, detail}), method, report);
        EXPECT_EQ(directions_of(image)[1], base);
        EXPECT_EQ(report.count("blend without direction"), 1U);
        EXPECT_THAT(report.findings()[0].first, ElementsAre(1));
    }
}

TEST(BlendNormals, TheSameBitsForAnyNumberOfThreads) {
    const Image base =
        image_of(300, wave_heights(300, 200, tiling_waves(300, 200, 6, 9, 1, 3)).normals);
    const Image detail =
        image_of(37, wave_heights(37, 11, tiling_waves(37, 11, 3, 5, 1, 4)).normals);
    for (const NormalBlend method : all_normal_blends) {
        Report report;
        Image one = base;
        set_thread_limit(1);
        blend_normals(one, detail, method, report);
        set_thread_limit(0);
        Image many = base;
        blend_normals(many, detail, method, report);
        EXPECT_EQ(one.samples, many.samples);
    }
}

TEST(BlendNormals, RefusesWhatAreNoNormals) {
    Image base = image_of(1, {{0, 0, 1}});
    Report report;
    const Image codes = make_image(2, 2, 3, 8, ColorSpace::data);
    EXPECT_EQ(test::message_of<InvalidInput>(
                  [&] { blend_normals(base, codes, NormalBlend::udn, report); }),
              "normals of a detail have 3 float channels, not 3 of 8 bits");
}

}  // namespace
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// The C interface of bakes: the results of C++, and wrong use.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "relief/mesh/bake.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/relief.h"

namespace relief {
namespace {

using testing::HasSubstr;

/// The wavy square and the flat square of a bake, in plain arrays.
struct BakePair {
    explicit BakePair() : high(make_quad(16)), low(make_quad(1)) {
        for (glm::vec3& position : high.positions)
            position.z = 0.05F * std::sin(3.0F * position.x);
        high.normals.clear();
        high.tangents.clear();
        low.tangents.clear();
        high_view = view_of(high);
        low_view = view_of(low);
    }

    static relief_mesh view_of(const Mesh& mesh) {
        relief_mesh view{};
        EXPECT_EQ(relief_mesh_init(&view, sizeof(view)), RELIEF_OK);
        view.vertex_count = mesh.positions.size();
        view.triangle_count = mesh.triangles.size();
        view.positions = &mesh.positions[0].x;
        view.normals = mesh.normals.empty() ? nullptr : &mesh.normals[0].x;
        view.texcoords = &mesh.texcoords[0].x;
        view.indices = mesh.triangles.data();
        return view;
    }

    Mesh high, low;
    relief_mesh high_view{}, low_view{};
};

constexpr int baked_size = 96;  // Two bands of rows.

TEST(CBake, BakesAsCpp) {
    const BakePair pair;
    BakeOptions same;
    same.map.width = same.map.height = baked_size;
    same.map.samples = 4;
    same.map.layers.heights = true;
    same.map.layers.occlusion = OcclusionOptions{.rays = 16};
    Image expected = make_image(baked_size, baked_size, 3, 32, ColorSpace::data);
    std::vector<float> expected_heights, expected_occlusion;
    Report report;
    const BakeResult cpp = bake_normals(
        std::span(&pair.high, 1), pair.low, same,
        [&](const BakedRows& rows) {
            std::copy(rows.normals.begin(), rows.normals.end(),
                      MutableImageView(expected).row<float>(rows.first_row));
            expected_heights.insert(expected_heights.end(), rows.heights.begin(),
                                    rows.heights.end());
            expected_occlusion.insert(expected_occlusion.end(), rows.occlusion.begin(),
                                      rows.occlusion.end());
        },
        report);
    const NormalMapFormat format{.bits = 8, .dither = Dither::blue_noise};
    Image expected_map = make_image(baked_size, baked_size, 4, 8, ColorSpace::data);
    encode_normal_map(expected, format, MutableImageView(expected_map));

    relief_bake_options options{};
    relief_bake_maps maps{};
    relief_bake_result result{};
    ASSERT_EQ(relief_bake_options_init(&options, sizeof(options)), RELIEF_OK);
    ASSERT_EQ(relief_bake_maps_init(&maps, sizeof(maps)), RELIEF_OK);
    ASSERT_EQ(relief_bake_result_init(&result, sizeof(result)), RELIEF_OK);
    options.samples = 4;
    options.occlusion_rays = 16;
    options.dither = RELIEF_DITHER_BLUE_NOISE;
    std::vector<std::uint8_t> texels(4 * baked_size * baked_size), states(baked_size * baked_size);
    std::vector<float> heights(states.size()), occlusion(states.size());
    maps.normals = {texels.data(), 0, baked_size, baked_size, 4, RELIEF_SAMPLE_UINT8};
    maps.heights = {heights.data(), 0, baked_size, baked_size, 1, RELIEF_SAMPLE_FLOAT};
    maps.occlusion = {occlusion.data(), 0, baked_size, baked_size, 1, RELIEF_SAMPLE_FLOAT};
    maps.states = states.data();
    const relief_mesh* const high[] = {&pair.high_view};
    ASSERT_EQ(relief_bake(high, 1, &pair.low_view, &options, nullptr, &maps, &result, nullptr),
              RELIEF_OK)
        << relief_last_error();
    EXPECT_EQ(texels, std::get<std::vector<std::uint8_t>>(expected_map.samples));
    EXPECT_EQ(heights, expected_heights);
    EXPECT_EQ(occlusion, expected_occlusion);
    EXPECT_THAT(states, testing::Each(RELIEF_TEXEL_BAKED));
    EXPECT_EQ(result.texels_baked, cpp.texels_baked);
    EXPECT_EQ(result.rays, cpp.rays);
    EXPECT_EQ(result.offset, cpp.distances.offset);
    EXPECT_EQ(result.max_height, cpp.max_height);
}

TEST(CBake, HasFurtherLayersAsCpp) {
    const BakePair pair;
    BakeOptions same;
    same.map.width = same.map.height = baked_size;
    same.map.layers.normals = false;
    same.map.layers.bent_normals = OcclusionOptions{.rays = 16};
    same.map.layers.thickness = ThicknessOptions{.rays = 8, .distance = 0.5};
    same.map.layers.curvature = same.map.layers.positions = true;
    Image bent = make_image(baked_size, baked_size, 3, 32, ColorSpace::data);
    std::vector<float> expected_thickness, expected_curvature, expected_positions;
    const auto append = [](std::vector<float>& values, std::span<const float> more) {
        values.insert(values.end(), more.begin(), more.end());
    };
    const BakeResult cpp =
        bake_normals(std::span(&pair.high, 1), pair.low, same, [&](const BakedRows& rows) {
            std::copy(rows.bent_normals.begin(), rows.bent_normals.end(),
                      MutableImageView(bent).row<float>(rows.first_row));
            append(expected_thickness, rows.thickness);
            append(expected_curvature, rows.curvature);
            append(expected_positions, rows.positions);
        });
    Image expected_bent = make_image(baked_size, baked_size, 3, 8, ColorSpace::data);
    encode_normal_map(bent, {.bits = 8, .green = Green::down}, MutableImageView(expected_bent));

    relief_bake_options options{};
    relief_bake_maps maps{};
    relief_bake_result result{};
    ASSERT_EQ(relief_bake_options_init(&options, sizeof(options)), RELIEF_OK);
    ASSERT_EQ(relief_bake_maps_init(&maps, sizeof(maps)), RELIEF_OK);
    ASSERT_EQ(relief_bake_result_init(&result, sizeof(result)), RELIEF_OK);
    EXPECT_EQ(options.thickness_rays, 64);
    EXPECT_EQ(options.thickness_distance, RELIEF_ABSENT);
    options.occlusion_rays = 16;
    options.thickness_rays = 8;
    options.thickness_distance = 0.5;
    options.green = RELIEF_GREEN_DOWN;
    constexpr std::size_t texels = std::size_t{baked_size} * baked_size;
    std::vector<std::uint8_t> bent_texels(3 * texels);
    std::vector<float> thickness(texels), curvature(texels), positions(3 * texels), ids(texels);
    const auto image = [](auto& values, int channels, int type) {
        return relief_output_image{values.data(), 0, baked_size, baked_size, channels, type};
    };
    maps.bent_normals = image(bent_texels, 3, RELIEF_SAMPLE_UINT8);
    maps.thickness = image(thickness, 1, RELIEF_SAMPLE_FLOAT);
    maps.curvature = image(curvature, 1, RELIEF_SAMPLE_FLOAT);
    maps.positions = image(positions, 3, RELIEF_SAMPLE_FLOAT);
    maps.ids = image(ids, 1, RELIEF_SAMPLE_FLOAT);
    // The first half of the triangles is 7, the others are 16000000.
    std::vector<std::uint32_t> numbers(pair.high.triangles.size(), 7);
    std::fill(numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2), numbers.end(),
              16'000'000);
    const std::uint32_t* const high_ids[] = {numbers.data()};
    options.high_ids = high_ids;
    const relief_mesh* const high[] = {&pair.high_view};
    const auto bake = [&] {
        return relief_bake(high, 1, &pair.low_view, &options, nullptr, &maps, &result, nullptr);
    };
    ASSERT_EQ(bake(), RELIEF_OK) << relief_last_error();
    EXPECT_EQ(bent_texels, std::get<std::vector<std::uint8_t>>(expected_bent.samples));
    EXPECT_EQ(thickness, expected_thickness);
    EXPECT_EQ(curvature, expected_curvature);
    EXPECT_EQ(positions, expected_positions);
    EXPECT_EQ(result.occlusion_rays, cpp.occlusion_rays);
    EXPECT_GT(result.thickness_rays, 0U);
    EXPECT_EQ(result.open_thickness_rays, cpp.open_thickness_rays);
    const auto count = [&](float id) { return std::count(ids.begin(), ids.end(), id); };
    EXPECT_NEAR(static_cast<double>(count(7.0F)) / texels, 0.5, 0.02);
    EXPECT_EQ(count(7.0F) + count(16'000'000.0F), static_cast<std::ptrdiff_t>(texels));
    options.high_ids = nullptr;
    ASSERT_EQ(bake(), RELIEF_OK) << relief_last_error();
    EXPECT_EQ(count(0.0F), static_cast<std::ptrdiff_t>(texels));
    numbers[3] = 1U << 24U;
    options.high_ids = high_ids;
    EXPECT_EQ(bake(), RELIEF_INVALID_INPUT);
    EXPECT_STREQ(relief_last_error(),
                 "triangle 3 of high mesh 0 has the id 16777216, but ids must be below 16777216");
    // A program that was compiled before has none of these fields.
    options.size = offsetof(relief_bake_options, thickness_distance);
    maps.size = offsetof(relief_bake_maps, bent_normals);
    result = {};
    result.size = offsetof(relief_bake_result, occlusion_rays);
    std::fill(thickness.begin(), thickness.end(), -2.0F);
    maps.heights = image(curvature, 1, RELIEF_SAMPLE_FLOAT);
    ASSERT_EQ(bake(), RELIEF_OK) << relief_last_error();
    EXPECT_THAT(thickness, testing::Each(-2.0F));
    EXPECT_EQ(result.occlusion_rays, 0U);
    EXPECT_EQ(result.texels_baked, texels);
}

struct WrongBake {
    const char* message;
    std::function<void(BakePair& pair, relief_bake_options& options, relief_bake_maps& maps)>
        change;
};

TEST(CBake, RefusesWrongUse) {
    const WrongBake rows[] = {
        {"no map to bake has pixels",
         [](auto&, auto&, auto& maps) { maps.normals.pixels = nullptr; }},
        {"the height map has 2 channels, but must have one of floats",
         [](auto&, auto&, auto& maps) {
             maps.heights = maps.normals;
             maps.heights.channels = 2;
         }},
        {"the occlusion map has 1 channels, but must have one of floats",
         [](auto&, auto&, auto& maps) {
             maps.occlusion = maps.normals;
             maps.occlusion.channels = 1;
         }},
        {"the height map has 8 x 4 texels, but another map has 8 x 8",
         [](auto&, auto&, auto& maps) {
             static std::array<float, 32> heights;
             maps.heights = {heights.data(), 0, 8, 4, 1, RELIEF_SAMPLE_FLOAT};
         }},
        {"no texture coordinates",
         [](auto& pair, auto&, auto&) { pair.low_view.texcoords = nullptr; }},
        {"the positions are NULL",
         [](auto& pair, auto&, auto&) { pair.high_view.positions = nullptr; }},
        {"directions is 3, but must be within 0 to 2",
         [](auto&, auto& options, auto&) { options.directions = 3; }},
        {"nan", [](auto&, auto& options, auto&) { options.offset = NAN; }},
        {"3", [](auto&, auto& options, auto&) { options.samples = 3; }},
    };
    for (const WrongBake& row : rows) {
        SCOPED_TRACE(row.message);
        BakePair pair;
        relief_bake_options options{};
        relief_bake_maps maps{};
        ASSERT_EQ(relief_bake_options_init(&options, sizeof(options)), RELIEF_OK);
        ASSERT_EQ(relief_bake_maps_init(&maps, sizeof(maps)), RELIEF_OK);
        std::vector<std::uint8_t> texels(8 * 8 * 3);
        maps.normals = {texels.data(), 0, 8, 8, 3, RELIEF_SAMPLE_UINT8};
        row.change(pair, options, maps);
        const relief_mesh* const high[] = {&pair.high_view};
        EXPECT_EQ(relief_bake(high, 1, &pair.low_view, &options, nullptr, &maps, nullptr, nullptr),
                  RELIEF_INVALID_INPUT);
        EXPECT_THAT(relief_last_error(), HasSubstr(row.message));
    }
    EXPECT_EQ(relief_bake(nullptr, 1, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr),
              RELIEF_INVALID_INPUT);
    EXPECT_STREQ(relief_last_error(), "the high meshes are NULL");
}

}  // namespace
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// The check of normal maps: maps with known damage, evidence for the flat code, and every normal
// map of the shared data.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "image/map_statistics.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/report.h"
#include "support/images.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::accuracy;
using namespace relief::detail;

namespace {

using enum MapCondition;

/// Numbers from 0 to 1, the same in every run.
class Random {
  public:
    explicit Random(std::uint32_t seed) : twister_(seed) {}
    double unit() { return static_cast<double>(twister_()) / 4294967296.0; }

  private:
    std::mt19937 twister_;
};

/// Hills without symmetry, with wavelengths of at least 6 texels.
Image hilly_normals(int width, int height, double rms_slope, std::uint32_t seed = 7) {
    return wave_heights(width, height, tiling_waves(width, height, 12, 6.0, rms_slope, seed))
        .heights;
}

Image map_from(const Image& heights, const NormalMapFormat& format = {.bits = 8}) {
    Report report;
    return normal_map_from_height(heights, {Kernel::central3, Wrap::repeat, 1.0}, format, report);
}

std::vector<MapCondition> conditions_of(const NormalMapCheck& check) {
    std::vector<MapCondition> conditions;
    for (const MapConditionCount& found : check.conditions)
        conditions.push_back(found.condition);
    return conditions;
}

/// Applies `change` to every sample, in the range 0 to 1.
template <typename Change>
Image changed(const Image& map, const Change& change) {
    Image result = map;
    for (std::uint8_t& sample : result.as<std::uint8_t>())
        sample = static_cast<std::uint8_t>(std::lround(
            255.0F * std::clamp(change(static_cast<float>(sample) / 255.0F), 0.F, 1.F)));
    return result;
}

TEST(NormalMapCheck, SoundMapHasNoFindings) {
    const NormalMapCheck check = check_normal_map(map_from(hilly_normals(128, 96, 0.5)));
    EXPECT_EQ(check.content, MapContent::tangent_normals);
    EXPECT_EQ(check.green.green, Green::up);
    EXPECT_GT(check.green.correlation, 0.99);
    EXPECT_GT(check.green.confidence, 0.999999);
    EXPECT_LT(check.lengths.rms_deviation, 0.005);
    EXPECT_EQ(check.lengths.within[0], 1.0);
    EXPECT_THAT(conditions_of(check), testing::IsEmpty());
    EXPECT_FALSE(check.has_problem());
}

TEST_LABELS(not_sanitized);
TEST(NormalMapCheck, DetectsGreenDespiteNoiseBitsAndStrength) {
    int told = 0;
    for (const double slope : {0.003, 0.01, 0.1, 0.5, 2.0}) {
        for (const double noise : {0.0, 0.02, 0.1}) {
            for (const Green green : {Green::up, Green::down}) {
                for (const int bits : {8, 16}) {
                    SCOPED_TRACE(fmt::format("slope {} noise {} bits {} green {}", slope, noise,
                                             bits, green == Green::up ? "up" : "down"));
                    Report report;
                    Image normals =
                        normals_from_height(hilly_normals(128, 128, slope),
                                            {Kernel::sobel3, Wrap::repeat, 1.0}, report);
                    Random random(5);
                    for (float& component : normals.as<float>())
                        component += static_cast<float>(noise * (2.0 * random.unit() - 1.0));
                    const Image map = encode_normal_map(
                        normals, {.bits = bits, .green = green, .flat = FlatCode::middle}, report);
                    const NormalMapCheck check = check_normal_map(map);
                    // The result is unknown or correct, and always correct if slopes exceed noise
                    // and steps.
                    EXPECT_EQ(check.green.green.value_or(green), green);
                    const bool stands_out =
                        slope >= 5.0 * noise && slope >= (bits == 8 ? 0.01 : 0.003);
                    EXPECT_TRUE(check.green.green || !stands_out);
                    told += check.green.green ? 1 : 0;
                }
            }
        }
    }
    EXPECT_GE(told, 40);  // Of 60 maps.
}

TEST(NormalMapCheck, ReportsUndecidableGreen) {
    const auto ripples_x = [](int x, int) { return 3.0 * std::sin(x * 0.3); };
    const auto ripples_y = [](int, int y) { return 3.0 * std::sin(y * 0.3); };
    const auto crate = [](int x, int y) { return 3.0 * (std::sin(x * 0.3) + std::sin(y * 0.2)); };
    for (const auto& [name, field] :
         std::vector<std::pair<const char*, Image>>{{"x", test::heights_of(128, 128, ripples_x)},
                                                    {"y", test::heights_of(128, 128, ripples_y)},
                                                    {"crate", test::heights_of(128, 128, crate)}}) {
        for (const int bits : {8, 16}) {
            const NormalMapCheck check = check_normal_map(map_from(field, {.bits = bits}));
            EXPECT_FALSE(check.green.green) << name << bits << " " << check.green.correlation;
            EXPECT_TRUE(check.has(green_unknown));
        }
    }
    // Ripples across have a known direction, and noise that is not a surface has none.
    const auto diagonal = [](int x, int y) { return 3.0 * std::sin((x + 2 * y) * 0.2); };
    EXPECT_EQ(check_normal_map(map_from(test::heights_of(128, 128, diagonal))).green.green,
              Green::up);
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        Image normals = make_image(96, 96, 3, 32, ColorSpace::data);
        Random random(seed);
        for (std::size_t i = 0; i < normals.as<float>().size(); ++i)
            normals.as<float>()[i] = i % 3 == 2 ? 1.0F : static_cast<float>(random.unit() - 0.5);
        Report report;
        const NormalMapCheck check = check_normal_map(
            encode_normal_map(normals, {.bits = 8, .green = Green::up, .flat = {}}, report));
        EXPECT_FALSE(check.green.green) << seed << " " << check.green.correlation;
    }
}

TEST(NormalMapCheck, SeesBothDirectionsOfTheSrgbCurve) {
    const Image map = map_from(hilly_normals(128, 128, 0.3));
    const NormalMapCheck bright = check_normal_map(changed(map, srgb_from_linear));
    EXPECT_EQ(bright.curve, StoredCurve::srgb_encoded);
    EXPECT_GT(bright.lengths.rms_deviation, 0.15);
    EXPECT_LT(bright.lengths_uncurved.rms_deviation, 0.01);
    EXPECT_THAT(conditions_of(bright), testing::ElementsAre(stored_through_srgb));
    EXPECT_EQ(bright.green.green, Green::up);
    const NormalMapCheck dark = check_normal_map(changed(map, linear_from_srgb));
    EXPECT_EQ(dark.curve, StoredCurve::srgb_decoded);
    EXPECT_TRUE(dark.has(decoded_from_srgb));
    // A flat map: 188 of 255, or 55.
    Image flat = make_image(32, 32, 3, 8, ColorSpace::data);
    for (std::size_t i = 0; i < flat.sample_count(); ++i)
        flat.as<std::uint8_t>()[i] = i % 3 == 2 ? 255 : 188;
    EXPECT_THAT(conditions_of(check_normal_map(flat)),
                testing::ElementsAre(stored_through_srgb, all_flat));
}

TEST(NormalMapCheck, ClassifiesObjectSpaceXyGrayAndColors) {
    // The normals of a sphere, as in an object-space map: every direction.
    Image sphere = make_image(64, 64, 3, 8, ColorSpace::data);
    for (int row = 0; row < 64; ++row) {
        for (int column = 0; column < 64; ++column) {
            const double a = (row + 0.5) * 0.0490873852, b = (column + 0.5) * 0.0981747704;
            const std::array n = {std::sin(a) * std::cos(b), std::cos(a),
                                  std::sin(a) * std::sin(b)};
            for (std::size_t i = 0; i < 3; ++i)
                sphere.as<std::uint8_t>()[static_cast<std::size_t>(row * 64 + column) * 3 + i] =
                    static_cast<std::uint8_t>(128.5 + 127.0 * n[i]);
        }
    }
    EXPECT_EQ(check_normal_map(sphere).content, MapContent::object_normals);
    EXPECT_TRUE(check_normal_map(sphere).has(object_space));

    Image xy = map_from(hilly_normals(64, 64, 1.0));
    for (std::size_t i = 2; i < xy.sample_count(); i += 3)
        xy.as<std::uint8_t>()[i] = 0;
    EXPECT_EQ(check_normal_map(xy).content, MapContent::xy_normals);
    EXPECT_TRUE(check_normal_map(xy).has(z_missing));
    EXPECT_EQ(check_normal_map(xy).green.green, Green::up);

    // Normals of a plane that faces x are no colors.
    Image side = map_from(hilly_normals(64, 64, 0.5));
    for (std::size_t i = 0; i < side.sample_count(); i += 3)
        std::swap(side.as<std::uint8_t>()[i], side.as<std::uint8_t>()[i + 2]);
    EXPECT_EQ(check_normal_map(side).content, MapContent::object_normals);

    EXPECT_EQ(check_normal_map(test::rough(32, 32)).content, MapContent::gray);
    Image colors = make_image(64, 64, 3, 8, ColorSpace::data);
    Random random(1);
    for (std::uint8_t& sample : colors.as<std::uint8_t>())
        sample = static_cast<std::uint8_t>(256.0 * random.unit());
    EXPECT_THAT(conditions_of(check_normal_map(colors)), testing::ElementsAre(not_normals));
}

TEST(NormalMapCheck, AStatedOrAssumedContentWinsOverTheTexels) {
    const Image map = map_from(hilly_normals(64, 64, 0.5));
    EXPECT_EQ(judged_content(map), MapContent::tangent_normals);
    EXPECT_EQ(check_normal_map(map, {{"relief:content", "normal map, object space"}}).content,
              MapContent::object_normals);
    EXPECT_EQ(check_normal_map(map, {}, {}, MapContent::object_normals).content,
              MapContent::object_normals);
    Image colors = make_image(64, 64, 3, 8, ColorSpace::data);
    Random random(1);
    for (std::uint8_t& sample : colors.as<std::uint8_t>())
        sample = static_cast<std::uint8_t>(256.0 * random.unit());
    EXPECT_EQ(judged_content(colors), MapContent::other);
    EXPECT_FALSE(check_normal_map(colors, {}, {}, MapContent::tangent_normals)
                     .has(MapCondition::not_normals));
    EXPECT_EQ(judged_content(make_image(9, 9, 1, 8, ColorSpace::data)), MapContent::gray);
    EXPECT_EQ(judged_content(make_image(9, 9, 3, 8, ColorSpace::data)), MapContent::gray);
}

TEST(NormalMapCheck, CountsInvalidNormals) {
    Image map = map_from(hilly_normals(64, 64, 0.3));
    const auto samples = map.as<std::uint8_t>();
    const auto set = [&](std::size_t texel, int r, int g, int b) {
        samples[texel * 3] = static_cast<std::uint8_t>(r);
        samples[texel * 3 + 1] = static_cast<std::uint8_t>(g);
        samples[texel * 3 + 2] = static_cast<std::uint8_t>(b);
    };
    set(7, 128, 127, 128);
    set(9, 128, 128, 1);
    set(4000, 128, 128, 1);
    set(5, 0, 0, 0);
    const NormalMapCheck check = check_normal_map(map);
    ASSERT_THAT(conditions_of(check),
                testing::ElementsAre(texel_without_direction, texel_facing_back, texel_gray));
    EXPECT_EQ(check.conditions[0].first, (std::vector<std::size_t>{7}));
    EXPECT_EQ(check.conditions[1].count, 2U);
    EXPECT_EQ(check.conditions[1].first, (std::vector<std::size_t>{9, 4000}));
    EXPECT_EQ(check.conditions[2].count, 1U);

    Image floats = map_from(hilly_normals(64, 64, 0.3), {.bits = 32});
    floats.as<float>()[30] = std::numeric_limits<float>::quiet_NaN();
    floats.as<float>()[61] = std::numeric_limits<float>::infinity();
    const NormalMapCheck holes = check_normal_map(floats);
    EXPECT_THAT(conditions_of(holes), testing::ElementsAre(texel_not_finite));
    EXPECT_EQ(holes.conditions[0].first, (std::vector<std::size_t>{10, 20}));
    EXPECT_EQ(holes.green.green, Green::up);
}

TEST(NormalMapCheck, ComparesWithTheMetadata) {
    const Image map =
        map_from(hilly_normals(64, 64, 0.5), {.bits = 16, .green = Green::down, .flat = {}});
    EXPECT_THAT(conditions_of(check_normal_map(map, {{"relief:green", "down"}})),
                testing::ElementsAre(green_down));
    EXPECT_THAT(conditions_of(check_normal_map(map, {{"relief:green", "up"}})),
                testing::ElementsAre(green_contradicted, green_down));
    Image flat = make_image(8, 8, 3, 8, ColorSpace::data);
    for (std::size_t i = 0; i < flat.sample_count(); ++i)
        flat.as<std::uint8_t>()[i] = i % 3 == 2 ? 255 : 127;
    EXPECT_THAT(conditions_of(check_normal_map(flat, {{"relief:flat", "128"}})),
                testing::ElementsAre(flat_contradicted, all_flat));
}

TEST(NormalMapCheck, ChecksChannelsAndBorders) {
    const Image heights = hilly_normals(64, 64, 0.5);
    const Image map = map_from(heights);
    Image four = make_image(64, 64, 4, 8, ColorSpace::data);
    const CodedHeights coded = coded_heights(heights, 8);
    for (std::size_t texel = 0; texel < 64UL * 64UL; ++texel) {
        for (std::size_t i = 0; i < 3; ++i)
            four.as<std::uint8_t>()[texel * 4 + i] = map.as<std::uint8_t>()[texel * 3 + i];
        four.as<std::uint8_t>()[texel * 4 + 3] = coded.codes.as<std::uint8_t>()[texel];
    }
    EXPECT_THAT(conditions_of(check_normal_map(four)), testing::ElementsAre(alpha_heights));
    EXPECT_GT(check_normal_map(four).alpha_correlation.value(), 0.95);
    for (std::size_t texel = 0; texel < 64UL * 64UL; ++texel)
        four.as<std::uint8_t>()[texel * 4 + 3] = 255;
    EXPECT_THAT(conditions_of(check_normal_map(four)), testing::ElementsAre(alpha_opaque));

    Image wide = make_image(64, 64, 3, 16, ColorSpace::data);
    for (std::size_t i = 0; i < wide.sample_count(); ++i)
        wide.as<std::uint16_t>()[i] = static_cast<std::uint16_t>(map.as<std::uint8_t>()[i] * 257);
    EXPECT_THAT(conditions_of(check_normal_map(wide)), testing::Contains(bits_unused));

    // A step of blue at the border is not a seam, because only x and y are directions that a
    // neighbor continues.
    Image ramp = map;
    for (std::size_t texel = 0; texel < 64UL * 64UL; ++texel)
        ramp.as<std::uint8_t>()[texel * 3 + 2] = static_cast<std::uint8_t>(190 + texel % 64);
    EXPECT_EQ(check_normal_map(ramp).tiling.seam_x, check_normal_map(map).tiling.seam_x);

    // One half of a map that tiles along y only.
    Image half = make_image(23, 64, 3, 8, ColorSpace::data);
    for (std::size_t row = 0; row < 64; ++row) {
        for (std::size_t i = 0; i < 23UL * 3UL; ++i)
            half.as<std::uint8_t>()[row * 23 * 3 + i] = map.as<std::uint8_t>()[row * 64 * 3 + i];
    }
    EXPECT_THAT(conditions_of(check_normal_map(half)), testing::ElementsAre(seam_x));
}

TEST(NormalMapCheck, IsTheSameForAnyNumberOfThreads) {
    const Image map = map_from(hilly_normals(300, 200, 0.3), {.bits = 16});
    set_thread_limit(1);
    const NormalMapCheck one = check_normal_map(map);
    set_thread_limit(0);
    const NormalMapCheck many = check_normal_map(map);
    EXPECT_EQ(one.green.correlation, many.green.correlation);
    EXPECT_EQ(one.green.deviation, many.green.deviation);
    EXPECT_EQ(one.lengths.rms_deviation, many.lengths.rms_deviation);
}

TEST(NormalMapCheck, AcceptsOneTexelAndRefusesAnEmptyImage) {
    EXPECT_EQ(test::message_of<InvalidInput>([] { check_normal_map(Image{}); }),
              "the normal map is empty");
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {9, 1}, {3, 2}}) {
        const NormalMapCheck check =
            check_normal_map(map_from(hilly_normals(width == 1 ? 8 : width, 8, 0.1)));
        EXPECT_EQ(check.content, MapContent::tangent_normals);
        Image flat = make_image(width, height, 3, 8, ColorSpace::data);
        for (std::size_t i = 0; i < flat.sample_count(); ++i)
            flat.as<std::uint8_t>()[i] = i % 3 == 2 ? 255 : 128;
        EXPECT_THAT(conditions_of(check_normal_map(flat)), testing::ElementsAre(all_flat));
    }
}

const std::map<std::string, std::string> says_128{{"relief:flat", "128"}};

Image codes(int side, std::uint8_t x, std::uint8_t y) {
    Image map = make_image(side, side, 3, 8, ColorSpace::data);
    for (std::size_t i = 0; i < map.sample_count(); ++i)
        map.as<std::uint8_t>()[i] = i % 3 == 0 ? x : i % 3 == 1 ? y : 255;
    return map;
}

/// Normals in 8 bits of a smooth surface with slopes by position.
template <typename Slope>
Image smooth(int side, const Slope& slope) {
    Image normals = make_image(side, side, 3, 32, ColorSpace::data);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const glm::dvec2 s = slope((x + 0.5) / side - 0.5, (y + 0.5) / side - 0.5);
            const glm::dvec3 normal = glm::normalize(glm::dvec3(s, 1.0));
            for (int i = 0; i < 3; ++i) {
                normals.as<float>()[static_cast<std::size_t>(3 * (y * side + x) + i)] =
                    static_cast<float>(normal[i]);
            }
        }
    }
    Report report;
    return encode_normal_map(normals, {.bits = 8, .flat = FlatCode::middle}, report);
}

TEST(FlatEvidence, CountsTexelsNearFlatAndThoseOfTheLowerCode) {
    Image map = codes(4, 127, 127);
    auto* samples = map.as<std::uint8_t>().data();
    samples[0] = 125;  // The code differs too much.
    samples[3] = 126;
    samples[7] = 129;
    samples[9] = samples[10] = 128;
    EXPECT_EQ(flat_evidence(map).near, 15U);
    EXPECT_EQ(flat_evidence(map).lower, 12U);
    EXPECT_FALSE(flat_evidence(map).is_half());  // There are too few texels.
    EXPECT_EQ(flat_evidence(make_image(9, 9, 3, 32, ColorSpace::data)).near, 0U);
    Image wide = make_image(8, 8, 4, 16, ColorSpace::data);
    std::fill(wide.as<std::uint16_t>().begin(), wide.as<std::uint16_t>().end(), 32767);
    EXPECT_EQ(flat_evidence(wide).lower, 64U);
    EXPECT_TRUE(flat_evidence(wide).is_half());
}

TEST_LABELS(not_sanitized);
TEST(FlatEvidence, ASmoothSurfaceRaisesNoAlarm) {
    for (const double steepness : {0.05, 0.2, 0.5, 1.0, 3.0}) {
        for (const double shift : {-0.3, -0.01, -0.004, 0.0, 0.003, 0.1}) {
            for (const int side : {64, 256}) {
                const Image map = smooth(side, [&](double x, double y) {
                    return glm::dvec2(steepness * (x + shift), steepness * (y - 0.7 * shift));
                });
                EXPECT_FALSE(check_normal_map(map, says_128).has(MapCondition::flat_contradicted))
                    << steepness << ' ' << shift << ' ' << side;
            }
        }
    }
}

TEST(FlatEvidence, DetectsFlatTexelsOfTheOtherCode) {
    // A quarter is flat, and the rest is a dome. The flat codes are changed afterwards.
    for (const int side : {32, 64, 256}) {
        Image map = smooth(side, [](double x, double y) {
            return x < 0.0 && y < 0.0 ? glm::dvec2(0.0) : glm::dvec2(x, y);
        });
        EXPECT_FALSE(check_normal_map(map, says_128).has(MapCondition::flat_contradicted));
        auto* samples = map.as<std::uint8_t>().data();
        for (std::size_t i = 0; i + 2 < map.sample_count(); i += 3) {
            if (samples[i] == 128 && samples[i + 1] == 128) samples[i] = samples[i + 1] = 127;
        }
        EXPECT_TRUE(check_normal_map(map, says_128).has(MapCondition::flat_contradicted)) << side;
        EXPECT_FALSE(
            check_normal_map(map, {{"relief:flat", "127.5"}}).has(MapCondition::flat_contradicted));
        EXPECT_FALSE(check_normal_map(map).has(MapCondition::flat_contradicted));
    }
}

struct RealMap {
    const char* file;
    std::optional<Green> green;  ///< Unknown for flakes, ripples and wires.
};

void PrintTo(const RealMap& map, std::ostream* out) {
    *out << map.file;
}

class RealNormalMaps : public testing::TestWithParam<RealMap> {};

/// Returns the map with the other direction of green.
Image green_flipped(Image map) {
    if (map.bits() == 32) {
        for (std::size_t i = 1; i < map.sample_count(); i += static_cast<std::size_t>(map.channels))
            map.as<float>()[i] = 1.0F - map.as<float>()[i];
    } else {
        for (std::size_t i = 1; i < map.sample_count(); i += static_cast<std::size_t>(map.channels))
            map.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(255 - map.as<std::uint8_t>()[i]);
    }
    return map;
}

TEST_LABELS(not_sanitized);
TEST_P(RealNormalMaps, AreRecognizedWithBothDirectionsOfGreen) {
    RELIEF_NEEDS_SHARED(file, std::string("data/") + GetParam().file);
    const Image map = read_image(file, ImageUse::data);
    const NormalMapCheck check = check_normal_map(map);
    EXPECT_EQ(check.content, MapContent::tangent_normals);
    EXPECT_EQ(check.curve, StoredCurve::none);
    EXPECT_EQ(check.green.green, GetParam().green) << check.green.correlation;
    const NormalMapCheck flipped = check_normal_map(green_flipped(map));
    if (GetParam().green) {
        EXPECT_EQ(flipped.green.green, *GetParam().green == Green::up ? Green::down : Green::up);
    } else {
        EXPECT_FALSE(flipped.green.green);
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, RealNormalMaps,
    testing::Values(
        RealMap{"textures/bricks_godot/texture_bricks_normal.jpg", Green::up},
        RealMap{"textures/cheese_godot/texture_cheese_normal.png", Green::up},
        RealMap{"textures/oiio_bump_normal/normal.exr", Green::down},
        RealMap{"textures/sand_ambientcg/sand_normal.png", Green::down},
        RealMap{"textures/rock023_ambientcg/rock023_nrm_rgh.png", Green::up},
        RealMap{"textures/parallax_bgfx/parallax-n.png", Green::down},
        RealMap{"textures/parallax_cube_bevy/cube_normal.png", Green::up},
        RealMap{"textures/materialx/mesh_wire_norm.png", std::nullopt},
        RealMap{"models/gltf/Box With Spaces/glTF/Normal Map.png", Green::up},
        RealMap{"models/gltf/BoomBox/glTF/BoomBox_normal.png", Green::up},
        RealMap{"models/gltf/Avocado/glTF/Avocado_normal.png", Green::up},
        RealMap{"models/gltf/TwoSidedPlane/glTF/TwoSidedPlane_Normal.png", Green::up},
        RealMap{"models/gltf/WaterBottle/glTF/WaterBottle_normal.png", Green::up},
        RealMap{"models/gltf-ext/tangent-pair/sphere_Texture0_Normal.png", std::nullopt},
        RealMap{"models/gltf-ext/misc/DuplicateMeshes/Texture0_Normal.png", std::nullopt},
        RealMap{"models/gltf-generator/Mesh_PrimitiveAttribute/Textures/"
                "Normal_Plane.png",
                Green::up}));

TEST_LABELS(not_sanitized);
TEST(RealPictures, AreNotTakenForNormalMaps) {
    RELIEF_NEEDS_SHARED(folder, "data/textures");
    int analyzed = 0;
    for (const char* root : {"data/textures", "data/models", "data/env/cube"}) {
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(test::shared_directory() / root)) {
            const std::string name = entry.path().filename().string();
            const std::string extension = entry.path().extension().string();
            if (extension != ".png" && extension != ".jpg") continue;
            const std::string path = entry.path().string();
            if (path.find("decoder") != std::string::npos) continue;
            if (path.find("orm") != std::string::npos || path.find("nrm") != std::string::npos ||
                name == "parallax-n.png")
                continue;  // A normal map: BoomBox_normal, Normal Map, rock023_nrm_rgh, ...
            const NormalMapCheck check = check_normal_map(read_image(entry.path(), ImageUse::data));
            EXPECT_TRUE(check.has(MapCondition::not_normals)) << name;
            ++analyzed;
        }
    }
    EXPECT_GE(analyzed, 40);
}

}  // namespace
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Height map files to normal map files: processing by rows and in memory gives the same bytes, and
// every output format equals the result of the image functions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include "io/maps/height_bands.h"
#include "relief/mesh/bump_file.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/report.h"
#include "support/images.h"
#include "support/invariants.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::message_of;
using test::samples_of;
using test::TemporaryDirectory;
using testing::AllOf;
using testing::HasSubstr;
using testing::SizeIs;

/// Noise of any depth.
Image noise(int width, int height, int channels, int bits) {
    Image image = make_image(width, height, channels, bits, ColorSpace::data);
    std::mt19937 random(7);
    std::visit(
        [&]<typename Sample>(std::vector<Sample>& samples) {
            for (Sample& sample : samples) {
                if constexpr (std::is_same_v<Sample, float>)
                    sample = static_cast<float>(random() % 4096) / 4096.0F;
                else
                    sample = static_cast<Sample>(random());
            }
        },
        image.samples);
    return image;
}

/// Options with which even the smallest map is read by rows, a few at a time.
HeightMapOptions by_rows(std::size_t texels_per_band, HeightChannel channel = HeightChannel::mean) {
    return {channel, false, 0, texels_per_band};
}

class BumpFile : public testing::Test {
  protected:
    std::filesystem::path written(const Image& image, const std::string& name) const {
        write_image(folder_ / name, image);
        return folder_ / name;
    }

    /// Returns the converted file.
    Image converted(const std::filesystem::path& file, const BumpOptions& options,
                    const BumpFileFormat& format, Report& report,
                    const HeightMapOptions& choice = {}) const {
        write_bump_file(HeightMapFile(file, choice), options, folder_ / "out.exr", format, report);
        return read_image(folder_ / "out.exr", ImageUse::data);
    }

    TemporaryDirectory folder_;
};

TEST_F(BumpFile, EqualsTheImageFunctionsByteForByte) {
    const Image heights = noise(37, 23, 1, 16);
    const BumpOptions options{Kernel::scharr3, Wrap::repeat, 9.0};
    const NormalMapFormat format{16, Green::down, FlatCode::half, Dither::blue_noise};
    Report report;
    write_bump_file(HeightMapFile(written(heights, "h.png")), options, folder_ / "a.png",
                    {.normals = format}, report);
    write_image(folder_ / "b.png", normal_map_from_height(heights, options, format, report),
                normal_map_metadata(format));
    EXPECT_EQ(test::read_bytes(folder_ / "a.png"), test::read_bytes(folder_ / "b.png"));
}

/// A map and its conversion options.
struct Streamed {
    const char* input;
    int width, height, channels, bits;
    Kernel kernel;
    Wraps wrap;
    const char* output;
    int output_bits;
};

class StreamedBumpFile : public BumpFile, public testing::WithParamInterface<Streamed> {};

TEST_P(StreamedBumpFile, EqualsAMapInMemoryForAnyBandsAndThreads) {
    const Streamed& map = GetParam();
    const std::filesystem::path file =
        written(noise(map.width, map.height, map.channels, map.bits), map.input);
    const BumpOptions options{map.kernel, map.wrap, 5.0, {1.0, 2.0}, 3};
    BumpFileFormat format;
    format.normals.bits = map.output_bits;
    format.alpha = MapAlpha::height;
    const HeightMapOptions ignore_alpha{HeightChannel::mean, true};
    Report report;
    const HeightMapFile whole(file, ignore_alpha);
    ASSERT_FALSE(whole.is_streamed());
    write_bump_file(whole, options, folder_ / map.output, format, report);
    const std::string expected = test::read_bytes(folder_ / map.output);
    for (const std::size_t texels_per_band : {1U, 100U, 1000U, 1000000U}) {
        for (const unsigned threads : {1U, 3U}) {
            set_thread_limit(threads);
            HeightMapOptions choice = by_rows(texels_per_band);
            choice.ignore_alpha = true;
            const HeightMapFile streamed(file, choice);
            ASSERT_TRUE(streamed.is_streamed());
            Report found;
            write_bump_file(streamed, options, folder_ / map.output, format, found);
            EXPECT_EQ(test::read_bytes(folder_ / map.output) == expected, true)
                << texels_per_band << " texels a band, " << threads << " threads";
            EXPECT_TRUE(std::ranges::equal(found.findings(), report.findings()));
        }
    }
    set_thread_limit(0);
}

INSTANTIATE_TEST_SUITE_P(
    Files, StreamedBumpFile,
    testing::Values(
        Streamed{"h.png", 61, 43, 1, 8, Kernel::sobel3, Wrap::repeat, "n.png", 8},
        Streamed{"h.png", 61, 43, 1, 16, Kernel::central7, Wrap::clamp, "n.png", 16},
        Streamed{
            "h.png", 61, 43, 3, 8, Kernel::gaussian, {Wrap::repeat, Wrap::mirror}, "n.tif", 16},
        Streamed{"h.tif", 61, 43, 4, 16, Kernel::sobel5, {Wrap::clamp, Wrap::repeat}, "n.exr", 32},
        Streamed{"h.tif", 61, 43, 1, 32, Kernel::central5, Wrap::repeat, "n.tif", 32},
        Streamed{"h.exr", 61, 43, 2, 32, Kernel::forward, Wrap::mirror, "n.png", 16},
        Streamed{"h.png", 1, 5, 1, 16, Kernel::gaussian, Wrap::repeat, "n.png", 16},
        Streamed{"h.png", 5, 2, 1, 16, Kernel::central7, Wrap::repeat, "n.png", 16}));

TEST_F(BumpFile, ASurveyFindsTheSameByRows) {
    const Image heights = test::heights_of(300, 280, [](int x, int y) {
        return 0.5 + 0.2 * std::sin(0.1 * x) + 0.2 * std::cos(0.07 * y) + 0.001 * (x * y % 7);
    });
    const std::filesystem::path file = written(heights, "h.exr");
    const std::vector<ImagePart> parts = {{0, 0, 10, 20}, {290, 13, 10, 200}, {5, 279, 3, 1}};
    const HeightMapFile::Survey whole = HeightMapFile(file).survey(parts);
    const HeightMapFile::Survey rows = HeightMapFile(file, by_rows(2000)).survey(parts);
    EXPECT_EQ(whole.tiling.seam_x, rows.tiling.seam_x);
    EXPECT_EQ(whole.tiling.seam_y, rows.tiling.seam_y);
    EXPECT_EQ(whole.tiling.seam_x, detect_tiling(heights).seam_x);
    ASSERT_THAT(rows.parts, SizeIs(3));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        EXPECT_EQ(rows.parts[i].samples, part_of(heights, parts[i]).samples);
        EXPECT_EQ(rows.parts[i].samples, whole.parts[i].samples);
    }
}

TEST_F(BumpFile, KeepsHeightsOrAlpha) {
    Image image = make_image(3, 1, 2, 8, ColorSpace::data);
    image.samples = std::vector<std::uint8_t>{0, 255, 51, 102, 255, 1};
    const std::filesystem::path file = written(image, "h.png");
    Report report;
    BumpFileFormat format;
    format.normals.bits = 32;
    const auto alphas = [&](MapAlpha alpha, double strength) {
        format.alpha = alpha;
        const Image map =
            converted(file, {Kernel::central3, Wrap::clamp, strength}, format, report);
        const std::vector<float> samples = samples_of<float>(map);
        return std::vector<float>{samples[3], samples[7], samples[11]};
    };
    EXPECT_THAT(alphas(MapAlpha::height, 4.0), testing::ElementsAre(0.0F, 0.2F, 1.0F));
    EXPECT_THAT(alphas(MapAlpha::height, -4.0), testing::ElementsAre(1.0F, 0.8F, 0.0F))
        << "dents for bumps";
    EXPECT_THAT(alphas(MapAlpha::keep, 4.0),
                testing::ElementsAre(1.0F, 0.4F, static_cast<float>(1.0 / 255.0)));
    EXPECT_TRUE(report.empty());
}

TEST_F(BumpFile, CountsHeightsThatItsAlphaCannotHold) {
    Image image = make_image(4, 1, 1, 32, ColorSpace::data);
    image.samples = std::vector<float>{-0.5F, 0.0F, 1.0F, 3.0F};
    const std::filesystem::path file = written(image, "h.exr");
    Report report;
    BumpFileFormat format{.alpha = MapAlpha::height};
    write_bump_file(HeightMapFile(file), {}, folder_ / "n.png", format, report);
    EXPECT_EQ(report.count("height outside 0 to 1"), 2U);
    const auto samples = samples_of<std::uint16_t>(read_image(folder_ / "n.png", ImageUse::data));
    EXPECT_EQ(samples[3], 0);
    EXPECT_EQ(samples[15], 65535);
    Report none;
    format.normals.bits = 32;
    EXPECT_EQ(samples_of<float>(converted(file, {}, format, none))[15], 3.0F);
    EXPECT_TRUE(none.empty());
}

TEST_F(BumpFile, BlueIsZeroWithoutZ) {
    const std::filesystem::path file = written(noise(5, 4, 1, 16), "h.png");
    Report report;
    write_bump_file(HeightMapFile(file), {}, folder_ / "xy.png", {.xy_only = true}, report);
    write_bump_file(HeightMapFile(file), {}, folder_ / "xyz.png", {}, report);
    const auto xy = samples_of<std::uint16_t>(read_image(folder_ / "xy.png", ImageUse::data));
    const auto xyz = samples_of<std::uint16_t>(read_image(folder_ / "xyz.png", ImageUse::data));
    for (std::size_t i = 0; i < xy.size(); ++i)
        EXPECT_EQ(xy[i], i % 3 == 2 ? 0 : xyz[i]);
    EXPECT_EQ(read_image_info(folder_ / "xy.png").metadata.at("relief:channels"), "xy");
}

TEST_F(BumpFile, TransparentTexelsAreFlatAndHideNoCliff) {
    // A slope of 1, and transparent black to the right of it.
    Image image = make_image(12, 6, 4, 32, ColorSpace::data);
    for (std::size_t i = 0; i < 72; ++i) {
        const std::size_t x = i % 12;
        const float height = x < 8 ? static_cast<float>(x) : 0.0F;
        for (std::size_t channel = 0; channel < 3; ++channel)
            image.as<float>()[4 * i + channel] = height;
        image.as<float>()[4 * i + 3] = x < 8 ? 1.0F : 0.0F;
    }
    const std::filesystem::path file = written(image, "h.exr");
    const BumpOptions options{Kernel::central3, Wrap::clamp, 1.0};
    BumpFileFormat format;
    format.normals.bits = 32;
    Report report;
    const std::vector<float> map = samples_of<float>(converted(file, options, format, report));
    const auto slope = [&](const std::vector<float>& samples, std::size_t x) {
        const std::size_t texel = 3 * (2 * 12 + x);
        return -(2.0 * static_cast<double>(samples[texel]) - 1.0) /
               (2.0 * static_cast<double>(samples[texel + 2]) - 1.0);
    };
    EXPECT_NEAR(slope(map, 6), 1.0, 1e-6);
    // Beyond the edge, the height continues with the value of the edge: half the slope, and not a
    // cliff of -3.
    EXPECT_NEAR(slope(map, 7), 0.5, 1e-6);
    for (std::size_t x = 8; x < 12; ++x) {
        const std::size_t texel = 3 * (2 * 12 + x);
        EXPECT_EQ(map[texel], 0.5F);
        EXPECT_EQ(map[texel + 1], 0.5F);
        EXPECT_EQ(map[texel + 2], 1.0F);
    }
    EXPECT_TRUE(report.empty());
    const std::vector<float> ignored =
        samples_of<float>(converted(file, options, format, report, {HeightChannel::mean, true}));
    EXPECT_NEAR(slope(ignored, 7), -3.0, 1e-6);
}

TEST_F(BumpFile, HiddenTexelsHaveNoInfluence) {
    // Flat ground on the left, and hidden noise on the right, which would be a seam and detail.
    Image image = noise(48, 32, 2, 8);
    for (std::size_t i = 0; i < image.sample_count() / 2; ++i) {
        const bool is_hidden = i % 48 >= 24;
        if (!is_hidden) image.as<std::uint8_t>()[2 * i] = 100;
        image.as<std::uint8_t>()[2 * i + 1] = is_hidden ? 0 : 255;
    }
    const std::filesystem::path file = written(image, "h.png");
    const std::vector<ImagePart> parts = {{0, 0, 32, 32}, {16, 0, 32, 32}};
    const HeightMapFile::Survey survey = HeightMapFile(file).survey(parts);
    EXPECT_EQ(survey.tiling.seam_x, 0.0);
    EXPECT_EQ(survey.tiling.seam_y, 0.0);
    ASSERT_THAT(survey.parts, SizeIs(2));
    for (const Image& part : survey.parts) {
        // The heights are exact, so the map has 8 bits.
        EXPECT_THAT(samples_of<float>(part), AllOf(SizeIs(1024), testing::Each(100.0F / 255.0F)));
        EXPECT_EQ(height_depth(part).bits, 1);
    }
    const HeightMapFile::Survey seen =
        HeightMapFile(file, {HeightChannel::mean, true}).survey(parts);
    EXPECT_GT(seen.tiling.seam_x, 0.5);
}

TEST(BumpBand, MomentsAreHeightSlopesAndTheirProducts) {
    const Image heights = noise(9, 7, 1, 16);
    const BumpOptions options{Kernel::sobel3, Wrap::repeat, 3.0};
    const BumpBandSource source{
        {9, 7, 16, [&](int row) { return &heights.as<std::uint16_t>()[9U * row]; }}, {}, 8, {}};
    BumpFileFormat format{.content = BumpContent::slope_moments};
    format.normals.green = Green::down;
    std::vector<float> moments(9 * 7 * 6);
    Report report;
    ASSERT_TRUE(make_bump_band(source, options, format, 0, 7,
                               std::as_writable_bytes(std::span(moments)), report));
    const std::vector<float> slopes =
        samples_of<float>(slopes_from_height(heights, options, report));
    for (std::size_t i = 0; i < 63; ++i) {
        const float dx = slopes[2 * i];
        const float dy = -slopes[2 * i + 1];
        const double height = heights.as<std::uint16_t>()[i] / 65535.0;
        EXPECT_FLOAT_EQ(moments[6 * i], static_cast<float>(3.0 * height));
        EXPECT_EQ(moments[6 * i + 1], dx);
        EXPECT_EQ(moments[6 * i + 2], dy);
        EXPECT_EQ(moments[6 * i + 3], dx * dx);
        EXPECT_EQ(moments[6 * i + 4], dy * dy);
        EXPECT_EQ(moments[6 * i + 5], dx * dy);
    }
}

TEST_F(BumpFile, SlopeMomentsHaveTheNamesThatFiltersExpect) {
    const Image heights = noise(9, 7, 1, 16);
    const std::filesystem::path file = written(heights, "h.png");
    const BumpOptions options{Kernel::sobel3, Wrap::repeat, 3.0};
    Report report;
    BumpFileFormat format{.content = BumpContent::slope_moments};
    write_bump_file(HeightMapFile(file), options, folder_ / "m.exr", format, report);
    // relief does not read six channels. The names show that the filters of OpenImageIO expect
    // them.
    EXPECT_THAT(test::read_bytes(folder_ / "m.exr"),
                AllOf(HasSubstr("b0_h"), HasSubstr("b1_dhds"), HasSubstr("b2_dhdt"),
                      HasSubstr("b3_dhds2"), HasSubstr("b4_dhdt2"), HasSubstr("b5_dh2dsdt")));
    format.xy_only = true;
    EXPECT_THROW(write_bump_file(HeightMapFile(file), options, folder_ / "m.exr", format, report),
                 InvalidInput);
}

TEST_F(BumpFile, HolesAreFilledAsInImages) {
    Image heights = noise(20, 11, 1, 32);
    for (const std::size_t texel : {0U, 63U, 64U, 83U, 219U})
        heights.as<float>()[texel] = std::numeric_limits<float>::quiet_NaN();
    const std::filesystem::path file = written(heights, "h.exr");
    BumpFileFormat format;
    format.normals.bits = 32;
    Report report;
    HeightMapOptions choice;
    choice.texels_per_band = 1;
    const Image map = converted(file, {}, format, report, choice);
    Report expected_report;
    const Image expected = normal_map_from_height(heights, {}, {.bits = 32}, expected_report);
    EXPECT_EQ(map.samples, expected.samples);
    EXPECT_EQ(report.count("non-finite height"), 5U);
    EXPECT_TRUE(std::ranges::equal(report.findings(), expected_report.findings()));
}

TEST_F(BumpFile, RowsRefuseOptionsThatNeedTheWholeMap) {
    Image heights = noise(20, 11, 1, 32);
    heights.as<float>()[105] = std::numeric_limits<float>::infinity();
    const std::filesystem::path holes = written(heights, "h.exr");
    BumpOptions options;  // No option depends on the map, so no part of it is read first.
    options.kernel = Kernel::sobel3;
    options.wrap = Wrap::repeat;
    const auto refusal = [&](const std::filesystem::path& file) {
        Report report;
        return message_of<FileError>([&] {
            write_bump_file(HeightMapFile(file, by_rows(40)), options, folder_ / "n.png", {},
                            report);
        });
    };
    EXPECT_EQ(refusal(holes), holes.string() +
                                  ": rows 4 to 5 hold heights that are not finite, which are "
                                  "filled only in maps that fit into 0 MiB");
    Image alpha = noise(20, 11, 2, 8);
    for (std::size_t i = 0; i < 220; ++i)
        alpha.as<std::uint8_t>()[2 * i + 1] = i == 107 ? 0 : 9;
    const std::filesystem::path transparent = written(alpha, "a.png");
    EXPECT_EQ(refusal(transparent), transparent.string() +
                                        ": the texel in column 7, row 5 is transparent, which is "
                                        "understood only in maps that fit "
                                        "into 0 MiB");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "n.png"));
}

TEST_F(BumpFile, ReportsProgress) {
    const std::filesystem::path file = written(noise(10, 10, 1, 8), "h.png");
    std::vector<double> parts;
    Report report;
    write_bump_file(HeightMapFile(file, by_rows(30)), {}, folder_ / "n.png", {}, report,
                    [&](double part) { parts.push_back(part); });
    EXPECT_THAT(parts, testing::ElementsAre(0.3, 0.6, 0.9, 1.0));
}

}  // namespace
}  // namespace relief

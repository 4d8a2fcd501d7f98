// SPDX-License-Identifier: Apache-2.0
// Normal map files that are converted by bands of rows: samples, metadata and findings are those of
// the functions for whole maps.
#include "relief/mesh/normal_map_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "support/invariants.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using testing::HasSubstr;

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> texts_of(const Report& report) {
    std::vector<std::string> texts;
    for (const Finding& finding : report.findings())
        texts.push_back(to_string(finding));
    return texts;
}

/// A map with smooth, flat, steep, reversed, short and zero vectors, and alpha if it has 4
/// channels.
Image map_of(int width, int height, int channels, int bits) {
    Image map = make_image(width, height, channels, bits, ColorSpace::data);
    std::uint32_t state = 7;
    const auto random = [&] {
        state = state * 1664525U + 1013904223U;
        return static_cast<float>(state >> 8) * 0x1p-24F;
    };
    std::visit(
        [&]<typename Sample>(std::vector<Sample>& samples) {
            const float largest = bits == 32 ? 1.0F : static_cast<float>((1U << bits) - 1U);
            const auto code = [&](float value) {
                return static_cast<Sample>(bits == 32 ? value : value * largest + 0.5F);
            };
            for (std::size_t i = 0; i < samples.size(); i += static_cast<std::size_t>(channels)) {
                const float kind = random();
                float x = 0.3F + 0.4F * random();
                float y = 0.3F + 0.4F * random();
                float z = 0.7F + 0.3F * random();
                if (kind < 0.3F) x = y = bits == 8 ? 128.0F / 255.0F : 0.5F;
                if (kind > 0.9F) z = 0.5F - 0.1F * random();
                if (kind > 0.97F) x = y = z = 0.5F;
                const float values[] = {x, y, z, random()};
                for (int c = 0; c < channels; ++c)
                    samples[i + static_cast<std::size_t>(c)] = code(values[c]);
            }
        },
        map.samples);
    return map;
}

/// The conversion of a whole map by the functions that the library had before.
Image whole_conversion(const Image& map, FlatCode flat, const NormalMapConversion& conversion,
                       ConvertedMapFile& result, Report& report) {
    Image normals;
    if (conversion.rebuild_z) {
        normals =
            decode_xy_map(map, *conversion.rebuild_z, Green::up, flat, report, FlatTexels::exact);
    } else {
        result.lengths = measure_lengths(map, flat, report);
        normals = decode_normal_map(map, Green::up, flat, report, FlatTexels::exact);
    }
    std::optional<Image> alpha;
    const bool alpha_is_x = conversion.rebuild_z && conversion.rebuild_z->x == 3;
    if (map.channels == 4 && conversion.keeps_alpha && !alpha_is_x) alpha = channel_of(map, 3);
    if (conversion.axes != same_axes) map_normal_axes(normals, conversion.axes);
    if (conversion.width > 0) {
        normals =
            resize_normals(normals, conversion.width, conversion.height, conversion.resize, report);
        if (alpha) {
            alpha = resize_samples(*alpha, conversion.width, conversion.height, conversion.resize);
        }
    }
    if (conversion.strength) scale_slopes(normals, *conversion.strength, report);
    if (conversion.detail) {
        report.merge(conversion.detail->report);
        blend_normals(normals, conversion.detail->normals, conversion.detail->blend, report);
    }
    const Image codes = encode_normal_map(normals, conversion.format, report);
    return alpha ? with_alpha(codes, *alpha) : codes;
}

class NormalMapFile : public testing::Test {
  protected:
    /// Writes the map, converts the file by rows and in memory, and compares with the whole map.
    void compare(const Image& map, const NormalMapConversion& conversion,
                 FlatCode flat = FlatCode::half) {
        const auto input = folder / (map.bits() == 32 ? "map.exr" : "map.png");
        write_image(input, map);
        NormalMapConversion in_bands = conversion;
        in_bands.texels_per_band = static_cast<std::size_t>(map.width) * 3;
        in_bands.metadata = {{"relief:content", "a test"}};
        const auto output = folder / (conversion.format.bits == 32 ? "out.exr" : "out.png");

        ConvertedMapFile expected;
        Report expected_report;
        const Image codes = whole_conversion(map, flat, conversion, expected, expected_report);
        const auto whole = folder / ("whole" + output.extension().string());
        write_image(whole, codes, in_bands.metadata, in_bands.write, expected_report);
        for (const Image* const image : {static_cast<const Image*>(nullptr), &map}) {
            Report report;
            const ConvertedMapFile result =
                convert_normal_map_file({input, image, flat, false}, output, in_bands, report);
            EXPECT_EQ(bytes_of(output), bytes_of(whole)) << (image == nullptr ? "file" : "memory");
            EXPECT_EQ(texts_of(report), texts_of(expected_report));
            ASSERT_EQ(result.lengths.has_value(), expected.lengths.has_value());
            if (!result.lengths) continue;
            EXPECT_EQ(result.lengths->min, expected.lengths->min);
            EXPECT_EQ(result.lengths->mean, expected.lengths->mean);
            EXPECT_EQ(result.lengths->max, expected.lengths->max);
        }
    }

    const test::TemporaryDirectory folder;
};

TEST_F(NormalMapFile, IsResizedWithEveryFilterDomainAndBorder) {
    const Image map = map_of(19, 47, 4, 8);
    NormalMapConversion conversion;
    conversion.format.bits = 16;
    for (const ResizeFilter filter : {ResizeFilter::best, ResizeFilter::box, ResizeFilter::triangle,
                                      ResizeFilter::cubic, ResizeFilter::lanczos}) {
        for (const ResizeDomain domain : {ResizeDomain::slopes, ResizeDomain::vectors}) {
            for (const Wraps& wrap : {Wraps(Wrap::repeat), Wraps(Wrap::clamp), Wraps(Wrap::mirror),
                                      Wraps(Wrap::repeat, Wrap::mirror)}) {
                conversion.width = domain == ResizeDomain::slopes ? 23 : 11;
                conversion.height = domain == ResizeDomain::slopes ? 20 : 61;
                conversion.resize = {filter, domain, wrap, {1.0, 1.0}};
                compare(map, conversion);
                ASSERT_FALSE(HasFailure()) << static_cast<int>(filter) << name_of(wrap);
            }
        }
    }
}

TEST_F(NormalMapFile, IsResizedToAnySize) {
    struct Size {
        int width, height;
    };
    NormalMapConversion conversion;
    conversion.format.bits = 8;
    for (const Wrap wrap : {Wrap::repeat, Wrap::mirror}) {
        conversion.resize.wrap = wrap;
        for (const Size& size :
             {Size{1, 1}, Size{17, 1}, Size{3, 2}, Size{17, 9}, Size{17, 10}, Size{60, 31}}) {
            conversion.width = size.width;
            conversion.height = size.height;
            compare(map_of(17, 9, 3, 16), conversion);
            compare(map_of(5, 1, 3, 8), conversion);
            ASSERT_FALSE(HasFailure()) << size.width << " x " << size.height;
        }
    }
}

TEST_F(NormalMapFile, HasTheSameBytesForAnyBits) {
    for (const int bits : {8, 16, 32}) {
        for (const int target_bits : {8, 16, 32}) {
            for (const FlatCode flat : {FlatCode::half, FlatCode::middle}) {
                NormalMapConversion conversion;
                conversion.format = {target_bits, Green::up, flat,
                                     target_bits == 8 ? Dither::blue_noise : Dither::none};
                conversion.axes = {{{1, false}, {0, true}, {2, false}}};
                conversion.strength = -1.5;
                compare(map_of(21, 14, 4, bits), conversion, flat);
                conversion.keeps_alpha = false;
                conversion.width = 16;
                conversion.height = 18;
                compare(map_of(21, 14, 4, bits), conversion, flat);
            }
        }
    }
}

TEST_F(NormalMapFile, HasZFromXAndY) {
    NormalMapConversion conversion;
    conversion.width = 12;
    conversion.height = 9;
    for (const XyChannels& channels : {XyChannels{0, 1}, XyChannels{3, 1}}) {
        conversion.rebuild_z = channels;
        compare(map_of(16, 20, 4, 8), conversion);
    }
    conversion.rebuild_z = XyChannels{0, 1};
    compare(map_of(16, 20, 2, 16), conversion);
}

TEST_F(NormalMapFile, IsBlendedWithADetailWhosePeriodIsNotThatOfBands) {
    NormalMapConversion conversion;
    conversion.format.bits = 8;
    conversion.format.dither = Dither::ordered;
    conversion.detail.emplace();
    conversion.detail->normals = decode_normal_map(map_of(7, 5, 3, 8), Green::up, FlatCode::half);
    conversion.detail->report.add("a problem of the detail", "texel", 3, "is kept");
    for (const NormalBlend blend : all_normal_blends) {
        conversion.detail->blend = blend;
        compare(map_of(20, 33, 3, 16), conversion);
    }
}

TEST_F(NormalMapFile, KeepsCodesWhenOnlyAxesAndAlphaChange) {
    for (const int bits : {8, 16}) {
        Image map = map_of(13, 17, 4, bits);
        const auto input = folder / "codes.png";
        const auto output = folder / "axes.png";
        write_image(input, map);
        NormalMapConversion conversion;
        conversion.keeps_codes = true;
        conversion.keeps_alpha = false;
        conversion.axes = {{{0, false}, {1, true}, {2, false}}};
        conversion.texels_per_band = 40;
        Report report, expected;
        const ConvertedMapFile result = convert_normal_map_file(
            {input, nullptr, FlatCode::middle, false}, output, conversion, report);
        EXPECT_FALSE(result.lengths);
        map_axes(map, conversion.axes, FlatCode::middle, expected);
        drop_alpha(map);
        EXPECT_EQ(read_image(output, ImageUse::data).samples, map.samples);
        EXPECT_EQ(texts_of(report), texts_of(expected));
    }
}

TEST_F(NormalMapFile, SignedFloatsAreReadAsUnsigned) {
    const auto input = folder / "signed.exr";
    Image map = map_of(11, 6, 4, 32);
    Image with_signs = map;
    const std::span<float> samples = with_signs.as<float>();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (i % 4 < 3) samples[i] = 2.0F * samples[i] - 1.0F;
    }
    write_image(input, with_signs);
    Image unsigned_map = with_signs;
    remove_signs(unsigned_map);
    NormalMapConversion conversion;
    conversion.width = 7;
    conversion.height = 5;
    convert_normal_map_file({input, nullptr, FlatCode::half, true}, folder / "a.png", conversion);
    convert_normal_map_file({input, &unsigned_map, FlatCode::half, true}, folder / "b.png",
                            conversion);
    EXPECT_EQ(bytes_of(folder / "a.png"), bytes_of(folder / "b.png"));
}

TEST_F(NormalMapFile, ThatIsDamagedLeavesTheOldOutput) {
    const auto input = folder / "cut.png";
    write_image(input, map_of(64, 64, 3, 8));
    std::filesystem::resize_file(input, std::filesystem::file_size(input) / 2);
    std::ofstream(folder / "old.png") << "old";
    NormalMapConversion conversion;
    conversion.width = conversion.height = 32;
    const auto convert = [&] {
        convert_normal_map_file({input, nullptr, FlatCode::half, false}, folder / "old.png",
                                conversion);
    };
    EXPECT_THAT(test::message_of<FileError>(convert), HasSubstr("cut.png: "));
    EXPECT_EQ(bytes_of(folder / "old.png"), "old");
}

TEST_F(NormalMapFile, WithoutTheChannelsOfNormalsIsRefused) {
    const auto input = folder / "map.png";
    const auto message = [&](int channels, const NormalMapConversion& conversion) {
        write_image(input, map_of(4, 4, channels, 8));
        return test::message_of<InvalidInput>([&] {
            convert_normal_map_file({input, nullptr, FlatCode::half, false}, folder / "out.png",
                                    conversion);
        });
    };
    NormalMapConversion conversion;
    EXPECT_EQ(message(1, conversion), "a normal map has 3 or 4 channels, not 1");
    conversion.rebuild_z = XyChannels{3, 1};
    EXPECT_EQ(message(3, conversion), "there is no channel 4, but only 3");
    EXPECT_EQ(message(1, conversion), "there is no channel 4, but only 1");
}

TEST_F(NormalMapFile, ReportsProgressAndReplacesItsInput) {
    const auto file = folder / "both.png";
    const Image map = map_of(24, 24, 3, 8);
    write_image(file, map);
    NormalMapConversion conversion;
    conversion.texels_per_band = 24 * 5;
    conversion.format.bits = 8;
    conversion.strength = 1.0;
    std::vector<double> parts;
    convert_normal_map_file({file, nullptr, FlatCode::half, false}, file, conversion,
                            IgnoredReport(), [&](double part) { parts.push_back(part); });
    EXPECT_THAT(parts, testing::ElementsAre(5.0 / 24, 10.0 / 24, 15.0 / 24, 20.0 / 24, 1.0));
    EXPECT_EQ(read_image_info(file).width, 24);
}

}  // namespace
}  // namespace relief

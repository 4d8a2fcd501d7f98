// SPDX-License-Identifier: Apache-2.0
// Descriptions of maps: every entry survives writing and reading; unknown values are ignored.
#include "relief/mesh/map_description.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace relief {
namespace {

using testing::IsEmpty;
using testing::Pair;
using testing::UnorderedElementsAre;

TEST(MapDescription, EveryKindSurvivesItsTextEntry) {
    std::set<std::string_view> texts;
    for (const EnumName<MapKind>& entry : enum_names<MapKind>) {
        const auto entries = write_description({.kind = entry.value}, 8);
        EXPECT_EQ(entries.size(), 1U);
        EXPECT_EQ(read_description(entries).kind, entry.value) << entry.name;
        EXPECT_TRUE(texts.insert(map_kind_info(entry.value).content).second);
        EXPECT_EQ(map_kind_info(entry.value).kind, entry.value);
    }
}

TEST(MapDescription, EveryConventionSurvives) {
    for (const int bits : {8, 16}) {
        for (const Green green : {Green::up, Green::down}) {
            for (const FlatCode flat : {FlatCode::half, FlatCode::middle}) {
                const MapDescription written = {.kind = MapKind::packed,
                                                .detail = "unity",
                                                .green = green,
                                                .flat = flat,
                                                .xy_only = true,
                                                .color_space = ColorSpace::srgb,
                                                .alpha = AlphaContent::opacity};
                const auto entries = write_description(written, bits);
                EXPECT_EQ(entries.size(), description_keys().size());
                const MapDescription read = read_description(entries);
                EXPECT_EQ(read.kind, written.kind);
                EXPECT_EQ(read.detail, written.detail);
                EXPECT_EQ(read.green, green);
                EXPECT_EQ(read.flat, flat);
                EXPECT_TRUE(read.xy_only);
                EXPECT_EQ(read.color_space, written.color_space);
                EXPECT_EQ(read.alpha, written.alpha);
            }
        }
    }
}

TEST(MapDescription, HasTheTextsOfTheDocuments) {
    EXPECT_THAT(
        write_description({.kind = MapKind::normal,
                           .green = Green::down,
                           .flat = FlatCode::middle,
                           .color_space = ColorSpace::data,
                           .alpha = AlphaContent::length},
                          16),
        UnorderedElementsAre(Pair("relief:content", "normal map, tangent space"),
                             Pair("relief:green", "down"), Pair("relief:flat", "32768"),
                             Pair("relief:color-space", "data"), Pair("relief:alpha", "length")));
    EXPECT_THAT(write_description({.flat = FlatCode::half}, 32),
                UnorderedElementsAre(Pair("relief:flat", "0.5")));
    EXPECT_THAT(write_description({}, 8), IsEmpty());
}

TEST(MapDescription, IgnoresUnknownValues) {
    const MapDescription read = read_description({{"relief:content", "colorsomething"},
                                                  {"relief:green", "left"},
                                                  {"relief:flat", "127"},
                                                  {"relief:channels", "xyz"},
                                                  {"relief:color-space", "srgb?"},
                                                  {"relief:alpha", ""},
                                                  {"Title", "colors"}});
    EXPECT_FALSE(read.kind || read.green || read.flat || read.xy_only || read.color_space ||
                 read.alpha);
    // Entries of other versions may say more.
    EXPECT_EQ(read_description({{"relief:content", "height map, tiles"}}).kind, MapKind::height);
    EXPECT_EQ(read_description({{"relief:content", "height map, tiles"}}).detail, "tiles");
}

}  // namespace
}  // namespace relief

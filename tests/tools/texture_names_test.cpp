// SPDX-License-Identifier: Apache-2.0
// The kinds of maps by the names of their files.
#include "texture_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace relief::tools {
namespace {

using testing::HasSubstr;

TEST(TextureNames, LastWordsNameTheKind) {
    struct Case {
        const char* stem;
        MapKind kind;
        const char* set;
    };
    for (const Case& each : {Case{"rock_n", MapKind::normal, "rock"},
                             Case{"rock_normal", MapKind::normal, "rock"},
                             Case{"Rock-Nrm", MapKind::normal, "Rock"},
                             Case{"rock_albedo", MapKind::color, "rock"},
                             Case{"RockBaseColor", MapKind::color, "Rock"},
                             Case{"rock_base_color", MapKind::color, "rock"},
                             Case{"rock_d", MapKind::color, "rock"},
                             Case{"rock_r", MapKind::roughness, "rock"},
                             Case{"rock.rough.2048", MapKind::roughness, "rock"},
                             Case{"rock_metal", MapKind::metalness, "rock"},
                             Case{"rock_m", MapKind::metalness, "rock"},
                             Case{"rock_ao", MapKind::occlusion, "rock"},
                             Case{"Rock_AmbientOcclusion", MapKind::occlusion, "Rock"},
                             Case{"rock_orm", MapKind::packed, "rock"},
                             Case{"rock_h", MapKind::height, "rock"},
                             Case{"rock_e", MapKind::emission, "rock"},
                             Case{"Avocado_roughnessMetallic", MapKind::packed, "Avocado"},
                             Case{"texture_cheese_albedo", MapKind::color, "texture_cheese"},
                             Case{"Rock023_1K-PNG_Roughness", MapKind::roughness, "Rock023"},
                             Case{"bricks-height", MapKind::height, "bricks"}}) {
        const NamedMap map = named_map(each.stem);
        EXPECT_EQ(map.kind, each.kind) << each.stem;
        EXPECT_EQ(map.set, each.set) << each.stem;
        EXPECT_EQ(map.problem, "") << each.stem;
    }
}

TEST(TextureNames, NamesMayStateConventions) {
    EXPECT_EQ(named_map("Rock023_1K-PNG_NormalGL").green, Green::up);
    EXPECT_EQ(named_map("Rock023_1K-PNG_NormalDX").green, Green::down);
    EXPECT_FALSE(named_map("rock_normal").green);
    EXPECT_TRUE(named_map("rock_smoothness").is_smoothness);
    EXPECT_FALSE(named_map("rock_roughness").is_smoothness);
    EXPECT_FALSE(named_map("rock_metallicRoughness").has_occlusion);
    EXPECT_TRUE(named_map("rock_MaskMap").is_unity_mask);
}

TEST(TextureNames, UncertainNamesAreNotGuessed) {
    for (const char* stem : {"rock_depth", "rock_mask", "rock_s", "rock_specular", "rock_opacity",
                             "rock_rma", "rock_a"}) {
        const NamedMap map = named_map(stem);
        EXPECT_FALSE(map.kind) << stem;
        EXPECT_THAT(map.problem, HasSubstr("the word '")) << stem;
    }
    for (const char* stem : {"rock", "n", "photograph", "2048", ""}) {
        EXPECT_FALSE(named_map(stem).kind) << stem;
        EXPECT_EQ(named_map(stem).problem, "its name does not say the kind of the map") << stem;
    }
}

}  // namespace
}  // namespace relief::tools

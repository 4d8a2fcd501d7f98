// SPDX-License-Identifier: Apache-2.0
// The kinds of maps against those that are accepted: as files state them, and as texels show them.
#include "relief/mesh/map_kind_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace relief {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Kinds = std::vector<MapKind>;

TEST(MapKindCheck, SlotsOfNormalsHeightsAndColorsAcceptTheirKinds) {
    EXPECT_THAT(accepted_kinds(TextureSlot::normal),
                ElementsAre(MapKind::normal, MapKind::object_normal));
    EXPECT_THAT(accepted_kinds(TextureSlot::bump), ElementsAre(MapKind::height));
    EXPECT_THAT(accepted_kinds(TextureSlot::base_color), ElementsAre(MapKind::color));
    EXPECT_THAT(accepted_kinds(TextureSlot::occlusion), IsEmpty());
}

TEST(MapKindCheck, NormalsAreDrawnInTheSpaceOfTheMaterialsMap) {
    Material material;
    material.normal_map = NormalMap{};
    EXPECT_THAT(drawn_kinds(material, TextureSlot::normal), ElementsAre(MapKind::normal));
    material.normal_map->space = NormalSpace::object;
    EXPECT_THAT(drawn_kinds(material, TextureSlot::normal), ElementsAre(MapKind::object_normal));
    EXPECT_THAT(drawn_kinds(material, TextureSlot::bump), ElementsAre(MapKind::height));
}

TEST(MapKindCheck, ComparesEveryStatedKind) {
    for (const EnumName<MapKind>& is : enum_names<MapKind>) {
        for (const EnumName<MapKind>& wanted : enum_names<MapKind>) {
            const auto wrong = stated_wrong_kind(Kinds{wanted.value}, {.kind = is.value});
            ASSERT_EQ(wrong.has_value(), is.value != wanted.value) << is.name << wanted.name;
            if (!wrong) continue;
            EXPECT_EQ(wrong->kind, is.value);
            EXPECT_THAT(wrong->problem, HasSubstr(map_kind_info(is.value).phrase));
        }
        EXPECT_FALSE(stated_wrong_kind(Kinds{}, {.kind = is.value})) << "any is accepted";
    }
    EXPECT_FALSE(stated_wrong_kind(Kinds{MapKind::normal}, {})) << "nothing is stated";
}

TEST(MapKindCheck, ComparesEveryContent) {
    using enum MapContent;
    const Kinds normals = {MapKind::normal}, any_normals = accepted_kinds(TextureSlot::normal);
    const Kinds heights = {MapKind::height}, colors = {MapKind::color};
    for (const MapContent content : {tangent_normals, object_normals, xy_normals, gray, other}) {
        const auto is_wrong = [&](const Kinds& accepted) {
            return judged_wrong_kind(accepted, content).has_value();
        };
        const bool is_tangent = content == tangent_normals || content == xy_normals;
        EXPECT_EQ(is_wrong(normals), !is_tangent);
        EXPECT_EQ(is_wrong(any_normals), !is_tangent && content != object_normals);
        EXPECT_EQ(is_wrong(heights), is_tangent || content == object_normals);
        EXPECT_FALSE(is_wrong(colors));
        EXPECT_FALSE(is_wrong({}));
    }
}

TEST(MapKindCheck, JudgesNeitherStatedKindsNorFewTexels) {
    const Image gray = make_image(8, 8, 1, 8, ColorSpace::data);
    EXPECT_EQ(unstated_content(gray, {}), MapContent::gray);
    EXPECT_EQ(unstated_content(gray, {.kind = MapKind::normal}), std::nullopt);
    EXPECT_EQ(unstated_content(make_image(9, 7, 1, 8, ColorSpace::data), {}), std::nullopt);
}

TEST(MapKindCheck, ReportsTheUsualKindOfTheSlot) {
    Report report;
    report_drawn_kind(*judged_wrong_kind(Kinds{MapKind::height}, MapContent::tangent_normals),
                      TextureSlot::bump, MapKind::height, 3, report);
    ASSERT_EQ(report.findings().size(), 1U);
    EXPECT_EQ(to_string(report.findings()[0]),
              "1 x bump map that seems to be a normal map (material 3): is drawn as a height map");
}

}  // namespace
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// The descriptions of fields: unique names, defaults within their ranges, and a complete document.
#include "relief/shade/scene_fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "support/shared_data.h"

namespace relief {
namespace {

using ::testing::HasSubstr;

std::string document() {
    std::ifstream file(test::source_directory() / "docs/scene-files.md");
    return {std::istreambuf_iterator<char>(file), {}};
}

template <typename T>
class SceneFields : public testing::Test {};

using DescribedTypes =
    testing::Types<Texture, NormalMap, BumpMap, MetallicRoughness, Material, DirectionalLight,
                   PointLight, SpotLight, Environment, Camera, Scene, Orbit, Turntable>;
TYPED_TEST_SUITE(SceneFields, DescribedTypes);

TYPED_TEST(SceneFields, HaveUniqueNamesAndTheDocumentListsThem) {
    const std::string text = document();
    std::set<std::string> names;
    for_each_field<TypeParam>([&](const auto& field) {
        EXPECT_TRUE(names.insert(field.name).second) << field.name;
        EXPECT_THAT(text, HasSubstr(field.name));
    });
    EXPECT_FALSE(names.empty());
}

TYPED_TEST(SceneFields, HaveDefaultsWithinTheirRanges) {
    for_each_field<TypeParam>([](const auto& field) {
        using Value = std::decay_t<decltype(field.default_value())>;
        const Value value = field.default_value();
        if constexpr (std::is_same_v<Value, float>) {
            EXPECT_GE(value, field.range.min) << field.name;
            EXPECT_LE(value, field.range.max) << field.name;
        } else if constexpr (std::is_same_v<Value, glm::vec3>) {
            for (int i = 0; i < 3; ++i) {
                EXPECT_GE(value[i], field.range.min) << field.name;
                EXPECT_LE(value[i], field.range.max) << field.name;
            }
            if (field.unit == FieldUnit::world_direction) {
                EXPECT_NE(value, glm::vec3(0.0F));
            }
        } else if constexpr (std::is_enum_v<Value>) {
            EXPECT_STRNE(enum_name(value), "") << field.name;
        }
    });
}

TEST(SceneField, HasALabelForMessages) {
    std::vector<std::string> labels;
    for_each_field<MetallicRoughness>([&](const auto& field) { labels.push_back(field.label()); });
    EXPECT_THAT(labels, testing::ElementsAre("base colour", "metallic", "roughness",
                                             "metallic-roughness texture"));
    EXPECT_EQ(outer_cone_field.label(), "outer cone");
}

TEST(EnumNames, NameEveryValueOnce) {
    EXPECT_STREQ(enum_name(FresnelModel::conductor), "conductor");
    EXPECT_STREQ(enum_name(FlatCode::middle), "128");
    EXPECT_STREQ(enum_name(static_cast<AlphaMode>(17)), "");
}

}  // namespace
}  // namespace relief

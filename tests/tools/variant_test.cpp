// SPDX-License-Identifier: Apache-2.0
// Changes of scenes as text, and scenes with one change, without drawing them.
#include "variant_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "common/command.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "scene_options.h"
#include "tools/workplace.h"
#include "view_options.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using test::Workplace;
using testing::HasSubstr;

std::string refusal_of(const std::string& text) {
    try {
        parse_variant("--compare " + text, text);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(Variant, TextRoundTrips) {
    std::set<std::string> texts;
    for (const VariantTopic& topic : variant_topics()) {
        for (const auto& [word, variant] : topic.choices) {
            EXPECT_EQ(to_text(variant), topic.name + "=" + word);
            EXPECT_EQ(parse_variant("", to_text(variant)), variant);
            EXPECT_TRUE(texts.insert(to_text(variant)).second);
        }
    }
    EXPECT_GE(texts.size(), 32U);
}

TEST(Variant, TopicsAreInTheOrderOfTheirTypes) {
    for (std::size_t i = 0; i < variant_topics().size(); ++i)
        EXPECT_EQ(variant_topics()[i].choices.front().second.index(), i);
}

TEST(Variant, RefusesUnknownNamesWithAList) {
    using testing::HasSubstr;
    EXPECT_THAT(refusal_of("kernel=box"), HasSubstr("kernel: not one of forward, central3"));
    EXPECT_THAT(refusal_of("colour=red"), HasSubstr("not one of interpolation=, map=, kernel="));
    EXPECT_THAT(refusal_of("kernel"), HasSubstr("not one of"));
    EXPECT_THAT(refusal_of(""), HasSubstr("not one of"));
}

class VariantScene : public testing::Test {
  protected:
    VariantScene() {
        workplace_.write_square("square.obj");
        options_.model = workplace_ / "square.obj";
    }

    void use_heights() { options_.height_map = workplace_ / "data/bricks-height.png"; }

    Scene scene() {
        Stages silent(true);
        Report report;
        return std::move(compose_scene(options_, silent, report).scene());
    }

    PreparedVariant prepared(const Scene& scene, const std::string& text) const {
        Report report;
        return prepare(parse_variant("", text), scene, options_, report);
    }
    Scene changed(const Scene& scene, const std::string& text) const {
        return with_variant(scene, prepared(scene, text));
    }
    std::string refusal(const Scene& scene, const std::string& text) const {
        try {
            prepared(scene, text);
        } catch (const UsageError& error) {
            return error.what();
        }
        return "";
    }

    ViewOptions& options() { return options_; }
    [[nodiscard]] const Workplace& workplace() const { return workplace_; }

    static const Image& map_of(const Scene& scene) {
        const std::size_t image = scene.materials[0].normal_map->texture.image;
        return *std::get<Shared<Image>>(scene.images.at(image).source);
    }

  private:
    Workplace workplace_;
    ViewOptions options_;
};

TEST_F(VariantScene, InterpolationAppliesToAllMaterialsAndSharesMeshes) {
    const Scene before = scene();
    const Scene flat = changed(before, "interpolation=flat");
    EXPECT_EQ(flat.materials[0].interpolation, Interpolation::flat);
    EXPECT_EQ(before.materials[0].interpolation, Interpolation::per_pixel);
    EXPECT_EQ(&*flat.meshes[0], &*before.meshes[0]);
    EXPECT_THAT(refusal(before, "interpolation=per_pixel"), HasSubstr("current setting"));
}

TEST_F(VariantScene, GouraudDrawsMetallicRoughnessByPhongsModel) {
    options().metallic_roughness = MetallicOption{0.5F, 0.5F};
    const Scene before = scene();
    EXPECT_FALSE(changed(before, "interpolation=gouraud").materials[0].metallic_roughness);
    EXPECT_TRUE(changed(before, "interpolation=flat").materials[0].metallic_roughness);
}

TEST_F(VariantScene, AKernelGivesTheMapThatTheOptionGives) {
    use_heights();
    const Scene before = scene();
    const Scene other = changed(before, "kernel=central5");
    options().kernel = Kernel::central5;
    EXPECT_EQ(map_of(other).samples, map_of(scene()).samples);
    EXPECT_NE(map_of(other).samples, map_of(before).samples);
    EXPECT_THAT(refusal(before, "kernel=central5"), HasSubstr("current setting"));
    // Without the option, by the kernel and the borders that relief-bake bump takes for the map.
    options().kernel.reset();
    Report report;
    const Image heights = height_field(read_image(*options().height_map, ImageUse::data));
    EXPECT_EQ(map_of(before).samples,
              encode_normal_map(normals_from_height(heights, {}, report),
                                {.bits = 16, .green = Green::up, .flat = FlatCode::middle}, report)
                  .samples);
}

TEST_F(VariantScene, HeightsBecomeABumpMapAndBack) {
    use_heights();
    options().strength = 9.0;
    const Scene before = scene();
    const Scene bumped = changed(before, "map=bump_map");
    ASSERT_TRUE(bumped.materials[0].bump_map);
    EXPECT_FALSE(bumped.materials[0].normal_map);
    EXPECT_EQ(bumped.materials[0].bump_map->strength, 9.0F);
    EXPECT_THAT(refusal(before, "map=normal_map"), HasSubstr("no bump map"));
    const Scene plain = changed(before, "map=none");
    EXPECT_FALSE(plain.materials[0].bump_map || plain.materials[0].normal_map);

    options().height_as = HeightUse::bump_map;
    const Scene as_bump = scene();
    const Scene converted = changed(as_bump, "map=normal_map");
    EXPECT_EQ(map_of(converted).samples, map_of(before).samples);
}

TEST_F(VariantScene, EightBitsAreThoseOfTheHeights) {
    use_heights();
    const Scene before = scene();
    const Scene eight = changed(before, "bits=8");
    EXPECT_EQ(map_of(before).bits(), 16);
    EXPECT_EQ(map_of(eight).bits(), 8);
    EXPECT_THAT(refusal(before, "bits=16"), HasSubstr("more bits"));
}

TEST_F(VariantScene, AMapFileOfSixteenBitsIsCodedAgainTheSameWayRound) {
    use_heights();
    write_image(workplace() / "map.png", map_of(scene()));
    options().height_map.reset();
    options().normal_map = workplace() / "map.png";
    options().green = Green::down;
    const Scene eight = changed(scene(), "bits=8");
    EXPECT_EQ(map_of(eight).bits(), 8);
    EXPECT_EQ(eight.materials[0].normal_map->green, Green::down);
    const auto wide = read_image(workplace() / "map.png", ImageUse::data);
    const auto codes = map_of(eight).as<std::uint8_t>();
    ASSERT_EQ(codes.size(), wide.as<std::uint16_t>().size());
    int worst = 0;
    for (std::size_t i = 0; i < codes.size(); ++i)
        worst = std::max(worst, std::abs(codes[i] * 257 - wide.as<std::uint16_t>()[i]));
    EXPECT_LT(worst, 400) << "half a step of 257, and the middle codes' shift";
}

TEST_F(VariantScene, FramesAreThoseOfTheMode) {
    use_heights();
    const Scene before = scene();
    EXPECT_EQ(changed(before, "tangents=derivatives").materials[0].tangent_frame,
              TangentFrame::derivatives);
    const Scene lengyel = changed(before, "tangents=lengyel");
    FrameOptions frames;
    frames.tangents = TangentMethod::lengyel;
    Report report;
    EXPECT_EQ(lengyel.meshes[0]->tangents,
              with_frames(*before.meshes[0], frames, report).mesh.tangents);
    frames = {};
    frames.normals = NormalMode::flat;
    EXPECT_EQ(changed(before, "normals=flat").meshes[0]->normals,
              with_frames(*before.meshes[0], frames, report).mesh.normals);
}

TEST_F(VariantScene, RefusesVariantsWithoutEffect) {
    const Scene plain = scene();
    EXPECT_THAT(refusal(plain, "kernel=central3"), HasSubstr("no height map"));
    EXPECT_THAT(refusal(plain, "tangents=lengyel"), HasSubstr("that needs tangents"));
    EXPECT_THAT(refusal(plain, "bits=8"), HasSubstr("no normal map"));
    EXPECT_THAT(refusal(plain, "map=none"), HasSubstr("no normal map or bump map to remove"));
    EXPECT_THAT(refusal(plain, "map=bump_map"), HasSubstr("converted from heights"));
}

TEST_F(VariantScene, EditsAfterwardsComeAlong) {
    use_heights();
    const Scene before = scene();
    const PreparedVariant variant = prepared(before, "kernel=central3");
    Scene edited = before;
    edited.exposure = 3.0F;
    edited.materials[0].diffuse = glm::vec3(0.25F);
    edited.materials[0].normal_map->scale = 0.5F;
    edited.images.push_back({"another", workplace() / "data/bricks-height.png"});
    const Scene other = with_variant(edited, variant);
    EXPECT_EQ(other.exposure, 3.0F);
    EXPECT_EQ(other.materials[0].diffuse, glm::vec3(0.25F));
    EXPECT_EQ(other.materials[0].normal_map->scale, 0.5F);
    EXPECT_EQ(map_of(other).samples, map_of(with_variant(before, variant)).samples);
    EXPECT_NO_THROW(validate(other));
}

TEST_F(VariantScene, OtherModelHasTheSameLights) {
    Scene before = scene();
    before.directional_lights.resize(1);
    before.exposure = 2.0F;
    Scene other = scene();
    other.materials[0].diffuse = glm::vec3(0.125F);
    const Scene lit = with_lighting_of(before, other);
    EXPECT_EQ(lit.directional_lights.size(), 1U);
    EXPECT_EQ(lit.exposure, 2.0F);
    EXPECT_EQ(lit.materials[0].diffuse, glm::vec3(0.125F));
}

}  // namespace
}  // namespace relief::tools

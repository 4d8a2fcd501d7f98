// SPDX-License-Identifier: Apache-2.0
// Pictures handed over are those that were drawn, and one that is shown is left alone.
#include "relief/shade/picture_exchange.h"

#include <gtest/gtest.h>

#include "draw_test.h"
#include "gl/api.h"

namespace relief {
namespace {

class Handing : public test::DrawTest {
  protected:
    /// A picture of one colour, of this size.
    void put(PictureExchange& handover, const glm::vec3& color, int width, int height) {
        Material material = test::black_material();
        material.unlit = true;
        material.diffuse = color;
        const Scene scene = test::scene_of(test::facing_square(), material);
        const FrameSettings settings{width, height, 1};
        Report report;
        Renderer renderer(context(), scene, plan_effects(scene, settings), settings, report);
        renderer.draw_only(*scene.camera);
        handover.put(renderer);
    }

    /// The middle of a texture.
    glm::ivec3 color_of(unsigned texture, int width, int height) {
        const gl::Api& api = context().api();
        std::vector<std::uint8_t> texels(static_cast<std::size_t>(4 * width * height));
        api->BindTexture(GL_TEXTURE_2D, texture);
        api->GetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
        api->BindTexture(GL_TEXTURE_2D, 0);
        const auto at = static_cast<std::size_t>(4 * (height / 2 * width + width / 2));
        return {texels[at], texels[at + 1], texels[at + 2]};
    }
};

TEST_F(Handing, NothingIsShownBeforeAnythingIsDrawn) {
    PictureExchange handover(context());
    EXPECT_EQ(handover.get().texture, 0U);
}

TEST_F(Handing, TheNewestIsShownInItsSize) {
    PictureExchange handover(context());
    put(handover, {1, 0, 0}, 20, 10);
    put(handover, {0, 1, 0}, 30, 10);
    const PictureExchange::Shown shown = handover.get();
    EXPECT_EQ(shown.width, 30);
    EXPECT_EQ(shown.height, 10);
    EXPECT_EQ(color_of(shown.texture, 30, 10), glm::ivec3(0, 255, 0));
}

TEST_F(Handing, WhatIsShownStaysAsItIsHoweverManyComeAfter) {
    PictureExchange handover(context());
    put(handover, {1, 0, 0}, 8, 8);
    const PictureExchange::Shown shown = handover.get();
    for (int i = 0; i < 5; ++i) {
        put(handover, {0, 0, 1}, 8, 8);
        EXPECT_EQ(color_of(shown.texture, 8, 8), glm::ivec3(255, 0, 0)) << i;
    }
    EXPECT_NE(handover.get().texture, shown.texture);
    EXPECT_EQ(color_of(handover.get().texture, 8, 8), glm::ivec3(0, 0, 255));
}

TEST_F(Handing, TwoPicturesComeTogetherAndTheSecondGoesWithoutOne) {
    PictureExchange handover(context());
    Report report;
    const FrameSettings settings{8, 4, 1};
    const auto renderer_of = [&](const glm::vec3& color) {
        Material material = test::black_material();
        material.unlit = true;
        material.diffuse = color;
        const Scene scene = test::scene_of(test::facing_square(), material);
        auto renderer = std::make_unique<Renderer>(context(), scene, settings, report);
        renderer->draw_only(*scene.camera);
        return renderer;
    };
    const std::unique_ptr<Renderer> red = renderer_of({1, 0, 0});
    const std::unique_ptr<Renderer> blue = renderer_of({0, 0, 1});
    handover.put(*red, blue.get());
    const PictureExchange::Shown both = handover.get();
    EXPECT_EQ(color_of(both.texture, 8, 4), glm::ivec3(255, 0, 0));
    ASSERT_NE(both.beside, 0U);
    EXPECT_EQ(color_of(both.beside, 8, 4), glm::ivec3(0, 0, 255));
    handover.put(*blue);
    EXPECT_EQ(handover.get().beside, 0U);
}

TEST_F(Handing, APictureFromElsewhereStandsUpright) {
    PictureExchange handover(context());
    Image picture = make_image(3, 2, 3, 8, ColorSpace::srgb);
    auto& codes = std::get<std::vector<std::uint8_t>>(picture.samples);
    for (std::size_t i = 0; i < codes.size(); ++i)
        codes[i] = static_cast<std::uint8_t>(10 * i);
    handover.put(picture);
    const PictureExchange::Shown shown = handover.get();
    std::vector<std::uint8_t> texels(4 * 3 * 2);
    context().api()->BindTexture(GL_TEXTURE_2D, shown.texture);
    context().api()->GetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    EXPECT_EQ(texels[0], codes[9]) << "the lower row begins";
    EXPECT_EQ(texels[3], 255);
    EXPECT_EQ(texels[12 + 4 + 2], codes[5]);
}

}  // namespace
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "window/capture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "relief/mesh/image_file.h"
#include "support/gl_environment.h"
#include "support/shapes.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::Workplace;
using testing::HasSubstr;

class Capturing : public testing::Test {
  protected:
    void SetUp() override {
        context_ = test::context_if_installed(Backend::osmesa);
        if (!context_) GTEST_SKIP() << "needs OSMesa";
        cache_ = std::make_unique<RenderCache>(*context_);
    }

    [[nodiscard]] CaptureWish wish_of(const std::string& name) const {
        auto scene = std::make_shared<Scene>();
        scene->meshes.push_back(test::cube());
        Instance instance;
        instance.world_from_object[3] = {1, 0, 0, 1};  // Beside the middle.
        scene->instances.push_back(instance);
        scene->ambient = glm::vec3(1.0F);
        scene->background = {0, 0, 1, 1};
        CaptureWish wish;
        wish.scene = scene;
        wish.settings = {40, 30, 1};
        wish.camera.world_from_view[3] = {0, 0, 8, 1};
        wish.file = workplace_ / name;
        return wish;
    }

    /// Draws all of it. \return how many steps it took
    int finish(CaptureWish wish, const std::shared_ptr<CaptureProgress>& progress) {
        const DrawTask task = capture_task(std::move(wish), progress);
        int steps = 1;
        while (task(*context_, *cache_))
            ++steps;
        return steps;
    }
    const Workplace& workplace() { return workplace_; }

  private:
    Workplace workplace_;
    std::unique_ptr<Context> context_;
    std::unique_ptr<RenderCache> cache_;
};

TEST_F(Capturing, WritesOnePictureInItsSize) {
    const auto progress = std::make_shared<CaptureProgress>();
    EXPECT_EQ(text_of(progress->state()), "");
    EXPECT_EQ(finish(wish_of("out/a.png"), progress), 1);
    const Image image = read_image(workplace() / "out/a.png", ImageUse::color);
    EXPECT_EQ(image.width, 40);
    EXPECT_EQ(image.height, 30);
    EXPECT_EQ(image.channels, 3);
    EXPECT_EQ(image.as<std::uint8_t>()[2], 255) << "the background";
    EXPECT_THAT(text_of(progress->state()), HasSubstr("Saved "));
    EXPECT_EQ(workplace().outputs(), "a.png");
}

TEST_F(Capturing, TransparentHasAlphaAndNoBackground) {
    const auto progress = std::make_shared<CaptureProgress>();
    CaptureWish wish = wish_of("out/a.png");
    wish.transparent = true;
    finish(wish, progress);
    const Image image = read_image(workplace() / "out/a.png", ImageUse::color);
    ASSERT_EQ(image.channels, 4);
    EXPECT_EQ(image.as<std::uint8_t>()[3], 0);
}

TEST_F(Capturing, ATurnIsNumberedAndTurnsTheModel) {
    const auto progress = std::make_shared<CaptureProgress>();
    CaptureWish wish = wish_of("out/turn.png");
    wish.turntable = 4;
    EXPECT_EQ(finish(wish, progress), 4);
    EXPECT_EQ(workplace().outputs(), "turn-0001.png turn-0002.png turn-0003.png turn-0004.png");
    EXPECT_EQ(progress->state().done, 4);
    // Beside the middle on the right; after half a turn, on the left.
    const auto right_half_is_background = [&](const char* name) {
        const Image image = read_image(workplace() / name, ImageUse::color);
        return image.as<std::uint8_t>()[3 * (15 * 40 + 24)] == 0;
    };
    EXPECT_FALSE(right_half_is_background("out/turn-0001.png"));
    EXPECT_TRUE(right_half_is_background("out/turn-0003.png"));
}

TEST_F(Capturing, WhatCannotBeWrittenIsSaidAndEnds) {
    const auto progress = std::make_shared<CaptureProgress>();
    CaptureWish wish = wish_of("out/missing/a.png");
    wish.turntable = 4;
    EXPECT_EQ(finish(wish, progress), 1);
    EXPECT_THAT(text_of(progress->state()), HasSubstr("Not saved: "));
    EXPECT_EQ(workplace().outputs(), "");
}

TEST_F(Capturing, TakesTheNextFreeName) {
    EXPECT_EQ(free_file("models/vase.obj", 0), "models/vase-1.png");
    workplace().write("out/vase-1.png", "");
    EXPECT_EQ(free_file(workplace() / "out/vase.obj", 0), workplace() / "out/vase-2.png");
    EXPECT_EQ(free_file(workplace() / "out/vase.obj", 3), workplace() / "out/vase-turn-1.png");
    workplace().write("out/vase-turn-1-0001.png", "");
    EXPECT_EQ(free_file(workplace() / "out/vase.obj", 3), workplace() / "out/vase-turn-2.png");
    workplace().write("out/vase-turn-2-0003.png", "");
    EXPECT_EQ(free_file(workplace() / "out/vase.obj", 2), workplace() / "out/vase-turn-2.png");
    EXPECT_EQ(free_file(workplace() / "out/vase.obj", 3), workplace() / "out/vase-turn-3.png");
}

}  // namespace
}  // namespace relief::tools

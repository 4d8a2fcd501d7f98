// SPDX-License-Identifier: Apache-2.0
// Renderers that take over what those before them left: the same pixels, and nothing made twice.
#include "relief/shade/render_cache.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "draw_test.h"
#include "random_scene.h"
#include "relief/mesh/image_file.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
namespace {

class Cached : public test::DrawTest {
  protected:
    void SetUp() override {
        test::DrawTest::SetUp();
        if (!IsSkipped()) cache_.emplace(context());
    }
    void TearDown() override {
        cache_.reset();
        test::DrawTest::TearDown();
    }

    /// A renderer of its own for every picture, as an editor makes one for every edit.
    Frame draw(const Scene& scene, const FrameSettings& settings, Report& report) {
        Renderer renderer(*cache_, context(), scene, plan_effects(scene, settings), settings,
                          report);
        return renderer.draw(*scene.camera);
    }
    Frame draw(const Scene& scene, const FrameSettings& settings = {40, 30, 1}) {
        Report report;
        return draw(scene, settings, report);
    }
    RenderCache& cache() { return *cache_; }

  private:
    std::optional<RenderCache> cache_;
};

TEST_F(Cached, DrawsTheSamePixelsAsWithout) {
    for (unsigned seed = 0; seed < 12; ++seed) {
        SCOPED_TRACE(seed);
        const Scene scene = test::random_scene(seed);
        const FrameSettings settings{48, 32, seed % 3 == 0 ? 4 : 1};
        EXPECT_TRUE(test::same_bits(draw(scene, settings).image, render(scene, settings).image));
        // Once more, with everything there; every seventh time from scratch.
        EXPECT_TRUE(test::same_bits(draw(scene, settings).image, render(scene, settings).image));
        if (seed % 7 == 0) cache().drop_unused();
    }
}

Scene textured_scene() {
    Material material = test::black_material();
    material.unlit = true;
    material.diffuse = glm::vec3(1.0F);
    material.diffuse_texture = Texture{};
    Scene scene = test::scene_of(test::facing_square(), material);
    scene.images = {
        {"red", test::constant_image({1, 0, 0, 1}, 3, 8, ColorSpace::srgb)},
        {"green", test::constant_image({0, 1, 0, 1}, 3, 8, ColorSpace::srgb)},
    };
    return scene;
}

TEST_F(Cached, AnEditedColourUploadsNothing) {
    Scene scene = textured_scene();
    draw(scene);
    const RenderCache::Contents before = cache().contents();
    EXPECT_EQ(before.meshes, 1U);
    EXPECT_EQ(before.textures, 1U);
    EXPECT_EQ(before.targets, 1U);
    scene.materials[0].diffuse = {0.25F, 1, 1};
    const Frame frame = draw(scene);
    EXPECT_EQ(test::pixel(frame.image, 20, 15).r, 137);  // sRGB's code of 0.25.
    const RenderCache::Contents after = cache().contents();
    EXPECT_EQ(after.programs, before.programs);
    EXPECT_EQ(after.meshes, 1U);
    EXPECT_EQ(after.textures, 1U);
    EXPECT_EQ(after.targets, 1U);
}

TEST_F(Cached, AnEditedMeshOrAnotherImageIsUploadedAndTheOldOneDropped) {
    Scene scene = textured_scene();
    EXPECT_EQ(test::pixel(draw(scene).image, 20, 15), glm::dvec4(255, 0, 0, 255));
    for (glm::vec3& position : scene.meshes[0].edit().positions)
        position.x += 100.0F;  // Out of sight.
    EXPECT_EQ(test::pixel(draw(scene).image, 20, 15).r, 0);
    EXPECT_EQ(cache().contents().meshes, 2U);
    for (glm::vec3& position : scene.meshes[0].edit().positions)
        position.x -= 100.0F;
    scene.materials[0].diffuse_texture->image = 1;
    EXPECT_EQ(test::pixel(draw(scene).image, 20, 15), glm::dvec4(0, 255, 0, 255));
    EXPECT_EQ(cache().contents().meshes, 3U);
    EXPECT_EQ(cache().contents().textures, 2U);

    const FrameSettings settings{40, 30, 1};
    Report report;
    const Renderer alive(cache(), context(), scene, plan_effects(scene, settings), settings,
                         report);
    cache().drop_unused();
    EXPECT_EQ(cache().contents().meshes, 1U);
    EXPECT_EQ(cache().contents().textures, 1U);
    EXPECT_EQ(cache().contents().targets, 1U);
}

TEST_F(Cached, AFileThatChangedIsReadAgain) {
    const std::filesystem::path file =
        std::filesystem::path(::testing::TempDir()) / "render_cache_test.png";
    write_image(file, test::constant_image({1, 0, 0, 1}, 3, 8, ColorSpace::srgb));
    Scene scene = textured_scene();
    scene.images[0].source = file;
    EXPECT_EQ(test::pixel(draw(scene).image, 20, 15), glm::dvec4(255, 0, 0, 255));
    write_image(file, test::constant_image({0, 0, 1, 1}, 3, 8, ColorSpace::srgb));
    // Of the same size, and perhaps in the same tick of the clock.
    std::filesystem::last_write_time(
        file, std::filesystem::last_write_time(file) + std::chrono::seconds(1));
    EXPECT_EQ(test::pixel(draw(scene).image, 20, 15), glm::dvec4(0, 0, 255, 255));
    std::filesystem::remove(file);
}

TEST_F(Cached, ADamagedFileIsReadAgainWhenItChanges) {
    const test::TemporaryDirectory folder;
    const std::filesystem::path file = folder / "image.png";
    Scene scene = textured_scene();
    const Image expected = draw(scene).image;
    write_image(file, test::constant_image({1, 0, 0, 1}, 3, 8, ColorSpace::srgb));
    std::ifstream stream(file, std::ios::binary);
    const std::string good((std::istreambuf_iterator<char>(stream)), {});
    const auto write = [&](const std::string& bytes) {
        std::ofstream(file, std::ios::binary) << bytes;
    };
    scene.images[0].source = file;
    write(std::string(good.size(), 'x'));
    const auto time = std::filesystem::last_write_time(file);
    const auto findings = [&] {
        Report report;
        (void)draw(scene, {40, 30, 1}, report);
        return report.findings().size();
    };
    EXPECT_EQ(findings(), 1U);
    write(good);
    std::filesystem::last_write_time(file, time);
    EXPECT_EQ(findings(), 1U) << "the file looks as it did, so it is not decoded again";
    std::filesystem::last_write_time(file, time + std::chrono::seconds(1));
    EXPECT_EQ(findings(), 0U);
    EXPECT_TRUE(test::same_bits(draw(scene).image, expected));
}

TEST_F(Cached, RenderersThatLiveSideBySideDoNotDrawIntoEachOther) {
    const Scene red = textured_scene();
    Scene green = red;
    green.materials[0].diffuse_texture->image = 1;
    const FrameSettings settings{40, 30, 1};
    Report report;
    Renderer first(cache(), context(), red, plan_effects(red, settings), settings, report);
    Renderer second(cache(), context(), green, plan_effects(green, settings), settings, report);
    const RenderedFrame one = first.draw_only(*red.camera);
    const RenderedFrame other = second.draw_only(*green.camera);
    EXPECT_NE(one.texture, other.texture);
    EXPECT_EQ(test::pixel(first.draw(*red.camera).image, 20, 15), glm::dvec4(255, 0, 0, 255));
    EXPECT_EQ(test::pixel(second.draw(*green.camera).image, 20, 15), glm::dvec4(0, 255, 0, 255));
    EXPECT_EQ(cache().contents().meshes, 1U);
    EXPECT_EQ(cache().contents().targets, 2U);
}

TEST_F(Cached, FindingsAreReportedEveryTime) {
    Scene scene = textured_scene();
    scene.meshes[0].edit().normals.clear();
    scene.meshes[0].edit().positions.push_back({0, 0, 0});  // Isolated: its normal is a fallback.
    scene.meshes[0].edit().texcoords.push_back({0, 0});
    scene.materials[0].unlit = false;
    scene.directional_lights = {{{0, 0, -1}, {1, 1, 1}}};
    Report first, second;
    draw(scene, {40, 30, 1}, first);
    draw(scene, {40, 30, 1}, second);
    ASSERT_EQ(first.findings().size(), 1U);
    ASSERT_EQ(second.findings().size(), 1U);
    EXPECT_EQ(second.findings()[0].count, first.findings()[0].count);
    EXPECT_EQ(cache().contents().meshes, 1U);
}

TEST_F(Cached, TheSameSurroundingsAreUploadedOnceWhateverTheirIntensity) {
    Scene scene = test::scene_of(test::facing_square(), test::black_material());
    scene.materials[0].diffuse = glm::vec3(1.0F);
    scene.environment = test::constant_environment({0.5F, 0.5F, 0.5F}, true);
    scene.environment->lights = true;
    const FrameSettings settings{16, 16, 1, OutputCoding::linear};
    const double once = test::pixel(draw(scene, settings).image, 8, 8).r;
    scene.environment->intensity = 0.5F;
    EXPECT_NEAR(test::pixel(draw(scene, settings).image, 8, 8).r, 0.5 * once, 1e-6);
    EXPECT_EQ(cache().contents().environments, 1U);
}

}  // namespace
}  // namespace relief

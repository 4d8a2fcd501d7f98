// SPDX-License-Identifier: Apache-2.0
// Programs and resources that renderers share: every pair of effects links with exactly the
// planned inputs, and cached or handed-over results are the same pixels.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "effects/shader_source.h"
#include "gl/api.h"
#include "relief/mesh/image_file.h"
#include "relief/shade/renderer.h"
#include "render/program_cache.h"
#include "shade/effects/feature_sets.h"
#include "shade/render/draw_support.h"
#include "shade/render/random_scene.h"
#include "support/gl_environment.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;
using namespace relief::shade::detail;

namespace {

class RendererPrograms : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(RendererPrograms);

std::vector<std::string> names(const std::vector<gl::ActiveVariable>& variables) {
    std::vector<std::string> result;
    for (const gl::ActiveVariable& variable : variables)
        result.push_back(variable.name);
    return result;
}

TEST_P(RendererPrograms, OfACoveringSetHaveExactlyThePlannedInputs) {
    for (const Features& f : test::covering_features()) {
        SCOPED_TRACE(describe(f));
        ProgramCache cache(api());
        const DrawProgram& program = *cache.get(f);
        const gl::ProgramInterface& actual = program.linked.interface();
        const PlannedInterface active{names(actual.attributes), names(actual.uniforms),
                                      actual.uniform_blocks, names(actual.samplers)};
        EXPECT_EQ(active.attributes, program.planned.attributes);
        EXPECT_EQ(active.uniforms, program.planned.uniforms);
        EXPECT_EQ(active.uniform_blocks, program.planned.uniform_blocks);
        EXPECT_EQ(active.samplers, program.planned.samplers);
    }
}

TEST(TextureUnits, LimitTheTexturesOfASurface) {
    PlannedInterface planned;
    planned.samplers = {"bump_texture", "diffuse_texture", "normal_texture"};
    EXPECT_NO_THROW(check_texture_units(planned, 3));
    try {
        check_texture_units(planned, 2);
        FAIL() << "accepted";
    } catch (const GpuError& error) {
        EXPECT_STREQ(error.what(),
                     "a surface needs 3 textures at once, and a shader of this OpenGL driver can "
                     "sample 2: bump_texture, diffuse_texture, normal_texture");
    }
}

TEST_P(RendererPrograms, AreSharedByEqualFeatures) {
    ProgramCache cache(api());
    Features f;
    f.directional_lights = 1;
    f.diffuse = true;
    const auto first = cache.get(f);
    EXPECT_EQ(first, cache.get(Features(f)));
    f.directional_lights = 2;
    EXPECT_NE(first, cache.get(f));
    EXPECT_EQ(cache.size(), 2U);
}

TEST_P(RendererPrograms, NameTheFileAndLineOfAnError) {
    const test::TemporaryDirectory folder;
    const test::ScopedVariable variable("RELIEF_SHADER_DIR", folder.path().c_str());
    std::ofstream(folder / "phong.glsl")
        << "// One part replaces the embedded one.\n//@part lambert\nuniform vec3 diffuse_color;\n"
           "vec3 diffuse_scattering(float n_dot_l) { return diffuse_colour * n_dot_l; }\n";
    Features f;
    f.directional_lights = 1;
    f.diffuse = true;
    ProgramCache cache(api());
    try {
        (void)cache.get(f);
        FAIL() << "a broken shader was accepted";
    } catch (const GpuError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("phong.glsl:4"));
        EXPECT_THAT(error.what(), ::testing::HasSubstr("diffuse_colour"));
        EXPECT_THAT(error.what(), ::testing::HasSubstr("1 directional light, diffuse"));
    }
}

TEST_P(RendererPrograms, AreThoseOfTheirTexts) {
    const auto red = std::make_shared<const ShaderTexts>(
        ShaderTexts{{{"output.glsl",
                      "//@part linear implements output\nvec3 coded(vec3 radiance) { return "
                      "vec3(1, 0, 0); }\n"}},
                    true});
    ProgramCaches caches(api());
    Features f;
    f.output = OutputCoding::linear;
    const auto plain = caches.with(nullptr).get(f);
    const auto edited = caches.with(red).get(f);
    EXPECT_NE(plain, edited);
    EXPECT_EQ(caches.with(red).get(f), edited);
    EXPECT_EQ(caches.with(nullptr).get(f), plain);
    EXPECT_EQ(caches.size(), 2U);
    const auto broken = std::make_shared<const ShaderTexts>(
        ShaderTexts{{{"output.glsl", "//@part linear implements output\n?\n"}}, true});
    try {
        (void)caches.with(broken).get(f);
        FAIL() << "a broken text was accepted";
    } catch (const GpuError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("output.glsl:2"));
    }
}

TEST_P(RendererPrograms, LeaveWithTheirTexts) {
    ProgramCaches caches(api());
    auto texts = std::make_shared<const ShaderTexts>();
    (void)caches.with(texts).get(Features{});
    EXPECT_EQ(caches.size(), 1U);
    texts.reset();
    EXPECT_EQ(caches.with(nullptr).size(), 0U);
    EXPECT_EQ(caches.size(), 0U);
}

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

    /// Renders every picture with a new renderer, as an editor does for every edit.
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
        // Renders again with a full cache, and every seventh time with an empty one.
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

TEST_F(Cached, AnEditedColorUploadsNothing) {
    Scene scene = textured_scene();
    draw(scene);
    const RenderCache::Contents before = cache().contents();
    EXPECT_EQ(before.meshes, 1U);
    EXPECT_EQ(before.textures, 1U);
    EXPECT_EQ(before.targets, 1U);
    scene.materials[0].diffuse = {0.25F, 1, 1};
    const Frame frame = draw(scene);
    EXPECT_EQ(test::pixel(frame.image, 20, 15).r, 137);  // The sRGB code of 0.25.
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
        position.x += 100.0F;  // The mesh is out of sight.
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
    // The new file has the same size, and possibly the same time stamp.
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
    scene.meshes[0].edit().positions.push_back({0, 0, 0});  // The vertex is isolated, so its normal
                                                            // is a fallback.
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

TEST_F(Cached, EnvironmentIsUploadedOnceForAnyIntensity) {
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

class Handing : public test::DrawTest {
  protected:
    /// Hands over a picture of one color and this size.
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

    /// Returns the color in the middle of a texture.
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

TEST_F(Handing, NoPictureIsShownBeforeTheFirstFrame) {
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

TEST_F(Handing, ShownPictureStaysUnchanged) {
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

TEST_F(Handing, SecondPictureIsOptional) {
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

TEST_F(Handing, ExternalPictureIsUpright) {
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

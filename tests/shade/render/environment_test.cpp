// SPDX-License-Identifier: Apache-2.0
// Environments from real files: six faces look like the panorama from which they were made, and the
// error message for invalid files names them.
#include "render/environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "environment/convolution.h"
#include "environment/environment_images.h"
#include "relief/mesh/report.h"
#include "relief/shade/image_compare.h"
#include "shade/environment/test_environments.h"
#include "shade/render/draw_support.h"
#include "support/labels.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;
using namespace relief::shade::detail;

namespace {

class Environments : public test::DrawTest {
  protected:
    /// Draws a picture of 48 x 48 pixels. The cache keeps the maps of the environment.
    [[nodiscard]] Image radiance_with(RenderCache& cache, const Scene& scene) const {
        const FrameSettings settings{48, 48, 1, OutputCoding::linear};
        Report report;
        Renderer renderer(cache, context(), scene, plan_effects(scene, settings), settings, report);
        return renderer.draw(*scene.camera).image;
    }
};

Environment six_files(const std::filesystem::path& folder, const std::string& extension) {
    CubeFaces faces;
    const char* const names[6] = {"posx", "negx", "posy", "negy", "posz", "negz"};
    for (std::size_t i = 0; i < 6; ++i) {
        const std::filesystem::path file = folder / (names[i] + extension);
        faces.faces[i] = {file.string(), file};
    }
    return {faces, 1.0F, true};
}

Scene mirror_ball(const Environment& environment) {
    Material mirror = test::black_material();
    mirror.reflectivity = mirror.grazing_reflectivity = glm::vec3(1.0F);
    Scene scene = test::scene_of(test::sphere(96, 48), mirror);
    scene.environment = environment;
    return scene;
}

TEST_F(Environments, LookAlikeAsSixFacesAndAsAPanorama) {
    RELIEF_NEEDS_SHARED(cube, "data/env/cube/venice_sunset_256");
    RELIEF_NEEDS_SHARED(panorama, "data/env/equirect/venice_sunset_1k.hdr");
    const FrameSettings settings{256, 256, 1, OutputCoding::srgb};
    const Image faces = render(mirror_ball(six_files(cube, ".hdr")), settings).image;
    const Environment round{Equirectangular{{panorama.string(), panorama}}, 1.0F, true};
    const Image equirect = render(mirror_ball(round), settings).image;
    const ImageDifference difference = compare(faces, equirect);
    // The mantissas of the faces are rounded down, so they are half a percent darker: one or two
    // codes.
    EXPECT_LE(difference.mean, 1.5);
    Environment turned = round;
    std::get<Equirectangular>(turned.source).image.source =
        test::constant_image({0.2F, 0.2F, 0.2F, 1}, 3, 32, ColorSpace::linear);
    EXPECT_GT(compare(faces, render(mirror_ball(turned), settings).image).mean, 20.0);
}

/// Six faces with one color in the left half and another in the right half.
std::vector<Image> two_colored_faces() {
    std::vector<Image> faces;
    for (std::size_t face = 0; face < 6; ++face) {
        Image image = make_image(4, 4, 3, 8, ColorSpace::srgb);
        for (std::size_t i = 0; i < image.sample_count(); ++i) {
            const bool right = i / 3 % 4 >= 2;
            image.as<std::uint8_t>()[i] =
                static_cast<std::uint8_t>(30 * face + 50 * (i % 3) + (right ? 25 : 0));
        }
        faces.push_back(std::move(image));
    }
    return faces;
}

TEST_F(Environments, LookAlikeAsSixFacesAndAsACross) {
    const std::vector<Image> images = two_colored_faces();
    CubeFaces faces;
    Image cross = make_image(16, 12, 3, 8, ColorSpace::srgb);
    const std::array<glm::ivec2, 6> corners{{{8, 4}, {0, 4}, {4, 0}, {4, 8}, {4, 4}, {12, 4}}};
    for (std::size_t face = 0; face < 6; ++face) {
        faces.faces.at(face) = {"face", images[face]};
        for (std::size_t i = 0; i < 48; ++i) {
            const auto x = static_cast<std::size_t>(corners.at(face).x) + i / 3 % 4;
            const auto y = static_cast<std::size_t>(corners.at(face).y) + i / 12;
            cross.as<std::uint8_t>()[3 * (16 * y + x) + i % 3] = images[face].as<std::uint8_t>()[i];
        }
    }
    const FrameSettings settings{64, 64, 1, OutputCoding::srgb};
    const Image as_faces = render(mirror_ball({faces, 1.0F, true}), settings).image;
    const Image as_cross =
        render(mirror_ball({CubeCross{{"cross", cross}}, 1.0F, true}), settings).image;
    EXPECT_EQ(compare(as_faces, as_cross).max, 0.0);

    // The other handedness: the picture of a set that was reversed by hand.
    faces.left_handed = true;
    const Image left = render(mirror_ball({faces, 1.0F, true}), settings).image;
    CubeFaces turned;
    const std::vector<Image> mirrored = other_handed(images);
    for (std::size_t face = 0; face < 6; ++face)
        turned.faces.at(face) = {"face", mirrored[face]};
    EXPECT_EQ(compare(left, render(mirror_ball({turned, 1.0F, true}), settings).image).max, 0.0);
    EXPECT_GT(compare(left, as_faces).mean, 5.0);
}

TEST_F(Environments, LookAlikeAsAPanoramaAndAsALightProbe) {
    RELIEF_NEEDS_SHARED(panorama, "data/env/equirect/venice_sunset_1k.hdr");
    RELIEF_NEEDS_SHARED(probe, "data/env/angular/venice_sunset_angular_512.hdr");
    const FrameSettings settings{128, 128, 1, OutputCoding::srgb};
    const Image round =
        render(mirror_ball({Equirectangular{{"panorama", panorama}}, 1.0F, true}), settings).image;
    const Image ball =
        render(mirror_ball({AngularMap{{"probe", probe}}, 1.0F, true}), settings).image;
    // In its middle, the probe has half the texels of the panorama. The difference is a slight
    // blur.
    EXPECT_LT(flip_difference(round, ball).mean, 0.06);
    EXPECT_LE(compare(round, ball).mean, 4.0);
}

/// Six faces whose texels hold the `radiance` of their direction.
Environment computed(int size, const std::function<double(glm::dvec3)>& radiance) {
    CubeFaces faces;
    std::vector<Image> images =
        test::faces_of(size, [&](glm::dvec3 d) { return glm::dvec3(radiance(d)); });
    for (std::size_t face = 0; face < 6; ++face)
        faces.faces.at(face) = {"face", std::move(images[face])};
    return {.source = faces, .skybox = false, .lights = true};
}

TEST_F(Environments, IlluminateByTheVisibleHemisphere) {
    Material white = test::black_material();
    white.diffuse = glm::vec3(1.0F);
    Scene scene = test::scene_of(test::facing_square(), white);
    const auto shown = [&](const Environment& environment) {
        scene.environment = environment;
        return test::pixel(radiance(scene, 8, 8), 4, 4).x;
    };
    // The square faces +z.
    EXPECT_NEAR(shown(computed(16, [](glm::dvec3) { return 0.75; })), 0.75, 1e-3);
    EXPECT_NEAR(shown(computed(64, [](glm::dvec3 d) { return d.z > 0 ? 1.0 : 0.0; })), 1.0, 2e-3);
    EXPECT_NEAR(shown(computed(64, [](glm::dvec3 d) { return d.z > 0 ? 0.0 : 1.0; })), 0.0, 2e-3);
    EXPECT_NEAR(shown(computed(64, [](glm::dvec3 d) { return d.y > 0 ? 1.0 : 0.0; })), 0.5, 2e-3);
    Environment bright = computed(16, [](glm::dvec3) { return 0.75; });
    bright.intensity = 4.0F;
    EXPECT_NEAR(shown(bright), 3.0, 4e-3);
}

/// A white furnace: in even light, a white ball is as bright as the light, at every angle.
TEST_F(Environments, ConstantLightIsReflectedCompletelyByWhiteSurfaces) {
    Material white = test::black_material();
    white.metallic_roughness.emplace();
    Scene scene = test::scene_of(test::sphere(48, 24), white);
    scene.environment = computed(16, [](glm::dvec3) { return 1.0; });
    RenderCache cache(context());
    for (const float metallic : {0.0F, 1.0F}) {
        for (const float roughness : {0.0F, 0.1F, 0.2F, 0.35F, 0.5F, 0.7F, 0.85F, 1.0F}) {
            scene.materials[0].metallic_roughness->metallic = metallic;
            scene.materials[0].metallic_roughness->roughness = roughness;
            const Image picture = radiance_with(cache, scene);
            double darkest = 1.0;
            double brightest = 1.0;
            for (int y = 0; y < picture.height; ++y) {
                for (int x = 0; x < picture.width; ++x) {
                    const glm::dvec4 color = test::pixel(picture, x, y);
                    if (color.a == 0.0) continue;
                    darkest = std::min(darkest, color.x);
                    brightest = std::max(brightest, color.x);
                }
            }
            EXPECT_GT(darkest, 0.995) << metallic << " " << roughness;
            EXPECT_LT(brightest, 1.005) << metallic << " " << roughness;
        }
    }
}

/// The same under a clear coat and with anisotropic facets.
TEST_F(Environments, OfEvenLightAreReflectedWhollyUnderCoatsAndByAnisotropicFacets) {
    Material white = test::black_material();
    white.metallic_roughness = {glm::vec3(1.0F), 1.0F, 0.5F, {}};
    Scene scene = test::scene_of(test::sphere(48, 24), white);
    scene.environment = computed(16, [](glm::dvec3) { return 1.0; });
    RenderCache cache(context());
    const auto expect_white = [&] {
        const Image picture = radiance_with(cache, scene);
        for (int y = 0; y < picture.height; ++y) {
            for (int x = 0; x < picture.width; ++x) {
                const glm::dvec4 color = test::pixel(picture, x, y);
                if (color.a == 0.0) continue;
                ASSERT_NEAR(color.x, 1.0, 0.005) << x << " " << y;
            }
        }
    };
    MetallicRoughness& model = *scene.materials[0].metallic_roughness;
    for (const float roughness : {0.0F, 0.2F, 0.5F, 0.7F, 1.0F}) {
        SCOPED_TRACE(roughness);
        model.clearcoat = 1.0F;
        model.clearcoat_roughness = roughness;
        expect_white();
        model.clearcoat = 0.0F;
        model.anisotropy = roughness;
        expect_white();
        model.anisotropy = 0.0F;
    }
}

/// The first bounce alone is the albedo of the table.
TEST_F(Environments, ConstantLightLosesMultipleScatteringWithoutCompensation) {
    Material metal = test::black_material();
    metal.metallic_roughness.emplace();
    Scene scene = test::scene_of(test::facing_square(), metal);
    scene.environment = computed(16, [](glm::dvec3) { return 1.0; });
    const FrameSettings settings{65, 65, 1, OutputCoding::linear};
    for (const float roughness : {0.1F, 0.5F, 1.0F}) {
        scene.materials[0].metallic_roughness->roughness = roughness;
        const FramePlan plan = force_effects(scene, settings, plan_effects(scene, settings),
                                             {{}, {{"energy compensation", false}}});
        // The view is along the normal and f0 is 1. The tolerance covers half floats and the
        // bilinear lookups of the table.
        const glm::dvec2 albedo = environment_brdf(1.0, static_cast<double>(roughness));
        EXPECT_NEAR(test::pixel(render(scene, plan, settings).image, 32, 32).x, albedo.x + albedo.y,
                    4e-3)
            << roughness;
    }
}

TEST_F(Environments, AreMirroredBlurredByRoughness) {
    Material rough = test::black_material();
    rough.reflectivity = rough.grazing_reflectivity = glm::vec3(1.0F);
    Scene scene = test::scene_of(test::facing_square(), rough);
    const auto light = [](glm::dvec3 d) { return d.z > 0.9 ? 5.0 : 0.25; };
    scene.environment = computed(128, light);
    const std::vector<Image> faces =
        test::faces_of(128, [&](glm::dvec3 d) { return glm::dvec3(light(d)); });
    // These are levels of the blurred map; between them, the picture is a blend. The last level has
    // 8 texels per face, whose lookups flatten a peak by a percent.
    for (const float roughness : {0.25F, 0.5F, 1.0F}) {
        scene.materials[0].reflection_roughness = roughness;
        const double expected =
            blurred_radiance(faces, {0, 0, 1}, static_cast<double>(roughness)).x;
        EXPECT_NEAR(test::pixel(radiance(scene, 65, 65), 32, 32).x / expected, 1.0, 0.02)
            << roughness;
    }
}

/// A dim sky with a sun, as a panorama.
Image sunny_panorama(float sun) {
    Image image = make_image(64, 32, 3, 32, ColorSpace::linear);
    const auto samples = image.as<float>();
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = 0.5F + 0.25F * static_cast<float>(i % 3);
    for (const std::size_t texel : {10U * 64U + 40U, 10U * 64U + 41U, 11U * 64U + 40U}) {
        samples[3 * texel] = sun;
        samples[3 * texel + 1] = 0.75F * sun;
        samples[3 * texel + 2] = 0.5F * sun;
    }
    return image;
}

/// Returns six faces of the panorama's texels in front of them.
CubeFaces faces_of_panorama(const Image& panorama) {
    CubeFaces faces;
    for (std::size_t face = 0; face < 6; ++face)
        faces.faces.at(face) = {"face", make_image(16, 16, 3, 32, ColorSpace::linear)};
    auto& front = std::get<Shared<Image>>(faces.faces[4].source).edit();
    std::ranges::copy(std::span(panorama.as<float>()).subspan(3 * (10 * 64 + 32), 3 * 256),
                      front.as<float>().begin());
    return faces;
}

/// Multiplies by a power of two, which is exact.
Image scaled(Image image, float factor) {
    for (float& sample : image.as<float>())
        sample *= factor;
    return image;
}

TEST_LABELS(not_sanitized);
TEST_F(Environments, KeepTheEnergyOfASun) {
    const Image panorama = sunny_panorama(1e6F);
    Image square = make_image(32, 32, 3, 32, ColorSpace::linear);
    std::ranges::copy(std::span(panorama.as<float>()).subspan(3 * 10 * 64, 3 * 32 * 16),
                      square.as<float>().begin());
    using Source = decltype(Environment::source);
    const std::vector<std::function<Source(float)>> sources = {
        [&](float factor) {
            return Equirectangular{{"panorama", scaled(panorama, factor)}};
        },
        [&](float factor) {
            return AngularMap{{"probe", scaled(square, factor)}};
        },
        [&](float factor) { return faces_of_panorama(scaled(panorama, factor)); }};
    for (std::size_t layout = 0; layout < sources.size(); ++layout) {
        for (const float roughness : {0.0F, 0.2F, 0.5F, 1.0F}) {
            SCOPED_TRACE(testing::Message() << layout << ", roughness " << roughness);
            const auto shown = [&](float factor) {
                Scene scene = test::scene_of(test::sphere(48, 24), Material{});
                scene.materials[0].diffuse = glm::vec3(0.5F);
                scene.materials[0].reflectivity = glm::vec3(0.5F);
                scene.materials[0].reflection_roughness = roughness;
                scene.environment = Environment{
                    .source = sources[layout](factor), .intensity = 1.0F / factor, .lights = true};
                Report report;
                Renderer renderer(context(), scene, {32, 32, 1, OutputCoding::linear}, report);
                EXPECT_TRUE(report.empty());
                return renderer.draw(*scene.camera).image;
            };
            const Image bright = shown(1.0F);
            const Image dim = shown(0x1p-5F);
            for (std::size_t i = 0; i < bright.sample_count(); ++i) {
                const float expected = dim.as<float>()[i];
                ASSERT_NEAR(bright.as<float>()[i], expected, 0.01F * expected) << i;
            }
        }
    }
}

/// An image with a NaN, an infinity and a number beyond the largest radiance in one texel each.
Image broken_image(int width, int height) {
    Image image = make_image(width, height, 3, 32, ColorSpace::linear);
    image.as<float>()[0] = std::numeric_limits<float>::quiet_NaN();
    image.as<float>()[4] = std::numeric_limits<float>::infinity();
    image.as<float>()[8] = 1e20F;
    return image;
}

TEST_F(Environments, WithTexelsThatAreNotFiniteAreCountedAndTheirPictureIsFinite) {
    const Image square = broken_image(12, 12);
    CubeFaces faces;
    for (ImageSource& face : faces.faces)
        face = {"face", make_image(12, 12, 3, 32, ColorSpace::linear)};
    faces.faces[3].source = square;
    // Empty parts of a cross have no effect, so its broken texels must lie in a face.
    Image cross = make_image(16, 12, 3, 32, ColorSpace::linear);
    std::ranges::copy(std::span(square.as<float>()).first(9),
                      cross.as<float>().subspan(3 * 4).begin());
    const std::vector<Environment> environments{
        {.source = faces, .lights = true},
        {.source = CubeCross{{"cross", cross}}, .lights = true},
        {.source = Equirectangular{{"panorama", broken_image(16, 8)}}, .lights = true},
        {.source = AngularMap{{"probe", square}}, .lights = true}};
    for (const Environment& environment : environments) {
        Scene scene = mirror_ball(environment);
        scene.materials[0].diffuse = glm::vec3(1.0F);
        scene.materials[0].reflectivity = glm::vec3(0.5F);
        for (const float roughness : {0.0F, 0.4F}) {
            scene.materials[0].reflection_roughness = roughness;
            Report report;
            Renderer renderer(context(), scene, {16, 16, 1, OutputCoding::linear}, report);
            EXPECT_EQ(report.count("radiance that is not finite"), 2U);
            EXPECT_EQ(report.count("radiance beyond 1e18"), 1U);
            const Image image = renderer.draw(*scene.camera).image;
            for (const float sample : image.as<float>())
                ASSERT_TRUE(std::isfinite(sample));
        }
    }
}

TEST_F(Environments, WorkWithOneTexelPerFace) {
    CubeFaces faces;
    for (std::size_t face = 0; face < 6; ++face) {
        Image texel = make_image(1, 1, 3, 32, ColorSpace::linear);
        for (float& sample : texel.as<float>())
            sample = face == 4 ? 1.0F : 0.25F;
        faces.faces.at(face) = {"face", std::move(texel)};
    }
    Material white = test::black_material();
    white.diffuse = glm::vec3(1.0F);
    Scene scene = test::scene_of(test::facing_square(), white);
    scene.environment = Environment{.source = faces, .skybox = false, .lights = true};
    const double shed = test::pixel(radiance(scene, 8, 8), 4, 4).x;
    // A quarter comes from all directions, and three quarters more from the face in front, which
    // gives 4 / (pi sqrt(2)) atan(1 / sqrt(2)) = 0.554 of the irradiance of a full hemisphere.
    EXPECT_NEAR(shed, 0.25 + 0.75 * 0.554, 0.02) << "order 2 leaves a little out";
}

TEST_F(Environments, RefuseInvalidCrossesByName) {
    const Environment environment{
        CubeCross{{"room.png", make_image(10, 10, 3, 32, ColorSpace::linear)}}};
    try {
        (void)render(mirror_ball(environment), {8, 8, 1, OutputCoding::srgb});
        FAIL() << "a square was accepted as a cross";
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(),
                     "cross 'room.png' has 10 x 10 texels, but the faces of a cube lie in 4 x 3 "
                     "(horizontal) or 3 x 4 (vertical) squares");
    }
}

TEST_F(Environments, NameTheFaceThatDoesNotFit) {
    Environment environment = test::constant_environment(glm::vec3(0.5F), true);
    auto& faces = std::get<CubeFaces>(environment.source).faces;
    faces[3].source = make_image(3, 2, 3, 32, ColorSpace::linear);
    try {
        (void)render(mirror_ball(environment), {8, 8, 1, OutputCoding::srgb});
        FAIL() << "a face that is not square was accepted";
    } catch (const InvalidInput& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("-y"));
    }
}

TEST_F(Environments, ThatAreMissingAreFileErrors) {
    const Environment environment = six_files("/nowhere", ".png");
    try {
        (void)render(mirror_ball(environment), {8, 8, 1, OutputCoding::srgb});
        FAIL() << "missing faces were accepted";
    } catch (const FileError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("/nowhere/"));
    }
}

}  // namespace
}  // namespace relief

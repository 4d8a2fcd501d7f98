// SPDX-License-Identifier: Apache-2.0
// The renderer as a whole: orientation, transforms and mirrors, culling, decoding and upload,
// background, samples, and invalid input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <vector>

#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "relief/shade/image_compare.h"
#include "relief/shade/reference.h"
#include "relief/shade/renderer.h"
#include "shade/render/draw_support.h"
#include "support/sanitized.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;

namespace {

using test::pixel;
using ::testing::HasSubstr;

class Rendering : public test::DrawTest {};

/// Red upper left, green upper right, blue lower left, white lower right.
Image four_colors() {
    Image image = make_image(2, 2, 3, 8, ColorSpace::srgb);
    image.samples = std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
    return image;
}

Material unlit_texture() {
    Material material = test::black_material();
    material.unlit = true;
    material.diffuse = glm::vec3(1.0F);
    Texture texture;
    texture.wrap_u = texture.wrap_v = Wrap::clamp;
    texture.filter = TextureFilter::nearest;
    material.diffuse_texture = texture;
    return material;
}

TEST_F(Rendering, ShowsTexturesUpright) {
    Scene scene = test::scene_of(test::facing_square(), unlit_texture());
    scene.images = {{"four colors", four_colors()}};
    const Frame frame = render(scene, {32, 32, 1, OutputCoding::srgb});
    EXPECT_EQ(pixel(frame.image, 4, 4), glm::dvec4(255, 0, 0, 255));
    EXPECT_EQ(pixel(frame.image, 28, 4), glm::dvec4(0, 255, 0, 255));
    EXPECT_EQ(pixel(frame.image, 4, 28), glm::dvec4(0, 0, 255, 255));
    EXPECT_EQ(pixel(frame.image, 28, 28), glm::dvec4(255, 255, 255, 255));
    EXPECT_EQ(frame.textures, 1U);
    EXPECT_EQ(frame.programs, 1U);
}

TEST_F(Rendering, PutsRowZeroOnTopAndXToTheRight) {
    Material material = test::black_material();
    material.emission = {1, 1, 1};
    Scene scene = test::scene_of(test::grid(1), material);  // [0,1]^2 is up and to the right of the
                                                            // center.
    const Image image = render(scene, {40, 40, 1, OutputCoding::srgb}).image;
    EXPECT_EQ(pixel(image, 25, 15).r, 255);
    EXPECT_EQ(pixel(image, 15, 15).r, 0);
    EXPECT_EQ(pixel(image, 25, 25).r, 0);
}

TEST_F(Rendering, DrawsBackFacesOnlyOfDoubleSidedMaterials) {
    Material material = test::black_material();
    material.diffuse = {1, 1, 1};
    Scene scene = test::scene_of(test::facing_square(), material);
    scene.directional_lights = {{{0, 0, -1}, {0.5F, 0.5F, 0.5F}}};
    scene.instances[0].world_from_object[0].x =
        -1.0F;  // Rotated about y, so that the back faces the camera.
    scene.instances[0].world_from_object[2].z = -1.0F;
    EXPECT_EQ(pixel(radiance(scene, 16, 16), 8, 8), glm::dvec4(0));
    scene.materials[0].double_sided = true;
    // The opposite of the normal faces camera and light.
    EXPECT_EQ(pixel(radiance(scene, 16, 16), 8, 8), glm::dvec4(0.5, 0.5, 0.5, 1));
}

/// A bumpy, asymmetric sphere with texture coordinates, under light from the side.
Scene bumpy_scene() {
    Image normals = make_image(16, 16, 3, 8, ColorSpace::data);
    auto samples = normals.as<std::uint8_t>();
    for (std::size_t i = 0; i < 256; ++i) {
        samples[3 * i] = static_cast<std::uint8_t>(100 + 5 * (i % 16));
        samples[3 * i + 1] = static_cast<std::uint8_t>(150 - 4 * (i / 16));
        samples[3 * i + 2] = 240;
    }
    Material material;
    material.specular = {0.3F, 0.3F, 0.3F};
    material.normal_map = NormalMap{Texture{0}, 1.0F, Green::up, FlatCode::middle};
    Scene scene = test::scene_of(test::sphere(32, 16), material);
    scene.images = {{"bumps", normals}};
    scene.directional_lights = {{{1, -0.5F, -1}, {0.8F, 0.8F, 0.8F}}};
    Report report;
    FrameOptions options;
    options.tangents = TangentMethod::mikktspace;
    scene.meshes[0] = with_frames(scene.meshes[0], options, report).mesh;
    return scene;
}

TEST_F(Rendering, ShadesAMirroredInstanceAsTheMirroredGeometry) {
    const Scene plain = bumpy_scene();
    Scene by_matrix = plain;
    by_matrix.instances[0].world_from_object = glm::mat4(1.0F);
    by_matrix.instances[0].world_from_object[0].x = -1.5F;
    by_matrix.instances[0].world_from_object[3] = glm::vec4(0.2F, 0, 0, 1);

    Scene by_geometry = plain;
    Mesh& mesh = by_geometry.meshes[0].edit();
    for (glm::vec3& p : mesh.positions)
        p.x = -1.5F * p.x + 0.2F;
    for (glm::vec3& n : mesh.normals)
        n = glm::normalize(glm::vec3(n.x / -1.5F, n.y, n.z));
    for (glm::vec4& t : mesh.tangents) {
        t = glm::vec4(glm::normalize(glm::vec3(-1.5F * t.x, t.y, t.z)), -t.w);
    }
    for (glm::uvec3& triangle : mesh.triangles)
        std::swap(triangle.y, triangle.z);

    const FrameSettings settings{96, 96, 1, OutputCoding::srgb};
    const ImageDifference difference =
        compare(render(by_matrix, settings).image, render(by_geometry, settings).image);
    // The order of roundings differs, so a few codes may differ by one.
    EXPECT_LE(difference.max, 1.0);
    EXPECT_LE(difference.mean, 0.01);
    const ImageDifference unlike =
        compare(render(by_matrix, settings).image, render(plain, settings).image);
    EXPECT_GT(unlike.mean, 1.0) << "the test shows nothing";
}

TEST_F(Rendering, TurnsNormalsByTheInverseTranspose) {
    // A sphere with a scale of a quarter in z, against the normals of the ellipsoid.
    Material material;
    Scene squashed = test::scene_of(test::sphere(64, 32), material);
    squashed.directional_lights = {{{1, -0.5F, -1}, {0.8F, 0.8F, 0.8F}}};
    Scene ellipsoid = squashed;
    squashed.instances[0].world_from_object[2].z = 0.25F;
    for (glm::vec3& p : ellipsoid.meshes[0].edit().positions)
        p.z *= 0.25F;
    for (glm::vec3& n : ellipsoid.meshes[0].edit().normals) {
        n = glm::normalize(glm::vec3(n.x, n.y, n.z * 4.0F));
    }
    const FrameSettings settings{64, 64, 1, OutputCoding::srgb};
    EXPECT_LE(compare(render(squashed, settings).image, render(ellipsoid, settings).image).max,
              1.0);
}

/// Faces of six different radiances.
Environment six_colors() {
    const glm::vec3 colors[6] = {{1, 0, 0}, {0, 1, 1}, {0, 1, 0}, {1, 0, 1}, {0, 0, 1}, {1, 1, 0}};
    CubeFaces faces;
    for (std::size_t i = 0; i < 6; ++i) {
        faces.faces[i] = {"face", test::constant_image(glm::vec4(colors[i] * 0.5F, 1), 3, 32,
                                                       ColorSpace::linear)};
    }
    return {faces, 1.0F, false};
}

TEST_F(Rendering, ReflectsInWorldSpace) {
    Material mirror = test::black_material();
    mirror.reflectivity = mirror.grazing_reflectivity = {1, 1, 1};
    Scene scene = test::scene_of(test::facing_square(), mirror);
    scene.environment = six_colors();
    // A mirror that faces the camera shows +z, which is behind the camera.
    EXPECT_EQ(pixel(radiance(scene, 16, 16), 8, 8), glm::dvec4(0, 0, 0.5, 1));
    // Rotated by 45 degrees about y, to the right, it shows +x. The environment stays.
    const float s = std::sqrt(0.5F);
    scene.instances[0].world_from_object = glm::mat4(glm::vec4(s, 0, -s, 0), glm::vec4(0, 1, 0, 0),
                                                     glm::vec4(s, 0, s, 0), glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(pixel(radiance(scene, 16, 16), 8, 8), glm::dvec4(0.5, 0, 0, 1));
    // Rotated upwards about x, it shows +y.
    scene.instances[0].world_from_object = glm::mat4(glm::vec4(1, 0, 0, 0), glm::vec4(0, s, -s, 0),
                                                     glm::vec4(0, s, s, 0), glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(pixel(radiance(scene, 16, 16), 8, 8), glm::dvec4(0, 0.5, 0, 1));
    // The camera is at +x and looks along -x, and the mirror faces it. It shows +x.
    scene.instances[0].world_from_object = glm::mat4(glm::vec4(0, 0, -1, 0), glm::vec4(0, 1, 0, 0),
                                                     glm::vec4(1, 0, 0, 0), glm::vec4(0, 0, 0, 1));
    scene.camera->world_from_view = glm::mat4(glm::vec4(0, 0, -1, 0), glm::vec4(0, 1, 0, 0),
                                              glm::vec4(1, 0, 0, 0), glm::vec4(3, 0, 0, 1));
    EXPECT_EQ(pixel(radiance(scene, 16, 16), 8, 8), glm::dvec4(0.5, 0, 0, 1));
}

TEST_F(Rendering, ShowsTheSkyboxBehindTheModel) {
    Material material = test::black_material();
    material.emission = {0.25F, 0.25F, 0.25F};
    Scene scene = test::scene_of(test::grid(1), material);
    scene.environment = six_colors();
    scene.environment->skybox = true;
    scene.environment->intensity = 0.5F;
    const Image image = radiance(scene, 40, 40);
    EXPECT_EQ(pixel(image, 25, 15), glm::dvec4(0.25, 0.25, 0.25, 1));  // The model.
    EXPECT_EQ(pixel(image, 15, 25), glm::dvec4(0.25, 0.25, 0, 1));     // -z, half as bright.
    scene.camera->vertical_fov = 2.6F;  // The view is wide enough to see +x on the right and +y at
                                        // the top.
    const Image wide = radiance(scene, 40, 40);
    EXPECT_EQ(pixel(wide, 39, 20), glm::dvec4(0.25, 0, 0, 1));
    EXPECT_EQ(pixel(wide, 0, 20), glm::dvec4(0, 0.25, 0.25, 1));
    EXPECT_EQ(pixel(wide, 20, 0), glm::dvec4(0, 0.25, 0, 1));
    EXPECT_EQ(pixel(wide, 20, 39), glm::dvec4(0.25, 0, 0.25, 1));
}

TEST_F(Rendering, DecodesOnlyPlannedTextures) {
    Material material;
    material.diffuse_texture = Texture{0};
    material.normal_map = NormalMap{Texture{1}};
    Scene scene = test::scene_of(test::facing_square(), material);
    scene.images = {{"first", std::filesystem::path("/nowhere/first.png")},
                    {"second", std::filesystem::path("/nowhere/second.png")}};
    scene.environment = Environment{Equirectangular{{"third", "/nowhere/third.hdr"}}, 1.0F, false};
    // The surface has no light and no reflection, so no texture is read, and none is missing.
    const Frame frame = render(scene, {16, 16, 1, OutputCoding::srgb});
    EXPECT_EQ(frame.textures, 0U);
    scene.ambient = {1, 1, 1};  // The diffuse texture shows, but the normal does not.
    Report report;
    const Renderer renderer(context(), scene, {16, 16, 1, OutputCoding::srgb}, report);
    ASSERT_EQ(report.findings().size(), 1U);
    EXPECT_THAT(report.findings()[0].outcome, HasSubstr("/nowhere/first.png: no such file"));
}

TEST_F(Rendering, LeavesOutTexturesThatCannotBeReadAndNamesThem) {
    const FrameSettings settings{48, 48, 4, OutputCoding::srgb};
    const std::vector<std::byte> damaged(100, std::byte{7});
    for (const test::UnreadableTexture& texture : test::unreadable_textures()) {
        Scene equal = test::scene_for_unreadable_textures();
        texture.make_equal(equal.materials[0]);
        const Image expected = render(equal, settings).image;
        for (const bool is_missing : {true, false}) {
            Scene scene = test::scene_for_unreadable_textures();
            texture.set(scene.materials[0], Texture{0});
            scene.images = {{"brick", damaged, "wall.gltf"}};
            if (is_missing) scene.images[0].source = std::filesystem::path("/nowhere/brick.png");
            Report report;
            Renderer renderer(context(), scene, settings, report);
            EXPECT_TRUE(test::same_bits(renderer.draw(*scene.camera).image, expected))
                << texture.effect;
            ASSERT_EQ(report.findings().size(), 1U) << texture.effect;
            const Finding& finding = report.findings()[0];
            EXPECT_EQ(finding.kind,
                      std::string("unreadable ") + texture.effect + " of material 'wall'");
            EXPECT_EQ(finding.element, "image");
            EXPECT_THAT(finding.outcome,
                        HasSubstr(is_missing ? "drawn without it: wall.gltf: /nowhere/brick.png: "
                                               "no such file"
                                             : "drawn without it: wall.gltf: brick: "));
            for (const EffectReason& reason : renderer.plan().draws[0].reasons)
                EXPECT_FALSE(reason.effect == texture.effect && reason.on) << texture.effect;
            EXPECT_FALSE(renderer.plan().draws[0].needs_tangents);
        }
    }
}

TEST_F(Rendering, LeavesUnreadableTexturesOutOfForcedPlansAndViewsToo) {
    Scene scene = test::scene_for_unreadable_textures();
    const FrameSettings settings{32, 32, 1, OutputCoding::srgb};
    const Image expected = render(scene, settings).image;
    scene.materials[0].normal_map = NormalMap{Texture{0}};
    scene.images = {{"bumps", std::filesystem::path("/nowhere/bumps.png")}};
    FramePlan plan = plan_effects(scene, settings);
    plan.draws[0].features.double_sided = true;  // The plan is forced.
    EXPECT_TRUE(test::same_bits(render(scene, plan, settings).image, expected));
    FrameSettings view = settings;
    view.view = DebugView::diffuse;
    EXPECT_NO_THROW((void)render(scene, view));
}

TEST_F(Rendering, RefusesRequiredImagesThatCannotBeRead) {
    Scene scene = test::scene_for_unreadable_textures();
    scene.materials[0].diffuse_texture = Texture{0};
    scene.images = {{"first", std::filesystem::path("/nowhere/first.png")}};
    scene.images[0].is_required = true;
    try {
        (void)render(scene, {16, 16, 1, OutputCoding::srgb});
        FAIL() << "a missing image was accepted";
    } catch (const FileError& error) {
        EXPECT_THAT(error.what(), HasSubstr("/nowhere/first.png"));
    }
}

/// Decoding is a loop over images, and reading each image contains loops, too.
TEST_F(Rendering, AMissingTextureEndsNoDecodingOfOthers) {
    const test::TemporaryDirectory folder;
    Scene scene = test::scene_for_unreadable_textures();
    Material& material = scene.materials[0];
    constexpr int size = test::is_sanitized ? 500 : 1500;
    Image texels = make_image(size, size, 3, 8, ColorSpace::srgb);
    for (std::size_t i = 0; i < texels.sample_count(); ++i)
        texels.as<std::uint8_t>()[i] = static_cast<std::uint8_t>((i * 2654435761U) >> 13);
    for (int i = 0; i < 3; ++i) {
        const std::filesystem::path file = folder / (std::to_string(i) + ".png");
        write_image(file, texels);
        scene.images.push_back({file.string(), file});
    }
    const FrameSettings settings{32, 32, 1, OutputCoding::srgb};
    material.diffuse_texture = Texture{0};
    material.specular_texture = Texture{1};
    material.occlusion_texture = Texture{2};
    const Image expected = render(scene, settings).image;
    scene.images.push_back({"gone", folder / "gone.png"});
    material.normal_map = NormalMap{Texture{3}};
    for (int round = 0; round < 10; ++round)
        ASSERT_TRUE(test::same_bits(render(scene, settings).image, expected)) << round;
}

TEST_F(Rendering, ComputesMissingFrames) {
    Scene with_tangents = bumpy_scene();
    Scene without = with_tangents;
    without.meshes[0] = test::sphere(32, 16);
    without.meshes[0].edit().material_ranges = with_tangents.meshes[0].edit().material_ranges;
    const FrameSettings settings{64, 64, 1, OutputCoding::srgb};
    EXPECT_TRUE(
        test::same_bits(render(with_tangents, settings).image, render(without, settings).image));
    without.meshes[0].edit().normals.clear();
    // The angle-weighted normals of a fine sphere are almost exact.
    EXPECT_LE(compare(render(with_tangents, settings).image, render(without, settings).image).mean,
              0.5);
}

TEST_F(Rendering, ReportsTexturesThatCannotShow) {
    Material material;
    material.normal_map = NormalMap{Texture{0}};
    Scene scene = test::scene_of(test::facing_square(), material);
    scene.meshes[0].edit().texcoords.clear();
    scene.images = {{"image", four_colors()}};
    scene.directional_lights = {{}};
    Report report;
    const Renderer renderer(context(), scene, {8, 8, 1, OutputCoding::srgb}, report);
    EXPECT_EQ(report.count("textured material on a mesh without texture coordinates"), 1U);
}

TEST_F(Rendering, ReportsMapsWhoseTexelsShowAnotherKind) {
    const std::filesystem::path data = test::source_directory() / "data";
    const Image normals = read_image(data / "scenes/bricks-normal.png", ImageUse::data);
    const Image colors = read_image(data / "bricks-diffuse.png", ImageUse::data);
    Image heights = colors;  // All channels are red.
    for (std::size_t i = 0; i < heights.sample_count(); ++i)
        heights.as<std::uint8_t>()[i] = colors.as<std::uint8_t>()[i - i % 3];
    const auto findings_of = [&](const Image& image, bool is_bump_map) {
        Material material;
        if (is_bump_map) {
            material.bump_map = BumpMap{Texture{0}};
        } else {
            material.normal_map = NormalMap{Texture{0}};
        }
        Scene scene = test::scene_of(test::facing_square(), material);
        scene.images = {{"image", image}};
        scene.directional_lights = {{}};
        Report drawn, again, traced;
        RenderCache cache(context());
        const FrameSettings settings{8, 8, 1, OutputCoding::srgb};
        const FramePlan plan = plan_effects(scene, settings);
        const Renderer first(cache, context(), scene, plan, settings, drawn);
        const Renderer second(cache, context(), scene, plan, settings, again);
        (void)render_reference(scene, {8, 8}, traced);
        std::string text;
        for (const Finding& finding : drawn.findings())
            text += to_string(finding) + "\n";
        EXPECT_TRUE(std::ranges::equal(drawn.findings(), again.findings())) << text;
        EXPECT_TRUE(std::ranges::equal(drawn.findings(), traced.findings())) << text;
        return text;
    };
    EXPECT_EQ(findings_of(normals, false), "");
    EXPECT_THAT(findings_of(colors, false),
                HasSubstr("normal map that is not a normal map: its texels are colors"));
    EXPECT_THAT(findings_of(heights, false), HasSubstr("normal map that is gray"));
    EXPECT_EQ(findings_of(heights, true), "");
    EXPECT_EQ(findings_of(colors, true), "") << "their red channel may be heights";
    EXPECT_THAT(findings_of(normals, true), HasSubstr("bump map that seems to be a normal map"));
}

TEST_F(Rendering, ReportsAShadowWithoutACaster) {
    Scene scene = test::scene_of(test::sphere(8, 4), Material{});
    scene.shadow = Shadow{};
    scene.point_lights = {{{0.5F, 0, 0}, {1, 1, 1}}};
    const auto findings = [&] {
        Report report;
        const Renderer renderer(context(), scene, {8, 8, 1, OutputCoding::srgb}, report);
        return report.count("requested shadow that nothing casts");
    };
    EXPECT_EQ(findings(), 1U) << "the light is inside of the scene";
    scene.point_lights[0].position_world = {5, 0, 0};
    EXPECT_EQ(findings(), 0U);
    scene.materials[0].unlit = true;
    EXPECT_EQ(findings(), 1U) << "no surface casts one";
    scene.shadow.reset();
    EXPECT_EQ(findings(), 0U);
}

TEST_F(Rendering, FillsWithTheBackground) {
    Scene scene;
    scene.background = {0.5F, 0.25F, 2.0F, 0.5F};
    scene.camera = test::front_camera();
    for (const int samples : {1, 4}) {
        SCOPED_TRACE(samples);
        const Image coded = render(scene, {8, 8, samples, OutputCoding::srgb}).image;
        EXPECT_EQ(coded.color_space, ColorSpace::srgb);
        EXPECT_EQ(coded.bits(), 8);
        EXPECT_EQ(pixel(coded, 3, 3), glm::dvec4(188, 137, 255, 128));  // 0.5 and 0.25 in sRGB.
        const Image linear = render(scene, {8, 8, samples, OutputCoding::linear}).image;
        EXPECT_EQ(linear.color_space, ColorSpace::linear);
        EXPECT_EQ(pixel(linear, 3, 3), glm::dvec4(0.5, 0.25, 2.0, 0.5));
    }
}

TEST_F(Rendering, AveragesSamplesInLinearLight) {
    Material material = test::black_material();
    material.emission = {100, 100, 100};  // The radiance is far above white.
    Mesh half = test::facing_square();    // Its right edge goes through pixel centers.
    for (glm::vec3& p : half.positions)
        p.x = p.x < 0.0F ? -2.0F : 0.125F;
    Scene scene = test::scene_of(half, material);
    scene.background = {0, 0, 0, 1};
    const Image image = render(scene, {16, 16, 4, OutputCoding::srgb}).image;
    EXPECT_EQ(pixel(image, 4, 8), glm::dvec4(255, 255, 255, 255));
    EXPECT_EQ(pixel(image, 12, 8), glm::dvec4(0, 0, 0, 255));
    // Two of four samples are white: half of the light has the sRGB code 188, not 128.
    EXPECT_EQ(pixel(image, 8, 8), glm::dvec4(188, 188, 188, 255));
    scene.background = {0, 0, 0, 0};
    // Covered parts are white at any coverage.
    const Image clear = render(scene, {16, 16, 4, OutputCoding::srgb}).image;
    EXPECT_EQ(pixel(clear, 8, 8), glm::dvec4(255, 255, 255, 128));
    EXPECT_EQ(pixel(clear, 12, 8), glm::dvec4(0, 0, 0, 0));
}

TEST_F(Rendering, WithOneOrFourSamplesAgreesAwayFromEdges) {
    const Scene scene = bumpy_scene();
    const Image one = render(scene, {64, 64, 1, OutputCoding::srgb}).image;
    const Image four = render(scene, {64, 64, 4, OutputCoding::srgb}).image;
    for (int y = 24; y < 40; ++y) {
        for (int x = 24; x < 40; ++x) {
            // Half floats and the final rounding give an error of one code.
            EXPECT_NEAR(pixel(one, x, y).g, pixel(four, x, y).g, 1.0);
        }
    }
}

TEST_F(Rendering, IsTheSameTwice) {
    const Scene scene = bumpy_scene();
    const FrameSettings settings{64, 64, 4, OutputCoding::srgb};
    Report report;
    Renderer renderer(context(), scene, settings, report);
    const Frame first = renderer.draw(*scene.camera);
    const Frame second = renderer.draw(*scene.camera);
    EXPECT_TRUE(test::same_bits(first.image, second.image));
    EXPECT_GT(first.times.prepare, 0.0);
    EXPECT_GT(second.times.draw, 0.0);
}

/// Adds a square with a material, in front of the others.
void add_square(Scene& scene, const Material& material, float z) {
    Mesh square = test::facing_square();
    square.material_ranges = {{0, static_cast<std::uint32_t>(square.triangles.size()),
                               static_cast<std::uint32_t>(scene.materials.size())}};
    scene.instances.push_back(
        {scene.meshes.size(),
         glm::translate(glm::scale(glm::mat4(1.0F), glm::vec3(0.3F, 0.4F, 1.0F)),
                        glm::vec3(z, -z, z)),
         ""});
    scene.meshes.push_back(square);
    scene.materials.push_back(material);
}

TEST_F(Rendering, IsTheSameInBandsAfterWhichItCanBeCancelled) {
    Scene scene = bumpy_scene();
    Material material = test::black_material();
    material.diffuse = {0.2F, 0.5F, 0.9F};
    material.alpha_mode = AlphaMode::blend;
    material.opacity = 0.5F;
    add_square(scene, material, 0.5F);
    add_square(scene, material, 0.9F);  // Both share their sorted triangles.
    scene.instances.back().mesh = scene.instances.end()[-2].mesh;
    material.alpha_mode = AlphaMode::opaque;
    material.metallic_roughness = MetallicRoughness{};
    material.metallic_roughness->transmission = 0.8F;
    add_square(scene, material, 0.7F);
    scene.environment = six_colors();
    scene.environment->skybox = true;
    scene.shadow = Shadow{};
    const FrameSettings settings{1536, 1500, 4, OutputCoding::srgb};  // More than one band.
    Report report;
    Renderer renderer(context(), scene, settings, report);
    const Image whole = renderer.draw(*scene.camera).image;
    Progress progress;
    {
        const ProgressScope scope(progress);
        EXPECT_TRUE(test::same_bits(renderer.draw(*scene.camera).image, whole));
        progress.cancel();
        EXPECT_THROW(renderer.draw(*scene.camera), Cancelled);
    }
    EXPECT_TRUE(test::same_bits(renderer.draw(*scene.camera).image, whole));
}

TEST_F(Rendering, RefusesInvalidScenes) {
    Scene scene = test::scene_of(test::facing_square(), Material{});
    Report report;
    EXPECT_THROW(Renderer(context(), scene, {0, 8, 1, OutputCoding::srgb}, report), InvalidInput);
    EXPECT_THROW(Renderer(context(), scene, {8, 8, 3, OutputCoding::srgb}, report), InvalidInput);
    Renderer renderer(context(), scene, {8, 8, 1, OutputCoding::srgb}, report);
    Camera camera = test::front_camera();
    camera.near = 0.0F;
    EXPECT_THROW(renderer.draw(camera), InvalidInput);

    FramePlan plan = plan_effects(scene, {.samples = 1});
    plan.draws[0].instance = 1;
    EXPECT_THROW(Renderer(context(), scene, plan, {8, 8, 1, OutputCoding::srgb}, report),
                 InvalidInput);
    plan = plan_effects(scene, {.samples = 1});
    plan.draws[0].range.first_triangle = 1;
    EXPECT_THROW(Renderer(context(), scene, plan, {8, 8, 1, OutputCoding::srgb}, report),
                 InvalidInput);
    scene.instances[0].mesh = 5;
    EXPECT_THROW(Renderer(context(), scene, {8, 8, 1, OutputCoding::srgb}, report), InvalidInput);
}

}  // namespace
}  // namespace relief

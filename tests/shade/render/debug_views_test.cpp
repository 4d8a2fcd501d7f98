// SPDX-License-Identifier: Apache-2.0
// Debug views as pictures against reference values: squares and spheres in closed form, normals and
// light terms from the CPU reference.
#include "relief/shade/frame_settings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "effects/shader_source.h"
#include "relief/mesh/report.h"
#include "relief/shade/reference.h"
#include "render/program_cache.h"
#include "shade/effects/feature_sets.h"
#include "shade/render/draw_support.h"
#include "shade/render/random_scene.h"

#include "support/labels.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;

namespace {

using test::pixel;

constexpr int view_size = 32;
/// The tolerance for float shaders.
constexpr double float_tolerance = 1e-5;

FrameSettings floats(DebugView view) {
    return {.width = view_size,
            .height = view_size,
            .samples = 1,
            .output = OutputCoding::linear,
            .view = view};
}
FrameSettings codes(DebugView view) {
    return {.width = view_size,
            .height = view_size,
            .samples = 4,
            .output = OutputCoding::srgb,
            .view = view};
}

class DebugViewPictures : public test::DrawTest {
  protected:
    [[nodiscard]] Image view(const Scene& scene, DebugView what) const {
        return render(scene, floats(what)).image;
    }
};

/// 0.5 v + 0.5, opaque.
glm::dvec4 coded(const glm::dvec3& v) {
    return {0.5 * v + 0.5, 1.0};
}

void expect_color(const Image& image, int x, int y, const glm::dvec4& color,
                  double tolerance = float_tolerance) {
    const glm::dvec4 found = pixel(image, x, y);
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(found[i], color[i], tolerance) << "channel " << i << " at " << x << ", " << y;
    }
}

/// The textured square without lights.
Scene square() {
    return test::scene_of(test::facing_square(), test::black_material());
}

TEST_F(DebugViewPictures, OfASquareShowItsAxes) {
    const Scene scene = square();
    expect_color(view(scene, DebugView::geometric_normal), 3, 5, coded({0, 0, 1}));
    expect_color(view(scene, DebugView::shading_normal), 3, 5, coded({0, 0, 1}));
    expect_color(view(scene, DebugView::tangent), 3, 5, coded({1, 0, 0}));
    expect_color(view(scene, DebugView::bitangent), 3, 5, coded({0, 1, 0}));
    expect_color(view(scene, DebugView::handedness), 3, 5, {0.2, 0.6, 1.0, 1.0});
}

TEST_F(DebugViewPictures, AreStoredAsCodesWithoutToneOrSrgb) {
    Scene scene = square();
    scene.exposure = 4.0F;
    scene.tone_mapping = ToneMapping::aces;
    const auto at = [&](DebugView what) { return pixel(render(scene, codes(what)).image, 9, 7); };
    // Half of 255 lies between two codes.
    EXPECT_NEAR(at(DebugView::tangent).x, 255.0, 0.0);
    EXPECT_NEAR(at(DebugView::tangent).y, 127.5, 0.5);
    EXPECT_NEAR(at(DebugView::geometric_normal).z, 255.0, 0.0);
    EXPECT_EQ(at(DebugView::handedness), glm::dvec4(51, 153, 255, 255));
}

TEST_F(DebugViewPictures, TurnWithTheInstanceAndMirror) {
    Scene scene = square();
    // The mirror x -> -x shows the texture from behind. The front stays the front.
    scene.instances[0].world_from_object[0][0] = -1.0F;
    expect_color(view(scene, DebugView::geometric_normal), 3, 5, coded({0, 0, 1}));
    expect_color(view(scene, DebugView::tangent), 3, 5, coded({-1, 0, 0}));
    expect_color(view(scene, DebugView::bitangent), 3, 5, coded({0, 1, 0}));
    expect_color(view(scene, DebugView::handedness), 3, 5, {1.0, 0.4, 0.2, 1.0});
    // A quarter turn about z.
    scene.instances[0].world_from_object = glm::mat4(1.0F);
    scene.instances[0].world_from_object[0] = {0, 1, 0, 0};
    scene.instances[0].world_from_object[1] = {-1, 0, 0, 0};
    expect_color(view(scene, DebugView::tangent), 3, 5, coded({0, 1, 0}));
    expect_color(view(scene, DebugView::bitangent), 3, 5, coded({-1, 0, 0}));
}

TEST_F(DebugViewPictures, MirroredTextureIsLeftHandedInBothFrames) {
    Scene scene = square();
    for (glm::vec2& uv : scene.meshes[0].edit().texcoords)
        uv.x = 1.0F - uv.x;
    for (const TangentFrame frame : {TangentFrame::stored, TangentFrame::derivatives}) {
        scene.materials[0].tangent_frame = frame;
        expect_color(view(scene, DebugView::tangent), 20, 11, coded({-1, 0, 0}));
        expect_color(view(scene, DebugView::bitangent), 20, 11, coded({0, 1, 0}));
        expect_color(view(scene, DebugView::handedness), 20, 11, {1.0, 0.4, 0.2, 1.0});
    }
}

TEST_F(DebugViewPictures, OfTextureCoordinatesHaveAChecker) {
    Scene scene = square();
    for (glm::vec2& uv : scene.meshes[0].edit().texcoords)
        uv = uv * 1.5F - glm::vec2(0.25F);
    const Image image = view(scene, DebugView::texcoords);
    for (const int y : {0, 7, 30}) {
        for (int x = 0; x < view_size; ++x) {
            // The camera sees the whole square.
            const double u = (x + 0.5) / view_size * 1.5 - 0.25;
            const double v = (y + 0.5) / view_size * 1.5 - 0.25;
            const bool odd = static_cast<long>(std::floor(8 * u) + std::floor(8 * v)) % 2 != 0;
            expect_color(image, x, y, {u - std::floor(u), v - std::floor(v), odd ? 1.0 : 0.0, 1.0});
        }
    }
}

TEST_F(DebugViewPictures, OfASphereAreItsNormals) {
    Scene scene = test::scene_of(test::sphere(128, 64), test::black_material());
    const Image shading = view(scene, DebugView::shading_normal);
    const Image geometric = view(scene, DebugView::geometric_normal);
    const Image tangents = view(scene, DebugView::tangent);
    int compared = 0;
    for (int y = 0; y < view_size; ++y) {
        for (int x = 0; x < view_size; ++x) {
            const double reach = 2.0 / 3.0;
            const glm::dvec3 ray =
                glm::normalize(glm::dvec3(((x + 0.5) / view_size * 2.0 - 1.0) * reach,
                                          (1.0 - (y + 0.5) / view_size * 2.0) * reach, -1.0));
            const double along = 3.0 * -ray.z;
            const double inside = along * along - 8.0;
            if (inside < 0.05) continue;  // This pixel is outside or at the rim.
            const glm::dvec3 n = glm::dvec3(0, 0, 3) + ray * (along - std::sqrt(inside));
            expect_color(shading, x, y, coded(n), 2e-3);
            expect_color(geometric, x, y, coded(n), 0.03);  // Facets have an angle of 2.8 degrees.
            const glm::dvec3 east = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), n));
            if (std::abs(n.y) < 0.9) expect_color(tangents, x, y, coded(east), 0.02);
            ++compared;
        }
    }
    EXPECT_GT(compared, 150);
}

TEST_F(DebugViewPictures, OfMapsAreTheirTexels) {
    Scene scene = square();
    scene.images = {
        {"normals", test::constant_image({0.8F, 0.4F, 0.6F, 1}, 3, 32, ColorSpace::linear)},
        {"heights", test::constant_image({0.3F, 0, 0, 1}, 1, 32, ColorSpace::linear)}};
    Material& material = scene.materials[0];
    material.normal_map = NormalMap{.texture = {0}, .green = Green::down, .flat = FlatCode::half};
    // Green points down: -(-0.2).
    const glm::dvec3 stored = glm::normalize(glm::dvec3(0.6, 0.2, 0.2));
    expect_color(view(scene, DebugView::normal_map), 8, 8, coded(stored), 1e-4);
    // The scene has no light, but the map changes the normal.
    expect_color(view(scene, DebugView::shading_normal), 8, 8, coded(stored), 1e-4);
    material.normal_map->space = NormalSpace::object;
    expect_color(view(scene, DebugView::normal_map), 8, 8, coded(stored), 1e-4);
    material.normal_map.reset();
    material.bump_map = BumpMap{{1}, 2.0F};
    expect_color(view(scene, DebugView::height), 8, 8, {0.3, 0.3, 0.3, 1.0}, 1e-4);
    expect_color(view(scene, DebugView::normal_map), 8, 8, coded({0, 0, 1}), 1e-4);
}

TEST_F(DebugViewPictures, HatchSurfacesWithoutTheData) {
    Scene scene = square();
    Mesh plain = scene.meshes[0];
    plain.texcoords.clear();
    scene.meshes.emplace_back(plain);
    // The upper half, in front, has no texture coordinates.
    scene.instances.push_back({1, glm::mat4(1.0F), "plain"});
    scene.instances[1].world_from_object[3] = {0.0F, 2.0F, 0.01F, 1.0F};
    const Image image = render(scene, codes(DebugView::texcoords)).image;
    int dark = 0;
    for (int x = 0; x < view_size; ++x) {
        // gl_FragCoord counts rows from the bottom.
        const double stripe = std::fmod(x + 0.5 + (view_size - 1 - 2 + 0.5), 16.0);
        const double gray = stripe < 8.0 ? 51.0 : 77.0;
        EXPECT_EQ(pixel(image, x, 2), glm::dvec4(gray, gray, gray, 255));
        dark += stripe < 8.0 ? 1 : 0;
        EXPECT_NE(pixel(image, x, view_size - 2).x, pixel(image, x, view_size - 2).z);
    }
    EXPECT_EQ(dark, view_size / 2);
}

TEST_F(DebugViewPictures, OfOverdrawCountFragments) {
    Scene scene = square();
    scene.background = {1, 1, 1, 1};
    for (int layers = 1; layers <= 5; ++layers) {
        const Image image = render(scene, codes(DebugView::overdraw)).image;
        EXPECT_EQ(pixel(image, 4, 4),
                  glm::dvec4(std::min(64 * layers, 255), 16 * layers, 4 * layers, 255));
        // Another instance behind the others; depth has no effect.
        Instance behind = scene.instances[0];
        behind.world_from_object[3].z = -0.1F * static_cast<float>(layers);
        scene.instances.push_back(behind);
    }
    // Beside the surfaces there is none, on black.
    for (Instance& instance : scene.instances)
        instance.world_from_object[3].x = 3.0F;
    EXPECT_EQ(pixel(render(scene, codes(DebugView::overdraw)).image, 1, 4),
              glm::dvec4(0, 0, 0, 255));
}

TEST_F(DebugViewPictures, LeaveThePictureAsItWas) {
    const Scene scene = test::random_scene(3);
    const FrameSettings picture{view_size, view_size, 4, OutputCoding::srgb};
    const Image before = render(scene, picture).image;
    RenderCache cache(context());
    for (const DebugView shown : {DebugView::picture, DebugView::geometric_normal,
                                  DebugView::diffuse, DebugView::overdraw}) {
        FrameSettings settings = picture;
        settings.view = shown;
        settings.overlays.wireframe = true;
        settings.overlays.vertex_frames = 0.1F;
        settings.overlays.markers =
            std::make_shared<std::vector<Marker>>(1, Marker{0, glm::vec3(0.0F), glm::vec3(1.0F)});
        Report report;
        (void)Renderer(cache, context(), scene, plan_effects(scene, settings), settings, report)
            .draw(*scene.camera);
        const Image after =
            Renderer(cache, context(), scene, plan_effects(scene, picture), picture, report)
                .draw(*scene.camera)
                .image;
        EXPECT_TRUE(test::same_bits(after, before)) << "after " << debug_view_info(shown).name;
    }
}

TEST_F(DebugViewPictures, OfShadingNormalsAgreeWithTheReference) {
    // A white surface under a light along each axis: its radiance is the positive part of the
    // normal.
    const glm::vec3 towards[] = {{0.8F, 0.0F, 0.6F}, {-0.4F, 0.7F, 0.6F}, {-0.4F, -0.7F, 0.6F}};
    test::Dice dice(5);
    Material material = test::black_material();
    material.diffuse = glm::vec3(1.0F);
    material.normal_map = NormalMap{.texture = {0}, .scale = 1.5F, .flat = FlatCode::half};
    Scene scene = test::scene_of(test::sphere(24, 12), material);
    scene.images = {{"normals", test::random_normals(dice)}};
    for (int i = 0; i < 3; ++i) {
        glm::vec3 channel(0.0F);
        channel[i] = 1.0F;
        scene.directional_lights.push_back({-towards[i], channel});
    }
    Report report;
    const Reference reference = render_reference(scene, {view_size, view_size}, report);
    const Image found = view(scene, DebugView::shading_normal);
    int compared = 0;
    for (int y = 0; y < view_size; ++y) {
        for (int x = 0; x < view_size; ++x) {
            const bool hit =
                reference.hits[static_cast<std::size_t>(y * view_size + x)].instance == 0;
            if (!hit || pixel(reference.edges, x, y)[0] > 0.0) continue;
            const glm::dvec3 n = 2.0 * glm::dvec3(pixel(found, x, y)) - 1.0;
            for (int i = 0; i < 3; ++i) {
                const double lit = glm::dot(n, glm::normalize(glm::dvec3(towards[i])));
                EXPECT_NEAR(std::max(lit, 0.0), pixel(reference.radiance, x, y)[i], 4e-3)
                    << x << ", " << y;
            }
            ++compared;
        }
    }
    EXPECT_GT(compared, 100);
}

/// A random scene without the alpha that would hide a sum.
Scene opaque_scene(std::uint64_t seed) {
    Scene scene = test::random_scene(seed);
    for (Material& material : scene.materials) {
        material.alpha_mode = AlphaMode::opaque;
        material.unlit = false;
        if (!material.metallic_roughness) continue;
        material.metallic_roughness->sheen_color = {0.8F, 0.5F, 0.2F};
        material.metallic_roughness->sheen_roughness = 0.6F;
        material.metallic_roughness->clearcoat = 0.7F;
        material.metallic_roughness->clearcoat_roughness = 0.3F;
        material.metallic_roughness->anisotropy = 0.7F;
        material.metallic_roughness->iridescence = 0.6F;
    }
    scene.background = glm::vec4(0.0F);
    if (scene.environment) scene.environment->skybox = false;
    return scene;
}

TEST_F(DebugViewPictures, OfTermsAddUpToThePicture) {
    std::vector<int> seen(debug_views().size(), 0);
    for (const std::uint64_t seed : {1U, 2U, 5U, 8U}) {
        const Scene scene = opaque_scene(seed);
        const Image whole = view(scene, DebugView::picture);
        std::vector<glm::dvec3> sum(static_cast<std::size_t>(view_size * view_size),
                                    glm::dvec3(0.0));
        for (const DebugViewInfo& info : debug_views()) {
            if (info.kind != DebugViewKind::term) continue;
            Image term;
            try {
                term = view(scene, info.view);
            } catch (const InvalidInput&) {
                continue;
            }
            ++seen[static_cast<std::size_t>(info.view)];
            for (int i = 0; i < view_size * view_size; ++i)
                sum[static_cast<std::size_t>(i)] +=
                    glm::dvec3(pixel(term, i % view_size, i / view_size));
        }
        for (int i = 0; i < view_size * view_size; ++i) {
            const glm::dvec3 expected(pixel(whole, i % view_size, i / view_size));
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(sum[static_cast<std::size_t>(i)][c], expected[c],
                            2e-5 * std::max(1.0, expected[c]))
                    << "seed " << seed << " at " << i % view_size << ", " << i / view_size;
            }
        }
    }
    for (const DebugViewInfo& info : debug_views()) {
        if (info.kind != DebugViewKind::term) continue;
        EXPECT_GT(seen[static_cast<std::size_t>(info.view)], 0) << info.name << " never shown";
    }
}

TEST_F(DebugViewPictures, OfDiffuseLightAgreeWithTheReferenceOfAMatteScene) {
    Material material = test::black_material();
    material.ambient = {0.3F, 0.2F, 0.1F};
    material.diffuse = {0.5F, 0.7F, 0.9F};
    material.specular = glm::vec3(0.5F);
    material.emission = {0.2F, 0.0F, 0.1F};
    Scene scene = test::scene_of(test::sphere(48, 24), material);
    scene.ambient = glm::vec3(0.5F);
    scene.directional_lights = {{{-0.5F, -0.5F, -1.0F}, glm::vec3(1.0F)}};
    Scene matte = scene;
    matte.ambient = glm::vec3(0.0F);
    matte.materials[0].specular = matte.materials[0].emission = glm::vec3(0.0F);
    Report report;
    const Reference reference = render_reference(matte, {view_size, view_size}, report);
    const Image found = view(scene, DebugView::diffuse);
    for (int y = 0; y < view_size; ++y) {
        for (int x = 0; x < view_size; ++x) {
            if (pixel(reference.edges, x, y)[0] > 0.0) continue;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(pixel(found, x, y)[c], pixel(reference.radiance, x, y)[c], 1e-3);
        }
    }
}

/// The programs of views have only the inputs that the plan lists.
TEST_LABELS(not_sanitized);
TEST_F(DebugViewPictures, LinkForACoveringSetAndUseThePlannedInputs) {
    shade::detail::ProgramCache cache(context().api());
    std::set<Features> tried;
    std::size_t at = 0;
    for (Features f : test::covering_features()) {
        {
            f.view = static_cast<DebugView>(1 + at++ % 17);
            const Features shown = canonical(f);
            if (!tried.insert(shown).second) continue;
            const auto program = cache.get(shown);
            for (const gl::ActiveVariable& uniform : program->linked.interface().uniforms) {
                EXPECT_TRUE(std::binary_search(program->planned.uniforms.begin(),
                                               program->planned.uniforms.end(), uniform.name))
                    << describe(shown) << " takes " << uniform.name;
            }
            for (const gl::ActiveVariable& attribute : program->linked.interface().attributes) {
                EXPECT_TRUE(std::binary_search(program->planned.attributes.begin(),
                                               program->planned.attributes.end(), attribute.name))
                    << describe(shown) << " takes " << attribute.name;
            }
        }
    }
    EXPECT_GT(tried.size(), 30U);
}

}  // namespace
}  // namespace relief

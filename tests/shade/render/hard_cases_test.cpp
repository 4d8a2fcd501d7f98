// SPDX-License-Identifier: Apache-2.0
// Hard inputs of the renderer: each has one defined outcome, and every picture is finite.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "relief/mesh/frames.h"
#include "relief/shade/image_compare.h"
#include "shade/render/draw_support.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;

namespace {

using test::pixel;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();

class HardCases : public test::DrawTest {
  protected:
    /// Returns the linear picture after a check that it is finite and not negative.
    [[nodiscard]] Image finite_radiance(const Scene& scene, int size = 16) const {
        Image image = radiance(scene, size, size);
        std::size_t offences = 0;
        for (const float sample : image.as<float>()) {
            if (!(sample >= 0.0F && std::isfinite(sample))) ++offences;
        }
        EXPECT_EQ(offences, 0U);
        return image;
    }
};

Scene lit_square() {
    Material material;
    material.diffuse = glm::vec3(1.0F);
    Scene scene = test::scene_of(test::facing_square(), material);
    scene.directional_lights = {{{0, 0, -1}, {0.5F, 0.5F, 0.5F}}};
    return scene;
}

const glm::dvec4 fully_lit(0.5, 0.5, 0.5, 1);

TEST_F(HardCases, ANormalWithoutLengthCountsAsTheZAxis) {
    for (const glm::vec3& bad : {glm::vec3(0.0F), glm::vec3(not_a_number), glm::vec3(infinite)}) {
        Scene scene = lit_square();
        scene.meshes[0].edit().normals.assign(4, bad);
        EXPECT_EQ(pixel(finite_radiance(scene), 8, 8), fully_lit);
    }
}

TEST_F(HardCases, NormalsThatCancelBetweenVerticesAreFinite) {
    Scene scene = lit_square();
    scene.materials[0].specular = glm::vec3(1.0F);
    auto& normals = scene.meshes[0].edit().normals;
    for (std::size_t i = 0; i < 4; ++i)
        normals[i] = {i % 2 == 0 ? 1.0F : -1.0F, 0, 0};
    // 17 pixels: the normals cancel at a column of pixels.
    EXPECT_NEAR(pixel(finite_radiance(scene, 17), 8, 8).r, 1.0,
                1e-5);  // 0.5 diffuse and 0.5 reflected.
}

TEST_F(HardCases, ANormalOfAnyLengthCountsAlike) {
    const Image expected = finite_radiance(lit_square());
    for (const float length : {1e-14F, 1e-3F, 1e3F, 1e14F}) {
        Scene scene = lit_square();
        for (glm::vec3& normal : scene.meshes[0].edit().normals)
            normal *= length;
        EXPECT_TRUE(test::same_bits(finite_radiance(scene), expected)) << length;
    }
}

TEST_F(HardCases, ANormalThatFacesAwayReflectsAtGrazingAngleAtMost) {
    Scene scene = test::scene_of(test::facing_square(), test::black_material());
    scene.meshes[0].edit().normals.assign(4, glm::vec3(0, 0, -1));
    scene.materials[0].reflectivity = {0.25F, 0.25F, 0.25F};
    scene.environment = test::constant_environment(glm::vec3(0.5F), false);
    // n.v is -1 and counts as 0, so all light is reflected.
    EXPECT_EQ(pixel(finite_radiance(scene), 8, 8), fully_lit);
}

TEST_F(HardCases, ExponentsFromZeroToAMillionKeepTheirHighlight) {
    for (const SpecularModel model : {SpecularModel::phong, SpecularModel::blinn_phong}) {
        for (const float shininess : {0.0F, 1e-6F, 1.0F, 1e4F, 1e5F, 1e6F}) {
            SCOPED_TRACE(shininess);
            Scene scene = lit_square();
            scene.materials[0] = test::black_material();
            scene.materials[0].specular = glm::vec3(1.0F);
            scene.materials[0].specular_model = model;
            scene.materials[0].shininess = shininess;
            // 17 pixels: at the middle one, the view and the light are along the normal.
            const Image image = finite_radiance(scene, 17);
            EXPECT_NEAR(pixel(image, 8, 8).r, 0.5, 1e-5);
            const double next = pixel(image, 9, 8).r;  // 0.0782 radians from the middle pixel.
            const double half = model == SpecularModel::phong ? 1.0 : 0.5;
            const double cosine = std::cos(half * std::atan2(4.0 / 17, 3.0));
            EXPECT_NEAR(next, 0.5 * std::pow(cosine, static_cast<double>(shininess)), 1e-5);
        }
    }
}

TEST_F(HardCases, AnExponentOfZeroShinesEvenAtRightAngles) {
    Scene scene = lit_square();
    scene.materials[0] = test::black_material();
    scene.materials[0].specular = glm::vec3(1.0F);
    scene.materials[0].specular_model = SpecularModel::phong;
    scene.materials[0].shininess = 0.0F;
    // The reflected light has an angle of 80 degrees to the normal, away from most of the picture.
    scene.directional_lights = {{{5.67F, 0, -1}, {0.5F, 0.5F, 0.5F}}};
    const Image image = finite_radiance(scene);
    for (int x = 0; x < 16; ++x)
        EXPECT_EQ(pixel(image, x, 8), fully_lit);
}

TEST_F(HardCases, ALightThatTouchesTheSurfaceIsFiniteAndLightsTheRest) {
    Scene scene = lit_square();
    scene.directional_lights.clear();
    // The light is at the middle of 17 pixels, exactly on the surface and then closer and closer
    // above it.
    for (const float height : {0.0F, 1e-38F, 1e-20F, 1e-10F, 1e-3F}) {
        SCOPED_TRACE(height);
        scene.point_lights = {{{0, 0, height}, {1, 1, 1}, std::nullopt}};
        (void)finite_radiance(scene, 17);
        SpotLight spot;
        spot.point = scene.point_lights[0];
        Scene spotted = scene;
        spotted.point_lights.clear();
        spotted.spot_lights = {spot};
        (void)finite_radiance(spotted, 17);
    }
    scene.materials[0].specular = glm::vec3(max_reflectance);
    scene.point_lights = {{{0, 0, 1e-19F}, glm::vec3(max_light), std::nullopt}};
    scene.ambient = glm::vec3(max_light);
    (void)finite_radiance(scene, 17);
}

TEST_F(HardCases, ALightBehindTheEyeExactlyOppositeHasNoHalfVector) {
    // The light comes from the direction l = -v, and the normal faces the light.
    Scene scene = lit_square();
    scene.materials[0] = test::black_material();
    scene.materials[0].specular = glm::vec3(1.0F);
    scene.meshes[0].edit().normals.assign(4, glm::vec3(0, 0, -1));
    scene.directional_lights = {{{0, 0, 1}, {1, 1, 1}}};
    EXPECT_EQ(pixel(finite_radiance(scene, 17), 8, 8), glm::dvec4(0, 0, 0, 1));
}

TEST_F(HardCases, TheEyeOnTheSurfaceIsFinite) {
    Scene scene = lit_square();
    scene.materials[0].specular = glm::vec3(1.0F);
    scene.materials[0].double_sided = true;
    scene.camera->world_from_view[3] = glm::vec4(0, 0, 0, 1);
    (void)finite_radiance(scene);
}

TEST_F(HardCases, SingularMatricesDrawTheCollapsedGeometry) {
    // Flattened onto z = 0, the sphere becomes a disc that faces both ways. Its normals are those
    // of the plane, with the sign of their z.
    Material material;
    material.diffuse = glm::vec3(1.0F);
    Scene scene = test::scene_of(test::sphere(32, 16), material);
    scene.directional_lights = {{{0, 0, -1}, {0.5F, 0.5F, 0.5F}}};
    scene.instances[0].world_from_object[2].z = 0.0F;
    EXPECT_EQ(pixel(finite_radiance(scene), 8, 8), fully_lit);
    // Flattened onto a line and onto a point, nothing remains.
    scene.instances[0].world_from_object[1].y = 0.0F;
    EXPECT_EQ(pixel(finite_radiance(scene), 8, 8), glm::dvec4(0));
    scene.instances[0].world_from_object = glm::mat4(0.0F);
    EXPECT_EQ(pixel(finite_radiance(scene), 8, 8), glm::dvec4(0));
}

TEST_F(HardCases, ScaleDoesNotMatter) {
    const Image expected = finite_radiance(lit_square());
    for (const float scale : {1e-12F, 1e-3F, 1e3F, 1e12F}) {
        SCOPED_TRACE(scale);
        Scene scene = lit_square();
        scene.instances[0].world_from_object = glm::mat4(scale);
        scene.instances[0].world_from_object[3].w = 1.0F;
        scene.camera->world_from_view[3] = glm::vec4(0, 0, 3.0F * scale, 1);
        scene.camera->near *= scale;
        scene.camera->far *= scale;
        EXPECT_LE(compare(finite_radiance(scene), expected).max, 1e-6);
    }
}

TEST_F(HardCases, FarFromTheOriginTheModelKeepsItsShape) {
    const Image expected = finite_radiance(lit_square());
    Scene scene = lit_square();
    const glm::vec3 away(1048576.0F, -2097152.0F, 524288.0F);  // Powers of two are exact in float.
    scene.instances[0].world_from_object[3] = glm::vec4(away, 1);
    scene.camera->world_from_view[3] = glm::vec4(away + glm::vec3(0, 0, 3), 1);
    EXPECT_LE(compare(finite_radiance(scene), expected).max, 1e-6);
}

TEST_F(HardCases, NaNInVertexDataStaysLocal) {
    Scene scene = lit_square();
    Mesh& mesh = scene.meshes[0].edit();
    const auto add_triangle = [&](const glm::vec3& first) {
        const auto base = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {first, {0, 0, 1}, {1, 0, 1}});
        mesh.normals.insert(mesh.normals.end(), 3, glm::vec3(0, 0, 1));
        mesh.texcoords.insert(mesh.texcoords.end(), 3, glm::vec2(0.0F));
        mesh.triangles.emplace_back(base, base + 1, base + 2);
    };
    add_triangle({not_a_number, 0, 1});
    add_triangle({0, infinite, 1});
    mesh.colors.assign(mesh.positions.size(), glm::vec4(1.0F));
    mesh.colors[0] = glm::vec4(not_a_number);  // The upper left corner of the square.
    mesh.material_ranges = {{0, 4, 0}};
    const Image image = finite_radiance(scene);
    EXPECT_EQ(image.width, 16);  // Pixels with NaN are black, and the picture is complete.
}

TEST_F(HardCases, NaNInATextureIsBlackAndStaysLocal) {
    Image texture = make_image(2, 1, 3, 32, ColorSpace::linear);
    texture.samples = std::vector<float>{not_a_number, infinite, -1, 0.5F, 0.5F, 0.5F};
    Scene scene = lit_square();
    scene.images = {{"texture", texture}};
    Texture use;
    use.filter = TextureFilter::nearest;
    use.wrap_u = use.wrap_v = Wrap::clamp;
    scene.materials[0].diffuse_texture = use;
    const Image image = finite_radiance(scene);
    EXPECT_EQ(pixel(image, 4, 8).r, 0.0);   // NaN.
    EXPECT_GT(pixel(image, 4, 8).g, 1e30);  // Infinity becomes the largest value.
    EXPECT_EQ(pixel(image, 4, 8).b, 0.0);   // Negative.
    EXPECT_EQ(pixel(image, 12, 8).r, 0.25);
}

/// A square with a bump map of constant slope, in a frame from derivatives.
Scene bumped_square() {
    Scene scene = lit_square();
    Image ramp = make_image(64, 64, 1, 32, ColorSpace::data);
    auto& samples = std::get<std::vector<float>>(ramp.samples);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = static_cast<float>(i % 64) / 64.0F;
    scene.images = {{"ramp", ramp}};
    BumpMap map;
    map.texture.wrap_u = map.texture.wrap_v = Wrap::clamp;
    map.strength = 64.0F;  // One texel up per texel: 45 degrees.
    scene.materials[0].bump_map = map;
    scene.materials[0].tangent_frame = TangentFrame::derivatives;
    return scene;
}

TEST_F(HardCases, ConstantTextureCoordinatesKeepTheNormal) {
    Scene scene = bumped_square();
    const double tilted = pixel(finite_radiance(scene), 8, 8).r;
    EXPECT_NEAR(tilted, 0.5 * std::sqrt(0.5), 1e-4);
    for (glm::vec2& texcoord : scene.meshes[0].edit().texcoords)
        texcoord = glm::vec2(0.5F);
    EXPECT_EQ(pixel(finite_radiance(scene), 8, 8), fully_lit);
    for (glm::vec2& texcoord : scene.meshes[0].edit().texcoords)
        texcoord = glm::vec2(not_a_number);
    (void)finite_radiance(scene);
    for (glm::vec2& texcoord : scene.meshes[0].edit().texcoords)
        texcoord *= infinite;
    (void)finite_radiance(scene);
}

TEST_F(HardCases, DerivativeFramesAndFlatShadingDoNotMindScale) {
    for (const Interpolation interpolation : {Interpolation::per_pixel, Interpolation::flat}) {
        Scene plain = bumped_square();
        plain.materials[0].interpolation = interpolation;
        const Image expected = finite_radiance(plain);
        for (const float scale : {1e-12F, 1e-3F, 1e3F, 1e12F}) {
            SCOPED_TRACE(scale);
            Scene scene = plain;
            scene.instances[0].world_from_object = glm::mat4(scale);
            scene.instances[0].world_from_object[3].w = 1.0F;
            scene.camera->world_from_view[3] = glm::vec4(0, 0, 3.0F * scale, 1);
            scene.camera->near *= scale;
            scene.camera->far *= scale;
            // Differences of adjacent positions have a relative error of about 1e-4.
            EXPECT_LE(compare(finite_radiance(scene), expected).max, 1e-3);
        }
    }
}

TEST_F(HardCases, MirroredTexturesBendTheNormalTheOtherWay) {
    Scene scene = bumped_square();
    scene.directional_lights = {{{1, 0, -1}, glm::vec3(0.5F)}};  // The light comes from the left.
    const double upright = pixel(finite_radiance(scene), 8, 8).r;
    for (glm::vec2& texcoord : scene.meshes[0].edit().texcoords)
        texcoord.x = 1.0F - texcoord.x;
    const double mirrored = pixel(finite_radiance(scene), 8, 8).r;
    EXPECT_NEAR(upright, 0.5, 1e-4);   // The surface is tilted towards the light.
    EXPECT_NEAR(mirrored, 0.0, 1e-4);  // The surface is perpendicular to the light.
}

TEST_F(HardCases, ANormalBentBehindTheSurfaceIsFiniteByEveryModel) {
    Scene scene = lit_square();
    Image map = make_image(1, 1, 3, 32, ColorSpace::data);
    map.samples = std::vector<float>{1.0F, 0.5F, 0.1F};  // (1, 0, -0.8).
    scene.images = {{"bent", map}};
    scene.materials[0].normal_map = NormalMap{};
    scene.materials[0].specular = glm::vec3(1.0F);
    scene.environment = test::constant_environment(glm::vec3(0.5F), true);
    scene.environment->lights = true;
    scene.directional_lights = {{{-1, 0, 0.5F}, glm::vec3(1.0F)}, {{0, 0, -1}, glm::vec3(1.0F)}};
    Material& material = scene.materials[0];
    material.reflectivity = glm::vec3(0.2F);
    for (const FresnelModel fresnel :
         {FresnelModel::schlick, FresnelModel::dielectric, FresnelModel::conductor}) {
        material.fresnel = fresnel;
        material.transmission = 0.5F;
        (void)finite_radiance(scene);
    }
    material.transmission = 0.0F;
    material.metallic_roughness = MetallicRoughness{};
    for (const float roughness : {0.0F, 0.5F, 1.0F}) {
        material.metallic_roughness->roughness = roughness;
        (void)finite_radiance(scene);
    }
}

/// The normal is turned away from the eye, and further from the half vector: n.v = -0.6 and n.h =
/// -0.88 count as 0. The square of n.h would give 1.6.
TEST_F(HardCases, MetalHasNoHighlightOfItsBackSide) {
    Scene scene = lit_square();
    scene.materials[0].metallic_roughness =
        MetallicRoughness{glm::vec3(1.0F), 1.0F, 0.5F, std::nullopt};
    scene.meshes[0].edit().normals.assign(4, glm::vec3(0.8F, 0.0F, -0.6F));
    scene.directional_lights = {{{0.28F, 0.0F, 0.96F}, glm::vec3(1.0F)}};
    const double alpha = 0.5 * 0.5;
    // n.l alpha^2 V with V = 1 / (2 n.l alpha): white metal reflects all colors.
    EXPECT_NEAR(pixel(finite_radiance(scene, 17), 8, 8).r, alpha / 2.0, 1e-5);
}

TEST_F(HardCases, AMetalLitFromExactlyBehindTheEyesLineIsFinite) {
    Scene scene = lit_square();
    scene.materials[0].metallic_roughness =
        MetallicRoughness{glm::vec3(1.0F), 1.0F, 0.0F, std::nullopt};
    scene.meshes[0].edit().normals.assign(4, glm::vec3(0, 0, -1));
    scene.directional_lights = {{{0, 0, 1}, glm::vec3(1.0F)}};
    // There is no half vector, or after rounding it is perpendicular to the normal. Facets of the
    // smallest roughness, 0.045, reflect half of its square there.
    EXPECT_NEAR(pixel(finite_radiance(scene, 17), 8, 8).r, 0.0, 0.5 * 0.045 * 0.045 * 1.01);
    // The brightest case: a mirror that faces the light, and the light at its maximum.
    scene.meshes[0].edit().normals.assign(4, glm::vec3(0, 0, 1));
    scene.directional_lights = {{{0, 0, -1}, glm::vec3(max_light)}};
    (void)finite_radiance(scene, 17);
}

TEST_F(HardCases, ExactFresnelFactorsAreFiniteFromHeadOnToGrazing) {
    Scene scene = test::scene_of(test::sphere(64, 32), test::black_material());
    scene.environment = test::constant_environment(glm::vec3(0.5F), false);
    Material& material = scene.materials[0];
    material.reflectivity = glm::vec3(1.0F);
    for (const float index : {1.0F, 1.5F, 1000.0F}) {
        material.fresnel = FresnelModel::dielectric;
        material.refractive_index = index;
        const double head_on = pixel(finite_radiance(scene, 65), 32, 32).r;
        const double expected = std::pow((static_cast<double>(index) - 1) / (index + 1), 2.0);
        EXPECT_NEAR(head_on, 0.5 * expected, 1e-3) << index;
    }
    material.fresnel = FresnelModel::conductor;
    for (const float absorption : {0.0F, 3.0F, 1000.0F}) {
        material.conductor_index = glm::vec3(0.2F);
        material.conductor_absorption = glm::vec3(absorption);
        const double k = static_cast<double>(absorption);
        const double expected = (0.64 + k * k) / (1.44 + k * k);  // ((n-1)^2 + k^2) / ((n+1)^2 +
                                                                  // k^2).
        EXPECT_NEAR(pixel(finite_radiance(scene, 65), 32, 32).r, 0.5 * expected, 2e-3)
            << absorption;
    }
    material.conductor_index = glm::vec3(0.0F);
    material.conductor_absorption = glm::vec3(0.0F);  // Total internal reflection.
    (void)finite_radiance(scene, 65);
}

TEST_F(HardCases, AnEmptySceneIsItsBackground) {
    Scene scene;
    scene.camera = test::front_camera();
    scene.background = {0.25F, 0.5F, 0.75F, 1.0F};
    EXPECT_EQ(pixel(finite_radiance(scene), 8, 8), glm::dvec4(0.25, 0.5, 0.75, 1));
    // A mesh without triangles, with an empty range, draws nothing.
    scene.meshes = {Mesh{}};
    scene.meshes[0].edit().material_ranges = {{0, 0, std::nullopt}};
    scene.instances = {{0, glm::mat4(1), "empty"}};
    scene.ambient = {1, 1, 1};
    EXPECT_EQ(pixel(finite_radiance(scene), 8, 8), glm::dvec4(0.25, 0.5, 0.75, 1));
}

/// A sphere with tangents and a tilted map, lit from one side.
Scene leaning_sphere() {
    Material material;
    material.diffuse = glm::vec3(1.0F);
    material.normal_map = NormalMap{Texture{0}, 1.0F, Green::up, FlatCode::middle};
    Report report;
    FrameOptions options;
    options.tangents = TangentMethod::mikktspace;
    Scene scene = test::scene_of(with_frames(test::sphere(24, 12), options, report).mesh, material);
    Image map = make_image(1, 1, 3, 8, ColorSpace::data);
    map.samples = std::vector<std::uint8_t>{178, 108, 228};
    scene.images = {{"map", map}};
    scene.directional_lights = {{{-1, -0.5F, -1}, {0.9F, 0.9F, 0.9F}}};
    return scene;
}

/// Returns the transformed mesh: normals by the inverse transpose, tangents by the matrix, the
/// opposite handedness if it mirrors, and triangles reversed so that they face outwards again.
Mesh placed(Mesh mesh, const glm::mat3& matrix) {
    const bool mirrors = glm::determinant(matrix) < 0.0F;
    const glm::mat3 of_normals = glm::transpose(glm::inverse(matrix));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        mesh.positions[v] = matrix * mesh.positions[v];
        mesh.normals[v] = glm::normalize(of_normals * mesh.normals[v]);
        const glm::vec3 tangent = glm::normalize(matrix * glm::vec3(mesh.tangents[v]));
        mesh.tangents[v] = glm::vec4(tangent, mesh.tangents[v].w * (mirrors ? -1.0F : 1.0F));
    }
    for (glm::uvec3& triangle : mesh.triangles) {
        if (mirrors) std::swap(triangle.y, triangle.z);
    }
    return mesh;
}

TEST_F(HardCases, AnInstanceThatMirrorsShadesAsItsMirroredSurface) {
    for (const glm::vec3& scale : {glm::vec3(-1, 1, 1), glm::vec3(1, 1, -1), glm::vec3(-1, -1, -1),
                                   glm::vec3(-1.2F, 0.7F, 0.9F)}) {
        const glm::mat3 matrix(scale.x, 0, 0, 0, scale.y, 0, 0, 0, scale.z);
        const Scene original = leaning_sphere();
        Scene instanced = original;
        instanced.instances[0].world_from_object = glm::mat4(matrix);
        Scene moved = original;
        moved.meshes[0] = placed(original.meshes[0], matrix);
        const Image image = finite_radiance(instanced, 48);
        // After a stretch, the interpolation of normals and tangents of unit length differs
        // slightly.
        const bool is_uniform = scale * scale == glm::vec3(1.0F);
        const double tolerance = is_uniform ? 1e-4 : 0.03;
        EXPECT_LE(compare(image, finite_radiance(moved, 48)).max, tolerance) << scale.x;
        // The map has an effect: without the reversed handedness, the picture differs.
        for (glm::vec4& tangent : moved.meshes[0].edit().tangents)
            tangent.w = -tangent.w;
        EXPECT_GT(compare(image, finite_radiance(moved, 48)).max, 0.1) << scale.x;
    }
}

}  // namespace
}  // namespace relief

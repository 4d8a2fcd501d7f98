// SPDX-License-Identifier: Apache-2.0
// Input of the GPU: matrices, codes of normal maps, the inputs that a plan lists, sorted triangles
// and lines of vertex frames.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "relief/shade/effects.h"
#include "render/draw_values.h"
#include "render/gpu_mesh.h"
#include "render/overlays.h"
#include "render/program_cache.h"
#include "shade/effects/feature_sets.h"
#include "support/gl_environment.h"
#include "support/invariants.h"
#include "support/labels.h"

namespace relief {
using namespace relief::shade;
using namespace relief::shade::detail;

namespace {

glm::mat4 scaling(float x, float y, float z) {
    glm::mat4 matrix(1.0F);
    matrix[0].x = x;
    matrix[1].y = y;
    matrix[2].z = z;
    return matrix;
}

TEST(DrawValues, TurnNormalsByTheInverseTranspose) {
    DrawValues values;
    glm::mat4 matrix = scaling(2, -3, 0.5F);
    matrix[1].x = 1.0F;  // Adds a shear.
    matrix[3] = glm::vec4(7, 8, 9, 1);
    set_place(values, matrix);
    const glm::dmat3 expected = glm::transpose(glm::inverse(glm::dmat3(matrix)));
    for (const glm::dvec3 n : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(1, 2, 3)}) {
        const glm::dvec3 turned(values.world_from_object_normal * glm::vec3(n));
        EXPECT_LT(test::degrees_between(turned, expected * n), 1e-5);
    }
    EXPECT_EQ(values.handedness, -1.0F);
}

TEST(DrawValues, KeepDirectionsWithinAFloatsRange) {
    for (const float scale : {1e-19F, 1.0F, 1e19F}) {
        DrawValues values;
        set_place(values, scaling(scale, scale, scale));
        EXPECT_EQ(values.world_from_object_normal, glm::mat3(1.0F)) << scale;
        EXPECT_EQ(values.world_from_object_tangent, glm::mat3(1.0F)) << scale;
        EXPECT_EQ(values.handedness, 1.0F);
    }
}

TEST(DrawValues, OfAFlatteningMatrixPointOutOfThePlane) {
    DrawValues values;
    set_place(values, scaling(1, 1, 0));
    EXPECT_EQ(values.world_from_object_normal * glm::vec3(1, 2, 3), glm::vec3(0, 0, 3));
    EXPECT_EQ(values.handedness, 1.0F);
    set_place(values, scaling(0, 0, 0));
    EXPECT_EQ(values.world_from_object_normal, glm::mat3(0.0F));
}

/// Returns the values for a map with this number of bits.
DrawValues numbers(int bits, FlatCode flat, Green green = Green::up, float scale = 1.0F) {
    DrawValues values;
    set_normal_map(values, NormalMap{{}, scale, green}, bits, flat);
    return values;
}

TEST(NormalMapNumbers, DecodeTheCodesOfBothConventions) {
    const auto decode = [](const DrawValues& n, double texel) {
        return texel * static_cast<double>(n.normal_map_scale.x) +
               static_cast<double>(n.normal_map_bias.x);
    };
    // The float rounding of numbers near 1.
    constexpr double rounding = 2e-7;
    const DrawValues middle = numbers(8, FlatCode::middle);
    EXPECT_NEAR(decode(middle, 128.0 / 255), 0.0, rounding);
    EXPECT_NEAR(decode(middle, 1.0), 1.0, rounding);
    EXPECT_NEAR(decode(middle, 1.0 / 255), -1.0, rounding);
    const DrawValues half = numbers(8, FlatCode::half);
    EXPECT_NEAR(decode(half, 0.0), -1.0, rounding);
    EXPECT_NEAR(decode(half, 1.0), 1.0, rounding);
    const DrawValues fine = numbers(16, FlatCode::middle);
    EXPECT_NEAR(decode(fine, 32768.0 / 65535), 0.0, rounding);
    EXPECT_NEAR(decode(fine, 1.0), 1.0, rounding);
    const DrawValues real = numbers(32, FlatCode::middle);
    EXPECT_EQ(decode(real, 0.5), 0.0);
}

TEST(NormalMapNumbers, HoldGreenAndScale) {
    const DrawValues up = numbers(8, FlatCode::half, Green::up, 0.5F);
    const DrawValues down = numbers(8, FlatCode::half, Green::down, 0.5F);
    EXPECT_EQ(up.normal_map_scale, glm::vec3(1, 1, 2));
    EXPECT_EQ(up.normal_map_bias, glm::vec3(-0.5F, -0.5F, -1));
    EXPECT_EQ(down.normal_map_scale, glm::vec3(1, -1, 2));
    EXPECT_EQ(down.normal_map_bias, glm::vec3(-0.5F, 0.5F, -1));
    EXPECT_EQ(down.normal_map_unscale, glm::vec3(2, 2, 1));
    EXPECT_EQ(numbers(8, FlatCode::half, Green::up, 0.0F).normal_map_unscale, glm::vec3(0, 0, 1));
}

TEST(ClipFromWorld, PutsNearAndFarAtTheEndsOfDepth) {
    Camera camera;
    camera.world_from_view[3] = glm::vec4(0, 0, 5, 1);
    camera.vertical_fov = 2.0F * std::atan(0.5F);
    camera.near = 1.0F;
    camera.far = 9.0F;
    const glm::dmat4 matrix = clip_from_world(camera, 2.0);
    const auto seen = [&](const glm::dvec3& p) {
        const glm::dvec4 clip = matrix * glm::dvec4(p, 1.0);
        return glm::dvec3(clip) / clip.w;
    };
    EXPECT_NEAR(seen({0, 0, 4}).z, -1.0, 1e-6);
    EXPECT_NEAR(seen({0, 0, -4}).z, 1.0, 1e-6);
    // At distance 5, the upper edge is 2.5 above and the right edge 5 to the right of the center.
    EXPECT_NEAR(seen({0, 2.5, 0}).y, 1.0, 1e-6);
    EXPECT_NEAR(seen({5, 0, 0}).x, 1.0, 1e-6);
}

class DrawUniforms : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(DrawUniforms);

TEST_LABELS(not_sanitized);
TEST_P(DrawUniforms, HaveAValueForEveryPlannedName) {
    ProgramCache cache(api());
    const DrawValues values;
    for (const Features& f : test::covering_features()) {
        const DrawProgram& program = *cache.get(f);
        program.linked.use();
        for (const std::string& name : program.planned.uniforms) {
            EXPECT_TRUE(set_uniform(program.linked, name, values)) << name;
        }
        EXPECT_FALSE(set_uniform(program.linked, "nothing", values));
    }
}

TEST_P(DrawUniforms, IncludeTheEyeOnlyForReflections) {
    struct Case {
        const char* what;
        DebugView view;
        FresnelTerm fresnel;
        bool by_normal;
        bool refraction;
        bool takes_eye;
    };
    constexpr auto picture = DebugView::picture;
    constexpr auto constant = FresnelTerm::constant;
    const std::array cases{
        Case{"mirror image", picture, constant, false, false, true},
        Case{"mirror image along the normal", picture, constant, true, false, false},
        Case{"Fresnel's factor", picture, FresnelTerm::schlick, true, false, true},
        Case{"refraction", picture, constant, true, true, true},
        Case{"dimming", DebugView::diffuse, constant, false, true, false},
        Case{"dimming by angle", DebugView::diffuse, FresnelTerm::schlick, false, false, true},
    };
    ProgramCache cache(api());
    const DrawValues values;
    for (const Case& c : cases) {
        SCOPED_TRACE(c.what);
        Features f;
        f.view = c.view;
        f.interpolation = Interpolation::gouraud;
        f.directional_lights = 1;
        f.diffuse = true;
        f.reflection = ReflectionTerm::mirror;
        f.fresnel = c.fresnel;
        f.reflection_by_normal = c.by_normal;
        f.refraction = c.refraction;
        const DrawProgram& program = *cache.get(canonical(f));
        const std::vector<std::string>& names = program.planned.uniforms;
        EXPECT_EQ(std::find(names.begin(), names.end(), "eye_world") != names.end(), c.takes_eye);
        program.linked.use();
        for (const std::string& name : names)
            EXPECT_TRUE(set_uniform(program.linked, name, values)) << name;
    }
}

test::CallingScene normal_mapped() {
    Features f;
    f.directional_lights = 1;
    f.diffuse = true;
    f.detail = NormalDetail::normal_map;
    return test::scene_calling_for(f);
}

TEST(PlannedInputs, NameStreamsAndImagesWithTheirReasons) {
    const test::CallingScene calling = normal_mapped();
    const FramePlan plan = plan_effects(calling.scene, calling.settings);
    const DrawInputs inputs = planned_inputs(calling.scene, plan.draws[0]);
    ASSERT_EQ(inputs.attributes.size(), 4U);
    EXPECT_EQ(inputs.attributes[1].name, "normal_object");
    EXPECT_TRUE(inputs.attributes[1].stored);
    EXPECT_EQ(inputs.attributes[2].name, "tangent_object");
    EXPECT_FALSE(inputs.attributes[2].stored) << "computed";
    EXPECT_EQ(inputs.attributes[2].reason, "a map or anisotropy lies in the mesh's tangent frame");
    ASSERT_EQ(inputs.textures.size(), 1U);
    EXPECT_EQ(inputs.textures[0].sampler, "normal_texture");
    EXPECT_EQ(inputs.textures[0].image, "normal");
    EXPECT_TRUE(inputs.textures[0].mip_chain);
    EXPECT_EQ(inputs.textures[0].reason, "material 'm' has it");
}

TEST_LABELS(not_sanitized);
TEST(PlannedInputs, AreThoseOfTheProgramForEveryPairOfEffects) {
    for (const Features& features : test::covering_features()) {
        const test::CallingScene calling = test::scene_calling_for(features);
        const FramePlan plan = plan_effects(calling.scene, calling.settings);
        const DrawPlan& draw = plan.draws[0];
        const PlannedInterface planned = planned_interface(draw.features);
        const DrawInputs inputs = planned_inputs(calling.scene, draw);
        EXPECT_EQ(inputs.attributes.size(), planned.attributes.size());
        EXPECT_EQ(inputs.textures.size(), planned.samplers.size());
        for (const PlannedTexture& texture : inputs.textures)
            EXPECT_NE(texture.reason, "") << texture.sampler;
    }
}

TEST(PlannedPasses, AreInTheOrderInWhichTheyAreDrawn) {
    test::CallingScene calling = normal_mapped();
    calling.scene.environment = Environment{};
    FrameSettings settings = calling.settings;
    settings.samples = 4;
    const std::vector<PlannedPass> passes = planned_passes(plan_effects(calling.scene, settings));
    ASSERT_EQ(passes.size(), 3U);
    EXPECT_EQ(passes[0].name, "surfaces");
    EXPECT_EQ(passes[1].name, "skybox");
    EXPECT_EQ(passes[2].name, "finishing");
    EXPECT_EQ(passes[2].reason, "4 samples per pixel are averaged in linear light");
    EXPECT_EQ(planned_passes(plan_effects(normal_mapped().scene, calling.settings)).size(), 1U);
}

/// Small triangles at these depths along z.
Mesh stack(const std::vector<float>& depths) {
    Mesh mesh;
    for (const float z : depths) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {{0, 0, z}, {1, 0, z}, {0, 1, z}});
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

std::vector<std::uint32_t> order(SortedTriangles& triangles, const glm::vec3& farther) {
    std::vector<std::uint32_t> result;
    for (const glm::uvec3& triangle : triangles.sort(farther))
        result.push_back(triangle.x / 3);
    return result;
}

using Order = std::vector<std::uint32_t>;

TEST(SortedTriangles, AreFarthestFirst) {
    const Mesh mesh = stack({0, 3, -2, 1});
    SortedTriangles triangles(mesh, {0, 4, std::nullopt});
    EXPECT_EQ(order(triangles, {0, 0, 1}), (Order{1, 3, 0, 2}));
    EXPECT_EQ(order(triangles, {0, 0, -5}), (Order{2, 0, 3, 1}));
    EXPECT_EQ(triangles.center().z, 0.5F);
}

TEST(SortedTriangles, KeepTheOrderOfTies) {
    const Mesh mesh = stack({1, 0, 1, 0});
    SortedTriangles triangles(mesh, {0, 4, std::nullopt});
    EXPECT_EQ(order(triangles, {0, 0, 1}), (Order{0, 2, 1, 3}));
    EXPECT_EQ(order(triangles, {1, 0, 0}), (Order{0, 1, 2, 3}));
}

TEST(SortedTriangles, OfARangeStayWithinIt) {
    const Mesh mesh = stack({0, 3, -2, 1});
    SortedTriangles triangles(mesh, {1, 2, std::nullopt});
    EXPECT_EQ(order(triangles, {0, 0, 1}), (Order{1, 2}));
}

TEST(SortedTriangles, WithoutFinitePositionComeLast) {
    const Mesh mesh = stack(
        {0, std::numeric_limits<float>::quiet_NaN(), 2, std::numeric_limits<float>::infinity()});
    SortedTriangles triangles(mesh, {0, 4, std::nullopt});
    EXPECT_EQ(order(triangles, {0, 0, 1}), (Order{2, 0, 1, 3}));
    // Two of four vertices count.
    EXPECT_EQ(triangles.center().x, glm::vec3(1.0F / 3.0F).x * 0.5F);
}

Mesh one_vertex() {
    Mesh mesh;
    mesh.positions = {{1, 2, 3}};
    mesh.normals = {{0, 0, 1}};
    mesh.tangents = {{1, 0, 0, 1}};
    return mesh;
}

VertexFrameLines lines_of(const Mesh& mesh, const glm::mat4& place, const glm::dvec3& center = {}) {
    VertexFrameLines lines;
    add_vertex_frames(mesh, place, center, 0.5, lines);
    return lines;
}

using Line = std::vector<glm::vec3>;

TEST(VertexFrames, StartAtTheVertexAndHaveTheLength) {
    const VertexFrameLines lines = lines_of(one_vertex(), glm::mat4(1.0F), {1, 1, 1});
    EXPECT_EQ(lines.tangents, (Line{{0, 1, 2}, {0.5F, 1, 2}}));
    EXPECT_EQ(lines.bitangents, (Line{{0, 1, 2}, {0, 1.5F, 2}}));
    EXPECT_EQ(lines.normals, (Line{{0, 1, 2}, {0, 1, 2.5F}}));
}

TEST(VertexFrames, KeepTheirLengthUnderScaleAndTurnRoundUnderMirrors) {
    glm::mat4 place(1.0F);
    place[0][0] = -4.0F;
    const VertexFrameLines lines = lines_of(one_vertex(), place);
    EXPECT_EQ(lines.tangents, (Line{{-4, 2, 3}, {-4.5F, 2, 3}}));
    EXPECT_EQ(lines.bitangents, (Line{{-4, 2, 3}, {-4, 2.5F, 3}})) << "still up in the image";
    EXPECT_EQ(lines.normals, (Line{{-4, 2, 3}, {-4, 2, 3.5F}}));
}

TEST(VertexFrames, StayPreciseFarFromTheOrigin) {
    Mesh mesh = one_vertex();
    mesh.positions = {{0.125F, 0, 0}};
    glm::mat4 place(1.0F);
    place[3] = {1e8F, 0, 0, 1};
    const VertexFrameLines lines = lines_of(mesh, place, {1e8, 0, 0});
    EXPECT_EQ(lines.tangents, (Line{{0.125F, 0, 0}, {0.625F, 0, 0}}));
}

TEST(VertexFrames, OmitNonFiniteVerticesAndZeroVectors) {
    Mesh mesh = one_vertex();
    mesh.positions.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
    mesh.normals.push_back({0, 0, 1});
    mesh.tangents.push_back({1, 0, 0, 1});
    mesh.positions.push_back({0, 0, 0});
    mesh.normals.push_back({0, 0, 0});
    mesh.tangents.push_back({1, 0, 0, 1});
    const VertexFrameLines lines = lines_of(mesh, glm::mat4(1.0F));
    EXPECT_EQ(lines.normals.size(), 2U);
    EXPECT_EQ(lines.tangents.size(), 4U);
    EXPECT_EQ(lines.bitangents.size(), 2U);
    mesh.tangents.clear();
    EXPECT_TRUE(lines_of(mesh, glm::mat4(1.0F)).tangents.empty());
}

}  // namespace
}  // namespace relief

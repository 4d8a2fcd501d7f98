// SPDX-License-Identifier: Apache-2.0
// The numbers that shaders take: matrices, normal-map codes, cameras, by hand. And every planned
// uniform has a value.
#include "render/draw_values.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../effects/all_features.h"
#include "relief/shade/effects.h"
#include "render/program_cache.h"
#include "support/angle.h"
#include "support/gl_environment.h"

namespace relief {
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
    matrix[1].x = 1.0F;  // A shear on top.
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

/// The numbers of a map of this many bits.
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
    // A float's rounding of numbers near 1.
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
    // At distance 5 the upper edge is 2.5 up and the right edge 5 to the right.
    EXPECT_NEAR(seen({0, 2.5, 0}).y, 1.0, 1e-6);
    EXPECT_NEAR(seen({5, 0, 0}).x, 1.0, 1e-6);
}

class DrawUniforms : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(DrawUniforms);

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

}  // namespace
}  // namespace relief

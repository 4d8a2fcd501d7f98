// SPDX-License-Identifier: Apache-2.0
// The method that made given tangents: each method is identified through noise, quantization,
// negated signs and other axes, and tangents of no known method are reported as such.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/tangents.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A torus with perturbed positions, so that methods differ.
Mesh bumpy_torus() {
    Mesh torus = make_torus(0.4F, 48, 24);
    for (glm::vec3& position : torus.positions) {
        position += 0.02F * glm::vec3(std::sin(31.0F * position.y), std::sin(29.0F * position.z),
                                      std::sin(37.0F * position.x));
    }
    return torus;
}

/// Gives each triangle its own vertices and the tangents of its own gradient.
Mesh with_triangle_tangents(const Mesh& mesh) {
    Mesh result;
    for (const glm::uvec3& triangle : mesh.triangles) {
        Mesh one;
        const auto first = static_cast<std::uint32_t>(result.positions.size());
        for (int k = 0; k < 3; ++k) {
            one.positions.push_back(mesh.positions[triangle[k]]);
            one.normals.push_back(mesh.normals[triangle[k]]);
            one.texcoords.push_back(mesh.texcoords[triangle[k]]);
        }
        one.triangles = {{0, 1, 2}};
        one = test::with_tangents(one, TangentMethod::mikktspace);
        result.positions.insert(result.positions.end(), one.positions.begin(), one.positions.end());
        result.normals.insert(result.normals.end(), one.normals.begin(), one.normals.end());
        result.texcoords.insert(result.texcoords.end(), one.texcoords.begin(), one.texcoords.end());
        result.tangents.insert(result.tangents.end(), one.tangents.begin(), one.tangents.end());
        result.triangles.emplace_back(first, first + 1, first + 2);
    }
    return result;
}

Mesh made_by(TangentMethod method) {
    return method == TangentMethod::triangle ? with_triangle_tangents(bumpy_torus())
                                             : test::with_tangents(bumpy_torus(), method);
}

/// Returns the tangent rotated about the normal of the vertex.
glm::vec4 turned(const Mesh& mesh, std::size_t v, double degrees) {
    const double angle = degrees * 3.14159265358979323846 / 180.0;
    const glm::dvec3 n = glm::normalize(glm::dvec3(mesh.normals[v]));
    const glm::dvec3 t(mesh.tangents[v]);
    return {glm::vec3(t * std::cos(angle) + glm::cross(n, t) * std::sin(angle)),
            mesh.tangents[v].w};
}

class TangentBasisTest : public testing::TestWithParam<TangentMethod> {};

TEST_P(TangentBasisTest, IsIdentified) {
    const Mesh mesh = made_by(GetParam());
    const IdentifiedTangents identified = identify_tangents(mesh);
    ASSERT_EQ(identified.method, GetParam());
    EXPECT_THAT(identified.equivalent_methods, IsEmpty());
    EXPECT_EQ(identified.corners, 3 * mesh.triangles.size());
    EXPECT_EQ(identified.left_out + identified.undefined, 0U);
    EXPECT_EQ(identified.stored_bits, 0);
    EXPECT_EQ(identified.agreements.size(), identifiable_tangent_methods.size());
    EXPECT_EQ(identified.best()->method, GetParam());
    EXPECT_EQ(identified.best()->agreeing(), identified.corners);
    EXPECT_LT(identified.best()->angles.max, 1e-4);
    EXPECT_EQ(identified.best()->negated, 0U);
    for (const TangentAgreement& other : identified.agreements) {
        if (other.method == GetParam()) continue;
        EXPECT_LT(other.fraction(), 0.6) << enum_name(other.method);
        EXPECT_GT(other.angles.mean, 0.2) << enum_name(other.method);
    }
}

TEST_P(TangentBasisTest, IsIdentifiedDespiteNoise) {
    Mesh mesh = made_by(GetParam());
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0.0, 0.03);  // In degrees.
    for (std::size_t v = 0; v < mesh.tangents.size(); ++v)
        mesh.tangents[v] = turned(mesh, v, noise(random));
    const IdentifiedTangents identified = identify_tangents(mesh);
    EXPECT_EQ(identified.method, GetParam());
    EXPECT_NEAR(identified.best()->angles.rms, 0.03, 0.003);
}

TEST_P(TangentBasisTest, IsTheNearestDespiteLargeNoise) {
    Mesh mesh = made_by(GetParam());
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, 0.3);
    for (std::size_t v = 0; v < mesh.tangents.size(); ++v)
        mesh.tangents[v] = turned(mesh, v, noise(random));
    const IdentifiedTangents identified = identify_tangents(mesh);
    EXPECT_FALSE(identified.method);
    EXPECT_EQ(identified.best()->method, GetParam());
    EXPECT_TRUE(identified.is_clearly_best());
}

TEST_P(TangentBasisTest, IsIdentifiedInFewBits) {
    for (const int bits : {8, 16}) {
        Mesh mesh = made_by(GetParam());
        const float steps = bits == 8 ? 127.0F : 32767.0F;
        for (glm::vec4& tangent : mesh.tangents)
            tangent = glm::round(tangent * steps) / steps;
        const IdentifiedTangents identified = identify_tangents(mesh);
        EXPECT_EQ(identified.method, GetParam()) << bits;
        EXPECT_EQ(identified.stored_bits, bits);
        EXPECT_EQ(identified.tolerance, bits == 8 ? 0.5 : 0.1);
        EXPECT_LT(identified.best()->angles.max, identified.tolerance) << "which has its reason";
    }
}

TEST_P(TangentBasisTest, IsIdentifiedWithNegatedSigns) {
    Mesh mesh = made_by(GetParam());
    for (glm::vec4& tangent : mesh.tangents)
        tangent.w = -tangent.w;
    const IdentifiedTangents all = identify_tangents(mesh);
    EXPECT_EQ(all.method, GetParam());
    EXPECT_EQ(all.best()->quarter_turns, 0);
    EXPECT_EQ(all.best()->negated, all.corners);

    mesh = made_by(GetParam());
    for (std::size_t v = 0; v < mesh.tangents.size() / 4; ++v)
        mesh.tangents[v].w = -mesh.tangents[v].w;
    const IdentifiedTangents some = identify_tangents(mesh);
    EXPECT_EQ(some.method, GetParam());
    EXPECT_GT(some.best()->negated, some.corners / 8);
    EXPECT_LT(some.best()->negated, some.corners / 2);
}

INSTANTIATE_TEST_SUITE_P(Each, TangentBasisTest,
                         testing::ValuesIn(identifiable_tangent_methods.begin(),
                                           identifiable_tangent_methods.end()),
                         [](const auto& name) {
                             std::string word(enum_name(name.param));
                             std::replace(word.begin(), word.end(), '-', '_');
                             return word;
                         });

TEST(TangentBasis, OtherAxesAreQuarterTurns) {
    // The direction that a program stores instead, and the reported rotation and sign.
    const struct {
        double degrees;
        bool negates;
        int quarter_turns;
        const char* words;
    } cases[] = {{0.0, true, 0, "w negated"},
                 {180.0, true, 2, "u mirrored"},
                 {180.0, false, 2, "turned by half a turn"},
                 {90.0, true, 1, "tangent and bitangent exchanged"},
                 {-90.0, false, 3, "turned by three quarters"}};
    for (const auto& expected : cases) {
        SCOPED_TRACE(expected.words);
        Mesh mesh = made_by(TangentMethod::mikktspace);
        for (std::size_t v = 0; v < mesh.tangents.size(); ++v) {
            const float w = mesh.tangents[v].w;
            // The bitangent is w * cross(n, t), so the direction of a quarter turn towards it
            // depends on w.
            mesh.tangents[v] = turned(mesh, v, expected.degrees * static_cast<double>(w));
            mesh.tangents[v].w = expected.negates ? -w : w;
        }
        const IdentifiedTangents identified = identify_tangents(mesh);
        ASSERT_EQ(identified.method, TangentMethod::mikktspace);
        EXPECT_EQ(identified.best()->quarter_turns, expected.quarter_turns);
        EXPECT_EQ(identified.best()->negated, expected.negates ? identified.corners : 0U);
        EXPECT_EQ(variant_text(identified.best()->quarter_turns, expected.negates), expected.words);
    }
}

TEST(TangentBasis, FlippedTextureCoordinatesAreSuchVariants) {
    // Tangents of the vertically flipped image differ only in w. Those of the mirrored image equal
    // mirrored u.
    for (const int axis : {0, 1}) {
        Mesh flipped = bumpy_torus();
        const std::vector<glm::vec2> texcoords = flipped.texcoords;
        for (glm::vec2& texcoord : flipped.texcoords)
            texcoord[axis] = 1.0F - texcoord[axis];
        flipped = test::with_tangents(std::move(flipped), TangentMethod::mikktspace);
        ASSERT_EQ(flipped.texcoords.size(), texcoords.size()) << "no vertex was split";
        flipped.texcoords = texcoords;
        const IdentifiedTangents identified = identify_tangents(flipped);
        ASSERT_EQ(identified.method, TangentMethod::mikktspace);
        EXPECT_EQ(identified.best()->quarter_turns, axis == 0 ? 2 : 0);
        EXPECT_EQ(identified.best()->negated, identified.corners);
    }
}

TEST(TangentBasis, RandomTangentsAreOfNone) {
    Mesh mesh = made_by(TangentMethod::mikktspace);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> any(0.0, 360.0);
    for (std::size_t v = 0; v < mesh.tangents.size(); ++v)
        mesh.tangents[v] = turned(mesh, v, any(random));
    const IdentifiedTangents identified = identify_tangents(mesh);
    EXPECT_FALSE(identified.method);
    ASSERT_NE(identified.best(), nullptr);
    EXPECT_LT(identified.best()->fraction(), 0.01);
    EXPECT_FALSE(identified.is_clearly_best());
}

TEST(TangentBasis, OtherTextureCoordinatesAreOfNone) {
    Mesh mesh = made_by(TangentMethod::mikktspace);
    for (std::size_t v = 0; v < mesh.texcoords.size(); ++v) {
        // The image is sheared over the surface, so every direction changes.
        mesh.texcoords[v].x += 0.7F * mesh.texcoords[v].y;
        mesh.texcoords[v].y += 0.3F * mesh.texcoords[v].x;
    }
    EXPECT_FALSE(identify_tangents(mesh).method);
}

TEST(TangentBasis, OnAPlaneAllAreTheSame) {
    const IdentifiedTangents identified =
        identify_tangents(test::with_tangents(make_quad(4), TangentMethod::lengyel));
    EXPECT_EQ(identified.method, TangentMethod::mikktspace) << "the usual one";
    EXPECT_THAT(
        identified.equivalent_methods,
        ElementsAre(TangentMethod::area_weighted, TangentMethod::lengyel, TangentMethod::triangle));
    EXPECT_EQ(identified.stored_bits, 0) << "whole numbers are no sign of few bits";
}

TEST(TangentBasis, LeaningTangentsAreJudgedInThePlaneOfTheNormal) {
    Mesh mesh = made_by(TangentMethod::mikktspace);
    for (std::size_t v = 0; v < mesh.tangents.size(); ++v)
        mesh.tangents[v] += glm::vec4(0.2F * mesh.normals[v], 0.0F);
    EXPECT_EQ(identify_tangents(mesh).method, TangentMethod::mikktspace);
}

/// The direction of u of each triangle is then parallel to the normal, so there is no angle of 0.
TEST(TangentBasis, MethodsWithoutAnyDirectionAreNotTheNearest) {
    Mesh quad = make_quad();
    quad.normals.assign(4, {1.0F, 0.0F, 0.0F});
    quad.tangents.assign(4, {0.0F, 0.8F, 0.6F, 1.0F});
    const IdentifiedTangents found = identify_tangents(quad);
    EXPECT_FALSE(found.method);
    ASSERT_NE(found.best(), nullptr);
    EXPECT_NE(found.best()->method, TangentMethod::triangle);
    EXPECT_EQ(found.best()->angles.count, 6U);
}

TEST(TangentBasis, UncertainCornersAreLeftOut) {
    Mesh mesh = made_by(TangentMethod::mikktspace);
    const IdentifiedTangents before = identify_tangents(mesh);
    mesh.tangents[mesh.triangles[5].x] = glm::vec4(0.0F, 0.0F, 0.0F, 1.0F);
    mesh.tangents[mesh.triangles[9].x] =
        glm::vec4(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F, 1.0F);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    // Triangles whose texture is a line, a point that is too small for floats, and NaN.
    for (const float height : {0.0F, 1e-7F, std::numeric_limits<float>::quiet_NaN()}) {
        for (int k = 0; k < 3; ++k) {
            mesh.positions.emplace_back(k == 1 ? 2.0F : 1.0F, k == 2 ? 1.0F : 0.0F, 5.0F);
            mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
            mesh.texcoords.emplace_back(k == 1 ? 1.0F : 0.5F, k == 2 ? 0.5F + height : 0.5F);
            mesh.tangents.emplace_back(0.6F, 0.8F, 0.0F, 1.0F);
        }
    }
    for (std::uint32_t i = 0; i < 3; ++i)
        mesh.triangles.emplace_back(first + 3 * i, first + 3 * i + 1, first + 3 * i + 2);
    mesh.material_ranges.clear();
    const IdentifiedTangents identified = identify_tangents(mesh);
    EXPECT_EQ(identified.method, TangentMethod::mikktspace);
    EXPECT_EQ(identified.left_out, 9U);
    EXPECT_GT(identified.undefined, 2U) << "all corners of two vertices";
    EXPECT_LE(identified.undefined, 16U);
    EXPECT_EQ(identified.corners + identified.undefined, before.corners);
}

TEST(TangentBasis, TheSizeOfAMeshChangesNothing) {
    const Mesh mesh = made_by(TangentMethod::mikktspace);
    const IdentifiedTangents expected = identify_tangents(mesh);
    Mesh small = mesh;
    constexpr float scale = 0x1p-14F;  // A power of two does not round the positions.
    for (glm::vec3& position : small.positions)
        position *= scale;
    const IdentifiedTangents identified = identify_tangents(small);
    EXPECT_EQ(identified.method, TangentMethod::mikktspace);
    EXPECT_EQ(identified.corners, expected.corners);
    EXPECT_EQ(identified.left_out, expected.left_out);
    EXPECT_EQ(identified.undefined, expected.undefined);
}

TEST(TangentBasis, IsUnknownWithoutItsInputs) {
    const Mesh whole = made_by(TangentMethod::mikktspace);
    for (const int missing : {0, 1, 2}) {
        Mesh mesh = whole;
        if (missing == 0) mesh.tangents.clear();
        if (missing == 1) mesh.normals.clear();
        if (missing == 2) mesh.texcoords.clear();
        const IdentifiedTangents identified = identify_tangents(mesh);
        EXPECT_FALSE(identified.method);
        EXPECT_EQ(identified.best(), nullptr);
    }
    EXPECT_EQ(identify_tangents({}).best(), nullptr);
    Mesh broken = whole;
    broken.triangles.front().x = 1000000;
    EXPECT_THROW(identify_tangents(broken), InvalidInput);
}

TEST(TangentBasis, IdentifiesRealModels) {
    RELIEF_NEEDS_SHARED(models, "data/models");
    const struct {
        const char* file;
        int set;
        std::optional<TangentMethod> method;
    } expected[] = {
        {"gltf/WaterBottle/glTF/WaterBottle.gltf", 0, TangentMethod::mikktspace},
        {"gltf/NormalTangentMirrorTest/glTF-Binary/NormalTangentMirrorTest.glb", 0,
         TangentMethod::mikktspace},
        {"gltf/AnisotropyStrengthTest/glTF-Binary/AnisotropyStrengthTest.glb", 0,
         TangentMethod::mikktspace},
        {"gltf-ext/misc/DuplicateMeshes/duplicate_meshes.gltf", 0, TangentMethod::mikktspace},
        {"gltf-ext/tangent-pair/sphere.gltf", 0, TangentMethod::lengyel},
        {"gltf/MultiUVTest/glTF-Binary/MultiUVTest.glb", 0, std::nullopt},
        {"gltf/MultiUVTest/glTF-Binary/MultiUVTest.glb", 1, TangentMethod::mikktspace},
        {"gltf/BoomBox/glTF/BoomBox.gltf", 0, std::nullopt},
    };
    for (const auto& model : expected) {
        SCOPED_TRACE(model.file);
        Report report;
        const GltfDocument document = GltfDocument::read(models / model.file, report);
        EXPECT_EQ(identify_tangents(document.mesh({0, 0}, model.set)).method, model.method);
    }
}

}  // namespace
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Whole bakes: a flat result for equal meshes, heights, texel states, padding, cages, samples and
// threads; a bumpy sphere against a brute-force search.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "support/invariants.h"
#include "support/labels.h"

namespace relief {
namespace {

using test::bake;
using test::BakedImage;
using test::moved;
using test::sized;

const glm::dvec3 straight_up(0, 0, 1);

/// A square with waves above that of make_quad().
Mesh gentle_waves(int cells) {
    Mesh mesh = make_quad(cells);
    mesh.normals.clear();
    for (glm::vec3& position : mesh.positions)
        position.z = 0.05F * std::sin(9.0F * position.x) * std::cos(7.0F * position.y);
    return mesh;
}

TEST(Bake, MeshOntoItselfIsFlat) {
    for (const Mesh& mesh :
         {make_quad(), make_sphere(), make_torus(), make_cube(), make_cylinder()}) {
        const BakedImage image = bake({mesh}, mesh, sized(128, 96));
        EXPECT_EQ(image.result.texels_missed, 0U);
        double worst = 0.0;
        float farthest = 0.0F;
        for (std::size_t i = 0; i < image.states.size(); ++i) {
            worst = std::max(worst, degrees_between(image.normal(i), straight_up));
            farthest = std::max(farthest, std::abs(image.heights[i]));
        }
        // Codes of 16 bits are 0.002 degrees apart.
        EXPECT_LT(worst, 0.001);
        EXPECT_LT(farthest, 1e-5F);
    }
}

TEST(Bake, OntoItselfIsFlatAtEveryScale) {
    for (const float scale : {1e-18F, 1e-6F, 1e6F, 1e18F}) {
        const Mesh mesh = moved(make_torus(), scale, glm::vec3(0));
        const BakedImage image = bake({mesh}, mesh, sized(64, 64));
        EXPECT_EQ(image.result.texels_baked, 64U * 64U);
        double worst = 0.0;
        for (std::size_t i = 0; i < image.states.size(); ++i)
            worst = std::max(worst, degrees_between(image.normal(i), straight_up));
        EXPECT_LT(worst, 0.001) << scale;
    }
}

TEST(Bake, HeightsAreHowFarOutsideTheSurfaceLies) {
    const Mesh low = make_quad();
    for (const float height : {0.25F, 0.0F, -0.125F}) {
        const BakedImage image =
            bake({moved(make_quad(), 1.0F, {0, 0, height})}, low, sized(16, 16));
        EXPECT_EQ(image.count(TexelState::baked), 256U);
        for (const float here : image.heights)
            EXPECT_NEAR(here, height, 1e-7F);
        EXPECT_NEAR(image.result.distances.offset, 1.5 * std::abs(height) + 0.01, 1e-6);
        EXPECT_NEAR(image.result.min_height, height, 1e-15);
        EXPECT_NEAR(image.result.max_height, height, 1e-15);
    }
}

TEST(Bake, IsTheSameForAnyNumberOfThreadsAndOrderOfHighTriangles) {
    BakeOptions options = sized(150, 130);
    options.map.padding = 7;
    options.map.samples = 4;
    Mesh high = make_torus(0.43F, 200, 100);
    const Mesh low = make_torus();
    const BakedImage usual = bake({high}, low, options);
    set_thread_limit(1);
    const BakedImage alone = bake({high}, low, options);
    set_thread_limit(0);
    EXPECT_EQ(usual.normals, alone.normals);
    EXPECT_EQ(usual.heights, alone.heights);
    EXPECT_TRUE(std::equal(usual.report.findings().begin(), usual.report.findings().end(),
                           alone.report.findings().begin(), alone.report.findings().end()));
    std::reverse(high.triangles.begin(), high.triangles.end());
    const BakedImage turned = bake({high}, low, options);
    EXPECT_EQ(usual.normals, turned.normals);
}

TEST(Bake, MissedTexelsAreCountedAndFilledFromTheNearest) {
    // A tilted high mesh above the left half only.
    Mesh high = make_quad();
    high.normals.assign(high.positions.size(), glm::normalize(glm::vec3(0.6F, 0, 0.8F)));
    for (glm::vec3& position : high.positions)
        position.x = (position.x - 1.0F) / 2.0F;
    BakeOptions options = sized(64, 64);
    const BakedImage image = bake({high}, make_quad(), options);
    EXPECT_EQ(image.count(TexelState::baked), 32U * 64U);
    EXPECT_EQ(image.count(TexelState::missed), 32U * 64U);
    EXPECT_EQ(image.report.count("texel missed by its rays"), 32U * 64U);
    EXPECT_EQ(image.result.texels_missed, 32U * 64U);
    EXPECT_EQ(image.normal(63), straight_up);
    options.map.padding = 5;
    const BakedImage padded = bake({high}, make_quad(), options);
    EXPECT_EQ(padded.count(TexelState::padded), 5U * 64U);
    EXPECT_LT(degrees_between(padded.normal(36), {0.6, 0, 0.8}), 1e-4);
    EXPECT_EQ(padded.normal(37), straight_up);
}

TEST(Bake, EmptyHighMeshMissesAllTexels) {
    const BakedImage image = bake({}, make_quad(), sized(8, 8));
    EXPECT_EQ(image.count(TexelState::missed), 64U);
    EXPECT_EQ(image.result.min_height, 0.0);
    EXPECT_THROW(bake({Mesh{}}, make_quad(), sized(8, 8)), BakeMismatch);
}

TEST(Bake, AChartSmallerThanATexelHasOne) {
    Mesh low = make_quad();
    for (glm::vec2& texcoord : low.texcoords)
        texcoord = glm::vec2(0.51F, 0.27F) + 0.01F * texcoord;
    const BakedImage image = bake({make_quad()}, low, sized(10, 10));
    EXPECT_EQ(image.count(TexelState::baked), 1U);
    EXPECT_EQ(image.states[25], TexelState::baked);
}

TEST(Bake, OddSizesAreBakedToo) {
    for (const auto& [width, height] : {std::pair(1, 1), {3, 17}, {1, 200}, {129, 1}}) {
        BakeOptions options = sized(width, height);
        options.map.padding = 3;
        const BakedImage image = bake({make_quad()}, make_quad(), options);
        EXPECT_EQ(image.count(TexelState::baked), static_cast<std::size_t>(width * height));
    }
}

TEST(Bake, MirroredChartsThatOverlapHaveOneOwnerEach) {
    // Two adjacent squares with the same image, one of them mirrored. The other one owns it.
    Mesh low = make_quad();
    Mesh other = moved(make_quad(), 1.0F, {3, 0, 0});
    for (glm::vec2& texcoord : other.texcoords)
        texcoord.x = 1.0F - texcoord.x;
    const auto first = static_cast<std::uint32_t>(low.positions.size());
    low.positions.insert(low.positions.end(), other.positions.begin(), other.positions.end());
    low.normals.insert(low.normals.end(), other.normals.begin(), other.normals.end());
    low.texcoords.insert(low.texcoords.end(), other.texcoords.begin(), other.texcoords.end());
    for (const glm::uvec3& triangle : other.triangles)
        low.triangles.push_back(triangle + first);
    // The slopes differ, so that the result identifies the mesh.
    Mesh high = make_quad();
    high.normals.assign(high.positions.size(), glm::normalize(glm::vec3(0.6F, 0, 0.8F)));
    Mesh wrong = moved(make_quad(), 1.0F, {3, 0, 0});
    wrong.normals.assign(wrong.positions.size(), glm::normalize(glm::vec3(0, 0.6F, 0.8F)));
    const BakedImage image = bake({high, wrong}, low, sized(32, 32));
    EXPECT_EQ(image.report.count("texel of mirrored triangles"), 32U * 32U);
    for (std::size_t i = 0; i < 32UL * 32UL; ++i)
        EXPECT_LT(degrees_between(image.normal(i), {0.6, 0, 0.8}), 1e-4);
}

TEST(Bake, RaysRunFromACageToTheLowMesh) {
    // The cage is shifted: rays come from the right and hit a floor 0.5 below at 0.25 further left.
    const Mesh cage = moved(make_quad(), 1.0F, {0.5F, 0, 1.0F});
    Mesh floor = moved(make_quad(), 4.0F, {0, 0, -0.5F});
    // The normal shows the hit point.
    floor.normals.clear();
    for (const glm::vec3& position : floor.positions)
        floor.normals.push_back(glm::vec3(position.x, position.y, 10));
    BakeOptions options = sized(8, 8);
    options.space = VectorSpace::object;
    options.cage = std::make_shared<const Mesh>(cage);
    const BakedImage image = bake({floor}, make_quad(), options);
    ASSERT_EQ(image.count(TexelState::baked), 64U);
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) {
            const glm::dvec3 expected((x + 0.5) / 4 - 1 - 0.25, 1 - (y + 0.5) / 4, 10);
            EXPECT_LT(degrees_between(image.normal(static_cast<std::size_t>(y * 8 + x)), expected),
                      1e-4);
        }
    }
    Mesh other = cage;
    other.triangles.pop_back();
    options.cage = std::make_shared<const Mesh>(other);
    EXPECT_EQ(test::message_of<InvalidInput>([&] { bake({floor}, make_quad(), options); }),
              "the cage has 1 triangles, not 2 as the low mesh");
}

TEST(Bake, HardDirectionsLeaveGapsAndAveragedOnesNone) {
    // A cube baked from a larger one: averaged rays spread over all of it, hard ones stay in front.
    const Mesh low = make_cube();
    const Mesh high = moved(make_cube(), 1.2F, glm::vec3(0));
    BakeOptions options = sized(64, 64);
    options.space = VectorSpace::object;
    options.max_distance = 0.01;
    options.offset = 0.5;
    const auto heights = [&](RayDirections directions, double hardness) {
        options.directions = directions;
        options.hardness = hardness;
        const BakedImage image = bake({high}, low, options);
        EXPECT_EQ(image.result.texels_missed, 0U);
        return *std::max_element(image.heights.begin(), image.heights.end());
    };
    EXPECT_NEAR(heights(RayDirections::face, 0.0), 0.2F, 1e-6F);
    EXPECT_NEAR(heights(RayDirections::shading, 0.0), 0.2F, 1e-6F);
    EXPECT_NEAR(heights(RayDirections::averaged, 1.0), 0.2F, 1e-6F);
    // The rays are diagonal at the corners, and between the diagonal and the normal elsewhere.
    EXPECT_NEAR(heights(RayDirections::averaged, 0.0), 0.2F * std::sqrt(3.0F), 0.005F);
    const float half = heights(RayDirections::averaged, 0.5);
    EXPECT_GT(half, 0.2F);
    EXPECT_LT(half, 0.25F);
}

TEST(Bake, RaysWithoutADirectionRunAlongTheTrianglesNormal) {
    // Smoothed normals and vertex normals of the opposite direction cancel at the hardness 0.5.
    Mesh low = make_quad();
    for (glm::vec3& normal : low.normals)
        normal = -normal;
    BakeOptions options = sized(8, 8);
    options.space = VectorSpace::object;
    options.hardness = 0.5;
    const BakedImage image = bake({moved(make_quad(), 1.0F, {0, 0, 0.25F})}, low, options);
    EXPECT_EQ(image.report.count("ray without a direction"), 64U);
    EXPECT_EQ(image.count(TexelState::baked), 64U);
    for (const float height : image.heights)
        EXPECT_NEAR(height, 0.25F, 1e-6F);
}

TEST(Bake, AutoSamplesTexelsWhoseFirstSamplesDiffer) {
    const Mesh high = gentle_waves(64);
    BakeOptions options = sized(16, 16);
    const BakedImage one = bake({high}, make_quad(), options);
    EXPECT_EQ(one.result.samples, 256U);
    options.map.samples = 16;
    const BakedImage many = bake({high}, make_quad(), options);
    EXPECT_EQ(many.result.samples, 16U * 256U);
    options.map.sample_angle = 0.0;
    const BakedImage all = bake({high}, make_quad(), options);
    EXPECT_EQ(all.result.samples, 16U * 256U);
    options.map.sample_angle = 3.2;
    EXPECT_THROW(bake({high}, make_quad(), options), InvalidInput);
    options.map.sample_angle = 3.1;
    EXPECT_EQ(bake({high}, make_quad(), options).result.samples, 4U * 256U);
    options.map.sample_angle = 0.12;
    const BakedImage some = bake({high}, make_quad(), options);
    EXPECT_GT(some.result.samples, 5U * 256U);
    EXPECT_LT(some.result.samples, 15U * 256U);
    // The reference is the mean of the normals of 16 x 16 texels of a map of 256 x 256.
    options = sized(256, 256);
    const BakedImage fine = bake({high}, make_quad(), options);
    const auto error = [&](const BakedImage& image) {
        double sum = 0.0;
        for (std::size_t texel = 0; texel < 256; ++texel) {
            glm::dvec3 reference(0.0);
            for (std::size_t i = 0; i < 256; ++i)
                reference +=
                    fine.normal((texel / 16 * 16 + i / 16) * 256 + texel % 16 * 16 + i % 16);
            sum += degrees_between(image.normal(texel), reference);
        }
        return sum / 256;
    };
    EXPECT_LT(error(many), 0.25 * error(one));
    EXPECT_LT(error(some), 0.5 * error(one));
}

TEST(Bake, RefusesInvalidInput) {
    Mesh bare = make_quad();
    bare.texcoords.clear();
    EXPECT_EQ(test::message_of<InvalidInput>([&] { bake({make_quad()}, bare, sized(4, 4)); }),
              "the low mesh has no texture coordinates");
    BakeOptions options = sized(4, 4);
    options.map.samples = 3;
    EXPECT_EQ(test::message_of<InvalidInput>([&] { bake({make_quad()}, make_quad(), options); }),
              "the number of samples is 3, but must be 1, 4, 16, 64, 256 or 1024");
    options = sized(4, 4);
    options.offset = -1.0;
    EXPECT_EQ(test::message_of<InvalidInput>([&] { bake({make_quad()}, make_quad(), options); }),
              "the offset is -1, but must be finite and at least 0");
    EXPECT_THROW(bake({make_quad()}, make_quad(), sized(0, 4)), InvalidInput);
}

constexpr int sphere_map_side = 128;

Mesh bumpy_sphere(int stacks) {
    Mesh mesh = make_sphere(2 * stacks, stacks);
    mesh.texcoords.clear();
    for (glm::vec3& position : mesh.positions) {
        const double longitude = std::atan2(position.x, position.z);
        const double polar = std::acos(std::clamp(double{position.y}, -1.0, 1.0));
        position *=
            static_cast<float>(1.0 + 0.02 * std::sin(12.0 * longitude) * std::sin(12.0 * polar));
    }
    Report report;
    mesh.normals = vertex_normals(mesh.positions, mesh.triangles, NormalWeight::angle, report);
    return mesh;
}

/// Returns the interpolated normal of the high mesh at the outermost hit of a ray, by a search over
/// all triangles.
glm::dvec3 reference(const Mesh& high, const glm::dvec3& origin, const glm::dvec3& direction) {
    double nearest = 1e30;
    glm::dvec3 normal(0.0);
    for (const glm::uvec3& t : high.triangles) {
        const glm::dvec3 a(high.positions[t.x]), e(glm::dvec3(high.positions[t.y]) - a),
            f(glm::dvec3(high.positions[t.z]) - a);
        const glm::dvec3 p = glm::cross(direction, f);
        const double determinant = glm::dot(e, p);
        if (determinant == 0.0) continue;
        const glm::dvec3 s = origin - a;
        const double u = glm::dot(s, p) / determinant;
        const glm::dvec3 q = glm::cross(s, e);
        const double v = glm::dot(direction, q) / determinant;
        const double distance = glm::dot(f, q) / determinant;
        if (u < -1e-12 || v < -1e-12 || u + v > 1.0 + 1e-12 || distance < 0.0 || distance > nearest)
            continue;
        nearest = distance;
        normal = (1.0 - u - v) * glm::dvec3(high.normals[t.x]) + u * glm::dvec3(high.normals[t.y]) +
                 v * glm::dvec3(high.normals[t.z]);
    }
    return normal;
}

struct Errors {
    double mean = 0.0;
    double largest = 0.0;
};

/// Returns the errors of a map as a shader reads it, with decoded codes in the basis of the low
/// mesh.
Errors errors_of(const Mesh& high, const Mesh& low, const BakedImage& baked, int bits) {
    Image normals = make_image(sphere_map_side, sphere_map_side, 3, 32, ColorSpace::data);
    std::copy(baked.normals.begin(), baked.normals.end(), normals.as<float>().begin());
    Report report;
    const NormalMapFormat format{.bits = bits};
    const Image decoded = decode_normal_map(encode_normal_map(normals, format, report),
                                            format.green, format.flat, report);
    const Image object = object_from_tangent(decoded, low, {}, report).normals;
    const std::vector<glm::vec3> averaged =
        vertex_normals(low.positions, low.triangles, NormalWeight::angle, report);
    Errors errors;
    std::size_t count = 0;
    cover_texels(
        low.texcoords, low.triangles, {.width = sphere_map_side, .height = sphere_map_side},
        [&](int first_row, std::span<const CoveredTexel> texels) {
            for (std::size_t i = 0; i < texels.size(); i += 37) {
                if (!texels[i].is_covered()) continue;
                const glm::uvec3 corners = low.triangles[texels[i].triangle];
                glm::dvec3 point(0.0), outward(0.0);
                for (int corner = 0; corner < 3; ++corner) {
                    const double weight = texels[i].weights()[corner];
                    point += weight * glm::dvec3(low.positions[corners[corner]]);
                    outward += weight * glm::dvec3(averaged[corners[corner]]);
                }
                outward = glm::normalize(outward);
                const std::size_t texel = static_cast<std::size_t>(first_row) * sphere_map_side + i;
                const float* n = &object.as<float>()[3 * texel];
                const double error = degrees_between(
                    glm::dvec3(n[0], n[1], n[2]), reference(high, point + 0.1 * outward, -outward));
                static std::mutex mutex;
                const std::lock_guard lock(mutex);
                errors.mean += error;
                errors.largest = std::max(errors.largest, error);
                ++count;
            }
        },
        report);
    EXPECT_GT(count, 400U);
    errors.mean /= static_cast<double>(count);
    return errors;
}

TEST_LABELS(not_sanitized);
TEST(BakeSphere, HasTheHighNormalsWithinRounding) {
    const Mesh high = bumpy_sphere(100);
    Report report;
    const Mesh low =
        with_frames(make_sphere(46, 23), {.tangents = TangentMethod::mikktspace}, report).mesh;
    const BakedImage baked = bake({high}, low, sized(sphere_map_side, sphere_map_side));
    EXPECT_EQ(baked.result.texels_missed, 0U);
    // The bumps have 2% of the radius, and the facets of the sphere lie up to 0.7% inside. The bake
    // found all of it.
    EXPECT_GT(baked.result.max_height, 0.02);
    EXPECT_LT(baked.result.min_height, -0.015);
    const Errors fine = errors_of(high, low, baked, 16);
    EXPECT_LT(fine.mean, 0.005);
    EXPECT_LT(fine.largest, 0.05);
    const Errors coarse = errors_of(high, low, baked, 8);
    EXPECT_LT(coarse.mean, 0.2);
}

}  // namespace
}  // namespace relief

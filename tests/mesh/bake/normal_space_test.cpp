// SPDX-License-Identifier: Apache-2.0
// Tangent space to object space and back: exact inverses of each other, and on a sphere what is
// known of it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "relief/mesh/analytic_heights.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/error.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normal_space.h"
#include "relief/mesh/shapes.h"
#include "relief/mesh/threads.h"
#include "support/message_of.h"

namespace relief {
namespace {

Mesh framed(Mesh mesh) {
    Report report;
    return with_frames(std::move(mesh), {.tangents = TangentMode::mikktspace}, report).mesh;
}

Image flat_map(int width, int height) {
    Image normals = make_image(width, height, 3, 32, ColorSpace::data);
    for (std::size_t i = 2; i < normals.sample_count(); i += 3)
        normals.as<float>()[i] = 1.0F;
    return normals;
}

Image hills(int width, int height) {
    Report report;
    return normals_from_height(
        wave_heights(width, height, tiling_waves(width, height, 8, 8.0, 0.5, 3)).heights,
        {Kernel::central3, Wrap::repeat, 1.0}, report);
}

glm::dvec3 at(const Image& normals, std::size_t texel) {
    const std::span<const float> n = normals.as<float>();
    return {n[texel * 3], n[texel * 3 + 1], n[texel * 3 + 2]};
}

/// Outward on a sphere, at a texel's centre: shapes.h says how u and v run.
glm::dvec3 outward(int column, int row, int width, int height) {
    const double longitude = 2.0 * std::numbers::pi * (column + 0.5) / width;
    const double polar = std::numbers::pi * (row + 0.5) / height;
    return {std::sin(longitude) * std::sin(polar), std::cos(polar),
            std::cos(longitude) * std::sin(polar)};
}

TEST(NormalSpace, MakesOfAFlatMapTheNormalsOfASphere) {
    // Facets of 5.6 and 2.8 degrees; the poles' own, whose texture is not their shape, left out.
    const auto largest_error = [](int slices) {
        Report report;
        const ConvertedNormals object = object_from_tangent(
            flat_map(512, 256), framed(make_sphere(slices, slices / 2)), {}, report);
        EXPECT_TRUE(report.empty());
        EXPECT_EQ(object.coverage.inside, 512U * 256U);
        double largest = 0.0;
        for (int row = 64; row < 192; ++row) {
            for (int column = 0; column < 512; ++column) {
                const auto texel = static_cast<std::size_t>(row * 512 + column);
                largest = std::max(largest, degrees_between(at(object.normals, texel),
                                                            outward(column, row, 512, 256)));
            }
        }
        return largest;
    };
    const double coarse = largest_error(64);
    EXPECT_LT(coarse, 0.1);
    // Of second order: linear interpolation.
    EXPECT_NEAR(coarse / largest_error(128), 4.0, 0.3);
}

TEST(NormalSpace, ThereAndBackIsTheSameMap) {
    for (const Mesh& mesh : {framed(make_sphere(24, 12)), framed(make_torus()), framed(make_quad()),
                             framed(make_cube())}) {
        const Image map = hills(200, 96);
        Report report;
        const ConvertedNormals object = object_from_tangent(map, mesh, {}, report);
        const ConvertedNormals back = tangent_from_object(object.normals, mesh, {}, report);
        EXPECT_EQ(report.count("texel without a frame"), 0U);
        EXPECT_EQ(report.count("normal behind the surface"), 0U);
        double worst = 0.0;
        for (std::size_t texel = 0; texel < 200UL * 96UL; ++texel)
            worst = std::max(worst, degrees_between(at(back.normals, texel), at(map, texel)));
        // 16-bit codes of a normal are 0.003 degrees apart.
        EXPECT_LT(worst, 1e-4);
    }
}

TEST(NormalSpace, TurnsAQuadsMapByItsOwnAxes) {
    // The image upright on the square in the xy plane: object space is tangent space.
    const Image map = hills(64, 64);
    Report report;
    const Mesh quad = framed(make_quad());
    const ConvertedNormals object = object_from_tangent(map, quad, {}, report);
    for (std::size_t texel = 0; texel < 64UL * 64UL; ++texel)
        EXPECT_LT(degrees_between(at(object.normals, texel), at(map, texel)), 1e-5);
    // Mirrored: x turns round.
    Mesh mirrored = make_quad();
    for (glm::vec2& texcoord : mirrored.texcoords)
        texcoord.x = 1.0F - texcoord.x;
    const ConvertedNormals other = object_from_tangent(map, framed(mirrored), {}, report);
    for (std::size_t texel = 0; texel < 64UL * 64UL; ++texel) {
        const glm::dvec3 n = at(map, texel);
        EXPECT_LT(degrees_between(at(other.normals, texel), {-n.x, n.y, n.z}), 1e-5);
    }
    EXPECT_TRUE(report.empty());
}

TEST(NormalSpace, CountsWhereThereIsNoMeshNoFrameAndNoNormal) {
    Mesh quad = framed(make_quad());
    for (glm::vec2& texcoord : quad.texcoords)
        texcoord *= 0.5F;
    Image map = flat_map(16, 16);
    map.as<float>()[17 * 3 + 2] = 0.0F;
    Report report;
    const ConvertedNormals object = object_from_tangent(map, quad, {}, report);
    EXPECT_EQ(object.coverage.empty, 256U - 64U);
    EXPECT_EQ(report.count("normal without direction"), 1U);
    EXPECT_EQ(at(object.normals, 255), glm::dvec3(0, 0, 1));
    for (glm::vec4& tangent : quad.tangents)
        tangent = glm::vec4(0, 0, 1, 1);
    Report other;
    tangent_from_object(map, quad, {}, other);
    EXPECT_EQ(other.count("texel without a frame"), 64U);
    // A map of another mesh: it faces the other way.
    for (std::size_t i = 2; i < map.sample_count(); i += 3)
        map.as<float>()[i] = -1.0F;
    Report behind;
    tangent_from_object(map, framed(make_quad()), {}, behind);
    EXPECT_EQ(behind.count("normal behind the surface"), 256U);
}

TEST(NormalSpace, IsTheSameForAnyNumberOfThreads) {
    const Mesh sphere = framed(make_sphere(24, 12));
    Report one_report, many_report;
    set_thread_limit(1);
    const ConvertedNormals one = object_from_tangent(hills(150, 300), sphere, {}, one_report);
    set_thread_limit(0);
    const ConvertedNormals many = object_from_tangent(hills(150, 300), sphere, {}, many_report);
    EXPECT_TRUE(std::ranges::equal(one.normals.as<float>(), many.normals.as<float>()));
    EXPECT_TRUE(std::ranges::equal(one_report.findings(), many_report.findings()));
}

TEST(NormalSpace, RefusesMeshesWithoutFrames) {
    Report report;
    const auto message = [&](const Image& map, const Mesh& mesh) {
        return test::message_of<InvalidInput>([&] { object_from_tangent(map, mesh, {}, report); });
    };
    EXPECT_EQ(message(Image{}, make_quad()), "an empty image holds no normals");
    EXPECT_EQ(message(flat_map(4, 4), make_quad()), "the mesh has no tangents");
    Mesh bare = framed(make_quad());
    bare.texcoords.clear();
    EXPECT_EQ(message(flat_map(4, 4), bare), "the mesh has no texture coordinates");
}

}  // namespace
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Thickness against closed forms: slabs, a sphere, and open surfaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/mesh.h"

namespace relief {
namespace {

using test::bake;
using test::BakedImage;
using test::moved;
using test::sized;

BakeOptions thickness_options(int width, int height, int rays, std::optional<double> distance) {
    BakeOptions options = sized(width, height);
    options.map.layers = {.normals = false,
                          .thickness = ThicknessOptions{.rays = rays, .distance = distance}};
    options.offset = options.max_distance = 0.01;
    options.allow_size_mismatch = true;
    return options;
}

/// A plate of 200 x 200 between z = -thickness and z = 0.
Mesh slab(float thickness) {
    Mesh top = moved(make_quad(), 100.0F, glm::vec3(0.0F));
    Mesh mesh = top;
    for (const glm::vec3& position : top.positions)
        mesh.positions.push_back(position - glm::vec3(0.0F, 0.0F, thickness));
    for (const glm::uvec3& t : top.triangles)
        mesh.triangles.emplace_back(t.x + 4, t.z + 4, t.y + 4);
    mesh.normals.clear();
    mesh.texcoords.clear();
    mesh.tangents.clear();
    return mesh;
}

Mesh turned_over(Mesh mesh) {
    for (glm::uvec3& triangle : mesh.triangles)
        std::swap(triangle.y, triangle.z);
    for (glm::vec3& normal : mesh.normals)
        normal = -normal;
    return mesh;
}

/// A ray at the angle a from the normal of a slab of thickness t meets its other side at t / cos a.
/// With v = cos^2 a, which is uniform in [0, 1], and rays of length l, the mean is the integral of
/// t / sqrt(v) from (t/l)^2 to 1, and l for smaller v: 2 t - t^2 / l.
double slab_mean(double t, double l) {
    return t < l ? 2.0 * t - t * t / l : l;
}

TEST(Thickness, OfASlabIsItsClosedForm) {
    for (const auto& [thickness, limit] :
         {std::pair(0.25, 10.0), {0.25, 0.5}, {1.0, 1.25}, {1.0, 0.5}}) {
        for (const int rays : {64, 1024}) {
            const BakedImage image = bake({slab(static_cast<float>(thickness))}, make_quad(),
                                          thickness_options(4, 4, rays, limit));
            EXPECT_EQ(image.result.thickness_rays, 16U * static_cast<std::size_t>(rays));
            // One v is in each interval of 1 / rays, and distances are monotone in v, so that the
            // error is at most their range divided by the rays. The rays start 4e-6 of half of the
            // size, 100, below the surface.
            const double tolerance = std::max(limit - thickness, 0.0) / rays + 0.001;
            for (const float here : image.thickness)
                EXPECT_NEAR(here, slab_mean(thickness, limit), tolerance) << thickness << limit;
            const bool is_reached = thickness < limit;
            EXPECT_EQ(image.report.count("texel without a surface behind it"),
                      is_reached ? 0U : 16U);
        }
    }
}

TEST(Thickness, OfASphereIsTwoThirdsOfItsDiameter) {
    // A chord at the angle a from the normal has the length 2 r cos a, whose mean is 4 r / 3.
    BakeOptions options = thickness_options(24, 12, 256, {});
    options.offset = options.max_distance = 0.5;
    const Mesh high = moved(make_sphere(256, 128), 2.5F, {3, 4, 5});
    const BakedImage image = bake({high}, moved(make_sphere(32, 16), 2.5F, {3, 4, 5}), options);
    for (std::size_t i = 0; i < image.thickness.size(); ++i) {
        if (image.states[i] != TexelState::baked) continue;
        // The range of 5, divided by the rays; the facets change chords by 5 (pi / 256)^2.
        EXPECT_NEAR(image.thickness[i], 10.0 / 3.0, 5.0 / 256.0 + 0.001) << i;
    }
    EXPECT_EQ(image.report.count("texel without a surface behind it"), 0U);
    // Chords along the surface leave it at once; none is longer than the box.
    EXPECT_EQ(image.result.open_thickness_rays, 0U);
}

TEST(Thickness, SamplesDivideTheRaysOfATexel) {
    BakeOptions options = thickness_options(4, 4, 256, 1.0);
    options.map.samples = 16;
    const BakedImage image = bake({slab(0.25F)}, make_quad(), options);
    EXPECT_EQ(image.result.thickness_rays, 16U * 256U);
    for (const float here : image.thickness)
        EXPECT_NEAR(here, slab_mean(0.25, 1.0), 0.75 / 256.0 + 0.001);
}

TEST(Thickness, OfAnOpenSurfaceIsTheLengthOfTheRays) {
    BakeOptions options = thickness_options(4, 4, 16, 3.0);
    const BakedImage image = bake({make_quad()}, make_quad(), options);
    for (const float here : image.thickness)
        EXPECT_EQ(here, 3.0F);
    EXPECT_EQ(image.report.count("texel without a surface behind it"), 16U);
    EXPECT_EQ(image.result.open_thickness_rays, image.result.thickness_rays);
    // The longest side of the box is the default length.
    options.map.layers.thickness->distance.reset();
    EXPECT_EQ(bake({make_quad()}, make_quad(), options).thickness[0], 2.0F);
    const Baker baker(std::vector<Mesh>{make_quad()}, make_quad(), options);
    EXPECT_EQ(baker.bounds(options.map.layers).thickness, 2.0);
}

TEST(Thickness, DoesNotExceedTheLengthOfTheRays) {
    // Neither the float of the length nor the mean of seven rays does.
    for (const double length : {0.1, 1.9, 1.0 / 3.0}) {
        const BakedImage image =
            bake({make_quad()}, make_quad(), thickness_options(8, 8, 7, length));
        for (const float here : image.thickness) {
            EXPECT_LE(static_cast<double>(here), length);
            EXPECT_NEAR(here, length, 1e-7 * length + 1e-8);
        }
    }
}

TEST(Thickness, OfInsideOutPartsIsThatOfTheOthers) {
    BakeOptions options = thickness_options(4, 4, 64, 1.0);
    const BakedImage image = bake({slab(0.25F)}, make_quad(), options);
    options.back_faces = BackFaces::take;
    const BakedImage turned = bake({turned_over(slab(0.25F))}, make_quad(), options);
    for (std::size_t i = 0; i < 16; ++i)
        EXPECT_NEAR(turned.thickness[i], image.thickness[i], 1e-5);
}

TEST(Thickness, EndsAtAnySideOfASurface) {
    // A plate inside of the slab faces the rays.
    const Mesh plate = moved(make_quad(), 100.0F, {0, 0, -0.125F});
    for (const Mesh& inner : {plate, turned_over(plate)}) {
        const BakedImage image =
            bake({slab(0.25F), inner}, make_quad(), thickness_options(2, 2, 256, 1.0));
        for (const float here : image.thickness)
            EXPECT_NEAR(here, slab_mean(0.125, 1.0), 0.875 / 256.0 + 0.001);
    }
}

TEST(Thickness, IsAShareOfItsRangeInFiles) {
    const std::vector<float> values = {0.0F, 1.0F, 2.0F, 5.0F};
    const std::vector<TexelState> states(4, TexelState::baked);
    const LayerCoding coding{.kind = LayerKind::thickness, .bits = 8, .range = 2.0};
    Report report;
    const std::vector<std::byte> codes = encode_layer(values, states, coding, false, 0, report);
    EXPECT_EQ(codes, (std::vector<std::byte>{std::byte{0}, std::byte{128}, std::byte{255},
                                             std::byte{255}}));
    EXPECT_EQ(report.count("thickness outside the range of its file"), 1U);
    EXPECT_EQ(layer_metadata(coding).at("relief:range"), "2");
    EXPECT_EQ(layer_metadata(coding).at("relief:content"), "thickness");
    EXPECT_EQ(coding.channels(), 1U);
}

}  // namespace
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Plain code is right where nothing is hard, and is what it is said to be where something is.
#include "stability/plain_code.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bump/bump_methods.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/shapes.h"
#include "relief/mesh/tangents.h"

namespace relief {
namespace {

TEST(PlainNormals, OfATorusAreNearlyThoseOfItsFormula) {
    const Mesh torus = make_torus();
    for (const auto& normals : {plain_area_normals(torus), plain_angle_normals(torus)}) {
        ASSERT_EQ(normals.size(), torus.positions.size());
        double worst = 0.0;
        for (std::size_t v = 0; v < normals.size(); ++v)
            worst = std::max(worst,
                             degrees_between(glm::dvec3(normals[v]), glm::dvec3(torus.normals[v])));
        // At the seam, which is not welded, half of the triangles are missing.
        EXPECT_LT(worst, 4.5);
    }
}

TEST(PlainNormals, VanishWhereAProductLeavesFloat) {
    Mesh quad = make_quad();
    for (glm::vec3& position : quad.positions)
        position *= 1e-25F;
    EXPECT_TRUE(std::isnan(plain_area_normals(quad).front().z));
    EXPECT_TRUE(std::isnan(plain_angle_normals(quad).front().z));
}

TEST(PlainTangents, AreThoseOfTheTexture) {
    for (const Mesh& mesh : {make_quad(3), make_torus()}) {
        Report report;
        const std::vector<glm::vec4> expected =
            lengyel_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, report);
        const std::vector<glm::vec4> found = plain_tangents(mesh);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            // lengyel_tangents() welds the torus's seam.
            EXPECT_LT(degrees_between(glm::dvec3(found[i]), glm::dvec3(expected[i])), 0.5) << i;
            EXPECT_EQ(found[i].w, expected[i].w);
        }
    }
}

TEST(PlainSobel, IsSobelAwayFromTheBorder) {
    const WaveMap wave = oblique_wave(48, 16.0, 32);
    BumpOptions options = wave.options;
    options.kernel = Kernel::sobel3;
    Report report;
    const Image expected = normals_from_height(wave.heights, options, report);
    const Image found = plain_sobel_normals(wave.heights, 1.0F);
    for (int y = 1; y < 47; ++y) {
        for (int x = 1; x < 47; ++x) {
            const auto at = [&](const Image& map) {
                const float* const n = &map.as<float>()[static_cast<std::size_t>(3 * (y * 48 + x))];
                return glm::dvec3(n[0], n[1], n[2]);
            };
            EXPECT_LT(degrees_between(at(found), at(expected)), 1e-4) << x << ", " << y;
        }
    }
}

}  // namespace
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// The agreement of high and low surfaces: scales and shifts are named, and pairs that fit are not
// suspected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/topology.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::moved;
using testing::HasSubstr;

/// A torus with waves across the tube, whose box is not symmetric.
Mesh high_torus() {
    Mesh mesh = make_torus(0.4F, 96, 48);
    for (glm::vec3& p : mesh.positions)
        p += 0.02F * std::sin(9.0F * p.y + 3.0F * p.x) * glm::vec3(p.x, 1.0F, p.z);
    mesh.normals.clear();
    mesh.tangents.clear();
    return mesh;
}

Mesh low_torus() {
    return make_torus(0.4F, 24, 12);
}

struct Comparison {
    BakeAgreement agreement;
    std::vector<Finding> findings;

    /// Returns the findings about the agreement.
    [[nodiscard]] std::string text() const {
        std::string all;
        for (const Finding& finding : findings) {
            if (finding.element == "model") all += to_string(finding) + "\n";
        }
        return all;
    }
};

Comparison compare(const std::vector<Mesh>& high, const Mesh& low,
                   const BakeOptions& options = {}) {
    Report report;
    const Baker baker(high, low, options, report);
    const auto findings = report.findings();
    return {baker.agreement(), {findings.begin(), findings.end()}};
}

TEST(BakeAgreement, PairsThatFitHaveNoFinding) {
    const Comparison pair = compare({high_torus()}, low_torus());
    EXPECT_EQ(pair.text(), "");
    EXPECT_EQ(pair.agreement.samples, 1024U);
    EXPECT_EQ(pair.agreement.missed, 0U);
    EXPECT_LT(pair.agreement.mean_angle, 0.3);
    EXPECT_LT(pair.agreement.median_distance, 0.03 * pair.agreement.half_diagonal);
    EXPECT_EQ(compare({low_torus()}, low_torus()).agreement.mean_angle, 0.0);
}

TEST(BakeAgreement, ScalesAreNamedWithTheirUnits) {
    for (const auto& [scale, text] :
         {std::pair(2.0F, "times as large as the low one"),
          std::pair(2.54F, "is the high model in centimeters and the low one in inches?"),
          std::pair(3.28F, "is the high model in feet and the low one in meters?"),
          std::pair(0.5F, "times as small as the low one")}) {
        for (const glm::vec3& by : {glm::vec3(0.0F), glm::vec3(0.5F, 0.2F, 0.0F)}) {
            // Scaled about the origin, which is not the center.
            const Comparison pair =
                compare({moved(moved(high_torus(), 1.0F, by), scale, glm::vec3(0.0F))},
                        moved(low_torus(), 1.0F, by));
            EXPECT_THAT(pair.text(), HasSubstr("high model of another size")) << scale;
            EXPECT_THAT(pair.text(), HasSubstr(text)) << scale;
            ASSERT_TRUE(pair.agreement.correction.has_value());
            EXPECT_NEAR(pair.agreement.correction->scale / scale, 1.0, 0.04);
            EXPECT_LT(pair.agreement.correction->mean_angle, 0.3);
        }
    }
    BakeOptions options;
    options.allow_size_mismatch = true;
    const std::vector<Mesh> large = {moved(high_torus(), 2.0F, glm::vec3(0.0F))};
    EXPECT_EQ(compare(large, low_torus(), options).text(), "");
}

TEST(BakeAgreement, ShiftsAreNamed) {
    for (const glm::vec3& shift :
         {glm::vec3(0.3F, 0.0F, 0.0F), {0.0F, -0.3F, 0.0F}, {0.1F, 0.2F, -0.1F}}) {
        const Comparison pair = compare({moved(high_torus(), 1.0F, shift)}, low_torus());
        EXPECT_THAT(pair.text(),
                    HasSubstr("high model at another position (model 0): is moved by ("));
        ASSERT_TRUE(pair.agreement.correction.has_value()) << shift.x;
        EXPECT_LT(glm::distance(pair.agreement.correction->shift, glm::dvec3(shift)), 0.05);
    }
}

TEST(BakeAgreement, OtherDifferencesAreNotTakenForAScaleOrAShift) {
    const Mesh high = high_torus();
    // Floating parts far away, which enlarge the box.
    const Mesh floater = moved(make_sphere(16, 8), 0.05F, {2.5F, 0.5F, 0.0F});
    EXPECT_EQ(compare({high, floater}, low_torus()).text(), "");
    // Half of the high model is missing.
    Mesh half = high;
    std::erase_if(half.triangles,
                  [&](const glm::uvec3& t) { return half.positions[t.x].x < 0.0F; });
    EXPECT_EQ(compare({half}, low_torus()).text(), "");
    // Concentric spheres and parallel planes have the same normals at any distance.
    EXPECT_EQ(compare({moved(make_sphere(), 2.0F, glm::vec3(0.0F))}, make_sphere(16, 8)).text(),
              "");
    EXPECT_EQ(compare({moved(make_quad(4), 1.0F, {0.0F, 0.0F, 0.2F})}, make_quad()).text(), "");
    // A coarse low model.
    EXPECT_EQ(compare({high}, make_torus(0.4F, 8, 5)).text(), "");
}

TEST(BakeAgreement, UnrelatedModelsAreReported) {
    Mesh cubes;
    for (int i = 0; i < 64; ++i) {
        const glm::vec3 center = 0.5F * glm::vec3(i % 4, i / 4 % 4, i / 16) - 0.75F;
        const Mesh cube = moved(make_cube(), 0.12F, center);
        const auto first = static_cast<std::uint32_t>(cubes.positions.size());
        cubes.positions.insert(cubes.positions.end(), cube.positions.begin(), cube.positions.end());
        for (const glm::uvec3& t : cube.triangles)
            cubes.triangles.push_back(t + first);
    }
    EXPECT_THAT(compare({cubes}, low_torus()).text(), HasSubstr("surfaces that do not agree"));
}

TEST(BakeAgreement, PartsAreJudgedTogether) {
    // Two tori of which each sees its own high mesh, both scaled by 2.
    Mesh low = low_torus();
    const Mesh second = moved(low_torus(), 1.0F, {4.0F, 0.0F, 0.0F});
    const auto count = static_cast<std::uint32_t>(low.triangles.size());
    const auto first = static_cast<std::uint32_t>(low.positions.size());
    low.positions.insert(low.positions.end(), second.positions.begin(), second.positions.end());
    low.texcoords.insert(low.texcoords.end(), second.texcoords.begin(), second.texcoords.end());
    low.normals.insert(low.normals.end(), second.normals.begin(), second.normals.end());
    low.tangents.clear();
    for (std::uint32_t t = 0; t < count; ++t)
        low.triangles.push_back(low.triangles[t] + first);
    low.material_ranges.clear();
    const std::vector<Mesh> near = {moved(high_torus(), 2.0F, glm::vec3(0.0F))};
    const std::vector<Mesh> far = {moved(high_torus(), 2.0F, {8.0F, 0.0F, 0.0F})};
    std::vector<BakePart> parts = {{near, {}, "near"}, {far, {}, "far"}};
    for (std::uint32_t t = 0; t < 2 * count; ++t)
        parts[t / count].triangles.push_back(t);
    Report report;
    const Baker baker(parts, low, {}, report);
    EXPECT_EQ(report.count("high model of another size"), 1U);
    ASSERT_TRUE(baker.agreement().correction.has_value());
    EXPECT_NEAR(baker.agreement().correction->scale, 2.0, 0.05);
}

TEST(BakeAgreement, AMapWithoutACoveredTexelIsReported) {
    Mesh low = make_quad();
    for (glm::vec2& texcoord : low.texcoords)
        texcoord += glm::vec2(3.0F, 0.0F);
    const test::BakedImage map = test::bake({make_quad()}, low, test::sized(8, 8));
    EXPECT_EQ(map.report.count("map without a covered texel"), 1U);
    EXPECT_EQ(map.result.texels_baked + map.result.texels_missed, 0U);
}

}  // namespace
}  // namespace relief

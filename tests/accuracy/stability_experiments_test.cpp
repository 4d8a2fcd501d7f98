// SPDX-License-Identifier: Apache-2.0
// Sweeps computed by hand; hard triangles, needles and textbook code against exact results.
#include "experiment_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "experiment_checks.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/tangents.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

TEST(Sweeps, FindTheFailurePointOfEachMethod) {
    const SweptErrors found =
        measured_sweeps({"good", "growing", "lost"}, 1.0,
                        {{"size", "Larger", "size", 6, 2, [](std::size_t method, double value) {
                              if (method == 0) return std::vector<float>{0.25F, 0.25F};
                              if (method == 1)
                                  return std::vector<float>{static_cast<float>(1e-3 * value)};
                              return std::vector<float>{0.0F, value > 50.0 ? NAN : 0.5F};
                          }}});
    EXPECT_EQ(found.errors[0].count, 8U);
    EXPECT_EQ(found.errors[2].undefined, 3U);
    ASSERT_EQ(found.charts.size(), 1U);
    const std::vector<Curve>& curves = found.charts.front().curves;
    ASSERT_EQ(curves[0].points.size(), 4U);
    EXPECT_EQ(curves[0].points[1].x, 100.0);
    EXPECT_NEAR(curves[0].points[3].error, 0.25, 1e-7);
    EXPECT_FALSE(curves[0].breaks_at);
    EXPECT_EQ(curves[1].breaks_at, 1e4) << "0.1 degrees at 100";
    EXPECT_EQ(curves[2].breaks_at, 100.0);
    EXPECT_TRUE(std::isnan(curves[2].points[1].error)) << "half a result is none";
    EXPECT_EQ(found.breaks,
              "Larger (size): lost fails from 100 on, growing fails from 1e+04 on, all others are "
              "within the limit.");
}

TEST(Sweeps, SayThatAllAreWithinTheLimitOrNone) {
    const SweptErrors found =
        measured_sweeps({"a", "b"}, 1.0,
                        {{"x", "Good", "x", 1, 1, [](auto, auto) { return std::vector{0.5F}; }},
                         {"y", "Bad", "y", 1, 1, [](auto, auto) { return std::vector{5.0F}; }}});
    EXPECT_EQ(found.breaks,
              "Good (x): all are within the limit. Bad (y): a and b fail from 1 on, none is within "
              "the limit everywhere.");
}

Mesh sound_torus() {
    return make_torus(0.4F, 24, 12);
}

TEST(HardTriangles, AreAddedToTheUnchangedMesh) {
    const Mesh sound = sound_torus();
    for (const HardTriangleName& one : hard_triangle_names) {
        SCOPED_TRACE(one.id);
        const Mesh hard = with_hard_triangles(sound, one.kind, 10);
        ASSERT_EQ(hard.triangles.size(), sound.triangles.size() + 10);
        for (std::size_t t = 0; t < sound.triangles.size(); ++t)
            EXPECT_EQ(hard.triangles[t], sound.triangles[t]);
        for (std::size_t v = 0; v < sound.positions.size(); ++v)
            EXPECT_EQ(hard.positions[v], sound.positions[v]);
        EXPECT_NO_THROW(validate(hard));
    }
    EXPECT_EQ(with_hard_triangles(sound, HardTriangle::back, 100000).triangles.size(),
              2 * sound.triangles.size());
}

TEST(HardTriangles, HaveTheNamedDefects) {
    const Mesh sound = sound_torus();
    const auto last = [&](HardTriangle kind) {
        const Mesh hard = with_hard_triangles(sound, kind, 3);
        const glm::uvec3& t = hard.triangles.back();
        return std::array{hard.positions[t.x], hard.positions[t.y], hard.positions[t.z]};
    };
    EXPECT_EQ(last(HardTriangle::collapsed)[1], last(HardTriangle::collapsed)[2]);
    EXPECT_EQ(last(HardTriangle::coinciding)[1], last(HardTriangle::coinciding)[2]);
    EXPECT_TRUE(std::isnan(last(HardTriangle::nowhere)[2].x));
    const auto [a, b, middle] = last(HardTriangle::needle);
    // Rounding of the midpoint: half a unit in the last of 24 bits, for coordinates below 2.
    EXPECT_LT(glm::length(glm::cross(b - a, middle - a)) / glm::length(b - a), 2e-7F);
    EXPECT_GT(glm::length(middle - a), 0.4F * glm::length(b - a));
}

__extension__ using Wide = __int128;

/// Coordinates in units of 2^-62, in which floats of 1e-11 and more are integers.
Wide units(float value) {
    return static_cast<Wide>(std::ldexp(static_cast<double>(value), 62));
}

TEST(Needles, HaveTheNormalsThatIntegersGive) {
    for (const double width : {1.0, 1e-3, 1e-6}) {
        const AnalyticMesh needles = make_needles(300, width, 7);
        for (const glm::uvec3& t : needles.mesh.triangles) {
            std::array<std::array<Wide, 3>, 3> p{};
            for (std::size_t corner = 0; corner < 3; ++corner) {
                for (std::size_t i = 0; i < 3; ++i)
                    p.at(corner).at(i) = units(
                        needles.mesh.positions[t[static_cast<int>(corner)]][static_cast<int>(i)]);
            }
            // A quarter of each difference keeps products below 2^127.
            glm::dvec3 normal;
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t j = (i + 1) % 3;
                const std::size_t k = (i + 2) % 3;
                const Wide first = (p[1].at(j) - p[0].at(j)) / 4 * ((p[2].at(k) - p[0].at(k)) / 4);
                const Wide second = (p[1].at(k) - p[0].at(k)) / 4 * ((p[2].at(j) - p[0].at(j)) / 4);
                normal[static_cast<int>(i)] = static_cast<double>(first - second);
            }
            EXPECT_LT(degrees_between(normal, needles.normals[t.x]), 1e-4) << width;
        }
    }
}

TEST(Needles, AreAsNarrowAsAsked) {
    for (const double width : {1e-2, 1e-12}) {
        const AnalyticMesh needles = make_needles(100, width, 3);
        EXPECT_EQ(needles.mesh.positions.size(), 300U);
        for (const glm::uvec3& t : needles.mesh.triangles) {
            std::array<double, 3> sides{};
            for (int i = 0; i < 3; ++i) {
                sides.at(static_cast<std::size_t>(i)) =
                    glm::distance(glm::dvec3(needles.mesh.positions[t[i]]),
                                  glm::dvec3(needles.mesh.positions[t[(i + 1) % 3]]));
            }
            std::sort(sides.begin(), sides.end());
            EXPECT_NEAR(sides[0], width, 1e-6 * width);
            EXPECT_NEAR(sides[2], 1.0, 2.0 * width + 1e-6);
        }
    }
}

TEST(PlainNormals, OfATorusAreCloseToItsFormula) {
    const Mesh torus = make_torus();
    for (const auto& normals : {textbook_area_normals(torus), textbook_angle_normals(torus)}) {
        ASSERT_EQ(normals.size(), torus.positions.size());
        double worst = 0.0;
        for (std::size_t v = 0; v < normals.size(); ++v)
            worst = std::max(worst,
                             degrees_between(glm::dvec3(normals[v]), glm::dvec3(torus.normals[v])));
        // At the seam, which is not welded, half of the triangles are missing.
        EXPECT_LT(worst, 4.5);
    }
}

TEST(PlainNormals, VanishIfAProductUnderflows) {
    Mesh quad = make_quad();
    for (glm::vec3& position : quad.positions)
        position *= 1e-25F;
    EXPECT_TRUE(std::isnan(textbook_area_normals(quad).front().z));
    EXPECT_TRUE(std::isnan(textbook_angle_normals(quad).front().z));
}

TEST(PlainTangents, AreThoseOfTheTexture) {
    for (const Mesh& mesh : {make_quad(3), make_torus()}) {
        Report report;
        const std::vector<glm::vec4> expected =
            lengyel_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, report);
        const std::vector<glm::vec4> found = textbook_tangents(mesh);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            // lengyel_tangents() welds the seam of the torus.
            EXPECT_LT(degrees_between(glm::dvec3(found[i]), glm::dvec3(expected[i])), 0.5) << i;
            EXPECT_EQ(found[i].w, expected[i].w);
        }
    }
}

TEST(PlainSobel, IsSobelAwayFromTheBorder) {
    const BumpField wave = oblique_wave(48, 16.0, 32);
    BumpOptions options = wave.options;
    options.kernel = Kernel::sobel3;
    Report report;
    const Image expected = normals_from_height(wave.heights, options, report);
    const Image found = textbook_sobel_normals(wave.heights, 1.0F);
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
}  // namespace relief::test

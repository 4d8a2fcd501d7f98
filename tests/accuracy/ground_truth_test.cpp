// SPDX-License-Identifier: Apache-2.0
// Reference surfaces and height fields in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace relief {
using namespace relief::accuracy;

namespace {

constexpr AnalyticSurface all_surfaces[] = {AnalyticSurface::sphere, AnalyticSurface::torus,
                                            AnalyticSurface::ellipsoid, AnalyticSurface::saddle,
                                            AnalyticSurface::cubic};

/// Counts the triangles whose back faces the reference normal at their first corner.
std::size_t turned_over(const AnalyticMesh& reference) {
    std::size_t count = 0;
    for (const glm::uvec3& t : reference.mesh.triangles) {
        const glm::dvec3 a(reference.mesh.positions[t.x]);
        const glm::dvec3 normal = glm::cross(glm::dvec3(reference.mesh.positions[t.y]) - a,
                                             glm::dvec3(reference.mesh.positions[t.z]) - a);
        count += glm::dot(normal, reference.normals[t.x]) <= 0.0 ? 1 : 0;
    }
    return count;
}

TEST(AnalyticMesh, FacesItsNormalsExceptAtFolds) {
    for (const AnalyticSurface surface : all_surfaces) {
        for (const Triangulation triangulation :
             {Triangulation::regular, Triangulation::jittered, Triangulation::anisotropic}) {
            EXPECT_EQ(turned_over(analytic_mesh(surface, triangulation, 64, 3)), 0U)
                << static_cast<int>(surface) << " " << static_cast<int>(triangulation);
        }
        const AnalyticMesh folded = analytic_mesh(surface, Triangulation::folded, 64, 3);
        const std::size_t turned = turned_over(folded);
        EXPECT_GT(turned, folded.mesh.triangles.size() / 100);
        EXPECT_LT(turned, folded.mesh.triangles.size() / 4);
    }
}

TEST(AnalyticMesh, InnerVerticesAreSurroundedByTriangles) {
    for (const AnalyticSurface surface : all_surfaces) {
        const AnalyticMesh reference = analytic_mesh(surface, Triangulation::regular, 8, 1);
        validate(reference.mesh);
        std::size_t inner = 0;
        for (const unsigned char is : reference.inner)
            inner += is;
        switch (surface) {
            case AnalyticSurface::torus:
                EXPECT_EQ(inner, 64U);
                EXPECT_EQ(reference.inner.size(), 64U);
                break;
            case AnalyticSurface::sphere:
            case AnalyticSurface::ellipsoid:
                EXPECT_EQ(inner, 8U * 7U);
                break;
            default:
                EXPECT_EQ(inner, 7U * 7U);
        }
    }
    EXPECT_THROW(analytic_mesh(AnalyticSurface::sphere, Triangulation::regular, 3, 1),
                 InvalidInput);
}

TEST(TexturedMesh, HasASeamAndAMirroredFold) {
    const TexturedMesh torus = textured_mesh(AnalyticSurface::torus, Triangulation::jittered,
                                             TextureLayout::upright, 8, 1);
    ASSERT_EQ(torus.mesh.positions.size(), 81U);
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_EQ(torus.mesh.positions[i], torus.mesh.positions[72 + i]);
        EXPECT_EQ(torus.mesh.positions[9 * i], torus.mesh.positions[9 * i + 8]);
        EXPECT_NE(torus.mesh.texcoords[9 * i], torus.mesh.texcoords[9 * i + 8]);
    }
    std::size_t inner = 0;
    for (const unsigned char is : torus.inner)
        inner += is;
    EXPECT_EQ(inner, 49U);

    const TexturedMesh folded = textured_mesh(AnalyticSurface::saddle, Triangulation::jittered,
                                              TextureLayout::mirrored, 8, 1);
    for (std::size_t row = 0; row < 9; ++row)
        EXPECT_EQ(folded.mesh.texcoords[9 * row + 4].x, 1.0F);
    EXPECT_EQ(folded.frame_at({0.4, 0.5}).handedness, 1.0);
    EXPECT_EQ(folded.frame_at({0.6, 0.5}).handedness, -1.0);
    EXPECT_THROW(textured_mesh(AnalyticSurface::saddle, Triangulation::regular,
                               TextureLayout::mirrored, 9, 1),
                 InvalidInput);
}

TEST(BevelledPlate, IsASquareWithAnUprightImageAndShearedOnesAroundIt) {
    const TexturedMesh plate = beveled_plate(0.25);
    validate(plate.mesh);
    ASSERT_EQ(plate.mesh.triangles.size(), 10U);
    EXPECT_EQ(plate.inner, (std::vector<unsigned char>{1, 1, 1, 1, 0, 0, 0, 0}));
    for (std::size_t v = 0; v < 4; ++v) {
        EXPECT_EQ(plate.mesh.normals[v], glm::vec3(0.0F, 0.0F, 1.0F));
        EXPECT_EQ(plate.mesh.positions[v + 4],
                  plate.mesh.positions[v] * 1.25F - glm::vec3(0.0F, 0.0F, 0.25F));
    }
    EXPECT_EQ(plate.mesh.texcoords[0], glm::vec2(0.0F, 1.0F));
    EXPECT_EQ(plate.mesh.texcoords[2], glm::vec2(1.0F, 0.0F));
    // A point outside (1, 1) by 0.25, and as far along the edge: (1, 1.5) of [-1,1]^2.
    EXPECT_EQ(plate.mesh.texcoords[6], glm::vec2(1.0F, -0.25F));
    for (const glm::uvec3& t : plate.mesh.triangles) {
        const glm::vec3 a = plate.mesh.positions[t.x];
        EXPECT_GT(glm::cross(plate.mesh.positions[t.y] - a, plate.mesh.positions[t.z] - a).z, 0.0F);
    }
    EXPECT_THROW(beveled_plate(0.0), InvalidInput);
}

TEST(CubicFan, IsClosedAroundTheOriginAndLevelThere) {
    for (const int valence : {3, 6, 9}) {
        for (std::uint32_t seed = 0; seed < 50; ++seed) {
            const Mesh fan = cubic_fan(valence, seed);
            ASSERT_EQ(fan.triangles.size(), static_cast<std::size_t>(valence));
            EXPECT_EQ(fan.positions[0], glm::vec3(0.0F));
            for (const glm::uvec3& t : fan.triangles) {
                const glm::vec3& a = fan.positions[t.y];
                const glm::vec3& b = fan.positions[t.z];
                EXPECT_GT(a.x * b.y - a.y * b.x, 0.0F) << "seen from above, all turn one way";
            }
        }
    }
    EXPECT_EQ(cubic_fan(5, 9).positions, cubic_fan(5, 9).positions);
    EXPECT_NE(cubic_fan(5, 9).positions, cubic_fan(5, 8).positions);
    EXPECT_THROW(cubic_fan(2, 0), InvalidInput);
}

TEST(AnalyticHeights, TilingWavesRepeatAndHaveTheSlopeAskedFor) {
    const std::vector<HeightWave> waves = tiling_waves(96, 160, 40, 8.0, 0.3, 7);
    ASSERT_EQ(waves.size(), 40U);
    for (const HeightWave& wave : waves) {
        EXPECT_GE(2.0 * std::numbers::pi / glm::length(wave.frequency), 8.0);
        const double across = wave.frequency.x * 96.0 / (2.0 * std::numbers::pi);
        const double along = wave.frequency.y * 160.0 / (2.0 * std::numbers::pi);
        EXPECT_NEAR(across, std::round(across), 1e-9);
        EXPECT_NEAR(along, std::round(along), 1e-9);
    }
    const AnalyticHeights field = wave_heights(96, 160, waves);
    double squares = 0.0;
    for (const glm::dvec3& n : field.normals)
        squares += (n.x * n.x + n.y * n.y) / (n.z * n.z);
    // The sum of similar waves differs slightly from that of independent ones.
    EXPECT_NEAR(std::sqrt(squares / (96.0 * 160.0)), 0.3, 0.05);
    EXPECT_NE(tiling_waves(96, 160, 40, 8.0, 0.3, 8)[0].phase, waves[0].phase);
    EXPECT_THROW(tiling_waves(8, 8, 3, 9.0, 0.3, 1), InvalidInput);
    EXPECT_THROW(tiling_waves(8, 8, 0, 4.0, 0.3, 1), InvalidInput);
}

TEST(AnalyticHeights, CodesFillTheRangeAndStrengthGivesTheTexelsBack) {
    Image heights = make_image(3, 1, 1, 32, ColorSpace::data);
    heights.samples = std::vector<float>{-2.0F, 0.0F, 4.0F};
    const CodedHeights coded = coded_heights(heights, 16);
    EXPECT_EQ(coded.strength, 6.0);
    EXPECT_EQ(coded.codes.as<std::uint16_t>()[0], 0);
    EXPECT_EQ(coded.codes.as<std::uint16_t>()[1], 21845);
    EXPECT_EQ(coded.codes.as<std::uint16_t>()[2], 65535);
    const CodedHeights narrow = coded_heights(heights, 8);
    EXPECT_EQ(narrow.codes.as<std::uint8_t>()[1], 85);
    const CodedHeights flat = coded_heights(make_image(2, 2, 1, 32, ColorSpace::data), 8);
    EXPECT_EQ(flat.strength, 0.0);
    EXPECT_EQ(flat.codes.as<std::uint8_t>()[3], 0);
    EXPECT_THROW(coded_heights(heights, 32), InvalidInput);
}

}  // namespace
}  // namespace relief

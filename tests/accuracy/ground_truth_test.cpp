// SPDX-License-Identifier: Apache-2.0
// Reference surfaces and height fields in closed form, and normals fitted to meshes without a
// formula.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/fitted_normals.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "support/shapes.h"

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

TEST(AnalyticHeights, AWaveHasTheHeightAndTheNormalOfItsFormula) {
    // 3 sin(pi/2 x + pi/4 y): the crest is at (1, 0); at (0, 0), the slopes are 3 pi/2 to the right
    // and 3 pi/4 downwards.
    const HeightWave wave{3.0, {std::numbers::pi / 2.0, std::numbers::pi / 4.0}, 0.0};
    const AnalyticHeights field = wave_heights(4, 3, std::span(&wave, 1));
    EXPECT_FLOAT_EQ(field.heights.as<float>()[1], 3.0F);
    EXPECT_NEAR(field.normals[1].z, 1.0, 1e-15);
    const glm::dvec3 expected(-3.0 * std::numbers::pi / 2.0, 3.0 * std::numbers::pi / 4.0, 1.0);
    EXPECT_LT(degrees_between(field.normals[0], expected), 1e-6);
    EXPECT_NEAR(glm::length(field.normals[7]), 1.0, 1e-15);
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

TEST(AnalyticHeights, ErrorsAreMeasuredWithinTheMargin) {
    const AnalyticHeights flat = wave_heights(4, 4, {});
    Image normals = make_image(4, 4, 3, 32, ColorSpace::data);
    for (std::size_t texel = 0; texel < 16; ++texel)
        normals.as<float>()[3 * texel + 2] = 1.0F;
    normals.as<float>()[0] = 1.0F;  // 45 degrees in the corner.
    EXPECT_NEAR(normal_error(normals, flat).max, 45.0, 1e-6);
    EXPECT_NEAR(normal_error(normals, flat).rms, 45.0 / 4.0, 1e-6);
    EXPECT_EQ(normal_error(normals, flat, 1).max, 0.0);
    EXPECT_EQ(normal_error(normals, flat, 1).count, 4U);
    EXPECT_THROW(normal_error(make_image(4, 3, 3, 32, ColorSpace::data), flat), InvalidInput);
}

/// Returns the RMS error of the fits at inner vertices, in degrees.
double error_of(const FittedNormals& fitted, const AnalyticMesh& reference) {
    double squares = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < fitted.corners.size(); ++i) {
        const std::uint32_t vertex = test::vertex_at(reference.mesh, fitted.corners[i]);
        if (reference.inner[vertex] == 0) continue;
        const double degrees = degrees_between(fitted.normals[i], reference.normals[vertex]);
        squares += degrees * degrees;
        ++count;
    }
    return std::sqrt(squares / static_cast<double>(count));
}

double averaged_error(const AnalyticMesh& reference) {
    Report report;
    const std::vector<glm::vec3> normals = vertex_normals(
        reference.mesh.positions, reference.mesh.triangles, NormalWeight::max, report);
    return direction_error(normals, reference.normals, reference.inner).rms;
}

struct Situation {
    AnalyticSurface surface;
    Triangulation triangulation;
    int cells = 48;
};
class FittedNormalsOnSurfaces : public testing::TestWithParam<Situation> {};

TEST_P(FittedNormalsOnSurfaces, AreFarTruerThanAveragedOnesAndKnowHowMuch) {
    const AnalyticMesh reference =
        analytic_mesh(GetParam().surface, GetParam().triangulation, GetParam().cells, 1);
    const FittedNormals fitted = fitted_normals(reference.mesh, {});
    const double error = error_of(fitted, reference);
    EXPECT_LE(error, 0.1 * averaged_error(reference));
    EXPECT_LE(error, fitted.reference_degrees);
    // At a border, triangles are on one side only, and most fits are unreliable. Inside, almost
    // every vertex has a fit.
    const auto inner = std::count(reference.inner.begin(), reference.inner.end(), 1);
    const double share = static_cast<double>(inner) / static_cast<double>(reference.inner.size());
    const auto fits =
        std::count_if(fitted.corners.begin(), fitted.corners.end(), [&](std::uint32_t corner) {
            return reference.inner[test::vertex_at(reference.mesh, corner)] == 1;
        });
    EXPECT_GE(static_cast<double>(fits), 0.97 * share * static_cast<double>(fitted.examined_fans));
}

INSTANTIATE_TEST_SUITE_P(
    All, FittedNormalsOnSurfaces,
    testing::Values(Situation{AnalyticSurface::torus, Triangulation::jittered},
                    Situation{AnalyticSurface::ellipsoid, Triangulation::jittered},
                    Situation{AnalyticSurface::saddle, Triangulation::jittered},
                    Situation{AnalyticSurface::cubic, Triangulation::jittered},
                    Situation{AnalyticSurface::ellipsoid, Triangulation::anisotropic, 192},
                    Situation{AnalyticSurface::cubic, Triangulation::anisotropic, 64}));

TEST(FittedNormals, UncertaintyCoversTheirErrorOnSpheres) {
    // Max's weights are exact on spheres and, by symmetry, on regular grids of a torus.
    for (const auto& [surface, triangulation] :
         {std::pair(AnalyticSurface::sphere, Triangulation::jittered),
          std::pair(AnalyticSurface::torus, Triangulation::regular)}) {
        const AnalyticMesh reference = analytic_mesh(surface, triangulation, 48, 1);
        const FittedNormals fitted = fitted_normals(reference.mesh, {});
        EXPECT_LE(averaged_error(reference), 1e-4);
        EXPECT_LE(error_of(fitted, reference), 0.02);
        EXPECT_LE(error_of(fitted, reference), fitted.reference_degrees);
    }
}

TEST(FittedNormals, GetTruerWithTheFourthPowerOfTheCells) {
    const auto error_with = [](int cells) {
        const AnalyticMesh reference =
            analytic_mesh(AnalyticSurface::cubic, Triangulation::jittered, cells, 3);
        return error_of(fitted_normals(reference.mesh, {}), reference);
    };
    const double order = std::log2(error_with(16) / error_with(32));
    EXPECT_GE(order, 3.0);
    EXPECT_LE(order, 5.5);
}

TEST(FittedNormals, TurnWithTheMesh) {
    const Mesh mesh =
        analytic_mesh(AnalyticSurface::ellipsoid, Triangulation::jittered, 24, 1).mesh;
    const glm::vec3 half_turn(-1.0F, -1.0F, 1.0F);
    Mesh turned = mesh;
    for (glm::vec3& position : turned.positions)
        position *= half_turn;
    const FittedNormals one = fitted_normals(mesh, {});
    const FittedNormals other = fitted_normals(turned, {});
    ASSERT_EQ(other.corners, one.corners);
    double most = 0.0;
    for (std::size_t i = 0; i < one.normals.size(); ++i)
        most = std::max(most,
                        degrees_between(one.normals[i] * glm::dvec3(half_turn), other.normals[i]));
    EXPECT_LE(most, 1e-8);
}

/// A grid over [-1,1]^2 with these heights.
template <typename Height>
Mesh graph_of(const Height& height, int cells) {
    Mesh mesh;
    for (int row = 0; row <= cells; ++row) {
        for (int column = 0; column <= cells; ++column) {
            const double x = 2.0 * column / cells - 1.0;
            const double y = 2.0 * row / cells - 1.0;
            mesh.positions.emplace_back(x, y, height(x, y));
        }
    }
    const auto at = [&](int column, int row) {
        return static_cast<std::uint32_t>(row * (cells + 1) + column);
    };
    for (int row = 0; row < cells; ++row) {
        for (int column = 0; column < cells; ++column) {
            mesh.triangles.emplace_back(at(column, row), at(column + 1, row),
                                        at(column + 1, row + 1));
            mesh.triangles.emplace_back(at(column, row), at(column + 1, row + 1),
                                        at(column, row + 1));
        }
    }
    return mesh;
}

TEST(FittedNormals, AreExactOnPolynomialSurfaces) {
    // The surface is horizontal in the middle, so that the axes of the tangent plane are those of
    // the polynomial.
    const Mesh mesh = graph_of(
        [](double x, double y) {
            return 0.3 * x * x - 0.2 * x * y + 0.25 * y * y * y + 0.2 * x * x * y * y;
        },
        16);
    const std::uint32_t middle = 8 * 17 + 8;
    const FittedNormals fitted = fitted_normals(mesh, {});
    bool is_found = false;
    for (std::size_t i = 0; i < fitted.corners.size(); ++i) {
        if (test::vertex_at(mesh, fitted.corners[i]) != middle) continue;
        is_found = true;
        // The rounding error of floats.
        EXPECT_LE(degrees_between(fitted.normals[i], {0.0, 0.0, 1.0}), 2e-5);
    }
    EXPECT_TRUE(is_found);
}

TEST(FittedNormals, EndAtHardEdges) {
    const Mesh roof = graph_of([](double x, double) { return 0.5 - 0.5 * std::abs(x); }, 16);
    FitOptions options;
    const auto worst_of = [&](const FittedNormals& fitted) {
        double worst = 0.0;
        for (std::size_t i = 0; i < fitted.corners.size(); ++i) {
            const glm::uvec3& triangle = roof.triangles[fitted.corners[i] / 3];
            const double middle = roof.positions[triangle.x].x + roof.positions[triangle.y].x +
                                  roof.positions[triangle.z].x;
            const glm::dvec3 side(middle > 0.0 ? 0.5 : -0.5, 0.0, 1.0);
            worst = std::max(worst, degrees_between(fitted.normals[i], side));
        }
        return worst;
    };
    options.hard_edges.crease_angle = 0.5;
    const FittedNormals parted = fitted_normals(roof, options);
    EXPECT_EQ(parted.fans, 17U * 18U);  // The vertices of the ridge count twice.
    EXPECT_LE(worst_of(parted), 1e-4);
    options.hard_edges.crease_angle.reset();
    const FittedNormals smooth = fitted_normals(roof, options);
    EXPECT_EQ(smooth.fans, 17U * 17U);
    // The fits along the ridge are unreliable.
    EXPECT_LT(smooth.corners.size(), parted.corners.size() * 9 / 10);
}

TEST(FittedNormals, ExcludeFoldedFans) {
    // A steep, symmetric roof: both fits agree on its ridge, but there is no normal.
    const Mesh roof = graph_of([](double x, double) { return 2.0 - 2.0 * std::abs(x); }, 16);
    FitOptions options;
    options.max_fit_difference = 180.0;
    options.max_fit_angle = 180.0;
    const auto beside_the_ridge = [&](const FittedNormals& found) {
        return std::count_if(found.corners.begin(), found.corners.end(), [&](std::uint32_t corner) {
            return roof.positions[test::vertex_at(roof, corner)].x != 0.0F;
        });
    };
    const FittedNormals all = fitted_normals(roof, options);
    options.max_fit_angle = 45.0;
    const FittedNormals found = fitted_normals(roof, options);
    EXPECT_GT(static_cast<std::ptrdiff_t>(all.corners.size()), beside_the_ridge(all) + 10);
    EXPECT_EQ(static_cast<std::ptrdiff_t>(found.corners.size()), beside_the_ridge(all));
    EXPECT_EQ(beside_the_ridge(found), beside_the_ridge(all));
}

TEST(FittedNormals, AreEmptyWithoutASurface) {
    Mesh tetrahedron;
    tetrahedron.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const FittedNormals few = fitted_normals(tetrahedron, {});
    EXPECT_EQ(few.examined_fans, 4U);
    EXPECT_TRUE(few.corners.empty());
    Mesh broken = graph_of([](double, double) { return 0.0; }, 8);
    broken.positions[40].x = std::numeric_limits<float>::quiet_NaN();
    for (const glm::dvec3& normal : fitted_normals(broken, {}).normals)
        EXPECT_LE(degrees_between(normal, {0.0, 0.0, 1.0}), 1e-6);
    EXPECT_TRUE(fitted_normals(Mesh{}, {}).corners.empty());
}

TEST(FittedNormals, SampleLargeMeshesIndependentlyOfThreads) {
    const AnalyticMesh reference =
        analytic_mesh(AnalyticSurface::torus, Triangulation::jittered, 32, 1);
    FitOptions options;
    options.max_fans = 100;
    set_thread_limit(1);
    const FittedNormals one = fitted_normals(reference.mesh, options);
    set_thread_limit(0);
    const FittedNormals all = fitted_normals(reference.mesh, options);
    EXPECT_EQ(one.examined_fans, 100U);
    EXPECT_EQ(one.fans, 1024U);
    EXPECT_EQ(one.corners, all.corners);
    EXPECT_EQ(one.normals, all.normals);
}

}  // namespace
}  // namespace relief

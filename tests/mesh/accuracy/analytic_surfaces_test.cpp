// SPDX-License-Identifier: Apache-2.0
// Ground truths: their normals stand on the surface, triangles face them, and none turns over but
// where that is meant.
#include "relief/mesh/analytic_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "relief/mesh/direction_error.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr AnalyticSurface all_surfaces[] = {AnalyticSurface::sphere, AnalyticSurface::torus,
                                            AnalyticSurface::ellipsoid, AnalyticSurface::saddle,
                                            AnalyticSurface::cubic};

/// Triangles seen from behind by the true normal at their first corner.
std::size_t turned_over(const AnalyticMesh& ground_truth) {
    std::size_t count = 0;
    for (const glm::uvec3& t : ground_truth.mesh.triangles) {
        const glm::dvec3 a(ground_truth.mesh.positions[t.x]);
        const glm::dvec3 normal = glm::cross(glm::dvec3(ground_truth.mesh.positions[t.y]) - a,
                                             glm::dvec3(ground_truth.mesh.positions[t.z]) - a);
        count += glm::dot(normal, ground_truth.normals[t.x]) <= 0.0 ? 1 : 0;
    }
    return count;
}

TEST(AnalyticMesh, FacesItsNormalsAndTurnsOverOnlyWhereFolded) {
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

TEST(AnalyticMesh, NormalsAreThoseOfTheSurfaceItself) {
    // By equations that the mesh was not made from.
    const auto gradient = [](AnalyticSurface surface, const glm::dvec3& p) {
        switch (surface) {
            case AnalyticSurface::sphere:
                return p;
            case AnalyticSurface::ellipsoid:
                return p / glm::dvec3(1.0, 0.49, 0.16);
            case AnalyticSurface::torus: {
                const double around = std::hypot(p.x, p.y);
                return p - glm::dvec3(p.x, p.y, 0.0) / around;
            }
            default:  // The saddle.
                return glm::dvec3(-p.x, p.y, 1.0);
        }
    };
    for (const AnalyticSurface surface : {AnalyticSurface::sphere, AnalyticSurface::torus,
                                          AnalyticSurface::ellipsoid, AnalyticSurface::saddle}) {
        const AnalyticMesh ground_truth = analytic_mesh(surface, Triangulation::jittered, 24, 5);
        for (std::size_t v = 0; v < ground_truth.normals.size(); ++v) {
            const glm::dvec3 expected =
                gradient(surface, glm::dvec3(ground_truth.mesh.positions[v]));
            // Positions are rounded to float, on curves of radius 0.16 and more.
            EXPECT_LE(degrees_between(ground_truth.normals[v], expected), 1e-4);
        }
    }
}

TEST(AnalyticMesh, CountsAsInnerWhatHasTrianglesAllAround) {
    for (const AnalyticSurface surface : all_surfaces) {
        const AnalyticMesh ground_truth = analytic_mesh(surface, Triangulation::regular, 8, 1);
        validate(ground_truth.mesh);
        std::size_t inner = 0;
        for (const unsigned char is : ground_truth.inner)
            inner += is;
        switch (surface) {
            case AnalyticSurface::torus:
                EXPECT_EQ(inner, 64U);
                EXPECT_EQ(ground_truth.inner.size(), 64U);
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

/// The largest angles between a triangle's own direction of u, and of its plane, and the truth at
/// its middle; triangles whose image is the wrong way round for the truth.
struct TextureErrors {
    double tangent = 0.0;
    double normal = 0.0;
    std::size_t wrong_hands = 0;
};

TextureErrors texture_errors(const TexturedMesh& ground_truth) {
    TextureErrors errors;
    for (const glm::uvec3& t : ground_truth.mesh.triangles) {
        const auto edge = [&](std::uint32_t to) {
            return glm::dvec3(ground_truth.mesh.positions[to]) -
                   glm::dvec3(ground_truth.mesh.positions[t.x]);
        };
        const auto step = [&](std::uint32_t to) {
            return glm::dvec2(ground_truth.mesh.texcoords[to]) -
                   glm::dvec2(ground_truth.mesh.texcoords[t.x]);
        };
        const glm::dvec3 e1 = edge(t.y), e2 = edge(t.z);
        const glm::dvec2 d1 = step(t.y), d2 = step(t.z);
        const double area = d1.x * d2.y - d1.y * d2.x;
        const SurfaceFrame frame =
            ground_truth.frame_at((ground_truth.parameters[t.x] + ground_truth.parameters[t.y] +
                                   ground_truth.parameters[t.z]) /
                                  3.0);
        const glm::dvec3 along_u = (e1 * d2.y - e2 * d1.y) / area;
        const glm::dvec3 up = (e1 * d2.x - e2 * d1.x) / area;
        errors.tangent = std::max(errors.tangent, degrees_between(along_u, frame.tangent));
        errors.normal = std::max(errors.normal, degrees_between(glm::cross(e1, e2), frame.normal));
        EXPECT_NEAR(glm::dot(frame.tangent, frame.normal), 0.0, 1e-14);
        EXPECT_NEAR(glm::length(frame.tangent), 1.0, 1e-14);
        const double hand = glm::dot(glm::cross(frame.normal, frame.tangent), up);
        errors.wrong_hands += hand * frame.handedness > 0.0 ? 0U : 1U;
    }
    return errors;
}

TEST(TexturedMesh, FramesAreTheLimitOfItsTrianglesOwn) {
    for (const AnalyticSurface surface : all_surfaces) {
        for (const TextureLayout layout :
             {TextureLayout::upright, TextureLayout::sheared, TextureLayout::mirrored}) {
            const auto at = [&](int cells) {
                const TexturedMesh ground_truth =
                    textured_mesh(surface, Triangulation::regular, layout, cells, 3);
                validate(ground_truth.mesh);
                return texture_errors(ground_truth);
            };
            const TextureErrors coarse = at(32);
            const TextureErrors fine = at(128);
            EXPECT_EQ(coarse.wrong_hands + fine.wrong_hands, 0U);
            EXPECT_LE(coarse.tangent, 12.0);
            // A triangle's edges are chords: four times finer, four times closer at least. The
            // frames of a wrong surface or layout would stay where they are.
            EXPECT_LE(fine.tangent, coarse.tangent / 3.5) << static_cast<int>(surface);
            EXPECT_LE(fine.normal, coarse.normal / 3.5) << static_cast<int>(surface);
        }
    }
}

TEST(TexturedMesh, HasASeamWhereTheSurfaceClosesAndAFoldWhereTheImageIsMirrored) {
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
    // Outside of (1, 1) by 0.25, and along the edge by as much: (1, 1.5) of [-1,1]^2.
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

}  // namespace
}  // namespace relief

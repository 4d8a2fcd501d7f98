// SPDX-License-Identifier: Apache-2.0
// Ground truths: their normals stand on the surface, triangles face them, and none turns over but
// where that is meant.
#include "relief/mesh/analytic_surfaces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relief/mesh/direction_error.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr AnalyticSurface all_surfaces[] = {AnalyticSurface::sphere, AnalyticSurface::torus,
                                            AnalyticSurface::ellipsoid, AnalyticSurface::saddle,
                                            AnalyticSurface::cubic};

/// Triangles seen from behind by the true normal at their first corner.
std::size_t turned_over(const AnalyticMesh& truth) {
    std::size_t count = 0;
    for (const glm::uvec3& t : truth.mesh.triangles) {
        const glm::dvec3 a(truth.mesh.positions[t.x]);
        const glm::dvec3 normal = glm::cross(glm::dvec3(truth.mesh.positions[t.y]) - a,
                                             glm::dvec3(truth.mesh.positions[t.z]) - a);
        count += glm::dot(normal, truth.normals[t.x]) <= 0.0 ? 1 : 0;
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
        const AnalyticMesh truth = analytic_mesh(surface, Triangulation::jittered, 24, 5);
        for (std::size_t v = 0; v < truth.normals.size(); ++v) {
            const glm::dvec3 expected = gradient(surface, glm::dvec3(truth.mesh.positions[v]));
            // Positions are rounded to float, on curves of radius 0.16 and more.
            EXPECT_LE(degrees_between(truth.normals[v], expected), 1e-4);
        }
    }
}

TEST(AnalyticMesh, CountsAsInnerWhatHasTrianglesAllAround) {
    for (const AnalyticSurface surface : all_surfaces) {
        const AnalyticMesh truth = analytic_mesh(surface, Triangulation::regular, 8, 1);
        validate(truth.mesh);
        std::size_t inner = 0;
        for (const unsigned char is : truth.inner)
            inner += is;
        switch (surface) {
            case AnalyticSurface::torus:
                EXPECT_EQ(inner, 64U);
                EXPECT_EQ(truth.inner.size(), 64U);
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

// SPDX-License-Identifier: Apache-2.0
// Checks the ground truth of normals, tangents and height fields independently: positions by the
// formulas of this file in long double, differentiated numerically.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "experiment_parts.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/statistics.h"
#include "storage_experiments.h"

namespace relief {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

using Real = long double;
using Point = glm::vec<3, Real>;
using Formula = std::function<Point(Real s, Real t)>;

constexpr Real pi = std::numbers::pi_v<Real>;

Formula ellipsoid(Real a, Real b, Real c) {
    return [=](Real s, Real t) {
        const Real polar = (0.15L + 0.7L * t) * pi;  // From one open pole to the other.
        return Point(a * std::sin(polar) * std::cos(2 * pi * s),
                     b * std::sin(polar) * std::sin(2 * pi * s), c * std::cos(polar));
    };
}

Point on_torus(Real s, Real t) {
    const Real around = 1.0L + 0.4L * std::cos(2 * pi * t);
    return {around * std::cos(2 * pi * s), around * std::sin(2 * pi * s),
            0.4L * std::sin(2 * pi * t)};
}

Point on_saddle(Real s, Real t) {
    const Real x = 2 * s - 1;
    const Real y = 2 * t - 1;
    return {x, y, (x * x - y * y) / 2};
}

constexpr std::size_t terms = 10;
std::array<Real, terms> powers(Real x, Real y) {
    return {1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y};
}

/// The random coefficients of a cubic are determined from points on it by least squares. x and y
/// range from -reach to reach while s and t range from 0 to 1.
Formula cubic_through(std::span<const glm::vec3> points, Real reach) {
    std::array<std::array<Real, terms + 1>, terms> rows{};
    for (const glm::vec3& p : points) {
        const auto row = powers(static_cast<Real>(p.x) / reach, static_cast<Real>(p.y) / reach);
        for (std::size_t i = 0; i < terms; ++i) {
            for (std::size_t j = 0; j < terms; ++j)
                rows[i][j] += row[i] * row[j];
            rows[i][terms] += row[i] * static_cast<Real>(p.z);
        }
    }
    for (std::size_t pivot = 0; pivot < terms; ++pivot) {  // Gauss-Jordan elimination.
        const auto largest = std::max_element(
            rows.begin() + static_cast<std::ptrdiff_t>(pivot), rows.end(),
            [&](const auto& a, const auto& b) { return std::abs(a[pivot]) < std::abs(b[pivot]); });
        std::swap(rows[pivot], *largest);
        for (std::size_t i = 0; i < terms; ++i) {
            const Real factor = i == pivot ? 0 : rows[i][pivot] / rows[pivot][pivot];
            for (std::size_t j = 0; j <= terms; ++j)
                rows[i][j] -= factor * rows[pivot][j];
        }
    }
    std::array<Real, terms> coefficients{};
    for (std::size_t i = 0; i < terms; ++i)
        coefficients[i] = rows[i][terms] / rows[i][i];
    return [coefficients, reach](Real s, Real t) {
        const auto row = powers(2 * s - 1, 2 * t - 1);
        Real z = 0;
        for (std::size_t i = 0; i < terms; ++i)
            z += coefficients[i] * row[i];
        return Point(reach * (2 * s - 1), reach * (2 * t - 1), z);
    };
}

Formula formula_of(AnalyticSurface surface, const TexturedMesh& ground_truth) {
    switch (surface) {
        case AnalyticSurface::sphere:
            return ellipsoid(1.0L, 1.0L, 1.0L);
        case AnalyticSurface::torus:
            return on_torus;
        case AnalyticSurface::ellipsoid:
            return ellipsoid(1.0L, 0.7L, 0.4L);
        case AnalyticSurface::saddle:
            return on_saddle;
        default:
            return cubic_through(ground_truth.mesh.positions, 1);
    }
}

/// The derivative along (ds, dt) by central differences of three widths, extrapolated twice
/// [Richardson 1911]; the error is O(h^6).
Point derivative(const Formula& formula, Real s, Real t, Real ds, Real dt) {
    const auto central = [&](Real h) {
        return (formula(s + h * ds, t + h * dt) - formula(s - h * ds, t - h * dt)) / (2 * h);
    };
    const Real h = 1e-2L;
    const Point wide = central(h);
    const Point middle = central(h / 2);
    const Point narrow = central(h / 4);
    const Point once = (Real(4) * middle - wide) / Real(3);
    const Point again = (Real(4) * narrow - middle) / Real(3);
    return (Real(16) * again - once) / Real(15);
}

/// The fitted coefficients of the cubic are only as accurate as the float positions.
double tolerance_for(AnalyticSurface surface) {
    return surface == AnalyticSurface::cubic ? 1e-5 : 1e-9;
}

TEST(AnalyticReference, MeshesLieOnTheSurfacesOfTheseFormulas) {
    for (const AnalyticSurface surface : all_surfaces) {
        const TexturedMesh ground_truth =
            textured_mesh(surface, Triangulation::jittered, TextureLayout::upright, 16, 1);
        const Formula formula = formula_of(surface, ground_truth);
        for (std::size_t v = 0; v < ground_truth.parameters.size(); ++v) {
            const glm::dvec2 at = ground_truth.parameters[v];
            const Point expected = formula(static_cast<Real>(at.x), static_cast<Real>(at.y));
            EXPECT_LE(
                glm::length(glm::dvec3(ground_truth.mesh.positions[v]) - glm::dvec3(expected)),
                2e-7)
                << name_of(surface);
        }
    }
}

TEST(AnalyticReference, FramesAreThoseOfNumericDerivatives) {
    for (const AnalyticSurface surface : all_surfaces) {
        for (const TextureLayout layout : {TextureLayout::upright, TextureLayout::sheared}) {
            const TexturedMesh ground_truth =
                textured_mesh(surface, Triangulation::jittered, layout, 16, 1);
            const Formula formula = formula_of(surface, ground_truth);
            // v is constant along u if t compensates the effect of s.
            const Real slant = layout == TextureLayout::sheared ? 0.5L : 0.0L;
            for (const glm::dvec2& at : ground_truth.parameters) {
                const Real s = static_cast<Real>(at.x);
                const Real t = static_cast<Real>(at.y);
                const Point along_s = derivative(formula, s, t, 1, 0);
                const Point along_t = derivative(formula, s, t, 0, 1);
                const Point along_u = derivative(formula, s, t, 1, slant);
                const SurfaceFrame frame = ground_truth.frame_at(at);
                const Point cross = glm::cross(along_s, along_t);
                // The normal points outwards or up, like the triangles of the mesh.
                const Point normal =
                    glm::dot(glm::dvec3(cross), frame.normal) < 0.0 ? -cross : cross;
                EXPECT_LE(degrees_between(glm::dvec3(normal), frame.normal),
                          tolerance_for(surface));
                EXPECT_LE(degrees_between(glm::dvec3(along_u), frame.tangent),
                          tolerance_for(surface));
            }
        }
    }
}

TEST(AnalyticReference, VertexNormalsAreThoseOfTheFrames) {
    for (const AnalyticSurface surface : all_surfaces) {
        const AnalyticMesh bare = analytic_mesh(surface, Triangulation::regular, 16, 1);
        const TexturedMesh textured =
            textured_mesh(surface, Triangulation::regular, TextureLayout::upright, 16, 1);
        // Vertices at seams of the textured mesh are duplicates, so match them by position.
        for (std::size_t v = 0; v < bare.normals.size(); ++v) {
            std::size_t found = 0;
            for (std::size_t w = 0; w < textured.parameters.size(); ++w) {
                if (textured.mesh.positions[w] != bare.mesh.positions[v]) continue;
                const SurfaceFrame frame = textured.frame_at(textured.parameters[w]);
                EXPECT_LE(degrees_between(bare.normals[v], frame.normal), 1e-12);
                ++found;
            }
            EXPECT_GE(found, 1U) << name_of(surface) << " " << v;
        }
    }
}

/// A field of waves with its normals; the z axis points out of the image, and y up.
struct WaveField {
    int side;
    std::vector<HeightWave> waves;
    std::vector<glm::dvec3> normals;
};

TEST(AnalyticReference, WavesHaveTheNormalsOfNumericDerivatives) {
    const double steepness = std::numbers::pi / 2.0;
    const std::array fields = {
        WaveField{256, tiling_waves(256, 256, 5, 128.0, 0.2, 41), smooth_surface(256)},
        WaveField{64, tiling_waves(64, 64, 8, 8.0, 0.3, 5), surface_at(64).normals},
        WaveField{16,
                  {{1.0 / steepness, steepness * glm::dvec2(2.0, 1.0) / std::sqrt(5.0), 0.7}},
                  oblique_wave(16, 4.0, 32).normals}};
    for (const WaveField& field : fields) {
        const Formula surface = [&](Real x, Real y) {
            Real height = 0;
            for (const HeightWave& wave : field.waves) {
                height += static_cast<Real>(wave.amplitude) *
                          std::sin(static_cast<Real>(wave.frequency.x) * x +
                                   static_cast<Real>(wave.frequency.y) * y +
                                   static_cast<Real>(wave.phase));
            }
            return Point(x, -y, height);
        };
        double max_slope = 0.0;
        for (std::size_t i = 0; i < field.normals.size(); i += 7) {
            const auto x = static_cast<Real>(i % static_cast<std::size_t>(field.side));
            const auto y = static_cast<Real>(i / static_cast<std::size_t>(field.side));
            const Point normal =
                glm::cross(derivative(surface, x, y, 0, 1), derivative(surface, x, y, 1, 0));
            ASSERT_LE(degrees_between(field.normals[i], glm::dvec3(normal)), 1e-9) << i;
            max_slope = std::max(max_slope, std::acos(field.normals[i].z));
        }
        EXPECT_GT(max_slope, 0.2) << "a flat field would show nothing";
    }
}

/// Fans of one seed lie on one cubic for every valence. Together they have enough points to
/// determine it, all within 0.2 of the origin, including the origin.
std::vector<glm::vec3> points_of_fans(std::uint32_t seed) {
    std::vector<glm::vec3> points;
    for (int valence = 3; valence <= 18; ++valence) {
        const Mesh fan = cubic_fan(valence, seed);
        points.insert(points.end(), fan.positions.begin(), fan.positions.end());
    }
    return points;
}

constexpr Real fan_reach = 0.2L;

/// The upward normal of the fitted surface at the origin, by numeric derivatives.
glm::dvec3 normal_at_origin(const Formula& surface) {
    return glm::dvec3(
        glm::cross(derivative(surface, 0.5L, 0.5L, 1, 0), derivative(surface, 0.5L, 0.5L, 0, 1)));
}

TEST(AnalyticReference, FansLieOnACubicWhoseNormalAtTheOriginIsUp) {
    // Heights below 1/16 are rounded by 2^-29, and x and y by 2^-27, where the surface rises by
    // half of that. At a distance of 0.05 or more this is 2e-6 degrees for one point, and less for
    // all.
    constexpr double height_rounding = 1e-8;
    constexpr double normal_rounding = 2e-6;
    const glm::dvec3 up(0.0, 0.0, 1.0);
    double furthest_bend = 0.0;
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
        const std::vector<glm::vec3> points = points_of_fans(seed);
        EXPECT_EQ(points.front(), glm::vec3(0.0F)) << "the vertex that is judged";
        const Formula surface = cubic_through(points, fan_reach);
        for (const glm::vec3& p : points) {
            const Point expected = surface(static_cast<Real>(p.x) / fan_reach / 2 + 0.5L,
                                           static_cast<Real>(p.y) / fan_reach / 2 + 0.5L);
            EXPECT_NEAR(static_cast<double>(expected.z), static_cast<double>(p.z), height_rounding)
                << seed;
            furthest_bend = std::max(furthest_bend, static_cast<double>(std::abs(p.z)));
        }
        EXPECT_LE(degrees_between(normal_at_origin(surface), up), normal_rounding) << seed;
    }
    EXPECT_GT(furthest_bend, 0.03) << "fans that were flat would show nothing";
}

}  // namespace
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Reference surfaces and height fields in closed form; their normals and tangents are checked by
// the formulas of this file in long double, differentiated numerically.
#include "relief/accuracy/ground_truth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "experiment_parts.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "storage_experiments.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

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

TEST(WaveHeights, TilingWavesRepeatAndHaveTheSlopeAskedFor) {
    const std::vector<HeightWave> waves = tiling_waves(96, 160, 40, 8.0, 0.3, 7);
    ASSERT_EQ(waves.size(), 40U);
    for (const HeightWave& wave : waves) {
        EXPECT_GE(2.0 * std::numbers::pi / glm::length(wave.frequency), 8.0);
        const double across = wave.frequency.x * 96.0 / (2.0 * std::numbers::pi);
        const double along = wave.frequency.y * 160.0 / (2.0 * std::numbers::pi);
        EXPECT_NEAR(across, std::round(across), 1e-9);
        EXPECT_NEAR(along, std::round(along), 1e-9);
    }
    const BumpField field = wave_heights(96, 160, waves);
    double squares = 0.0;
    for (const glm::dvec3& n : field.normals)
        squares += (n.x * n.x + n.y * n.y) / (n.z * n.z);
    // The sum of similar waves differs slightly from that of independent ones.
    EXPECT_NEAR(std::sqrt(squares / (96.0 * 160.0)), 0.3, 0.05);
    EXPECT_NE(tiling_waves(96, 160, 40, 8.0, 0.3, 8)[0].phase, waves[0].phase);
    EXPECT_THROW(tiling_waves(8, 8, 3, 9.0, 0.3, 1), InvalidInput);
    EXPECT_THROW(tiling_waves(8, 8, 0, 4.0, 0.3, 1), InvalidInput);
}

TEST(WaveHeights, CodesFillTheRangeAndStrengthGivesTheTexelsBack) {
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
}  // namespace relief::test

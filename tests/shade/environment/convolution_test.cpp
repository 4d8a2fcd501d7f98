// SPDX-License-Identifier: Apache-2.0
// Convolved environments: the GGX distribution, its directional albedo, irradiance by spherical
// harmonics, and blurred environments, against known integrals and brute force.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "environment/convolution.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "shade/environment/test_environments.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade::detail;

namespace {

using std::numbers::pi;
using test::faces_of;
using test::spread_directions;

TEST(Ggx, ProjectedFacetsCoverTheSurfaceOnce) {
    for (const double alpha : {0.05, 0.3, 0.7, 1.0}) {
        // In x, the square of the sine, n.h dh = pi dx. Uniform steps of a fourth root resolve the
        // peak.
        double sum = 0.0;
        constexpr int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const double root = (i + 0.5) / steps;
            const double x = std::pow(root, 4.0);
            sum += ggx_distribution(std::sqrt(1.0 - x), alpha) * pi * 4.0 * std::pow(root, 3.0);
        }
        EXPECT_NEAR(sum / steps, 1.0, 1e-4) << alpha;
    }
}

TEST(Ggx, FacetsAreDrawnAsOftenAsTheyAre) {
    for (const double alpha : {0.1, 0.5, 1.0}) {
        // Compares the share of facets within an angle of the normal between samples and the
        // formula.
        constexpr unsigned count = 4096;
        unsigned within = 0;
        for (unsigned i = 0; i < count; ++i) {
            const glm::dvec3 facet = ggx_facet(hammersley(i, count), alpha);
            EXPECT_NEAR(glm::length(facet), 1.0, 1e-12);
            if (facet.z > 0.9) ++within;
        }
        const double tan_squared = 1.0 / 0.81 - 1.0;
        EXPECT_NEAR(static_cast<double>(within) / count,
                    tan_squared / (tan_squared + alpha * alpha), 2.0 / count);
    }
}

TEST(Ggx, VisibilityIsSymmetricAndOneForAMirror) {
    EXPECT_DOUBLE_EQ(ggx_visibility(0.3, 0.8, 0.4), ggx_visibility(0.8, 0.3, 0.4));
    EXPECT_NEAR(ggx_visibility(0.3, 0.8, 1e-9) * 4.0 * 0.3 * 0.8, 1.0, 1e-12);
    EXPECT_LT(ggx_visibility(0.3, 0.8, 1.0) * 4.0 * 0.3 * 0.8, 0.5);
}

TEST(Ggx, AVerySharpPeakIsFinite) {
    EXPECT_NEAR(ggx_distribution(1.0, 1e-4) * pi * 1e-8, 1.0, 1e-12);
    EXPECT_GT(ggx_distribution(0.5, 1e-4), 0.0);
    EXPECT_DOUBLE_EQ(ggx_distribution(0.2, 1.0), 1.0 / pi);
}

TEST(Hammersley, PutsOnePointInEachStripBothWays) {
    constexpr unsigned count = 64;
    std::set<int> columns;
    std::set<int> rows;
    for (unsigned i = 0; i < count; ++i) {
        const glm::dvec2 point = hammersley(i, count);
        columns.insert(static_cast<int>(point.x * count));
        rows.insert(static_cast<int>(point.y * count));
        EXPECT_GT(point.x, 0.0);
        EXPECT_LT(point.x, 1.0);
        EXPECT_LT(point.y, 1.0);
    }
    EXPECT_EQ(columns.size(), count);
    EXPECT_EQ(rows.size(), count);
    EXPECT_EQ(hammersley(1, 64).y, 0.5 + 0.5 / 64);
}

/// The integral of D V n.l, split by (1 - v.h)^5, over facets sampled by D n.h: each sample weighs
/// 4 V n.l v.h / n.h. The samples are uniform in the root of the rest of the facets.
glm::dvec2 brute_force(double n_v, double roughness, int steps) {
    const double alpha = roughness * roughness;
    const glm::dvec3 view(std::sqrt(1.0 - n_v * n_v), 0.0, n_v);
    glm::dvec2 sum(0.0);
    for (int i = 0; i < steps; ++i) {
        const double root = (i + 0.5) / steps;
        for (int j = 0; j < steps; ++j) {
            const glm::dvec3 half = ggx_facet({1.0 - root * root, 0.5 * (j + 0.5) / steps}, alpha);
            const double v_h = glm::dot(view, half);
            const double n_l = 2.0 * v_h * half.z - n_v;
            if (v_h <= 0.0 || n_l <= 0.0) continue;
            const double fresnel = std::pow(1.0 - v_h, 5.0);
            sum += 2.0 * root * 4.0 * ggx_visibility(n_l, n_v, alpha) * n_l * v_h / half.z *
                   glm::dvec2(1.0 - fresnel, fresnel);
        }
    }
    return sum / static_cast<double>(steps * steps);
}

/// The integral of D V n.l over directions of light, uniform in n.l and azimuth, without importance
/// sampling. It is accurate for rough surfaces.
double albedo_over_light(double n_v, double roughness, int steps) {
    const double alpha = roughness * roughness;
    const glm::dvec3 view(std::sqrt(1.0 - n_v * n_v), 0.0, n_v);
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double n_l = (i + 0.5) / steps;
        const double across = std::sqrt(1.0 - n_l * n_l);
        for (int j = 0; j < steps; ++j) {
            const double turn = std::numbers::pi * (j + 0.5) / steps;
            const glm::dvec3 light(across * std::cos(turn), across * std::sin(turn), n_l);
            const glm::dvec3 half = glm::normalize(light + view);
            sum += ggx_distribution(half.z, alpha) * ggx_visibility(n_l, n_v, alpha) * n_l;
        }
    }
    return sum * 2.0 * std::numbers::pi / (static_cast<double>(steps) * steps);
}

TEST_LABELS(not_sanitized);
TEST(EnvironmentBrdf, IsTheIntegralOverFacets) {
    double worst = 0.0;
    for (const double roughness : {1.0 / 64, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0}) {
        for (const double n_v : {1.0 / 64, 0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0}) {
            // The result of 500 x 500 steps is within 3e-4 of that of four times as many.
            const glm::dvec2 off =
                environment_brdf(n_v, roughness) - brute_force(n_v, roughness, 500);
            worst = std::max({worst, std::abs(off.x), std::abs(off.y)});
        }
    }
    RecordProperty("worst", std::to_string(worst));
    EXPECT_LT(worst, 1e-3);
}

TEST(EnvironmentBrdf, IsTheIntegralOverDirectionsOfLight) {
    for (const double roughness : {0.4, 0.7, 1.0}) {
        for (const double n_v : {0.1, 0.5, 1.0}) {
            const glm::dvec2 split = environment_brdf(n_v, roughness);
            EXPECT_NEAR(split.x + split.y, albedo_over_light(n_v, roughness, 400), 1.5e-3)
                << roughness << ' ' << n_v;
        }
    }
}

TEST(EnvironmentBrdf, MirrorHasFresnelsFactor) {
    for (const double n_v : {0.02, 0.3, 0.9, 1.0}) {
        const double fresnel = std::pow(1.0 - n_v, 5.0);
        const glm::dvec2 split = environment_brdf(n_v, 0.0);
        EXPECT_NEAR(split.x, 1.0 - fresnel, 1e-9);
        EXPECT_NEAR(split.y, fresnel, 1e-9);
    }
}

TEST(EnvironmentBrdf, ConservesEnergyAndDecreasesWithRoughness) {
    for (int i = 1; i <= 32; ++i) {
        const double n_v = i / 32.0;
        double before = 1.0 + 1e-12;
        for (int j = 0; j <= 32; ++j) {
            const glm::dvec2 split = environment_brdf(n_v, j / 32.0);
            EXPECT_GE(split.x, 0.0);
            EXPECT_GE(split.y, 0.0);
            EXPECT_LE(split.x + split.y, 1.0 + 1e-12);
            // At grazing angles, the albedo is largest at a medium roughness.
            if (n_v > 0.5) {
                EXPECT_LT(split.x + split.y, before + 2e-3) << n_v << ' ' << j;
                before = split.x + split.y;
            }
        }
    }
}

/// compensates_energy() leaves these surfaces out.
TEST(EnvironmentBrdf, LosesLessThanAPercentOnSmoothDielectrics) {
    const double f0 = 0.045;
    const double mean = (20.0 * f0 + 1.0) / 21.0;
    double most = 0.0;
    for (const double roughness : {0.045, 0.05}) {
        for (int i = 1; i <= 200; ++i) {
            const double root = i / 200.0;  // Of n.v.
            const glm::dvec2 albedo = environment_brdf(root * root, roughness);
            const double lost = 1.0 - albedo.x - albedo.y;
            most = std::max({most, mean * lost / (1.0 - mean * lost),
                             f0 * (1.0 / (albedo.x + albedo.y) - 1.0)});
        }
    }
    EXPECT_LT(most, 0.01);
    EXPECT_GT(most, 0.009);
}

TEST(EnvironmentBrdf, TheTableHoldsItFromEndToEndForAnyNumberOfThreads) {
    const Image table = environment_brdf_table(8);
    ASSERT_EQ(table.width, 8);
    ASSERT_EQ(table.height, 8);
    ASSERT_EQ(table.channels, 2);
    EXPECT_EQ(table.color_space, ColorSpace::data);
    const glm::dvec2 value = environment_brdf(2.0 / 7 * 2.0 / 7, 6.0 / 7);
    const std::size_t texel = 2 * (8 * 6 + 2);
    EXPECT_EQ(table.as<float>()[texel], static_cast<float>(value.x));
    EXPECT_EQ(table.as<float>()[texel + 1], static_cast<float>(value.y));
    const std::size_t last = 2 * 63;
    EXPECT_EQ(table.as<float>()[last], static_cast<float>(environment_brdf(1.0, 1.0).x));
    EXPECT_EQ(table.as<float>()[2 * 7], 1.0F) << "a mirror, head on";
    for (const float part : table.as<float>())
        EXPECT_TRUE(part >= 0.0F && part <= 1.0F);
    set_thread_limit(1);
    const Image again = environment_brdf_table(8);
    set_thread_limit(0);
    EXPECT_EQ(table.samples, again.samples);
    EXPECT_THROW(environment_brdf_table(1), InvalidInput);
}

TEST(EnvironmentBrdf, ATableOf64IsCloseBetweenItsTexels) {
    constexpr int size = 64;
    const Image table = environment_brdf_table(size);
    const auto samples = table.as<float>();
    const auto at = [&](std::size_t column, std::size_t row) {
        const std::size_t texel = 2 * (size * row + column);
        return glm::dvec2(samples[texel], samples[texel + 1]);
    };
    double worst = 0.0;
    for (double roughness = 0.045; roughness < 1.0; roughness += 0.019) {
        for (double n_v = 0.005; n_v < 1.0; n_v += 0.017) {
            const glm::dvec2 place =
                glm::min(glm::dvec2(std::sqrt(n_v), roughness) * (size - 1.0), size - 1.001);
            const auto x = static_cast<std::size_t>(place.x);
            const auto y = static_cast<std::size_t>(place.y);
            const glm::dvec2 part = glm::fract(place);
            const glm::dvec2 looked_up =
                glm::mix(glm::mix(at(x, y), at(x + 1, y), part.x),
                         glm::mix(at(x, y + 1), at(x + 1, y + 1), part.x), part.y);
            const glm::dvec2 off = glm::abs(looked_up - environment_brdf(n_v, roughness));
            worst = std::max({worst, off.x, off.y});
        }
    }
    RecordProperty("worst", std::to_string(worst));
    EXPECT_LT(worst, 3e-3);
}

double gray_at(const IrradianceSh& sh, const glm::dvec3& normal) {
    return irradiance_over_pi(sh, normal).x;
}

/// Radiance that depends only on the cosine to an axis.
std::vector<Image> lobe(int size, const glm::dvec3& axis, double (*radiance)(double cosine)) {
    return faces_of(size, [&](glm::dvec3 d) { return glm::dvec3(radiance(glm::dot(d, axis))); });
}

TEST(IrradianceSh, ConstantLightIsExact) {
    for (const int size : {1, 2, 3, 32, 100}) {
        const IrradianceSh sh =
            irradiance_sh(faces_of(size, [](glm::dvec3) { return glm::dvec3(0.5, 2, 8); }));
        EXPECT_LT(glm::length(sh[0] - glm::vec3(0.5F, 2, 8)), 1e-6F) << size;
        for (std::size_t i = 1; i < 9; ++i)
            EXPECT_LT(glm::length(sh.at(i)), 1e-6F) << size << ' ' << i;
    }
}

TEST(IrradianceSh, IsExactForLightUpToOrderTwo) {
    // Radiance 2 + a.d + (b.d)^2 gives an irradiance, divided by pi, of 2 + 2/3 a.n + ((b.n)^2 +
    // |b|^2) / 4: a third of |b|^2 has order 0 and stays, the rest has order 2 and is divided by
    // four.
    const glm::dvec3 a(0.3, -0.5, 0.2);
    const glm::dvec3 b(0.8, 0.4, -0.6);
    const IrradianceSh sh = irradiance_sh(faces_of(64, [&](glm::dvec3 d) {
        return glm::dvec3(2.0 + glm::dot(a, d) + std::pow(glm::dot(b, d), 2.0));
    }));
    for (const glm::dvec3& n : spread_directions(100)) {
        const double expected = 2.0 + 2.0 / 3.0 * glm::dot(a, n) +
                                0.25 * (std::pow(glm::dot(b, n), 2.0) + glm::dot(b, b));
        // Radiance is constant within each of 64 x 64 texels.
        EXPECT_NEAR(gray_at(sh, n), expected, 2e-4);
    }
}

TEST(IrradianceSh, HemisphereIsExact) {
    // The lobe (1 + cos) / 2 has no part of order 2.
    const IrradianceSh sh =
        irradiance_sh(lobe(64, {0, 1, 0}, [](double cosine) { return cosine > 0 ? 1.0 : 0.0; }));
    for (const glm::dvec3& n : spread_directions(100))
        EXPECT_NEAR(gray_at(sh, n), 0.5 * (1.0 + n.y), 1e-4);
}

TEST(IrradianceSh, CosineLobeHasTheErrorOfOrderTwo) {
    for (const glm::dvec3& axis : spread_directions(7)) {
        const IrradianceSh sh =
            irradiance_sh(lobe(64, axis, [](double cosine) { return std::max(cosine, 0.0); }));
        // The coefficients of the lobe are those of the cosine: the sum of A_l^2 (2 l + 1) / (4
        // pi^2) is 127 / 192 = 0.6615. The integral is 2/3.
        EXPECT_NEAR(gray_at(sh, axis), 127.0 / 192.0, 2e-4);
        EXPECT_NEAR(gray_at(sh, -axis), 1.0 / 4 - 1.0 / 3 + 5.0 / 64, 2e-4) << "instead of 0";
    }
}

TEST(IrradianceSh, SmallLightHasTheKnownError) {
    // One bright texel of 64 x 64 gives an irradiance of 1 at normal incidence. With order 2 it is
    // 1/4 + 1/2 + 5/16.
    std::vector<Image> faces = faces_of(64, [](glm::dvec3) { return glm::dvec3(0); });
    const double cover = solid_angle({0, 0}, {2.0 / 64, 2.0 / 64});
    for (std::size_t c = 0; c < 3; ++c)
        faces[0].as<float>()[3 * (64 * 32 + 32) + c] = static_cast<float>(pi / cover);
    const IrradianceSh sh = irradiance_sh(faces);
    const glm::dvec3 towards = glm::normalize(face_direction(0, 1.0 / 64, 1.0 / 64));
    EXPECT_NEAR(gray_at(sh, towards), 17.0 / 16.0, 1e-4);
    double lowest = 0.0;
    double worst = 0.0;
    for (const glm::dvec3& n : spread_directions(5000)) {
        lowest = std::min(lowest, gray_at(sh, n));
        worst = std::max(worst, std::abs(gray_at(sh, n) - std::max(glm::dot(n, towards), 0.0)));
    }
    // With the cosine x, the polynomial is 3/32 + x/2 + 15/32 x^2. Its minimum is at -8/15, and its
    // largest distance from max(x, 0) is at 0.
    EXPECT_NEAR(lowest, 3.0 / 32 - 2.0 / 15, 1e-4);
    EXPECT_NEAR(worst, 3.0 / 32, 1e-3);
}

TEST_LABELS(not_sanitized);
TEST(IrradianceSh, RealPanoramaIsWithinTwoPercent) {
    RELIEF_NEEDS_SHARED(folder, "data/env/cube/venice_sunset_256");
    std::vector<Image> faces;
    for (const char* name : {"posx", "negx", "posy", "negy", "posz", "negz"})
        faces.push_back(read_image(folder / (std::string(name) + ".hdr"), ImageUse::color));
    const IrradianceSh sh = irradiance_sh(faces);
    double worst = 0.0;
    double sum = 0.0;
    double brightest = 0.0;
    const std::vector<glm::dvec3> normals = spread_directions(60);
    for (const glm::dvec3& n : normals) {
        glm::dvec3 integral(0.0);
        test::for_each_texel(faces,
                             [&](const glm::dvec3& d, double cover, const glm::dvec3& light) {
                                 integral += light * (cover * std::max(glm::dot(d, n), 0.0) / pi);
                             });
        const double off = glm::length(irradiance_over_pi(sh, n) - integral);
        worst = std::max(worst, off);
        sum += off;
        brightest = std::max(brightest, glm::length(integral));
    }
    RecordProperty("worst_of_brightest", std::to_string(worst / brightest));
    RecordProperty("mean_of_brightest", std::to_string(sum / 60.0 / brightest));
    EXPECT_LT(worst / brightest, 0.02);
    EXPECT_LT(sum / 60.0 / brightest, 0.01);
}

TEST(IrradianceSh, RotatedEnvironmentEqualsARotatedNormal) {
    const IrradianceSh sh = irradiance_sh(faces_of(32, [](glm::dvec3 d) {
        return glm::dvec3(std::max(d.x, 0.0), d.z * d.z + 0.5 * d.y,
                          std::max(d.x * d.z + d.y, 0.0));
    }));
    for (const double radians : {0.0, 0.3, pi / 2, -2.0, 3.0}) {
        const IrradianceSh turned = rotated(sh, radians);
        const double c = std::cos(radians), s = std::sin(radians);
        double worst = 0.0;
        for (const glm::dvec3& n : spread_directions(60)) {
            // A quarter turn moves the light at +z to +x.
            const glm::dvec3 now(c * n.x + s * n.z, n.y, c * n.z - s * n.x);
            worst = std::max(
                worst, glm::length(irradiance_over_pi(turned, now) - irradiance_over_pi(sh, n)));
        }
        EXPECT_LT(worst, 1e-6) << radians;
    }
}

TEST(IrradianceSh, RefusesNonFiniteTexelsByPosition) {
    std::vector<Image> faces = faces_of(4, [](glm::dvec3) { return glm::dvec3(1); });
    faces[3].as<float>()[3 * 7 + 1] = std::numeric_limits<float>::infinity();
    try {
        (void)irradiance_sh(faces);
        FAIL() << "was accepted";
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(),
                     "irradiance: face -y holds inf in column 3, row 1, which is not finite");
    }
    faces.pop_back();
    EXPECT_THROW(irradiance_sh(faces), InvalidInput);
    const std::vector<Image> codes(6, make_image(4, 4, 3, 8, ColorSpace::srgb));
    EXPECT_THROW(irradiance_sh(codes), InvalidInput);
}

/// The directions of the texels of faces of this size, all or a regular subset.
struct Probe {
    std::size_t face;
    int x;
    int y;
    glm::dvec3 direction;
};

std::vector<Probe> probes(int size, int step) {
    std::vector<Probe> all;
    for (std::size_t face = 0; face < 6; ++face) {
        for (int y = step / 2; y < size; y += step) {
            for (int x = step / 2; x < size; x += step) {
                all.push_back({face, x, y,
                               face_direction(face, 2.0 * (x + 0.5) / size - 1.0,
                                              2.0 * (y + 0.5) / size - 1.0)});
            }
        }
    }
    return all;
}

glm::dvec3 texel(const std::vector<Image>& faces, const Probe& probe) {
    const Image& face = faces[probe.face];
    const float* sample =
        face.as<float>().data() + static_cast<std::size_t>(3 * (probe.y * face.width + probe.x));
    return {sample[0], sample[1], sample[2]};
}

/// Returns the root mean square of the difference between the tree walk and the sum, divided by
/// that of the sum.
double relative_error(const std::vector<Image>& faces, int size, double roughness, int step) {
    const std::vector<Image> blurred = blurred_faces(RadianceTree(faces), size, roughness);
    double apart = 0.0;
    double all = 0.0;
    for (const Probe& probe : probes(size, step)) {
        const glm::dvec3 expected = blurred_radiance(faces, probe.direction, roughness);
        const glm::dvec3 off = texel(blurred, probe) - expected;
        apart += glm::dot(off, off);
        all += glm::dot(expected, expected);
    }
    return std::sqrt(apart / all);
}

/// A dim room with a small sun that is ten thousand times as bright, and a wide light.
glm::dvec3 sunny_room(glm::dvec3 d) {
    const double sun = glm::dot(d, glm::normalize(glm::dvec3(0.3, 0.8, -0.5)));
    const double lamp = glm::dot(d, glm::normalize(glm::dvec3(-0.7, 0.1, 0.6)));
    return glm::dvec3(0.3 + 0.2 * d.y, 0.3, 0.3 - 0.1 * d.x) +
           glm::dvec3(sun > 0.9995 ? 4000.0 : 0.0) + glm::dvec3(lamp > 0.9 ? 20.0 : 0.0);
}

TEST(Blur, EvenLightStaysEven) {
    const glm::dvec3 light(0.5, 2, 8);
    for (const int source : {1, 2, 64}) {
        const std::vector<Image> faces = faces_of(source, [&](glm::dvec3) { return light; });
        const RadianceTree tree(faces);
        for (const double roughness : {0.1, 0.2, 0.6, 1.0}) {
            for (const int size : {1, 3, 8, 20}) {
                const std::vector<Image> blurred = blurred_faces(tree, size, roughness);
                double worst = 0.0;
                for (const Probe& probe : probes(size, 1))
                    worst = std::max(worst, glm::length(texel(blurred, probe) / light - 1.0));
                // The sum has several thousand terms in float.
                EXPECT_LT(worst, 2e-5) << source << ' ' << roughness << ' ' << size;
            }
        }
    }
}

TEST(Blur, RoughestLevelIsTheCosineMean) {
    // GGX of roughness 1 has a uniform distribution of half vectors: 1 + a.d becomes 1 + 2/3 a.n.
    const glm::dvec3 a(0.4, -0.3, 0.6);
    const std::vector<Image> faces =
        faces_of(64, [&](glm::dvec3 d) { return glm::dvec3(1.0 + glm::dot(a, d)); });
    for (const glm::dvec3& n : spread_directions(20))
        EXPECT_NEAR(blurred_radiance(faces, n, 1.0).x, 1.0 + 2.0 / 3.0 * glm::dot(a, n), 2e-4);
    const std::vector<Image> blurred = blurred_faces(RadianceTree(faces), 8, 1.0);
    for (const Probe& probe : probes(8, 1)) {
        EXPECT_NEAR(texel(blurred, probe).x,
                    1.0 + 2.0 / 3.0 * glm::dot(a, glm::normalize(probe.direction)), 2e-3);
    }
}

TEST_LABELS(not_sanitized);
TEST(Blur, TheWalkIsCloseToTheSumOverAllTexels) {
    const std::vector<Image> faces = faces_of(128, sunny_room);
    // The levels of a prefiltered cube map have these values.
    EXPECT_LT(relative_error(faces, 128, 0.2, 26), 0.02);
    EXPECT_LT(relative_error(faces, 64, 0.4, 13), 0.02);
    EXPECT_LT(relative_error(faces, 32, 0.6, 11), 0.01);
    EXPECT_LT(relative_error(faces, 16, 0.8, 6), 0.01);
    EXPECT_LT(relative_error(faces, 8, 1.0, 3), 0.005);
}

TEST_LABELS(not_sanitized);
TEST(Blur, RealPanoramaIsWithinAPercent) {
    RELIEF_NEEDS_SHARED(folder, "data/env/cube/venice_sunset_256");
    std::vector<Image> faces;
    for (const char* name : {"posx", "negx", "posy", "negy", "posz", "negz"})
        faces.push_back(read_image(folder / (std::string(name) + ".hdr"), ImageUse::color));
    EXPECT_LT(relative_error(faces, 128, 0.2, 64), 0.01);
    EXPECT_LT(relative_error(faces, 32, 0.6, 16), 0.01);
    EXPECT_LT(relative_error(faces, 8, 1.0, 4), 0.01);
}

TEST(Blur, ASunGetsDimmerAndWiderWithRoughness) {
    const std::vector<Image> faces = faces_of(128, sunny_room);
    const RadianceTree tree(faces);
    const glm::dvec3 sun = glm::normalize(glm::dvec3(0.3, 0.8, -0.5));
    const FacePoint at = face_point(sun);
    double before = 1e9;
    double aside_before = 0.0;
    for (const double roughness : {0.1, 0.2, 0.3}) {
        const std::vector<Image> blurred = blurred_faces(tree, 32, roughness);
        const auto column = [&](double shift) {
            return static_cast<int>((at.s + shift + 1.0) * 16.0);
        };
        const int row = static_cast<int>((at.t + 1.0) * 16.0);
        const double peak = texel(blurred, {at.face, column(0), row, {}}).y;
        const double aside = texel(blurred, {at.face, column(0.6), row, {}}).y;
        EXPECT_LT(peak, before);
        EXPECT_GT(aside, aside_before);
        EXPECT_GT(peak, 2.0 * aside);
        before = peak;
        aside_before = aside;
    }
}

TEST(Blur, IsInvariantToRotation) {
    // A quarter turn about y maps texels to texels: +x to -z, -z to -x.
    const auto turned = [](glm::dvec3 d) { return glm::dvec3(d.z, d.y, -d.x); };
    const std::vector<Image> before = faces_of(32, sunny_room);
    const std::vector<Image> after =
        faces_of(32, [&](glm::dvec3 d) { return sunny_room(turned(d)); });
    const std::vector<Image> a = blurred_faces(RadianceTree(before), 16, 0.5);
    const std::vector<Image> b = blurred_faces(RadianceTree(after), 16, 0.5);
    for (const Probe& probe : probes(16, 1)) {
        const FacePoint from = face_point(turned(probe.direction));
        const Probe other{from.face,
                          static_cast<int>((from.s + 1.0) * 8.0),
                          static_cast<int>((from.t + 1.0) * 8.0),
                          {}};
        // The walk visits the same nodes in another order.
        EXPECT_NEAR(texel(b, probe).y / texel(a, other).y, 1.0, 1e-4);
    }
}

TEST(Blur, TheNumberOfThreadsChangesNoBit) {
    const std::vector<Image> faces = faces_of(32, sunny_room);
    const std::vector<Image> all = blurred_faces(RadianceTree(faces), 20, 0.4);
    set_thread_limit(1);
    const std::vector<Image> one = blurred_faces(RadianceTree(faces), 20, 0.4);
    set_thread_limit(0);
    for (std::size_t face = 0; face < 6; ++face)
        EXPECT_EQ(all[face].samples, one[face].samples);
}

TEST(Blur, BlackEnvironmentStaysBlack) {
    const std::vector<Image> faces = faces_of(16, [](glm::dvec3) { return glm::dvec3(0); });
    for (const Image& face : blurred_faces(RadianceTree(faces), 8, 0.5)) {
        for (const float sample : face.as<float>())
            EXPECT_EQ(sample, 0.0F);
    }
}

TEST(Blur, FacesOfAnotherKindAreRefused) {
    const auto faces = [](int size, int channels, int bits) {
        return std::vector<Image>(6, make_image(size, size, channels, bits, ColorSpace::linear));
    };
    try {
        const RadianceTree tree(faces(12, 3, 32));
        FAIL() << "was accepted";
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(),
                     "faces of 12 texels, 3 channels and 32 bits cannot be blurred: it takes a "
                     "power of two, three and 32");
    }
    EXPECT_THROW(RadianceTree(faces(16, 4, 32)), InvalidInput);
    EXPECT_THROW(RadianceTree(faces(16, 3, 8)), InvalidInput);
    EXPECT_THROW(RadianceTree(std::vector<Image>(5, faces(16, 3, 32)[0])), InvalidInput);
}

/// Returns the sheen's albedo by a fine grid over both angles of the light, by KHR_materials_sheen.
double sheen_by_grid(double n_v, double roughness) {
    constexpr int steps = 100;
    const double alpha = roughness * roughness;
    const glm::dvec3 view(std::sqrt(1.0 - n_v * n_v), 0.0, n_v);
    double sum = 0.0;
    for (int j = 0; j < steps; ++j) {
        const double root = (j + 0.5) / steps;
        const double n_l = root * root;
        for (int k = 0; k < steps; ++k) {
            const double phi = 2.0 * std::numbers::pi * (k + 0.5) / steps;
            const double across = std::sqrt(1.0 - n_l * n_l);
            const glm::dvec3 light(across * std::cos(phi), across * std::sin(phi), n_l);
            const double n_h = glm::normalize(light + view).z;
            sum += sheen_distribution(n_h, alpha) * sheen_visibility(n_l, n_v, alpha) * 2.0 * root;
        }
    }
    return sum * 2.0 * std::numbers::pi / (steps * steps);
}

TEST(Sheen, DistributionHasTheIntegralOneOverTheHemisphere) {
    for (const double alpha : {0.01, 0.25, 1.0}) {
        constexpr int steps = 2000;
        double sum = 0.0;
        for (int i = 0; i < steps; ++i) {
            const double n_h = (i + 0.5) / steps;
            sum += sheen_distribution(n_h, alpha) * n_h * 2.0 * std::numbers::pi / steps;
        }
        EXPECT_NEAR(sum, 1.0, 1e-4) << alpha;
    }
}

/// Values of a grid of 400 x 400 by another program.
TEST(Sheen, AlbedoIsTheIntegral) {
    EXPECT_NEAR(sheen_by_grid(0.3, 0.3), 0.21986, 1e-4);
    for (const double roughness : {0.1, 0.3, 0.6, 1.0}) {
        const SheenAlbedo table = sheen_albedo_table(roughness);
        for (const std::size_t i : {4U, 10U, 20U, 31U}) {
            const double root = static_cast<double>(i) / 31.0;
            EXPECT_NEAR(table[i], std::min(sheen_by_grid(root * root, roughness), 1.0), 1e-3)
                << roughness << ", " << i;
        }
        for (int i = 1; i < 50; ++i) {
            const double n_v = i / 50.0;
            EXPECT_NEAR(sheen_albedo(table, n_v), std::min(sheen_by_grid(n_v, roughness), 1.0),
                        5e-3)
                << roughness << ", " << n_v;
        }
    }
}

TEST(Sheen, TablesHaveTheAlbedoOfEveryTexel) {
    for (const double roughness : {1.0, 0.6, 0.3}) {
        const SheenAlbedos tables = sheen_albedo_tables(roughness);
        EXPECT_EQ(tables.back(), sheen_albedo_table(roughness)) << roughness;
        double sum = 0.0;
        double count = 0.0;
        for (double texel = 0.0; texel <= 1.0; texel += 1.0 / 64.0) {
            const double at_texel = roughness * texel;
            if (at_texel < 0.1) continue;
            const SheenAlbedo table = sheen_albedo_table(at_texel);
            for (double n_v = 0.026; n_v <= 1.0; n_v += 0.05) {
                const double difference =
                    std::abs(sheen_albedo(tables, n_v, texel) - sheen_albedo(table, n_v));
                EXPECT_LT(difference, 1e-2) << at_texel << ", " << n_v;
                sum += difference;
                count += 1.0;
            }
        }
        EXPECT_LT(sum / count, 1e-3) << roughness;
        EXPECT_EQ(sheen_albedo(tables, 0.3, 1.0), sheen_albedo(tables.back(), 0.3));
        EXPECT_EQ(sheen_albedo(tables, 0.3, 2.0), sheen_albedo(tables, 0.3, 1.0));
        EXPECT_EQ(sheen_albedo(tables, 0.3, -1.0), sheen_albedo(sheen_albedo_table(0.0), 0.3));
        EXPECT_EQ(sheen_albedo(tables, 1e-4, 0.1), 1.0) << "its fibers would reflect more";
    }
}

TEST(Sheen, NeverReflectsMoreThanItReceives) {
    const SheenAlbedo smooth = sheen_albedo_table(0.0);
    EXPECT_EQ(smooth, sheen_albedo_table(0.045)) << "the smallest roughness";
    EXPECT_EQ(smooth[2], 1.0) << "its fibers would reflect 3.4 times the light";
    for (const double roughness : {0.0, 0.2, 0.5, 1.0}) {
        for (const double albedo : sheen_albedo_table(roughness)) {
            EXPECT_GE(albedo, 0.0);
            EXPECT_LE(albedo, 1.0);
        }
    }
    EXPECT_TRUE(std::isfinite(sheen_visibility(0.0, 0.0, 1.0)));
}

}  // namespace
}  // namespace relief

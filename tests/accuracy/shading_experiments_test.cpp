// SPDX-License-Identifier: Apache-2.0
// The environment formula and the mirror ball in closed form, Fresnel methods and interpolated
// normals against closed forms, and the results of the experiments with rendered images.
#include "shading_experiments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "experiment_checks.h"
#include "experiment_driver.h"
#include "relief/mesh/image.h"
#include "relief/shade/image_compare.h"
#include "rendered_methods.h"
#include "support/labels.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;
using namespace relief::shade;

namespace {

constexpr int cube_side = 24;

double furthest(const Image& a, const Image& b) {
    return compare(a, b).max;
}

glm::dvec3 slope(const glm::dvec3& direction, double strength) {
    return glm::dvec3(0.5 + strength * (0.4 * direction.y + 0.2 * direction.x));
}

/// The factor by which GGX, viewed along the normal, reduces an environment that grows linearly
/// along a direction: the mean of l.r over the directions l that the facets h reflect r to,
/// weighted by l.r. Integrates over the angle of the facets by Simpson's rule.
double left_of_slope(double roughness) {
    const double alpha = roughness * roughness;
    constexpr int steps = 200000;
    double above = 0.0;
    double below = 0.0;
    for (int i = 0; i <= steps; ++i) {
        const double angle = 0.25 * std::numbers::pi * i / steps;
        const double cosine = std::cos(angle);
        const double spread = cosine * cosine * (alpha * alpha - 1.0) + 1.0;
        const double facets = alpha * alpha / (spread * spread) * cosine * std::sin(angle);
        const double mirrored = std::cos(2.0 * angle);
        const double weight = i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
        above += weight * facets * mirrored * mirrored;
        below += weight * facets * mirrored;
    }
    return above / below;
}

TEST_LABELS(not_sanitized);
TEST(TrueMirror, MatchesTheReferenceShader) {
    const Scene ball = mirror_ball(cube_map_of(waves_and_lights, 512), 0.0);
    const Image traced = supersampled_reference(ball, cube_side, 4);
    EXPECT_LT(furthest(traced, exact_mirror(waves_and_lights, cube_side, 4)), 0.006);
    // A mirrored environment is detected.
    const auto turned = [](const glm::dvec3& d) { return waves_and_lights({-d.x, d.y, d.z}); };
    EXPECT_GT(furthest(traced, exact_mirror(turned, cube_side, 4)), 0.1);
}

TEST(RoughMirror, ConstantEnvironmentIsReflectedUnchanged) {
    const auto constant = [](const glm::dvec3&) { return glm::dvec3(0.25, 0.5, 0.75); };
    for (const double roughness : {0.1, 0.5, 1.0}) {
        const Image blurred =
            supersampled_reference(mirror_ball(cube_map_of(constant, 8), roughness), 8, 1);
        EXPECT_LT(furthest(blurred, exact_mirror(constant, 8, 1)), 1e-6) << roughness;
    }
}

TEST(RoughMirror, FlattensGradientsByTheClosedForm) {
    const Environment environment =
        cube_map_of([](const glm::dvec3& d) { return slope(d, 1.0); }, 64);
    for (const double roughness : {0.2, 0.5, 0.9}) {
        const double left = left_of_slope(roughness);
        const Image blurred =
            supersampled_reference(mirror_ball(environment, roughness), cube_side, 1);
        const Image expected =
            exact_mirror([&](const glm::dvec3& d) { return slope(d, left); }, cube_side, 1);
        EXPECT_LT(furthest(blurred, expected), 0.002) << roughness << ", " << left;
        EXPECT_LT(left, 1.0);
    }
    EXPECT_LT(left_of_slope(0.9), 0.8) << "rough enough to tell";
}

FormulaMethod named(const std::vector<FormulaMethod>& methods, const std::string& name) {
    return *std::find_if(methods.begin(), methods.end(),
                         [&](const FormulaMethod& one) { return one.name == name; });
}

ErrorStats error_of(const std::string& name, std::complex<double> index) {
    const std::vector<float> cosines = cosines_of_angles(9001);
    return formula_error(named(fresnel_methods(index, cosines), name),
                         exact_reflectances(index, cosines));
}

TEST(SchlicksError, MatchesPublishedValues) {
    // Computed independently, over angles.
    EXPECT_NEAR(error_of("Schlick", 1.33).max, 0.060, 0.0005);
    EXPECT_NEAR(error_of("Schlick", 1.5).max, 0.036, 0.0005);
    EXPECT_NEAR(error_of("Schlick", 1.5).rms, 0.0135, 0.0002);
    EXPECT_NEAR(error_of("Schlick", 2.42).max, 0.076, 0.0005);
    EXPECT_NEAR(error_of("Schlick", 3.5).max, 0.165, 0.0005);
}

TEST(TrueReflectances, AreKnownAtThreeAngles) {
    // At normal incidence, at Brewster's angle (tan = 1.5) and at grazing incidence.
    const std::vector<float> cosines = {1.0F, static_cast<float>(1.0 / std::sqrt(3.25)), 0.0F};
    const std::vector<double> glass = exact_reflectances(1.5, cosines);
    EXPECT_NEAR(glass[0], 0.04, 1e-12);
    EXPECT_NEAR(glass[1], 0.5 * std::pow(1.25 / 3.25, 2.0), 1e-7);
    EXPECT_EQ(glass[2], 1.0);
}

TEST(FresnelMethods, InFloatAreNearlyExactForGlassAndMetals) {
    for (const std::complex<double>& index :
         {std::complex<double>(1.33), std::complex<double>(4.0), std::complex<double>(0.43, 2.46),
          std::complex<double>(0.96, 6.69), std::complex<double>(2.95, 2.93)}) {
        const ErrorStats error = error_of("Fresnel, float32", index);
        EXPECT_LT(error.max, 3e-6) << index;
        EXPECT_EQ(error.undefined, 0U) << index;
    }
}

TEST(FresnelMethods, WithAThirdNumberAreRightThere) {
    const std::vector<float> at = {1.0F, 1.0F / 7.0F, 0.0F};
    const std::complex<double> iron(2.95, 2.93);
    const FormulaMethod method = named(fresnel_methods(iron, at), "Schlick, right at 82 degrees");
    EXPECT_LT(formula_error(method, exact_reflectances(iron, at)).max, 1e-6);
    EXPECT_LT(error_of(method.name, iron).rms, 0.3 * error_of("Schlick", iron).rms);
}

TEST(FormulaError, SeesAWrongFormula) {
    const std::vector<float> cosines = cosines_of_angles(901);
    const FormulaMethod broken{"Schlick of the fourth power", {}, [&](std::span<float> results) {
                                   for (std::size_t i = 0; i < results.size(); ++i) {
                                       results[i] =
                                           0.04F + 0.96F * std::pow(1.0F - cosines[i], 4.0F);
                                   }
                               }};
    EXPECT_GT(formula_error(broken, exact_reflectances(1.5, cosines)).rms,
              2.0 * error_of("Schlick", 1.5).rms);
    const FormulaMethod undefined{"NaN", {}, [](std::span<float> results) {
                                      std::fill(results.begin(), results.end(), NAN);
                                  }};
    EXPECT_EQ(formula_error(undefined, exact_reflectances(1.5, cosines)).undefined, 901U);
}

TEST(NormalSamples, AreShortestInTheMiddle) {
    // The mean of three unit vectors that are 40 degrees apart.
    const NormalSamples samples(40.0, 97);
    const double expected = std::sqrt((1.0 + 2.0 * std::cos(glm::radians(40.0))) / 3.0);
    double shortest = 2.0;
    double longest = 0.0;
    for (const glm::vec3& n : samples.interpolated()) {
        shortest = std::min(shortest, glm::length(glm::dvec3(n)));
        longest = std::max(longest, glm::length(glm::dvec3(n)));
    }
    EXPECT_NEAR(shortest, expected, 1e-4);
    EXPECT_NEAR(longest, 1.0, 0.01);
    EXPECT_LE(longest, 1.0);
}

/// Diffuse light 0.55 and a highlight 0.45 of shininess 40 [Blinn 1977], by powers and angles. The
/// light is at (0.3, 0.1, 1), the viewer at +z.
double radiance_by_angles(const glm::vec3& interpolated) {
    using Vector = glm::vec<3, long double>;
    const Vector light = glm::normalize(Vector(0.3L, 0.1L, 1.0L));
    const Vector half = glm::normalize(light + Vector(0.0L, 0.0L, 1.0L));
    const Vector normal(interpolated);
    const auto cosine_to = [&](const Vector& other) {
        return std::cos(
            std::atan2(glm::length(glm::cross(normal, other)), glm::dot(normal, other)));
    };
    const long double lit = std::max(cosine_to(light), 0.0L);
    const long double shone = std::pow(std::max(cosine_to(half), 0.0L), 40.0L);
    return static_cast<double>(0.55L * lit + 0.45L * shone);
}

/// The light and the half vector are rounded to float, each component by at most 2^-25. The effect
/// on a highlight 0.45 of exponent 40 is 18 times as large.
constexpr double radiance_rounding = 1e-6;

TEST(UnitNormalReference, IsAFormulaOfAngles) {
    for (const double degrees : {1.0, 30.0, 90.0}) {
        const NormalSamples samples(degrees, 32);
        const std::vector<double> ground_truth = samples.exact_radiances();
        ASSERT_EQ(ground_truth.size(), samples.count());
        double least = 1.0;
        double most = 0.0;
        for (std::size_t i = 0; i < ground_truth.size(); ++i) {
            ASSERT_NEAR(ground_truth[i], radiance_by_angles(samples.interpolated()[i]),
                        radiance_rounding)
                << degrees << " " << i;
            least = std::min(least, ground_truth[i]);
            most = std::max(most, ground_truth[i]);
        }
        if (degrees > 1.0) {
            EXPECT_LT(least, 0.5 * most) << "places of all kinds";
        }
    }
}

/// The RMS error of a method is less than that of another one, times a factor.
struct Rank {
    const char* experiment;
    const char* better;
    const char* worse;
    double factor = 1.0;
};
constexpr std::array ranks = {
    Rank{"shading/interpolation", "Phong, 2304 triangles", "Gouraud, 2304 triangles"},
    Rank{"shading/interpolation", "Gouraud, 2304 triangles", "flat, 2304 triangles"},
    Rank{"shading/interpolation", "flat, 36864 triangles", "flat, 144 triangles", 0.3},
    Rank{"shading/interpolation", "Phong, 36864 triangles", "Phong, 144 triangles", 0.3},
    Rank{"shading/highlights", "GGX", "Blinn-Phong", 0.2},
    Rank{"shading/highlights", "Blinn-Phong", "Blinn-Phong, Phong's exponent"},
    Rank{"shading/highlights", "Phong, a quarter of Blinn's exponent", "Phong, Blinn's exponent"},
    Rank{"shading/cube-map-size", "32 x 32 texels", "16 x 16 texels", 0.65},
    Rank{"shading/cube-map-size", "64 x 64 texels", "32 x 32 texels", 0.6},
    Rank{"shading/cube-map-size", "128 x 128 texels", "64 x 64 texels", 0.9},
    Rank{"shading/glossy-levels", "5 levels, 128 texels", "not blurred", 0.3},
    Rank{"shading/glossy-levels", "6 levels, 256 texels", "not blurred", 0.3},
    Rank{"shading/energy", "all bounces", "one bounce", 0.01},
    Rank{"shading/specular-antialiasing", "Toksvig", "averaged normals", 0.5},
    Rank{"shading/specular-antialiasing", "Toksvig, 2 x 2 pixels", "Toksvig"},
    Rank{"shading/specular-antialiasing", "averaged normals, 2 x 2 pixels", "averaged normals",
         0.6},
    Rank{"shading/specular-antialiasing", "averaged normals, 4 x 4 pixels", "Toksvig", 0.5},
    Rank{"shading/edges", "MSAA, 4 samples", "1 sample", 0.6},
    Rank{"shading/edges", "4 x 4 pixels", "2 x 2 pixels", 0.6},
    // Frames that jump between facets have a small visible error.
    Rank{"tangents/drawn", "stored, 576 triangles", "derived, 576 triangles", 0.995},
    Rank{"tangents/drawn", "stored, 147456 triangles", "stored, 576 triangles", 0.5},
    Rank{"tangents/drawn", "stored, 9216 triangles", "no normal map, 9216 triangles", 0.2}};

class RenderedExperiment : public testing::TestWithParam<const char*> {
  protected:
    void SetUp() override {
        if (!accuracy::detail::GlDevice().is_available()) GTEST_SKIP() << "no OpenGL";
    }
};

TEST_LABELS(not_sanitized);
TEST_P(RenderedExperiment, RanksItsMethods) {
    const Experiment experiment = run_one(GetParam());
    expect_whole({experiment}, experiment.subject);
    for (const Rank& rank : ranks) {
        if (experiment.id != rank.experiment) continue;
        EXPECT_LT(measurement_of(experiment, rank.better).error.rms,
                  rank.factor * measurement_of(experiment, rank.worse).error.rms)
            << rank.better << " against " << rank.worse;
    }
    // Images and heat maps have the size that the experiment states.
    for (const PicturePair& pair : experiment.pictures) {
        for (const Image& image : {pair.before, pair.after})
            EXPECT_EQ(static_cast<double>(image.width) * image.height, experiment.items);
    }
    for (const HeatMap& map : experiment.heat_maps)
        EXPECT_EQ(static_cast<double>(map.errors.width) * map.errors.height, experiment.items);
    if (experiment.id == "shading/energy") {
        // From the front, a white metal of roughness 1 mirrors 1 - log(2) of even light at once.
        EXPECT_NEAR(measurement_of(experiment, "one bounce").error.max, 69.3, 0.5);
    }
}

INSTANTIATE_TEST_SUITE_P(All, RenderedExperiment,
                         testing::Values("shading/interpolation", "shading/highlights",
                                         "shading/cube-map-size", "shading/glossy-levels",
                                         "shading/energy", "shading/specular-antialiasing",
                                         "shading/edges", "tangents/drawn"),
                         [](const testing::TestParamInfo<const char*>& tested) {
                             std::string name = tested.param;
                             std::replace_if(
                                 name.begin(), name.end(),
                                 [](char letter) { return letter == '/' || letter == '-'; }, '_');
                             return name;
                         });

}  // namespace
}  // namespace relief::test

// SPDX-License-Identifier: Apache-2.0
// Fresnel methods and interpolated normals against closed forms.
#include "shading_experiments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "experiment_checks.h"
#include "experiment_driver.h"

namespace relief {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

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

}  // namespace
}  // namespace relief

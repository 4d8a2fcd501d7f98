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

/// The error of the light of normals from `normal_of`, by the formula of this file.
template <typename NormalOf>
double error_of_normals(const NormalSamples& samples, NormalOf normal_of) {
    const FormulaMethod method{
        "", {}, [&](std::span<float> results) {
            for (std::size_t i = 0; i < results.size(); ++i) {
                results[i] =
                    static_cast<float>(radiance_by_angles(normal_of(samples.interpolated()[i])));
            }
        }};
    return formula_error(method, samples.exact_radiances()).rms;
}

TEST(UnitNormalReference, DetectsNormalsRotatedByADegree) {
    const NormalSamples samples(30.0, 32);
    const auto turned = [](double degrees) {
        return [degrees](const glm::vec3& n) {
            const double angle = glm::radians(degrees);
            return glm::vec3(std::cos(angle) * n.x + std::sin(angle) * n.z, n.y,
                             std::cos(angle) * n.z - std::sin(angle) * n.x);
        };
    };
    EXPECT_LT(error_of_normals(samples, turned(0.0)), radiance_rounding);
    const double of_one = error_of_normals(samples, turned(1.0));
    // At its steepest, 9 degrees from its center, a highlight of exponent 40 changes by 0.03 per
    // degree; diffuse light elsewhere changes by a few thousandths.
    EXPECT_GT(of_one, 0.01);
    EXPECT_LT(of_one, 0.03);
    EXPECT_NEAR(error_of_normals(samples, turned(2.0)), 2.0 * of_one, 0.01 * of_one);
}

TEST(UnitNormalReference, DetectsWrongLengths) {
    // The light of normals n |n|^p: p = 0 for the interpolated normal, -1 for the unit normal, -2
    // for one that is too long by the same factor. At one degree only the first order shows.
    const NormalSamples samples(1.0, 32);
    const auto error_with = [&](double power) {
        const FormulaMethod method{
            "", {}, [&](std::span<float> results) {
                for (std::size_t i = 0; i < results.size(); ++i) {
                    const glm::dvec3 n = glm::dvec3(samples.interpolated()[i]) *
                                         std::pow(glm::length(samples.interpolated()[i]), power);
                    const double diffuse = glm::dot(n, glm::dvec3(NormalSamples::light()));
                    const double highlight = glm::dot(n, glm::dvec3(NormalSamples::half()));
                    results[i] =
                        static_cast<float>(0.55 * diffuse + 0.45 * std::pow(highlight, 40.0));
                }
            }};
        return formula_error(method, samples.exact_radiances()).rms;
    };
    const std::vector<FormulaMethod> methods = unit_normal_methods(samples);
    const double as_interpolated = formula_error(methods.front(), samples.exact_radiances()).rms;
    EXPECT_LT(error_with(-1.0), radiance_rounding);
    EXPECT_NEAR(error_with(0.0), as_interpolated, radiance_rounding);
    EXPECT_NEAR(error_with(-2.0), as_interpolated, 0.01 * as_interpolated);
    EXPECT_GT(as_interpolated, 2e-4);
}

}  // namespace
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Interpolated normals and what their length does to light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "experiment_checks.h"
#include "shading/shading_plan.h"
#include "shading/unit_normal_methods.h"

namespace relief {
namespace {

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

TEST(UnitNormalMethods, ErrByTheSquareAndTheFourthPowerOfTheAngle) {
    const Experiment experiment = unit_normal_experiment(test::quick_untimed());
    const std::vector<Curve>& curves = experiment.charts.front().curves;
    ASSERT_EQ(curves.size(), 4U);
    EXPECT_NEAR(curves[0].order.value(), curves[0].expected_order.value(), 0.15);
    EXPECT_NEAR(curves[1].order.value(), curves[1].expected_order.value(), 0.3);
    EXPECT_GT(experiment.measurements[0].error.max, 0.1);
    EXPECT_LT(experiment.measurements[1].error.rms, 0.15 * experiment.measurements[0].error.rms);
    EXPECT_LT(experiment.measurements[2].error.max, 1e-5);
    EXPECT_LT(experiment.measurements[3].error.max, 1e-7);
}

/// Diffuse light 0.55 and a highlight of 0.45 and shininess 40 [Blinn 1977], by powers and angles:
/// the lamp at (0.3, 0.1, 1), the eye in +z.
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

/// Lamp and half vector are rounded to float, each number by 2^-25 at most: what that does to a
/// highlight of 0.45 and exponent 40 is 18 times as much.
constexpr double radiance_rounding = 1e-6;

TEST(UnitNormalTruth, IsAFormulaOfAnglesAtEveryPlace) {
    for (const double degrees : {1.0, 30.0, 90.0}) {
        const NormalSamples samples(degrees, 32);
        const std::vector<double> truth = samples.true_radiances();
        ASSERT_EQ(truth.size(), samples.count());
        double least = 1.0;
        double most = 0.0;
        for (std::size_t i = 0; i < truth.size(); ++i) {
            ASSERT_NEAR(truth[i], radiance_by_angles(samples.interpolated()[i]), radiance_rounding)
                << degrees << " " << i;
            least = std::min(least, truth[i]);
            most = std::max(most, truth[i]);
        }
        EXPECT_EQ(samples.brightest(), most);
        if (degrees > 1.0) {
            EXPECT_LT(least, 0.5 * most) << "places of all kinds";
        }
    }
}

/// The error of light from what `normal_of` makes of interpolated normals, by this file's formula.
template <typename NormalOf>
double error_of_normals(const NormalSamples& samples, NormalOf normal_of) {
    const FormulaMethod method{
        "", {}, [&](std::span<float> results) {
            for (std::size_t i = 0; i < results.size(); ++i) {
                results[i] =
                    static_cast<float>(radiance_by_angles(normal_of(samples.interpolated()[i])));
            }
        }};
    return formula_error(method, samples.true_radiances()).rms;
}

TEST(UnitNormalTruth, TellsNormalsThatAreTurnedByADegree) {
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
    // Where it is steepest, 9 degrees off, a highlight of exponent 40 loses 0.03 in a degree, and
    // diffuse light elsewhere some thousandths.
    EXPECT_GT(of_one, 0.01);
    EXPECT_LT(of_one, 0.03);
    EXPECT_NEAR(error_of_normals(samples, turned(2.0)), 2.0 * of_one, 0.01 * of_one);
}

TEST(UnitNormalTruth, TellsALengthThatIsWrong) {
    // The light of normals n |n|^p: p = 0 as interpolated, -1 unit, -2 as much too long as those
    // are short. Where normals are a degree apart, only the first order shows.
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
        return formula_error(method, samples.true_radiances()).rms;
    };
    const std::vector<FormulaMethod> methods = unit_normal_methods(samples);
    const double as_interpolated = formula_error(methods.front(), samples.true_radiances()).rms;
    EXPECT_LT(error_with(-1.0), radiance_rounding);
    EXPECT_NEAR(error_with(0.0), as_interpolated, radiance_rounding);
    EXPECT_NEAR(error_with(-2.0), as_interpolated, 0.01 * as_interpolated);
    EXPECT_GT(as_interpolated, 2e-4);
}

}  // namespace
}  // namespace relief

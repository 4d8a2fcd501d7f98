// SPDX-License-Identifier: Apache-2.0
// Schlick's error where it is known, and the other formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiment_checks.h"
#include "measured_methods.h"
#include "shading/fresnel_methods.h"
#include "shading/shading_plan.h"

namespace relief {
namespace {

FormulaMethod named(const std::vector<FormulaMethod>& methods, const std::string& name) {
    return *std::find_if(methods.begin(), methods.end(),
                         [&](const FormulaMethod& one) { return one.name == name; });
}

ErrorFigures error_of(const std::string& name, std::complex<double> index) {
    const std::vector<float> cosines = cosines_of_angles(9001);
    return formula_error(named(fresnel_methods(index, cosines), name),
                         true_reflectances(index, cosines));
}

TEST(SchlicksError, IsWhatItIsKnownToBe) {
    // Measured apart from this program, over angles.
    EXPECT_NEAR(error_of("Schlick", 1.33).max, 0.060, 0.0005);
    EXPECT_NEAR(error_of("Schlick", 1.5).max, 0.036, 0.0005);
    EXPECT_NEAR(error_of("Schlick", 1.5).rms, 0.0135, 0.0002);
    EXPECT_NEAR(error_of("Schlick", 2.42).max, 0.076, 0.0005);
    EXPECT_NEAR(error_of("Schlick", 3.5).max, 0.165, 0.0005);
}

TEST(TrueReflectances, AreKnownAtThreeAngles) {
    // Straight on, at Brewster's angle, where tan = 1.5, and along the surface.
    const std::vector<float> cosines = {1.0F, static_cast<float>(1.0 / std::sqrt(3.25)), 0.0F};
    const std::vector<double> glass = true_reflectances(1.5, cosines);
    EXPECT_NEAR(glass[0], 0.04, 1e-12);
    EXPECT_NEAR(glass[1], 0.5 * std::pow(1.25 / 3.25, 2.0), 1e-7);
    EXPECT_EQ(glass[2], 1.0);
}

TEST(FresnelMethods, InFloatAreNearlyExactForGlassAndMetals) {
    for (const std::complex<double>& index :
         {std::complex<double>(1.33), std::complex<double>(4.0), std::complex<double>(0.43, 2.46),
          std::complex<double>(0.96, 6.69), std::complex<double>(2.95, 2.93)}) {
        const ErrorFigures error = error_of("Fresnel, float32", index);
        EXPECT_LT(error.max, 3e-6) << index;
        EXPECT_EQ(error.undefined, 0U) << index;
    }
}

TEST(FresnelMethods, WithAThirdNumberAreRightThere) {
    const std::vector<float> at = {1.0F, 1.0F / 7.0F, 0.0F};
    const std::complex<double> iron(2.95, 2.93);
    const FormulaMethod method = named(fresnel_methods(iron, at), "Schlick, right at 82 degrees");
    EXPECT_LT(formula_error(method, true_reflectances(iron, at)).max, 1e-6);
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
    EXPECT_GT(formula_error(broken, true_reflectances(1.5, cosines)).rms,
              2.0 * error_of("Schlick", 1.5).rms);
    const FormulaMethod undefined{"NaN", {}, [](std::span<float> results) {
                                      std::fill(results.begin(), results.end(), NAN);
                                  }};
    EXPECT_EQ(formula_error(undefined, true_reflectances(1.5, cosines)).undefined, 901U);
}

TEST(FresnelExperiments, RankTheFormulas) {
    const RunOptions options = test::quick_untimed();
    const Experiment glass = glass_experiment(options);
    EXPECT_LT(method_in(glass, "Schlick").error.rms, 0.1 * method_in(glass, "constant").error.rms);
    EXPECT_LT(method_in(glass, "Fresnel, float32").error.rms, 1e-6);
    EXPECT_NE(glass.finding.find("0.013 (RMS; at most 0.036)"), std::string::npos) << glass.finding;
    const Experiment metal = metal_experiment(options);
    EXPECT_GT(method_in(metal, "Schlick").error.max,
              3.0 * method_in(metal, "Schlick, right at 82 degrees").error.max);
    EXPECT_FALSE(glass.measurements.front().cost.one_thread);
}

}  // namespace
}  // namespace relief

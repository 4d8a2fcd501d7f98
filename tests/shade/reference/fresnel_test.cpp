// SPDX-License-Identifier: Apache-2.0
// Fresnel's factor and the reflectance of thin films of the CPU reference, against hand-computed
// values and a sum over wavelengths.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/reference_parts.h"

namespace relief::shade::reference {
namespace {

TEST(Fresnel, AtNormalIncidenceIsTheSquaredRatioOfDifferenceAndSum) {
    EXPECT_NEAR(fresnel(1.5, 1.0), 0.04, 1e-15);
    EXPECT_NEAR(fresnel(3.0, 1.0), 0.25, 1e-15);
    // |n - 1 + ik|^2 / |n + 1 + ik|^2.
    EXPECT_NEAR(fresnel({0.5, 2.0}, 1.0), (0.25 + 4.0) / (2.25 + 4.0), 1e-15);
}

TEST(Fresnel, AtGrazingIncidenceMirrorsEverything) {
    EXPECT_EQ(fresnel(1.5, 0.0), 1.0);
    EXPECT_EQ(fresnel({0.2, 3.0}, 0.0), 1.0);
    EXPECT_NEAR(fresnel(1.5, 1e-6), 1.0, 1e-5);
}

TEST(Fresnel, AtBrewstersAngleMirrorsOnePolarisationOnly) {
    // At tan = n, the surface transmits all light polarized in the plane and reflects
    // ((n^2-1)/(n^2+1))^2 of the rest.
    const double cosine = 1.0 / std::sqrt(1.0 + 1.5 * 1.5);
    const double across = (1.5 * 1.5 - 1.0) / (1.5 * 1.5 + 1.0);
    EXPECT_NEAR(fresnel(1.5, cosine), 0.5 * across * across, 1e-15);
}

TEST(Fresnel, IsZeroWithoutABoundary) {
    for (const double cosine : {0.0, 0.3, 1.0})
        EXPECT_EQ(fresnel(1.0, cosine), 0.0);
}

TEST(Fresnel, IsOneForAnIndexOfZero) {
    EXPECT_EQ(fresnel(0.0, 0.7), 1.0);
}

TEST(Fresnel, FactorFollowsTheMaterialsModel) {
    Material material;
    material.reflectivity = {0.25F, 0.5F, 1.0F};
    material.grazing_reflectivity = {1.0F, 0.5F, 1.0F};
    // (1 - 0.5)^5 = 1/32.
    EXPECT_EQ(fresnel_factor(material, 0.5), glm::dvec3(0.25 + 0.75 / 32, 0.5, 1.0));
    material.fresnel = FresnelModel::dielectric;
    material.refractive_index = 3.0F;
    EXPECT_NEAR(fresnel_factor(material, 1.0).g, 0.5 * 0.25, 1e-15);
    material.fresnel = FresnelModel::conductor;
    material.conductor_index = {0.5F, 3.0F, 0.5F};
    material.conductor_absorption = {2.0F, 0.0F, 0.0F};
    const glm::dvec3 metal = fresnel_factor(material, 1.0);
    EXPECT_NEAR(metal.r, 0.25 * 4.25 / 6.25, 1e-15);
    EXPECT_NEAR(metal.g, 0.5 * 0.25, 1e-15);
    EXPECT_NEAR(metal.b, 1.0 / 9.0, 1e-15);
}

/// The sensitivities of an eye as sums of Gaussians over wavelengths in nanometers: Wyman, Sloan,
/// Shirley: Simple Analytic Approximations to the CIE XYZ Color Matching Functions. JCGT 2(2),
/// 2013.
glm::dvec3 sensitivity(double wavelength) {
    const auto g = [&](double mean, double below, double above) {
        const double t = (wavelength - mean) / (wavelength < mean ? below : above);
        return std::exp(-0.5 * t * t);
    };
    return {
        1.056 * g(599.8, 37.9, 31.0) + 0.362 * g(442.0, 16.0, 26.7) - 0.065 * g(501.1, 20.4, 26.2),
        0.821 * g(568.8, 46.9, 40.5) + 0.286 * g(530.9, 16.3, 31.1),
        1.217 * g(437.0, 11.8, 36.0) + 0.681 * g(459.0, 26.0, 13.8)};
}

/// Returns a film's reflectance at normal incidence by Airy's formula [Born and Wolf 1999], as a
/// sum over wavelengths, relative to white.
glm::dvec3 film_by_wavelengths(double base_index, double index, double thickness) {
    const double outer = (1.0 - index) / (1.0 + index);
    const double inner = (index - base_index) / (index + base_index);
    glm::dvec3 sum(0.0);
    glm::dvec3 white(0.0);
    for (double wavelength = 360.0; wavelength < 830.0; wavelength += 1.0) {
        const double phase = 4.0 * std::numbers::pi * index * thickness / wavelength;
        const double mixed = 2.0 * outer * inner * std::cos(phase);
        const double reflected =
            (outer * outer + inner * inner + mixed) / (1.0 + outer * outer * inner * inner + mixed);
        sum += sensitivity(wavelength) * reflected;
        white += sensitivity(wavelength);
    }
    const glm::dmat3 rgb_from_xyz(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108,
                                  -0.2040259, -0.4985314, 0.0415560, 1.0572252);
    return rgb_from_xyz * sum / (rgb_from_xyz * white);
}

/// The model's sensitivities and its white differ slightly from those of the sum.
TEST(FilmReflectance, AtNormalIncidenceIsTheSumOverWavelengths) {
    double darkest = 1.0;
    double brightest = 0.0;
    for (const double base_index : {1.5, 3.0}) {
        for (const double index : {1.3, 1.8}) {
            for (const double thickness : {0.0, 100.0, 200.0, 300.0, 600.0, 2000.0}) {
                const double root = (base_index - 1.0) / (base_index + 1.0);
                const glm::dvec3 found =
                    film_reflectance(glm::dvec3(root * root), 1.0, index, thickness);
                const glm::dvec3 expected = film_by_wavelengths(base_index, index, thickness);
                for (int i = 0; i < 3; ++i) {
                    EXPECT_NEAR(found[i], expected[i], 0.04)
                        << base_index << " " << index << " " << thickness << " " << i;
                    darkest = std::min(darkest, found[i]);
                    brightest = std::max(brightest, found[i]);
                }
            }
        }
    }
    EXPECT_LT(darkest, 0.01);
    EXPECT_GT(brightest, 0.2);
}

TEST(FilmReflectance, IsFiniteAtTheEndsOfItsRanges) {
    EXPECT_EQ(film_reflectance(glm::dvec3(0.04), 0.0, 1.3, 400.0), glm::dvec3(1.0));
    for (const double f0 : {0.0, 0.9999, 1.0}) {
        for (const double index : {1.0, 1000.0}) {
            for (const double cosine : {0.0, 1.0}) {
                const glm::dvec3 film = film_reflectance(glm::dvec3(f0), cosine, index, 1e6);
                EXPECT_TRUE(film.r >= 0.0 && film.r <= 1.001) << film.r;
            }
        }
    }
}

TEST(Fresnel, FactorOutsideItsAnglesIsTheNearerEnds) {
    Material material;
    material.reflectivity = glm::vec3(0.25F);
    EXPECT_EQ(fresnel_factor(material, -0.5), glm::dvec3(1.0));
    EXPECT_EQ(fresnel_factor(material, 1.5), glm::dvec3(0.25));
}

TEST(Fresnel, IsZeroForZeroReflectivity) {
    Material material;
    for (const FresnelModel model :
         {FresnelModel::schlick, FresnelModel::dielectric, FresnelModel::conductor}) {
        material.fresnel = model;
        EXPECT_EQ(fresnel_factor(material, 0.0), glm::dvec3(0.0));
    }
}

}  // namespace
}  // namespace relief::shade::reference

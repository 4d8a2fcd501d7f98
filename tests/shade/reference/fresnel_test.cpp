// SPDX-License-Identifier: Apache-2.0
// Fresnel's formulas at angles where they have a short answer.
#include "reference/shading.h"

#include <gtest/gtest.h>

#include <cmath>

namespace relief::reference {
namespace {

TEST(Fresnel, AtNormalIncidenceIsTheSquaredRatioOfDifferenceAndSum) {
    EXPECT_NEAR(fresnel(1.5, 1.0), 0.04, 1e-15);
    EXPECT_NEAR(fresnel(3.0, 1.0), 0.25, 1e-15);
    // |n - 1 + ik|^2 / |n + 1 + ik|^2
    EXPECT_NEAR(fresnel({0.5, 2.0}, 1.0), (0.25 + 4.0) / (2.25 + 4.0), 1e-15);
}

TEST(Fresnel, AtGrazingIncidenceMirrorsEverything) {
    EXPECT_EQ(fresnel(1.5, 0.0), 1.0);
    EXPECT_EQ(fresnel({0.2, 3.0}, 0.0), 1.0);
    EXPECT_NEAR(fresnel(1.5, 1e-6), 1.0, 1e-5);
}

TEST(Fresnel, AtBrewstersAngleMirrorsOnePolarisationOnly) {
    // tan = n: what is polarised along the plane goes in; the rest mirrors ((n^2-1)/(n^2+1))^2.
    const double cosine = 1.0 / std::sqrt(1.0 + 1.5 * 1.5);
    const double across = (1.5 * 1.5 - 1.0) / (1.5 * 1.5 + 1.0);
    EXPECT_NEAR(fresnel(1.5, cosine), 0.5 * across * across, 1e-15);
}

TEST(Fresnel, WithoutABoundaryMirrorsNothing) {
    for (const double cosine : {0.0, 0.3, 1.0})
        EXPECT_EQ(fresnel(1.0, cosine), 0.0);
}

TEST(Fresnel, OfNoIndexMirrorsEverything) {
    EXPECT_EQ(fresnel(0.0, 0.7), 1.0);
}

TEST(Fresnel, FactorFollowsTheMaterialsModel) {
    Material material;
    material.reflectivity = {0.25F, 0.5F, 1.0F};
    material.grazing_reflectivity = {1.0F, 0.5F, 1.0F};
    // (1 - 0.5)^5 = 1/32
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

TEST(Fresnel, FactorOutsideItsAnglesIsTheNearerEnds) {
    Material material;
    material.reflectivity = glm::vec3(0.25F);
    EXPECT_EQ(fresnel_factor(material, -0.5), glm::dvec3(1.0));
    EXPECT_EQ(fresnel_factor(material, 1.5), glm::dvec3(0.25));
}

TEST(Fresnel, FactorOfASurfaceThatMirrorsNothingIsZeroAtEveryAngle) {
    Material material;
    for (const FresnelModel model :
         {FresnelModel::schlick, FresnelModel::dielectric, FresnelModel::conductor}) {
        material.fresnel = model;
        EXPECT_EQ(fresnel_factor(material, 0.0), glm::dvec3(0.0));
    }
}

}  // namespace
}  // namespace relief::reference

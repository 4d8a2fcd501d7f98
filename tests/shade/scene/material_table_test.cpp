// SPDX-License-Identifier: Apache-2.0
// The classic materials: numbers known from the printed table, and that all of them can be drawn.
#include <gtest/gtest.h>

#include <cmath>

#include <algorithm>

#include "relief/shade/scene.h"

namespace relief {
namespace {

/// A colour of the table, decoded by hand from sRGB (IEC 61966-2-1).
glm::vec3 seen(const glm::vec3& codes) {
    glm::vec3 linear;
    for (int i = 0; i < 3; ++i)
        linear[i] =
            codes[i] <= 0.04045F ? codes[i] / 12.92F : std::pow((codes[i] + 0.055F) / 1.055F, 2.4F);
    return linear;
}

void expect_same_color(const glm::vec3& actual, const glm::vec3& expected) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(actual[i], expected[i], 1e-6F);
}

TEST(MaterialByName, HasTheNumbersOfTheTable) {
    const Material gold = material_by_name("gold").value();
    EXPECT_EQ(gold.name, "gold");
    expect_same_color(gold.ambient, seen(glm::vec3(0.24725F, 0.1995F, 0.0745F)));
    expect_same_color(gold.diffuse, seen(glm::vec3(0.75164F, 0.60648F, 0.22648F)));
    expect_same_color(gold.specular, seen(glm::vec3(0.628281F, 0.555802F, 0.366065F)));
    EXPECT_NEAR(gold.shininess, 51.2F, 1e-5F);
    EXPECT_EQ(gold.specular_model, SpecularModel::phong);
    // Exponents as later tables print them.
    EXPECT_NEAR(material_by_name("brass")->shininess, 27.8974F, 1e-4F);
    EXPECT_NEAR(material_by_name("pewter")->shininess, 9.84615F, 1e-4F);
    EXPECT_NEAR(material_by_name("pearl")->shininess, 11.264F, 1e-4F);
    EXPECT_NEAR(material_by_name("polished silver")->shininess, 89.6F, 1e-4F);
    EXPECT_EQ(material_by_name("black rubber")->shininess, 10.0F);
    expect_same_color(material_by_name("yellow plastic")->diffuse,
                      seen(glm::vec3(0.5F, 0.5F, 0.0F)));
}

TEST(MaterialByName, CaresForNeitherCaseNorSeparators) {
    EXPECT_EQ(material_by_name("Red_Plastic")->name, "red plastic");
    EXPECT_EQ(material_by_name("POLISHED-GOLD")->name, "polished gold");
}

TEST(MaterialByName, GivesNothingForOtherNames) {
    EXPECT_FALSE(material_by_name("gild"));
    EXPECT_FALSE(material_by_name(""));
    EXPECT_FALSE(material_by_name("gold "));
}

TEST(MaterialNames, AreSortedAndAllCanBeDrawn) {
    const std::vector<std::string>& names = material_names();
    EXPECT_EQ(names.size(), 29U);  // 24 teapots, pewter and four polished metals.
    EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
    Scene scene;
    for (const std::string& name : names) {
        scene.materials.push_back(material_by_name(name).value());
        EXPECT_EQ(scene.materials.back().name, name);
    }
    EXPECT_NO_THROW(validate(scene));
}

}  // namespace
}  // namespace relief

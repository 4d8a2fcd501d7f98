// SPDX-License-Identifier: Apache-2.0
// The factors of materials that are written to a document.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <string>

#include "files.h"
#include "relief/mesh/gltf_document.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using testing::HasSubstr;
using testing::Not;

class GltfFactors : public testing::Test {
  protected:
    GltfFactors() {
        MeshFile file;
        file.mesh = test::grid(1);
        file.materials.resize(1);
        file.mesh.material_ranges = {{0, 2, 0U}};
        document_.emplace(GltfDocument::from_mesh(file));
    }

    /// Returns the JSON of the document.
    std::string written() {
        document_->write(folder_ / "a.gltf");
        return detail::read_file(folder_ / "a.gltf");
    }
    GltfMaterial read_back() {
        written();
        return GltfDocument::read(folder_ / "a.gltf").view().materials.front();
    }

    test::TemporaryDirectory folder_;
    std::optional<GltfDocument> document_;
};

TEST_F(GltfFactors, AreReadBackAndDeclareTheirExtensions) {
    GltfMaterial values;
    MetallicRoughness& surface = *values.metallic_roughness;
    surface.base_color = {0.5F, 0.25F, 0.125F};
    values.opacity = 0.75F;
    surface.metallic = 0.1F;
    surface.roughness = 0.2F;
    surface.refractive_index = 1.25F;
    surface.sheen_color = {0.0F, 0.5F, 1.0F};
    surface.attenuation_distance = 3.5F;
    values.emission_factor = {1.0F, 0.5F, 0.0F};
    values.emission_strength = 4.0F;
    values.double_sided = true;
    document_->set_factors(0, values);
    const GltfMaterial read = read_back();
    EXPECT_EQ(read.metallic_roughness->base_color, surface.base_color);
    EXPECT_EQ(read.opacity, 0.75F);
    EXPECT_EQ(read.metallic_roughness->metallic, 0.1F);
    EXPECT_EQ(read.metallic_roughness->roughness, 0.2F);
    EXPECT_EQ(read.metallic_roughness->refractive_index, 1.25F);
    EXPECT_EQ(read.metallic_roughness->sheen_color, surface.sheen_color);
    EXPECT_EQ(read.metallic_roughness->attenuation_distance, 3.5F);
    EXPECT_EQ(read.emission, glm::vec3(4.0F, 2.0F, 0.0F));
    EXPECT_TRUE(read.double_sided);
    const std::string text = written();
    for (const char* extension : {"KHR_materials_ior", "KHR_materials_sheen",
                                  "KHR_materials_volume", "KHR_materials_emissive_strength"})
        EXPECT_THAT(text, HasSubstr(extension));
    EXPECT_THAT(text, Not(HasSubstr("KHR_materials_clearcoat")));
}

TEST_F(GltfFactors, AreLeftOutIfTheyHaveTheirDefaults) {
    GltfMaterial values;
    values.metallic_roughness->clearcoat = 1.0F;
    values.emission_strength = 2.0F;
    document_->set_factors(0, values);
    EXPECT_THAT(written(), HasSubstr("KHR_materials_clearcoat"));
    document_->set_factors(0, GltfMaterial());
    const std::string text = written();
    for (const char* word :
         {"extensions", "metallicFactor", "roughnessFactor", "baseColorFactor", "emissiveFactor"})
        EXPECT_THAT(text, Not(HasSubstr(word)));
}

TEST_F(GltfFactors, AreClampedToTheRangesOfGltf) {
    GltfMaterial values;
    values.metallic_roughness->metallic = 2.0F;
    values.metallic_roughness->roughness = -1.0F;
    values.metallic_roughness->base_color = glm::vec3(3.0F);
    values.emission_factor = glm::vec3(5.0F);
    document_->set_factors(0, values);
    const GltfMaterial read = read_back();
    EXPECT_EQ(read.metallic_roughness->metallic, 1.0F);
    EXPECT_EQ(read.metallic_roughness->roughness, 0.0F);
    EXPECT_EQ(read.metallic_roughness->base_color, glm::vec3(1.0F));
    EXPECT_EQ(read.emission, glm::vec3(1.0F));
}

TEST_F(GltfFactors, MustBeFiniteAndBelongToAMaterial) {
    GltfMaterial values;
    EXPECT_THROW(document_->set_factors(1, values), InvalidInput);
    values.metallic_roughness->roughness = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(document_->set_factors(0, values), InvalidInput);
}

}  // namespace
}  // namespace relief

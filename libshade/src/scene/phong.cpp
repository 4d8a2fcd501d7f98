// SPDX-License-Identifier: Apache-2.0
// Other material models as Phong's, by the rules of scene_file.h. Colours linear;
// metallic-roughness as glTF 2.0 defines it (alpha = roughness^2). Out-of-range factors, which glTF
// forbids, count as the nearest allowed one. Tests: tests/shade/scene/phong_test.cpp.
#include <algorithm>
#include <cmath>

#include "relief/shade/scene_file.h"
#include "scene/usable_numbers.h"

namespace relief {

namespace {

/// Of every dielectric, as glTF fixes it.
constexpr float dielectric_f0 = 0.04F;
/// The least roughness that the highlight's exponent follows.
constexpr float least_roughness = 0.045F;
/// tan 3 degrees, squared: facets tilted less mirror a recognisable picture.
constexpr float mirror_tan_squared = 0.0027465F;

}  // namespace

Material phong_from_metallic_roughness(const GltfMaterial& material, const TextureMeans& means) {
    const glm::vec3 base = usable(glm::vec3(material.base_color), 1.0F);
    const float metallic = usable(material.metallic * means.metallic, 1.0F);
    const float roughness =
        std::max(usable(material.roughness * means.roughness, 1.0F), least_roughness);
    const float alpha_squared = roughness * roughness * roughness * roughness;
    const glm::vec3 f0 = glm::mix(glm::vec3(dielectric_f0), base * means.base_color, metallic);
    const float mirror = mirror_tan_squared / (mirror_tan_squared + alpha_squared);

    Material phong;
    phong.name = material.name;
    phong.specular_model = SpecularModel::blinn_phong;
    phong.shininess = 2.0F / alpha_squared - 2.0F;
    phong.specular = f0 * ((phong.shininess + 2.0F) / 8.0F);
    phong.reflectivity = f0 * mirror;
    phong.grazing_reflectivity = glm::vec3(mirror);
    phong.diffuse = base * (1.0F - metallic);
    phong.ambient = phong.diffuse + glm::mix(glm::vec3(dielectric_f0), base, metallic);
    phong.emission = usable(material.emission, max_reflectance);
    phong.double_sided = material.double_sided;
    phong.unlit = material.unlit;
    if (material.unlit) phong.diffuse = base;
    return phong;
}

Material phong_from_mtl(const MtlMaterial& material) {
    Material phong;
    phong.name = material.name;
    phong.ambient = usable(material.ambient, max_reflectance);
    phong.diffuse = usable(material.diffuse, max_reflectance);
    phong.emission = usable(material.emission, max_reflectance);
    const glm::vec3 specular = usable(material.specular, max_reflectance);
    const int illumination = material.illumination_model;
    if (illumination >= 2) phong.specular = specular;
    phong.specular_model = SpecularModel::blinn_phong;
    phong.shininess = usable(material.shininess, 1e6F);
    if (illumination >= 3 && illumination <= 9) {
        phong.reflectivity = glm::min(specular, glm::vec3(1.0F));
        const bool fresnel = illumination == 5 || illumination == 7;
        phong.grazing_reflectivity = fresnel ? glm::vec3(1.0F) : phong.reflectivity;
    }
    phong.refractive_index = std::max(usable(material.refractive_index, 1e3F), 1.0F);
    const float opacity = usable(material.opacity, 1.0F);
    if (illumination == 6 || illumination == 7) {
        phong.transmission = 1.0F - opacity;
    } else {
        phong.opacity = opacity;
    }
    if (phong.opacity < 1.0F || material.opacity_map) phong.alpha_mode = AlphaMode::blend;
    phong.unlit = illumination == 0;
    phong.double_sided = true;
    return phong;
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/many_samples_test.cpp.
#include "drawn/lit_scene.h"

namespace relief {

Scene lit_scene(Mesh mesh, Material material) {
    Scene scene;
    mesh.material_ranges = {{0, static_cast<std::uint32_t>(mesh.triangles.size()), 0U}};
    scene.meshes.emplace_back(std::move(mesh));
    scene.materials = {std::move(material)};
    scene.instances = {{}};
    scene.directional_lights = {{lamp_direction_world, glm::vec3(lamp_irradiance)}};
    scene.ambient = glm::vec3(lit_ambient);
    scene.background = lit_background;
    scene.camera =
        framed(world_bounds(scene), glm::radians(30.0F), glm::radians(35.0F), 0.7F, 1.0F);
    scene.camera->vertical_fov = 0.5F;  // What lies flat leaves room above and below.
    return scene;
}

Scene bumpy_scene(Mesh mesh, Material material, Image normal_map) {
    material.normal_map = NormalMap{};
    Scene scene = lit_scene(std::move(mesh), std::move(material));
    scene.images = {{"bumps", Shared<Image>(std::move(normal_map))}};
    return scene;
}

Material glossy_plastic() {
    Material material;
    material.ambient = material.diffuse = {0.55F, 0.16F, 0.1F};
    material.specular = glm::vec3(0.5F);
    material.shininess = 40.0F;
    return material;
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// From a glTF document to a scene: primitives become meshes (one for each, however often placed)
// with the texture coordinates that their material uses, light units become irradiance over pi.
// World space is glTF's. What cannot be drawn as meant is counted in the report; see scene_file.h
// for the list.
// Tests: tests/shade/scene/scene_file_test.cpp.
#include "scene/gltf_scene.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "relief/mesh/frames.h"
#include "scene/gltf_materials.h"

namespace relief {

namespace {

/// A primitive with the texture coordinates at which its material looks its images up.
Mesh mesh_from(const GltfDocument& document, GltfPrimitiveId id,
               const std::vector<GltfMaterial>& materials) {
    Mesh mesh = document.mesh(id);
    if (mesh.material_ranges.empty() || !mesh.material_ranges.front().material) return mesh;
    const TexcoordSource source =
        texcoord_source(materials[*mesh.material_ranges.front().material]);
    if (source.set != 0) mesh = document.mesh(id, source.set);
    if (source.transform == GltfTextureTransform{}) return mesh;
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord = transformed(source.transform, texcoord);
    return mesh;
}

/// Meshes and their places; a primitive that stands in several places is read once.
void add_instances(const GltfDocument& document, const GltfView& view, Scene& scene,
                   Report& report) {
    // Without normals, glTF asks for flat ones and says that tangents given do not count; new ones
    // are left to the effect plan.
    FrameOptions options;
    options.if_missing = NormalMode::flat;
    options.tangents = TangentMode::none;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> mesh_of;
    for (const auto& placed : view.primitives) {
        const auto key = std::pair(placed.what.mesh, placed.what.primitive);
        const auto [entry, is_new] = mesh_of.try_emplace(key, scene.meshes.size());
        if (is_new) {
            Mesh mesh = mesh_from(document, placed.what, view.materials);
            if (mesh.normals.empty()) mesh = with_frames(std::move(mesh), options, report).mesh;
            scene.meshes.push_back(std::move(mesh));
        }
        scene.instances.push_back({entry->second, placed.world_from_object, placed.name});
    }
}

void add_lights(const GltfView& view, Scene& scene) {
    for (const auto& placed : view.lights) {
        const GltfLight& light = placed.what;
        const glm::vec3 direction(-placed.world_from_object[2]);
        const glm::vec3 position(placed.world_from_object[3]);
        const glm::vec3 power = light.color * light.intensity * std::numbers::inv_pi_v<float>;
        const PointLight point{position, power, light.range};
        switch (light.type) {
            case GltfLight::Type::directional:
                scene.directional_lights.push_back({direction, power});
                break;
            case GltfLight::Type::point:
                scene.point_lights.push_back(point);
                break;
            case GltfLight::Type::spot:
                scene.spot_lights.push_back({point, direction, light.inner_cone, light.outer_cone});
                break;
        }
    }
}

/// The first camera, its matrix reduced to rotation and translation; one without depth reaches to
/// the farthest corner of the scene.
void add_camera(const GltfView& view, Scene& scene, Report& report) {
    if (view.cameras.empty()) return;
    const auto& placed = view.cameras.front();
    const glm::vec3 eye(placed.world_from_object[3]);
    const glm::vec3 back = glm::normalize(glm::vec3(placed.world_from_object[2]));
    const glm::vec3 right =
        glm::normalize(glm::cross(glm::vec3(placed.world_from_object[1]), back));
    if (!(glm::length(right) > 0.5F && glm::length(back) > 0.5F)) {
        report.add("camera without a direction", "camera", 0, "left out");
        return;
    }
    Camera camera;
    camera.world_from_view =
        glm::mat4(glm::vec4(right, 0.0F), glm::vec4(glm::cross(back, right), 0.0F),
                  glm::vec4(back, 0.0F), glm::vec4(eye, 1.0F));
    camera.vertical_fov = placed.what.vertical_fov;
    camera.near = placed.what.near;
    if (placed.what.far) {
        camera.far = *placed.what.far;
    } else {
        const Bounds bounds = world_bounds(scene);
        const float reach =
            bounds.empty()
                ? 0.0F
                : glm::length(glm::max(glm::abs(bounds.min - eye), glm::abs(bounds.max - eye)));
        camera.far = std::max(2.0F * camera.near, 1.01F * reach);
    }
    scene.camera = camera;
}

}  // namespace

Scene scene_from(const GltfDocument& document, const SceneOptions& options, Report& report) {
    const GltfView view = document.view();
    Scene scene;
    for (const GltfImage& image : view.images) {
        ImageSource source;
        source.name = image.name;
        std::visit([&](const auto& encoded) { source.source = encoded; }, image.source);
        scene.images.push_back(std::move(source));
    }
    scene.materials = materials_from(view, options, scene.images, report);
    add_instances(document, view, scene, report);
    add_lights(view, scene);
    add_camera(view, scene, report);
    return scene;
}

}  // namespace relief

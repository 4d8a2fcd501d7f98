// SPDX-License-Identifier: Apache-2.0
// Small unlit spheres where point and spot lights are. World space, linear colours. Lights of one
// colour share a mesh and a material. Tests: tests/shade/scene/light_markers_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "relief/mesh/error.h"
#include "relief/mesh/shapes.h"
#include "relief/shade/scene_graph.h"

namespace relief {

namespace {

/// Adds the markers of one scene, and remembers the mesh of each colour.
class MarkerMaker {
  public:
    MarkerMaker(SceneGraph& graph, float radius) : graph_(graph), radius_(radius) {}

    void add(const std::string& name, const PointLight& light, const Carried* carried) {
        const glm::vec3& power = light.intensity;
        const float largest = std::max({power.r, power.g, power.b});
        if (!(largest > 0.0F)) return;
        Scene& scene = graph_.scene;
        const glm::mat4 size = glm::scale(glm::mat4(1.0F), glm::vec3(radius_));
        glm::mat4 world_from_marker = size;
        world_from_marker[3] = glm::vec4(light.position_world, 1.0F);
        graph_.instances.resize(scene.instances.size());
        scene.instances.push_back({mesh_of(power / largest), world_from_marker, name});
        Carried& marker = graph_.instances.emplace_back();
        if (carried == nullptr || !carried->node) return;
        marker = {carried->node, size, true};
        marker.node_from_object[3] = carried->node_from_object[3];
    }

  private:
    std::size_t mesh_of(const glm::vec3& color) {
        Scene& scene = graph_.scene;
        for (const auto& [known, mesh] : meshes_) {
            if (known == color) return mesh;
        }
        Material material;
        material.name = "light marker";
        material.unlit = true;
        material.diffuse = color;
        material.ambient = glm::vec3(0.0F);
        scene.materials.push_back(material);
        Mesh sphere = make_sphere(24, 12);
        sphere.name = "light marker";
        sphere.material_ranges = {{0, static_cast<std::uint32_t>(sphere.triangles.size()),
                                   static_cast<std::uint32_t>(scene.materials.size() - 1)}};
        scene.meshes.push_back(std::move(sphere));
        meshes_.emplace_back(color, scene.meshes.size() - 1);
        return scene.meshes.size() - 1;
    }

    SceneGraph& graph_;
    float radius_;
    std::vector<std::pair<glm::vec3, std::size_t>> meshes_;
};

const Carried* carried_at(const std::vector<Carried>& list, std::size_t index) {
    return index < list.size() ? &list[index] : nullptr;
}

}  // namespace

void add_light_markers(SceneGraph& graph, float radius) {
    if (!(radius > 0.0F && std::isfinite(radius))) {
        throw InvalidInput(fmt::format(
            "the radius of light markers is {}, but must be positive and finite", radius));
    }
    MarkerMaker maker(graph, radius);
    const Scene& scene = graph.scene;
    for (std::size_t i = 0; i < scene.point_lights.size(); ++i) {
        maker.add(fmt::format("point light {}", i), scene.point_lights[i],
                  carried_at(graph.point_lights, i));
    }
    for (std::size_t i = 0; i < scene.spot_lights.size(); ++i) {
        maker.add(fmt::format("spot light {}", i), scene.spot_lights[i].point,
                  carried_at(graph.spot_lights, i));
    }
}

}  // namespace relief

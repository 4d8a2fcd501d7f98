// SPDX-License-Identifier: Apache-2.0
// Markers in a picture: small unlit spheres at point and spot lights, and points at the elements
// that diagnose() reports. Lights of one color share a mesh and a material. Elements without a
// finite position have no marker and are counted only.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <string_view>

#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_graph.h"
#include "scene/scene_parts.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::detail;

// Lights

namespace {

/// Adds the markers of one scene and remembers the mesh of each color.
class MarkerMaker {
  public:
    MarkerMaker(SceneGraph& graph, float radius) : graph_(graph), radius_(radius) {}

    void add(const std::string& name, const PointLight& light, const Carried* carried) {
        const glm::vec3& power = light.intensity;
        const float largest = std::max({power.r, power.g, power.b});
        if (!light.on || !(largest > 0.0F)) return;
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

// Mesh health

namespace {

/// Returns the position of an element of a condition in object space; none if it is not finite.
std::optional<glm::vec3> element_position(const Mesh& mesh, std::string_view element,
                                          std::size_t index) {
    glm::vec3 position;
    if (element == "vertex") {
        position = mesh.positions[index];
    } else if (element == "mesh") {
        return std::nullopt;
    } else {  // A triangle, or an edge of one.
        const glm::uvec3& corners = mesh.triangles[index];
        const glm::dvec3 sum = glm::dvec3(mesh.positions[corners.x]) +
                               glm::dvec3(mesh.positions[corners.y]) +
                               glm::dvec3(mesh.positions[corners.z]);
        position = glm::vec3(sum / 3.0);
    }
    return is_finite(position) ? std::optional(position) : std::nullopt;
}

/// Returns the saturated color of a hue from 0 to 1.
glm::vec3 hue_color(double hue) {
    const auto channel = [&](double shift) {
        const double at = 6.0 * (hue + shift - std::floor(hue + shift));
        return static_cast<float>(std::clamp(std::abs(at - 3.0) - 1.0, 0.0, 1.0));
    };
    return {channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0)};
}

}  // namespace

glm::vec3 marker_color(MeshCondition condition) {
    // The golden ratio gives neighbors in the list very different hues.
    const double hue = 0.61803398875 * static_cast<double>(condition);
    return hue_color(hue - std::floor(hue));
}

HealthMarkers health_markers(const Scene& scene, std::optional<Severity> severity) {
    const bool with_notes = severity != Severity::problem;
    const DiagnoseOptions options{
        .near_duplicates = with_notes, .texture_overlap = with_notes, .listed = max_markers};
    std::map<std::size_t, Diagnosis> diagnoses;
    for (const Instance& instance : scene.instances) {
        if (!diagnoses.contains(instance.mesh))
            diagnoses.emplace(instance.mesh, diagnose(scene.meshes[instance.mesh], options));
    }
    auto markers = std::make_shared<std::vector<Marker>>();
    HealthMarkers result;
    for (const MeshConditionInfo& info : mesh_conditions()) {
        if (severity && info.severity != *severity) continue;
        MarkedCondition marked{info.condition, 0, 0, marker_color(info.condition)};
        for (std::size_t i = 0; i < scene.instances.size(); ++i) {
            const Shared<Mesh> mesh = deformed_mesh(scene, i);
            for (const MeshConditionCount& found :
                 diagnoses.at(scene.instances[i].mesh).conditions) {
                if (found.condition != info.condition) continue;
                marked.count += found.count;
                for (const std::size_t index : found.first) {
                    const std::optional<glm::vec3> position =
                        element_position(mesh, info.element, index);
                    if (!position) continue;
                    markers->push_back({i, *position, marked.color_srgb});
                    ++marked.marked;
                }
            }
        }
        if (marked.count > 0) result.conditions.push_back(marked);
    }
    result.markers = std::move(markers);
    return result;
}

}  // namespace relief::shade

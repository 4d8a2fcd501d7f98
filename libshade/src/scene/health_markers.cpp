// SPDX-License-Identifier: Apache-2.0
// Places of what diagnose() names. Object space of each instance. Elements that are nowhere have no
// marker and are counted. Tests: tests/shade/scene/health_markers_test.cpp.
#include "relief/shade/health_markers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "scene/is_finite.h"

namespace relief {

namespace {

/// Where an element of a condition is; nothing if it is nowhere.
std::optional<glm::vec3> place_of(const Mesh& mesh, std::string_view element, std::size_t index) {
    glm::vec3 place;
    if (element == "vertex") {
        place = mesh.positions[index];
    } else if (element == "mesh") {
        return std::nullopt;
    } else {  // A triangle, or an edge of one.
        const glm::uvec3& corners = mesh.triangles[index];
        const glm::dvec3 sum = glm::dvec3(mesh.positions[corners.x]) +
                               glm::dvec3(mesh.positions[corners.y]) +
                               glm::dvec3(mesh.positions[corners.z]);
        place = glm::vec3(sum / 3.0);
    }
    return is_finite(place) ? std::optional(place) : std::nullopt;
}

/// A full colour by its place on the colour circle, from 0 to 1.
glm::vec3 hue_color(double hue) {
    const auto channel = [&](double shift) {
        const double at = 6.0 * (hue + shift - std::floor(hue + shift));
        return static_cast<float>(std::clamp(std::abs(at - 3.0) - 1.0, 0.0, 1.0));
    };
    return {channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0)};
}

}  // namespace

glm::vec3 marker_color(MeshCondition condition) {
    // The golden section sets neighbours in the list far apart on the circle.
    const double hue = 0.61803398875 * static_cast<double>(condition);
    return hue_color(hue - std::floor(hue));
}

HealthMarkers health_markers(const Scene& scene, std::optional<Severity> severity) {
    const bool remarks = severity != Severity::trouble;
    const DiagnoseOptions options{
        .near_duplicates = remarks, .texture_overlap = remarks, .listed = most_markers};
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
            const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
            for (const FoundCondition& found : diagnoses.at(scene.instances[i].mesh).found) {
                if (found.condition != info.condition) continue;
                marked.count += found.count;
                for (const std::size_t index : found.first) {
                    const std::optional<glm::vec3> place = place_of(mesh, info.element, index);
                    if (!place) continue;
                    markers->push_back({i, *place, marked.color_srgb});
                    ++marked.marked;
                }
            }
        }
        if (marked.count > 0) result.conditions.push_back(marked);
    }
    result.markers = std::move(markers);
    return result;
}

}  // namespace relief

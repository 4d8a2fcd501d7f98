// SPDX-License-Identifier: Apache-2.0
// Lines from vertices along tangent, bitangent and normal. World space, about a centre, in double
// until they are stored. Tests: tests/shade/render/vertex_frames_test.cpp.
#include "render/vertex_frames.h"

#include <cmath>

#include "render/draw_values.h"
#include "scene/is_finite.h"

namespace relief {

namespace {

/// A line from a point, unless the direction has no length.
void add_line(const glm::dvec3& from, const glm::dvec3& direction, double length,
              std::vector<glm::vec3>& lines) {
    const double size = glm::length(direction);
    if (!(size > 0.0) || !std::isfinite(size)) return;
    lines.emplace_back(from);
    lines.emplace_back(from + direction * (length / size));
}

}  // namespace

void add_vertex_frames(const Mesh& mesh, const glm::mat4& world_from_object,
                       const glm::dvec3& center, double length, VertexFrameLines& lines) {
    DrawValues place;
    set_place(place, world_from_object);
    const glm::dmat4 to_world(world_from_object);
    const glm::dmat3 normal_to_world(place.world_from_object_normal);
    const glm::dmat3 tangent_to_world(place.world_from_object_tangent);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3 from =
            glm::dvec3(to_world * glm::dvec4(glm::dvec3(mesh.positions[i]), 1.0)) - center;
        if (!is_finite(from)) continue;
        const glm::dvec3 normal = normal_to_world * glm::dvec3(mesh.normals[i]);
        add_line(from, normal, length, lines.normals);
        if (mesh.tangents.empty()) continue;
        const glm::vec4& stored = mesh.tangents[i];
        const glm::dvec3 tangent = tangent_to_world * glm::dvec3(stored);
        const auto hand = static_cast<double>(stored.w * place.handedness);
        add_line(from, tangent, length, lines.tangents);
        add_line(from, hand * glm::cross(normal, tangent), length, lines.bitangents);
    }
}

}  // namespace relief

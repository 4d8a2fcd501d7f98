// SPDX-License-Identifier: Apache-2.0
/// \file
/// Frames at the vertices of a mesh as lines. No OpenGL.
/// Tests: tests/shade/render/vertex_frames_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief {

/// Pairs of points, each pair a line.
struct VertexFrameLines {
    std::vector<glm::vec3> tangents;
    std::vector<glm::vec3> bitangents;
    std::vector<glm::vec3> normals;
};

/// Adds the lines of an instance: from each vertex along the directions that its frame has in world
/// space, as shaders make it from the vertex (vertex.glsl, normal_and_tangent).
///
/// \param mesh    with normals; tangents are optional
/// \param center  in world space, from which the points count: it keeps their precision where the
///                scene is far from the origin
/// \param length  of each line, in world space
///
/// A vertex that is nowhere gets no line, and a direction without length none either.
void add_vertex_frames(const Mesh& mesh, const glm::mat4& world_from_object,
                       const glm::dvec3& center, double length, VertexFrameLines& lines);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Computes normals and MikkTSpace tangents of an interleaved vertex buffer with 16-bit indices, in
// place.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/buffers.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "relief/mesh/tangents.h"

struct Vertex {
    glm::vec3 position, normal;
    glm::vec4 tangent;
    glm::vec2 texcoord;
};

int main() {
    // A wave over the unit square, as an engine holds it: a grid of 33 by 33 vertices.
    const int side = 33;
    std::vector<Vertex> vertices;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            Vertex vertex{};
            vertex.texcoord = glm::vec2(x, side - 1 - y) / float{side - 1};  // v points down.
            vertex.position = {vertex.texcoord.x, 1.0F - vertex.texcoord.y,
                               0.1F * std::sin(6.2831853F * vertex.texcoord.x)};
            vertices.push_back(vertex);
        }
    }
    std::vector<std::uint16_t> indices;
    for (int y = 0; y + 1 < side; ++y) {
        for (int x = 0; x + 1 < side; ++x) {
            for (const int offset : {0, 1, side + 1, 0, side + 1, side})
                indices.push_back(static_cast<std::uint16_t>(y * side + x + offset));
        }
    }

    // Views of the buffers; nothing is copied.
    const std::size_t count = vertices.size();
    const std::size_t stride = sizeof(Vertex);
    const relief::StridedSpan<const glm::vec3> positions(&vertices[0].position, count, stride);
    const relief::StridedSpan<glm::vec3> normals(&vertices[0].normal, count, stride);
    const relief::StridedSpan<glm::vec4> tangents(&vertices[0].tangent, count, stride);
    const relief::StridedSpan<const glm::vec2> texcoords(&vertices[0].texcoord, count, stride);
    const relief::TriangleSpan triangles{std::span<const std::uint16_t>(indices)};

    relief::Report report;  // Counts degenerate elements. It is optional.
    relief::vertex_normals(positions, triangles, relief::NormalOptions{}, normals, report);
    relief::vertex_tangents(positions, normals, texcoords, triangles, tangents, report);

    for (const relief::Finding& finding : report.findings())
        std::printf("%s\n", relief::to_string(finding).c_str());
    const Vertex& middle = vertices[16 * side + 16];  // The steepest slope of the wave: -0.2 pi.
    std::printf("vertices %zu\n", vertices.size());
    std::printf("normal %.4f %.4f %.4f\n", middle.normal.x, middle.normal.y, middle.normal.z);
    std::printf("tangent %.4f %.4f %.4f %.0f\n", middle.tangent.x, middle.tangent.y,
                middle.tangent.z, middle.tangent.w);
}

// SPDX-License-Identifier: Apache-2.0
// Computes normals and MikkTSpace tangents of a mesh in buffers of your own, and writes them into a
// vertex buffer.
#include <cstdio>
#include <glm/glm.hpp>
#include <vector>

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
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::uvec3> triangles;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const glm::vec2 at(x / float{side - 1}, y / float{side - 1});
            positions.emplace_back(at, 0.1F * glm::sin(6.2831853F * at.x));
            texcoords.emplace_back(at.x, 1.0F - at.y);  // v points down
        }
    }
    for (unsigned y = 0; y + 1 < side; ++y) {
        for (unsigned x = 0; x + 1 < side; ++x) {
            const unsigned corner = y * side + x;
            triangles.emplace_back(corner, corner + 1, corner + side + 1);
            triangles.emplace_back(corner, corner + side + 1, corner + side);
        }
    }

    relief::Report report;  // Counts what was degenerate.
    const std::vector<glm::vec3> normals =
        relief::vertex_normals(positions, triangles, relief::NormalWeight::angle, report);

    // MikkTSpace's tangents belong to the corners of triangles; those of one vertex are equal here.
    std::vector<glm::vec4> tangents(positions.size());
    const std::vector<glm::vec4> corner_tangents =
        relief::mikktspace_tangents(positions, normals, texcoords, triangles, report);
    for (std::size_t corner = 0; corner < corner_tangents.size(); ++corner)
        tangents[triangles[corner / 3][static_cast<int>(corner % 3)]] = corner_tangents[corner];

    std::vector<Vertex> vertices(positions.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
        vertices[i] = {positions[i], normals[i], tangents[i], texcoords[i]};

    for (const relief::Finding& finding : report.findings())
        std::printf("%s\n", relief::to_string(finding).c_str());
    const Vertex& middle = vertices[16 * side + 16];  // The steepest slope of the wave: -0.2 pi.
    std::printf("vertices %zu\n", vertices.size());
    std::printf("normal %.4f %.4f %.4f\n", middle.normal.x, middle.normal.y, middle.normal.z);
    std::printf("tangent %.4f %.4f %.4f %.0f\n", middle.tangent.x, middle.tangent.y,
                middle.tangent.z, middle.tangent.w);
}

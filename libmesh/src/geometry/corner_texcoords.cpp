// SPDX-License-Identifier: Apache-2.0
#include "geometry/corner_texcoords.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "relief/mesh/report.h"

namespace relief::detail {

FramedMesh with_corner_texcoords(const Mesh& mesh, std::span<const glm::vec2> texcoords) {
    if (texcoords.size() != 3 * mesh.triangles.size())
        throw InvalidInput(fmt::format("there are {} texture coordinates for {} triangles",
                                       texcoords.size(), mesh.triangles.size()));
    std::vector<glm::vec3> values;
    values.reserve(texcoords.size());
    for (const glm::vec2& each : texcoords)
        values.emplace_back(each, 0.0F);
    VertexSplit split = split_where_corners_differ(mesh.positions.size(), mesh.triangles, values);
    FramedMesh result;
    result.mesh = carried(mesh, split);
    result.mesh.texcoords.assign(result.mesh.positions.size(), glm::vec2(0.0F));
    for (std::size_t corner = 0; corner < texcoords.size(); ++corner) {
        const std::uint32_t vertex =
            split.triangles[corner / 3][static_cast<glm::length_t>(corner % 3)];
        result.mesh.texcoords[vertex] = texcoords[corner];
    }
    result.source_vertex = std::move(split.source_vertex);
    return result;
}

}  // namespace relief::detail

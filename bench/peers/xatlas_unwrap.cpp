// SPDX-License-Identifier: Apache-2.0
// Lets relief-unwrap-bench call xatlas, which is not part of the project (bench/README.md):
//
//     c++ -O3 -shared -fPIC -I FOLDER -o xatlas.so bench/peers/xatlas_unwrap.cpp FOLDER/xatlas.cpp
#include <xatlas.h>

#include <cstddef>
#include <cstdint>

/// Unwraps triangles with the default options of xatlas.
/// \param positions  three floats for each vertex
/// \param fixes_winding  not 0: without mirrored charts
/// \param texels  gets two floats for each corner, v downwards; 0 for triangles without a chart
/// \param width  gets the size of the map that xatlas chooses
/// \return 0, or an error of xatlas
extern "C" int relief_peer_unwrap(const float* positions, std::uint32_t vertices,
                                  const std::uint32_t* triangles, std::uint32_t triangle_count,
                                  std::uint32_t size, std::uint32_t padding, int fixes_winding,
                                  float* texels, std::uint32_t* width, std::uint32_t* height) {
    xatlas::Atlas* const atlas = xatlas::Create();
    xatlas::MeshDecl mesh;
    mesh.vertexPositionData = positions;
    mesh.vertexPositionStride = 3 * sizeof(float);
    mesh.vertexCount = vertices;
    mesh.indexData = triangles;
    mesh.indexCount = 3 * triangle_count;
    mesh.indexFormat = xatlas::IndexFormat::UInt32;
    const xatlas::AddMeshError error = xatlas::AddMesh(atlas, mesh);
    if (error != xatlas::AddMeshError::Success) {
        xatlas::Destroy(atlas);
        return static_cast<int>(error);
    }
    xatlas::ChartOptions charts;
    charts.fixWinding = fixes_winding != 0;
    xatlas::PackOptions packing;
    packing.resolution = size;
    packing.padding = padding;
    xatlas::Generate(atlas, charts, packing);
    *width = atlas->width;
    *height = atlas->height;
    const xatlas::Mesh& result = atlas->meshes[0];
    for (std::uint32_t corner = 0; corner < result.indexCount; ++corner) {
        const xatlas::Vertex& vertex = result.vertexArray[result.indexArray[corner]];
        const bool has_place = vertex.atlasIndex >= 0;
        texels[2 * corner] = has_place ? vertex.uv[0] : 0.0F;
        texels[2 * corner + 1] = has_place ? vertex.uv[1] : 0.0F;
    }
    xatlas::Destroy(atlas);
    return 0;
}

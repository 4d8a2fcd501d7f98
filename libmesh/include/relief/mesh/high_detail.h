// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the high meshes of a bake have beside their vertices: materials, with textures of colour
/// and normal maps. Tests: tests/mesh/bake/high_detail_test.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"

namespace relief {

/// An image on a mesh. Looked up at its full size, between the four nearest texels linearly or at
/// the nearest one, as `filter` says: a map that is coarser than the image needs several samples a
/// texel.
struct SurfaceTexture {
    const Image* image = nullptr;  ///< One to four channels; must outlive the bake.
    TextureWrap wrap_u = TextureWrap::repeat;
    TextureWrap wrap_v = TextureWrap::repeat;
    TextureFilter filter = TextureFilter::linear;
    GltfTextureTransform transform{};
};

/// How the map's numbers are normals, and how deep they are.
struct SurfaceNormalMap {
    SurfaceTexture texture;  ///< Three or four channels.
    float scale = 1.0F;      ///< Of x and y.
    Green green = Green::up;
    FlatCode flat = FlatCode::half;  ///< glTF's formula.
    /// Of x and y: read as exactly flat, see flat_texel_codes(). Only for FlatCode::half.
    std::optional<std::array<std::uint16_t, 2>> flat_codes{};
};

struct HighMaterial {
    glm::vec3 color{1.0F};  ///< Linear; times the texture, times the vertex colours.
    /// Grey or RGB; sRGB or linear as the image says; its alpha has no say.
    std::optional<SurfaceTexture> color_texture;
    std::optional<SurfaceNormalMap> normal_map;
};

/// The materials of a mesh.
struct HighDetail {
    const Mesh* mesh = nullptr;           ///< One of those baked from, at its place in memory.
    std::vector<HighMaterial> materials;  ///< As the mesh's material ranges name them.
    /// For colour textures, by vertex. Empty: those of the mesh, which normal maps always have,
    /// with its tangents or MikkTSpace's.
    std::vector<glm::vec2> color_texcoords;
    std::optional<HighMaterial> otherwise{};  ///< Of triangles without a material.
};

}  // namespace relief

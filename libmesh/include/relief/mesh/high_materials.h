// SPDX-License-Identifier: Apache-2.0
/// \file
/// Describes the materials of the high meshes of a bake: colors, color textures and normal maps.
/// Tests: tests/mesh/bake/high_materials_test.cpp.
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

/// An image on a mesh. It is sampled at full resolution, bilinearly or nearest, as `filter` says; a
/// map that is coarser than the image needs several samples per texel.
struct SurfaceTexture {
    const Image* image = nullptr;  ///< One to four channels; it must outlive the bake.
    TextureWrap wrap_u = TextureWrap::repeat;
    TextureWrap wrap_v = TextureWrap::repeat;
    TextureFilter filter = TextureFilter::linear;
    GltfTextureTransform transform{};
};

/// A normal map and its conventions.
struct SurfaceNormalMap {
    SurfaceTexture texture;  ///< Three or four channels.
    float scale = 1.0F;      ///< Multiplies x and y.
    Green green = Green::up;
    FlatCode flat = FlatCode::half;  ///< The formula of glTF.
    /// The codes of x and y that are decoded as exactly flat, see flat_texel_codes(). Only for
    /// FlatCode::half.
    std::optional<std::array<std::uint16_t, 2>> flat_codes{};
};

struct HighMaterial {
    glm::vec3 color{1.0F};  ///< Linear; multiplied by the texture and the vertex colors.
    /// Gray or RGB; sRGB or linear, as the image says. Its alpha is ignored.
    std::optional<SurfaceTexture> color_texture;
    std::optional<SurfaceNormalMap> normal_map;
};

/// The materials of a high mesh.
struct HighMaterials {
    const Mesh* mesh = nullptr;           ///< A high mesh of the bake, identified by its address.
    std::vector<HighMaterial> materials;  ///< Indexed by the mesh's material ranges.
    /// The texture coordinates of color textures, by vertex. If empty, those of the mesh. Normal
    /// maps always use those of the mesh, with its tangents or MikkTSpace's.
    std::vector<glm::vec2> color_texcoords;
    std::optional<HighMaterial> otherwise{};  ///< The material of triangles without a material.
};

}  // namespace relief

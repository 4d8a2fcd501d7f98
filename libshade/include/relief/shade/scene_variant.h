// SPDX-License-Identifier: Apache-2.0
/// \file
/// Variants of a scene for comparisons: one change of all its materials or meshes.
///
/// - Interpolation: of all materials. Gouraud draws metallic-roughness with its Phong equivalent.
/// - MapUse: none removes normal and bump maps; the other values convert between both.
/// - Kernel: converts heights to normal maps.
/// - TangentMethod, NormalMode: computed for all meshes that permit it. Stored tangents are
///   recomputed if the normals change.
/// - MapBits: encodes normal maps again.
///
/// Heights come from bump maps, or from the height map that the normal maps were converted from. A
/// variant is prepared once for the meshes and maps of a scene; later edits of lights and colors do
/// not need another preparation. Tests: tests/tools/variant_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/report.h"
#include "relief/shade/material.h"
#include "relief/shade/scene.h"

namespace RELIEF_API relief {
namespace shade {

/// The kind of map that perturbs the normals.
enum class MapUse { none, bump_map, normal_map };

/// Bits per channel of a normal map.
enum class MapBits { eight = 8, sixteen = 16 };

/// TangentMethod::none means that the shader derives the tangent frames of normal and bump maps.
using SceneVariant =
    std::variant<Interpolation, MapUse, Kernel, TangentMethod, MapBits, NormalMode>;

/// The height map of all materials, which they show as a normal map or as a bump map.
struct SceneHeights {
    std::optional<std::filesystem::path> file;
    bool is_bump_map = false;
    std::optional<double> strength;  ///< BumpOptions::strength, if absent its default.
    std::optional<Kernel> kernel;    ///< If absent, the kernel is chosen for the map.
};

/// Returns the kernel that converts the height map; none without a kernel and a height map, and for
/// an automatic Gaussian, which has a radius of its own.
/// \throws FileError if the height map cannot be read
std::optional<Kernel> displayed_kernel(const SceneHeights& heights);

/// Converts heights to a normal map with this number of bits. Green is up, and flat decodes to
/// exactly flat.
Image converted_heights(const Image& image, const BumpOptions& bump, int bits, Report& report);

/// The decoding parameters of a converted height map.
NormalMap converted_map(const Texture& texture);

/// The normal and bump maps of a material.
struct MaterialMaps {
    std::optional<NormalMap> normal_map;
    std::optional<BumpMap> bump_map;
};

/// A variant that was prepared for a scene.
struct PreparedVariant {
    std::optional<Interpolation> interpolation;
    std::optional<TangentFrame> tangent_frame;
    std::vector<Shared<Mesh>> meshes;  ///< Replaces the meshes of the scene, unless empty.
    /// For the vertices of each of `meshes`, if an instance deforms it.
    std::vector<std::optional<Shared<GltfDeformation>>> deformations;
    /// Replaces MeshPose::has_flat_normals of deformed instances, if the normals change.
    std::optional<bool> has_flat_normals;
    std::vector<MaterialMaps> maps;  ///< Replaces the maps of each material, unless empty.
    std::size_t first_image = 0;     ///< Texture indices from here on refer to `images`.
    std::vector<ImageSource> images;
    /// For each of `meshes`, the former vertex of each vertex; empty: the same.
    std::vector<std::vector<std::uint32_t>> source_vertices;
};

/// A variant would not change the scene.
struct UnchangedScene : InvalidInput {
    /// The scene lacks nothing if the variant is its current setting.
    enum class Lack { nothing, heights, maps };

    UnchangedScene(Lack missing, const std::string& reason) : InvalidInput(reason), lack(missing) {}

    Lack lack;
};

/// Prepares a variant.
/// \throws UnchangedScene if the variant would change nothing
/// \throws FileError if a map cannot be read
PreparedVariant prepare_variant(const SceneVariant& variant, const Scene& scene,
                                const SceneHeights& heights, Report& report);

/// Applies a variant. \param scene  the scene that it was prepared for, which may have been edited
Scene with_variant(const Scene& scene, const PreparedVariant& prepared);

/// Gives another scene the lights, environment, background and exposure of this scene.
Scene with_lighting_of(const Scene& scene, Scene other);

}  // namespace shade
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// A scene with one change (variant.h): what takes long is done once, for a scene of some meshes
/// and maps; what is edited afterwards, lights and colours, comes along at once.
///
/// - interpolation: of all materials; Gouraud's draws metallic-roughness by its Phong equivalent.
/// - map: none takes normal and bump maps away; the other two turn heights into each other.
/// - kernel: heights become normal maps by it, as --height-map does.
/// - tangents, normals: computed for all meshes that can have them; where normals change, tangents
///   that were stored are computed anew.
/// - bits: normal maps are coded again.
///
/// Heights are those of bump maps, or of the options' height map.
/// Tests: tests/tools/variant_scene_test.cpp.
#pragma once

#include <optional>
#include <vector>

#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "variant.h"
#include "view_options.h"

namespace relief::tools {

/// What a material's normals are bent by in the changed scene.
struct MaterialMaps {
    std::optional<NormalMap> normal_map;
    std::optional<BumpMap> bump_map;
};

/// A change worked out for one scene.
struct PreparedVariant {
    std::optional<Interpolation> interpolation;
    std::optional<TangentFrame> tangent_frame;
    std::vector<Shared<Mesh>> meshes;  ///< In place of the scene's; empty: those.
    std::vector<MaterialMaps> maps;    ///< Of each material; empty: its own.
    std::size_t first_image = 0;  ///< Textures count from here in `images`; below, in the scene.
    std::vector<ImageSource> images;
};

/// \param options  of the scene: its height map
/// \throws UsageError where the change could show nothing; FileError if a map cannot be read
PreparedVariant prepare(const Variant& variant, const Scene& scene, const ViewOptions& options,
                        Report& report);

/// The scene with the change. \param scene  that for which it was prepared, edited or not
Scene with(const Scene& scene, const PreparedVariant& prepared);

/// What another model file shows, lit like this scene and before its background; a scene file has
/// its own light.
Scene in_light_of(const Scene& scene, Scene other);

}  // namespace relief::tools

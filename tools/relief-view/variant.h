// SPDX-License-Identifier: Apache-2.0
/// \file
/// Variants of a scene for comparisons: one change, its form as text, and its application.
///
///     interpolation=flat  map=bump_map  kernel=central3  tangents=lengyel  bits=8  normals=area
///
/// - interpolation: for all materials. Gouraud draws metallic-roughness with its Phong equivalent.
/// - map: none removes normal and bump maps; the other values convert between both.
/// - kernel: converts heights to normal maps, like --height-map.
/// - tangents, normals: computed for all meshes that permit it. Stored tangents are recomputed if
/// the
///   normals change.
/// - bits: encodes normal maps again.
///
/// Heights come from bump maps, or from the height map of the options. A variant is prepared once
/// for the meshes and maps of a scene; later edits of lights and colors do not need another
/// preparation. Tests: tests/tools/variant_test.cpp, variant_scene_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "relief/mesh/bump.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/report.h"
#include "relief/shade/material.h"
#include "relief/shade/scene.h"

namespace relief::tools {

struct ViewOptions;

/// The kind of map that perturbs the normals.
enum class MapUse { none, bump_map, normal_map };

/// Bits per channel of a normal map.
enum class MapBits { eight = 8, sixteen = 16 };

/// TangentMethod::none means that the shader derives the tangent frames of normal and bump maps.
using Variant = std::variant<Interpolation, MapUse, Kernel, TangentMethod, MapBits, NormalMode>;

/// All variants of one property.
struct VariantTopic {
    std::string name;  ///< For example "kernel".
    std::string what;  ///< For example "The kernel that computes slopes from heights".
    std::vector<std::pair<std::string, Variant>> choices;
};
const std::vector<VariantTopic>& variant_topics();

/// \throws UsageError with the valid names
Variant parse_variant(const std::string& subject, const std::string& text);

/// For example "kernel=central3". The inverse of parse_variant().
std::string to_text(const Variant& variant);

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
    std::vector<MaterialMaps> maps;    ///< Replaces the maps of each material, unless empty.
    std::size_t first_image = 0;       ///< Texture indices from here on refer to `images`.
    std::vector<ImageSource> images;
};

/// Prepares a variant.
/// \param options  the options of the scene, which contain its height map
/// \throws UsageError if the variant would change nothing
/// \throws FileError if a map cannot be read
PreparedVariant prepare(const Variant& variant, const Scene& scene, const ViewOptions& options,
                        Report& report);

/// Applies a variant. \param scene  the scene that it was prepared for, which may have been edited
Scene with_variant(const Scene& scene, const PreparedVariant& prepared);

/// Gives another scene the lights, environment, background and exposure of this scene.
Scene with_lighting_of(const Scene& scene, Scene other);

}  // namespace relief::tools

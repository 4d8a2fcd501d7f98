// SPDX-License-Identifier: Apache-2.0
// The texture coordinate set of a primitive's tangents: that of the texture that needs them, which
// KHR_texture_transform may override. A set that is missing falls back to the first there is, and
// says so. Source: glTF 2.0 (ISO/IEC 12113), sections 3.7.2.1 and 3.9.3; KHR_texture_transform,
// KHR_materials_clearcoat, KHR_materials_anisotropy.
// Tests: tests/mesh/io/gltf/gltf_tangent_texcoords_test.cpp.
#include "io/gltf/gltf_tangent_texcoords.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "io/gltf/gltf_primitive.h"

namespace relief {
namespace {

/// A texture of a material that is looked up in tangent space.
struct TangentTexture {
    const char* name = "";
    const Json* info = nullptr;
};

/// The first of those that a material has, in the order in which glTF makes tangents for them.
TangentTexture tangent_texture(const Json& material) {
    const TangentTexture candidates[] = {
        {"normalTexture", find(material, "normalTexture")},
        {"clearcoatNormalTexture",
         find(material, "extensions", "KHR_materials_clearcoat", "clearcoatNormalTexture")},
        {"anisotropyTexture",
         find(material, "extensions", "KHR_materials_anisotropy", "anisotropyTexture")}};
    for (const TangentTexture& candidate : candidates) {
        if (candidate.info != nullptr && candidate.info->is_object()) return candidate;
    }
    return {};
}

/// Whether the image's u runs in another direction than the coordinates' u, or its v another way.
/// Scales alone, as of tiles and atlases, leave both directions as they are.
bool turns(const Json& transform) {
    const auto rotation = static_cast<double>(float_in(transform, "rotation", 0.0F));
    const glm::vec2 scale = vector_in(transform, "scale", glm::vec2(1.0F));
    constexpr double rounding = 1e-6;  // Of a full turn written in float.
    const bool is_turned = std::abs(std::sin(rotation)) > rounding || !(std::cos(rotation) > 0.0);
    return is_turned || scale.x < 0.0F || scale.y < 0.0F;
}

}  // namespace

std::vector<int> texcoord_sets_of(const GltfContents& contents, GltfPrimitiveId id) {
    constexpr std::string_view prefix = "TEXCOORD_";
    std::vector<int> sets;
    for (const auto& [name, accessor] : primitive_json(contents, id)["attributes"].items()) {
        if (!name.starts_with(prefix)) continue;
        int set = 0;
        const char* end = name.data() + name.size();
        const auto parsed = std::from_chars(name.data() + prefix.size(), end, set);
        if (parsed.ec == std::errc() && parsed.ptr == end && set >= 0) sets.push_back(set);
    }
    std::sort(sets.begin(), sets.end());
    return sets;
}

GltfTangentTexcoords tangent_texcoords_of(const GltfContents& contents, GltfPrimitiveId id) {
    GltfTangentTexcoords result;
    const std::vector<int> sets = texcoord_sets_of(contents, id);
    const int first = sets.empty() ? 0 : sets.front();
    result.set = first;
    const auto material = index_in(primitive_json(contents, id), "material");
    if (!material) return result;
    const TangentTexture texture = tangent_texture(contents.root["materials"][*material]);
    if (texture.info == nullptr) return result;
    result.texture = texture.name;
    result.set = static_cast<int>(size_in(*texture.info, "texCoord"));
    if (const Json* transform = find(*texture.info, "extensions", "KHR_texture_transform")) {
        result.set =
            static_cast<int>(size_in(*transform, "texCoord", static_cast<std::size_t>(result.set)));
        result.is_turned = turns(*transform);
    }
    if (!std::binary_search(sets.begin(), sets.end(), result.set)) {
        result.missing = result.set;
        result.set = first;
    }
    return result;
}

}  // namespace relief

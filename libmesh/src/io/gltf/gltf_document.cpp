// SPDX-License-Identifier: Apache-2.0
// Summaries of a glTF document: texture coordinate sets and the one of the tangents, compression,
// and contents that other formats cannot hold.
#include "relief/mesh/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_reader.h"

namespace relief {
namespace {

/// A texture of a material that is sampled in tangent space.
struct TangentTexture {
    const char* name = "";
    const Json* info = nullptr;
};

/// The first such texture of a material, in the order in which glTF derives tangents from them.
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

/// Returns true if the transform rotates or mirrors texture coordinates. Positive scales, as used
/// for tiles and atlases, keep both directions.
bool rotates_or_mirrors(const Json& transform) {
    const auto rotation = static_cast<double>(float_in(transform, "rotation", 0.0F));
    const glm::vec2 scale = vector_in(transform, "scale", glm::vec2(1.0F));
    constexpr double rounding = 1e-6;  // Relative error of an angle in float.
    const bool is_rotated = std::abs(std::sin(rotation)) > rounding || !(std::cos(rotation) > 0.0);
    return is_rotated || scale.x < 0.0F || scale.y < 0.0F;
}

}  // namespace

std::vector<int> GltfDocument::texcoord_sets(GltfPrimitiveId id) const {
    const GltfContents& contents = contents_->data;
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

GltfTangentTexcoords GltfDocument::tangent_texcoords(GltfPrimitiveId id) const {
    const GltfContents& contents = contents_->data;
    GltfTangentTexcoords result;
    const std::vector<int> sets = texcoord_sets(id);
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
        result.is_rotated = rotates_or_mirrors(*transform);
    }
    if (!std::binary_search(sets.begin(), sets.end(), result.set)) {
        result.missing = result.set;
        result.set = first;
    }
    return result;
}

namespace {

void add_count(std::vector<std::string>& lines, std::size_t count, const char* thing) {
    if (count > 0) lines.push_back(fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s"));
}

/// Totals over all primitives.
struct PrimitiveCounts {
    std::size_t morph_targets = 0;
    std::size_t points_and_lines = 0;
    std::size_t more_attributes = 0;  ///< Attributes that Mesh does not have.
};

PrimitiveCounts count_primitives(const Json& root) {
    PrimitiveCounts counts;
    for (const Json& mesh : array_in(root, "meshes")) {
        for (const Json& primitive : mesh["primitives"]) {
            counts.morph_targets += array_in(primitive, "targets").size();
            if (size_in(primitive, "mode", 4) < 4) ++counts.points_and_lines;
            for (const auto& [name, accessor] : primitive["attributes"].items()) {
                if (name != "POSITION" && name != "NORMAL" && name != "TANGENT" &&
                    name != "TEXCOORD_0" && name != "COLOR_0") {
                    ++counts.more_attributes;
                }
            }
        }
    }
    return counts;
}

/// Number of buffer views with a compressed copy by an extension.
std::size_t packed_views(const Json& root, const char* extension) {
    const Json& views = array_in(root, "bufferViews");
    return static_cast<std::size_t>(std::count_if(
        views.begin(), views.end(),
        [&](const Json& view) { return find(view, "extensions", extension) != nullptr; }));
}

/// Number of primitives with a compressed copy.
std::size_t packed_primitives(const Json& root) {
    std::size_t count = 0;
    for (const Json& mesh : array_in(root, "meshes")) {
        for (const Json& primitive : mesh["primitives"])
            count += find(primitive, "extensions", draco_extension) != nullptr ? 1 : 0;
    }
    return count;
}

}  // namespace

GltfDocument::GltfDocument(std::unique_ptr<Contents> contents) : contents_(std::move(contents)) {}
GltfDocument::GltfDocument(GltfDocument&&) noexcept = default;
GltfDocument& GltfDocument::operator=(GltfDocument&&) noexcept = default;
GltfDocument::~GltfDocument() = default;

std::vector<GltfCompression> GltfDocument::compression() const {
    const GltfContents& contents = contents_->data;
    std::vector<GltfCompression> result;
    const auto add = [&](const char* extension, const char* element, std::size_t copies) {
        const auto decoded = contents.unpacked.find(extension);
        const std::size_t count = decoded == contents.unpacked.end() ? 0 : decoded->second;
        if (count + copies > 0) result.push_back({extension, element, count, copies});
    };
    add(draco_extension, "primitive", packed_primitives(contents.root));
    for (const char* extension : meshopt_extensions)
        add(extension, "buffer view", packed_views(contents.root, extension));
    return result;
}

std::vector<std::string> GltfDocument::unsupported_contents() const {
    const Json& root = contents_->data.root;
    const PrimitiveCounts counts = count_primitives(root);
    std::vector<std::string> lines;
    add_count(lines, array_in(root, "animations").size(), "animation");
    add_count(lines, array_in(root, "skins").size(), "skin");
    add_count(lines, counts.morph_targets, "morph target");
    add_count(lines, array_in(root, "cameras").size(), "camera");
    if (const Json* lights = find(root, "extensions", "KHR_lights_punctual")) {
        add_count(lines, array_in(*lights, "lights").size(), "light");
    }
    add_count(lines, counts.more_attributes, "further vertex attribute");
    add_count(lines, counts.points_and_lines, "primitive of points or lines");
    return lines;
}

}  // namespace relief

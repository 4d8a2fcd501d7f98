// SPDX-License-Identifier: Apache-2.0
// All primitives of a glTF scene as one mesh in world space.
//
// Each primitive is placed as placed.h says. Attributes that only some primitives have are filled
// in: flat normals (as glTF asks), texture coordinate (0, 0), white. Tangents are left out: neither
// format has them. Tests: tests/mesh/io/gltf/gltf_view_test.cpp.
#include <fmt/format.h>

#include <algorithm>

#include "relief/mesh/error.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/placed.h"

namespace relief {
namespace {

/// The inverse of the rule in gltf_from_mesh.cpp.
MtlMaterial translated(const GltfMaterial& material, const GltfView& view) {
    MtlMaterial result;
    result.name = material.name;
    result.diffuse = glm::vec3(material.base_color);
    result.opacity = material.base_color.a;
    result.emission = material.emission;
    const float alpha = std::max(material.roughness * material.roughness, 1e-3F);
    result.shininess = std::max(2.0F / (alpha * alpha) - 2.0F, 0.0F);
    const auto path = [&](const std::optional<GltfTexture>& texture) {
        std::optional<std::filesystem::path> file;
        if (texture) {
            const auto* found =
                std::get_if<std::filesystem::path>(&view.images[texture->image].source);
            if (found != nullptr) file = *found;
        }
        return file;
    };
    result.diffuse_map = path(material.base_color_texture);
    result.emission_map = path(material.emission_texture);
    result.normal_map = path(material.normal_texture);
    return result;
}

/// Appends one placed primitive. Arrays are completed for those that lack them.
void append(Mesh& all, Mesh part) {
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    const std::size_t count = part.positions.size();
    if (part.texcoords.empty()) part.texcoords.assign(count, glm::vec2(0.0F));
    if (part.colors.empty()) part.colors.assign(count, glm::vec4(1.0F));
    all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
    all.normals.insert(all.normals.end(), part.normals.begin(), part.normals.end());
    all.texcoords.insert(all.texcoords.end(), part.texcoords.begin(), part.texcoords.end());
    all.colors.insert(all.colors.end(), part.colors.begin(), part.colors.end());
    const auto first_triangle = static_cast<std::uint32_t>(all.triangles.size());
    for (const glm::uvec3& triangle : part.triangles)
        all.triangles.push_back(triangle + first);
    for (MaterialRange range : part.material_ranges) {
        range.first_triangle += first_triangle;
        MaterialRange* last = all.material_ranges.empty() ? nullptr : &all.material_ranges.back();
        if (last != nullptr && last->material == range.material) {
            last->triangle_count += range.triangle_count;
        } else {
            all.material_ranges.push_back(range);
        }
    }
}

}  // namespace

MeshFile flattened(const GltfDocument& document) {
    const GltfView view = document.view();
    std::vector<Mesh> parts;
    bool any_normals = false;
    bool any_texcoords = false;
    bool any_colors = false;
    std::size_t vertex_count = 0;
    for (const auto& placed : view.primitives) {
        const Mesh& part = parts.emplace_back(document.mesh(placed.what));
        any_normals = any_normals || !part.normals.empty();
        any_texcoords = any_texcoords || !part.texcoords.empty();
        any_colors = any_colors || !part.colors.empty();
        vertex_count += part.positions.size();
    }
    if (vertex_count > std::numeric_limits<std::uint32_t>::max()) {
        throw InvalidInput(fmt::format("{} vertices are too many for one mesh", vertex_count));
    }
    MeshFile result;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (any_normals && parts[i].normals.empty()) {
            FrameOptions options;
            options.if_missing = NormalMode::flat;
            Report ignored;  // The document's own processing reports what matters.
            parts[i] = with_frames(std::move(parts[i]), options, ignored).mesh;
        }
        append(result.mesh, placed(std::move(parts[i]), view.primitives[i].world_from_object));
    }
    if (!any_texcoords) result.mesh.texcoords.clear();
    if (!any_colors) result.mesh.colors.clear();
    for (const GltfMaterial& material : view.materials) {
        result.materials.push_back(translated(material, view));
    }
    return result;
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "model_info.h"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "common/command.h"
#include "common/model_file.h"

namespace relief::tools {
namespace {

std::vector<std::string> attributes_of(const Mesh& mesh) {
    std::vector<std::string> names;
    if (!mesh.normals.empty()) names.emplace_back("normals");
    if (!mesh.texcoords.empty()) names.emplace_back("texcoords");
    if (!mesh.tangents.empty()) names.emplace_back("tangents");
    if (!mesh.colors.empty()) names.emplace_back("colors");
    return names;
}

/// The name, or "material 3" for one without.
std::string material_name(const std::string& name, std::size_t index) {
    return name.empty() ? fmt::format("material {}", index) : name;
}

std::vector<std::string> materials_of(const Mesh& mesh,
                                      const std::vector<MaterialInfo>& materials) {
    std::set<std::uint32_t> used;
    for (const MaterialRange& range : mesh.material_ranges) {
        if (range.material) used.insert(*range.material);
    }
    std::vector<std::string> names;
    for (const std::uint32_t index : used) {
        if (index < materials.size()) names.push_back(materials[index].name);
    }
    return names;
}

template <typename T>
std::size_t bytes_of(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

MeshBytes memory_of(const Mesh& mesh) {
    return {bytes_of(mesh.positions) + bytes_of(mesh.normals) + bytes_of(mesh.texcoords) +
                bytes_of(mesh.tangents) + bytes_of(mesh.colors),
            bytes_of(mesh.triangles)};
}

void add_part(ModelInfo& info, std::string name, const Mesh& mesh) {
    info.parts.push_back({.name = std::move(name),
                          .vertices = mesh.positions.size(),
                          .triangles = mesh.triangles.size(),
                          .attributes = attributes_of(mesh),
                          .materials = materials_of(mesh, info.materials),
                          .bounds = bounds_of(mesh),
                          .memory = memory_of(mesh)});
    info.memory.attributes += info.parts.back().memory.attributes;
    info.memory.indices += info.parts.back().memory.indices;
    info.vertices += mesh.positions.size();
    info.triangles += mesh.triangles.size();
}

/// The box of a mesh at its place: of its moved vertices, which is tighter than its moved box.
Bounds bounds_in_world(Mesh mesh, const glm::mat4& world_from_object) {
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(world_from_object * glm::vec4(position, 1.0F));
    return bounds_of(mesh);
}

void include(Bounds& all, const Bounds& more) {
    if (more.empty()) return;
    all.min = glm::min(all.min, more.min);
    all.max = glm::max(all.max, more.max);
}

MaterialInfo material_info(const GltfMaterial& material, std::size_t index) {
    MaterialInfo info{material_name(material.name, index), {}};
    if (material.base_color_texture) info.textures.emplace_back("base color");
    if (material.metallic_roughness_texture) info.textures.emplace_back("metallic-roughness");
    if (material.normal_texture) info.textures.emplace_back("normal");
    if (material.emission_texture) info.textures.emplace_back("emission");
    return info;
}

MaterialInfo material_info(const MtlMaterial& material, std::size_t index) {
    MaterialInfo info{material_name(material.name, index), {}};
    if (material.diffuse_map) info.textures.emplace_back("diffuse");
    if (material.normal_map) info.textures.emplace_back("normal");
    if (material.bump_map) info.textures.emplace_back("bump");
    if (material.emission_map) info.textures.emplace_back("emission");
    return info;
}

template <typename Material>
void add_materials(ModelInfo& info, const std::vector<Material>& materials) {
    for (std::size_t i = 0; i < materials.size(); ++i)
        info.materials.push_back(material_info(materials[i], i));
}

void describe(const GltfDocument& document, ModelInfo& info) {
    const GltfView view = document.view();
    add_materials(info, view.materials);
    for (const GltfPrimitiveId id : document.triangle_primitives())
        add_part(info, document.describe(id), document.mesh(id));
    for (const GltfPlaced<GltfPrimitiveId>& placed : view.primitives)
        include(info.bounds, bounds_in_world(document.mesh(placed.what), placed.world_from_object));
    info.instances = view.primitives.size();
    info.images = view.images.size();
    info.lights = view.lights.size();
    info.cameras = view.cameras.size();
    info.beyond_a_mesh = document.beyond_a_mesh();
    info.compression = compression_in_words(document, false);
}

void describe(const MeshFile& contents, ModelInfo& info) {
    add_materials(info, contents.materials);
    add_part(info, contents.mesh.name, contents.mesh);
    info.bounds = info.parts.front().bounds;
    if (!info.bounds.empty()) {
        info.bounds.min = glm::vec3(glm::dvec3(info.bounds.min) + contents.origin);
        info.bounds.max = glm::vec3(glm::dvec3(info.bounds.max) + contents.origin);
    }
    info.instances = 1;
}

}  // namespace

ModelInfo model_info(const std::filesystem::path& file) {
    ModelInfo info;
    info.format = format_name(readable_format(file));
    Report report;
    const Model model = read_model(file, report);
    info.bytes = std::filesystem::file_size(file);
    about(file,
          [&] { std::visit([&](const auto& contents) { describe(contents, info); }, model); });
    info.findings.add("", report);
    return info;
}

}  // namespace relief::tools

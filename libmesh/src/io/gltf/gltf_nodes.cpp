// SPDX-License-Identifier: Apache-2.0
// Writes meshes as nodes. GltfDocument::from_mesh() has one node, because a mesh file is one object
// for most programs. Tests: tests/make/stage_file_test.cpp.
#include "io/gltf/gltf_nodes.h"

#include <fmt/format.h>

#include <string_view>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "io/gltf/gltf_writer.h"
#include "relief/mesh/gltf_document.h"

namespace relief::detail {
namespace {

template <typename Element>
std::size_t add_accessor(GltfContents& contents, std::span<const Element> elements,
                         std::size_t count, const char* type, int component_type, int target) {
    const std::size_t view = add_view(
        contents,
        std::string_view(reinterpret_cast<const char*>(elements.data()), elements.size_bytes()));
    contents.root["bufferViews"][view]["target"] = target;
    Json& accessors = contents.root["accessors"];
    accessors.push_back({{"bufferView", view},
                         {"componentType", component_type},
                         {"count", count},
                         {"type", type}});
    return accessors.size() - 1;
}

Json primitive_of(GltfContents& contents, const Mesh& mesh) {
    validate(mesh);
    if (mesh.triangles.empty()) throw InvalidInput("a node must have at least one triangle");
    Json attributes;
    const auto add = [&](const char* name, const auto& values, const char* type) {
        if (values.empty()) return;
        attributes[name] = add_accessor(contents, std::span(values), values.size(), type,
                                        gltf_code::float32, gltf_code::array_buffer);
    };
    add("POSITION", mesh.positions, "VEC3");
    set_bounds(contents.root["accessors"][attributes["POSITION"].get<std::size_t>()],
               mesh.positions);
    add("NORMAL", mesh.normals, "VEC3");
    if (!mesh.normals.empty()) add("TANGENT", mesh.tangents, "VEC4");
    add("TEXCOORD_0", mesh.texcoords, "VEC2");
    add("COLOR_0", mesh.colors, "VEC4");
    const std::size_t indices =
        add_accessor(contents, std::span(mesh.triangles), 3 * mesh.triangles.size(), "SCALAR",
                     gltf_code::uint32, gltf_code::element_array_buffer);
    return {{"attributes", std::move(attributes)}, {"indices", indices}};
}

Json material_of(const NodeMaterial& material) {
    Json json = {{"name", material.name}};
    if (material.alpha_mode == AlphaMode::mask) json["alphaMode"] = "MASK";
    if (material.alpha_mode == AlphaMode::blend) json["alphaMode"] = "BLEND";
    return json;
}

}  // namespace

void write_nodes(const std::filesystem::path& file, std::span<const MeshNode> nodes,
                 std::span<const NodeMaterial> materials, const glm::dvec3& origin,
                 Report& report) {
    GltfContents contents;
    Json& root = contents.root;
    root["asset"] = {{"version", "2.0"}, {"generator", "relief"}};
    root["scene"] = 0;
    Json roots = Json::array();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        Json node = {{"mesh", i}, {"name", nodes[i].name}};
        if (origin != glm::dvec3(0.0)) node["translation"] = {origin.x, origin.y, origin.z};
        Json primitives = Json::array();
        for (const NodePrimitive& part : nodes[i].primitives) {
            if (!materials.empty() && part.material >= materials.size())
                fail_gltf("a node names material {}, but there are only {}", part.material,
                          materials.size());
            Json primitive = primitive_of(contents, part.mesh);
            if (!materials.empty()) primitive["material"] = part.material;
            primitives.push_back(std::move(primitive));
        }
        root["meshes"].push_back({{"name", nodes[i].name}, {"primitives", std::move(primitives)}});
        root["nodes"].push_back(std::move(node));
        roots.push_back(i);
    }
    root["scenes"] = Json::array({{{"nodes", std::move(roots)}}});
    for (const NodeMaterial& material : materials)
        root["materials"].push_back(material_of(material));
    contents.position_uses.assign(root["accessors"].size(), 0);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (std::size_t k = 0; k < nodes[i].primitives.size(); ++k)
            repair_values(contents, {i, k}, report);
    }
    repair_document(contents, report);
    require_valid(contents);
    write_gltf(file, contents);
}

}  // namespace relief::detail

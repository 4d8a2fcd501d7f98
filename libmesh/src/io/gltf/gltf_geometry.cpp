// SPDX-License-Identifier: Apache-2.0
// Putting another mesh in the place of a glTF primitive's. Object space; all values become floats.
//
// What goes is retired, and left out when the document is written (gltf_layout.h), unless others
// use it. What a mesh cannot carry (morph targets, skinning, further texture coordinates) is not
// dropped: it throws InvalidInput. Tests: tests/mesh/io/gltf/gltf_geometry_test.cpp.
#include <fmt/format.h>

#include <array>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_edit.h"
#include "io/gltf/gltf_primitive.h"
#include "io/gltf/gltf_schema.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr std::array carried_attributes = {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0",
                                           "COLOR_0"};

/// What the primitive has beyond a mesh; "" if nothing.
std::string beyond_a_mesh(const Json& primitive) {
    if (!array_in(primitive, "targets").empty()) return "morph targets";
    for (const auto& [name, accessor] : primitive["attributes"].items()) {
        bool is_carried = false;
        for (const char* carried : carried_attributes)
            is_carried = is_carried || name == carried;
        if (!is_carried) return name;
    }
    if (find(primitive, "extensions", "CESIUM_primitive_outline") != nullptr) return "an outline";
    return "";
}

template <typename Element>
std::size_t add_values(GltfContents& contents, const std::vector<Element>& elements,
                       const char* type, int component_type, int target) {
    return add_accessor(contents, {{"componentType", component_type}, {"type", type}},
                        std::string(reinterpret_cast<const char*>(elements.data()),
                                    elements.size() * sizeof(Element)),
                        target);
}

/// The bounds that glTF asks for of positions; none where they are not finite.
void set_bounds(Json& accessor, const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh);
    if (bounds.empty()) return;
    accessor["min"] = {bounds.min.x, bounds.min.y, bounds.min.z};
    accessor["max"] = {bounds.max.x, bounds.max.y, bounds.max.z};
}

Json attributes_of(GltfContents& contents, const Mesh& mesh) {
    Json attributes = Json::object();
    const auto add = [&](const char* name, const auto& values, const char* type) {
        if (values.empty()) return;
        attributes[name] =
            add_values(contents, values, type, gltf_code::float32, gltf_code::array_buffer);
    };
    add("POSITION", mesh.positions, "VEC3");
    set_bounds(contents.root["accessors"].back(), mesh);
    add("NORMAL", mesh.normals, "VEC3");
    if (!mesh.normals.empty()) add("TANGENT", mesh.tangents, "VEC4");
    add("TEXCOORD_0", mesh.texcoords, "VEC2");
    add("COLOR_0", mesh.colors, "VEC4");
    return attributes;
}

}  // namespace

void replace_geometry(GltfContents& contents, GltfPrimitiveId id, const Mesh& mesh) {
    const Json before = primitive_json(contents, id);
    const std::string more = beyond_a_mesh(before);
    if (!more.empty()) {
        throw InvalidInput(fmt::format("{}: has {}, which another mesh cannot take over",
                                       describe_primitive(contents, id), more));
    }
    validate(mesh);
    if (mesh.triangles.empty()) throw InvalidInput("the mesh has no triangle");
    for (const auto& [name, accessor] : before["attributes"].items())
        contents.retired_accessors.insert(accessor.get<std::size_t>());
    if (const auto indices = index_in(before, "indices"))
        contents.retired_accessors.insert(*indices);
    Json attributes = attributes_of(contents, mesh);
    const std::size_t indices = add_values(contents, mesh.triangles, "SCALAR", gltf_code::uint32,
                                           gltf_code::element_array_buffer);
    Json& primitive = contents.root["meshes"][id.mesh]["primitives"][id.primitive];
    primitive["attributes"] = std::move(attributes);
    primitive["indices"] = indices;
    primitive.erase("mode");  // Triangles are the default.
}

}  // namespace relief

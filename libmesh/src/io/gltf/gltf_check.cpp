// SPDX-License-Identifier: Apache-2.0
// Checks of a glTF document beyond the types of its properties: version, required extensions, the
// ranges of buffer views and accessors, primitives, animations, and that nodes form trees.
//
// The first offence throws InvalidInput. Source: glTF 2.0 (ISO/IEC 12113), chapters 3 and 5.
// Tests: tests/mesh/io/gltf/gltf_document_test.cpp.
#include "io/gltf/gltf_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_schema.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// "2.1" as 2 and 1.
std::pair<int, int> version_in(const Json& asset, const char* key) {
    const std::string text = text_in(asset, key);
    int major = -1;
    int minor = -1;
    const char* end = text.data() + text.size();
    const auto [dot, error] = std::from_chars(text.data(), end, major);
    if (error == std::errc() && dot != end && *dot == '.') std::from_chars(dot + 1, end, minor);
    if (major < 0 || minor < 0) fail_gltf("asset.{} is '{}', which is no version", key, text);
    return {major, minor};
}

void check_version(const Json& root) {
    const Json& asset = root["asset"];
    const auto [major, minor] = version_in(asset, "version");
    if (major != 2) fail_gltf("asset.version is {}.{}, but only 2 is read", major, minor);
    if (asset.contains("minVersion") && version_in(asset, "minVersion") > std::pair(2, 0)) {
        fail_gltf("asset.minVersion is {}, but only 2.0 is read", text_in(asset, "minVersion"));
    }
}

/// Extensions that a document may require: those that leave its meshes as they are, and those that
/// are decoded. One that ends in '*' stands for all that begin so.
bool is_accepted(std::string_view extension) {
    static constexpr std::array accepted = {
        "KHR_materials_*",
        "KHR_texture_*",
        "KHR_lights_punctual",
        "KHR_mesh_quantization",
        "KHR_draco_mesh_compression",
        "KHR_meshopt_compression",
        "KHR_animation_pointer",
        "KHR_xmp*",
        "KHR_node_visibility",
        "EXT_meshopt_compression",
        "EXT_mesh_gpu_instancing",
        "EXT_mesh_features",
        "EXT_instance_features",
        "EXT_structural_metadata",
        "EXT_texture_*",
        "EXT_lights_*",
        "MSFT_texture_dds",
        "MSFT_lod",
        "CESIUM_primitive_outline",
        "FB_geometry_metadata",
        "FB_ngon_encoding",
        "AGI_*",
        "ADOBE_materials_*",
    };
    return std::any_of(accepted.begin(), accepted.end(), [&](std::string_view known) {
        if (!known.ends_with('*')) return known == extension;
        known.remove_suffix(1);
        return extension.starts_with(known);
    });
}

void check_required_extensions(const Json& root) {
    for (const Json& name : array_in(root, "extensionsRequired")) {
        const auto& extension = name.get_ref<const std::string&>();
        if (is_accepted(extension)) continue;
        fail_gltf("requires the extension {}, which relief does not know", extension);
    }
}

void check_range(const std::string& what, std::size_t offset, std::size_t length, std::size_t limit,
                 const std::string& container) {
    if (offset + length > limit) {
        fail_gltf("{} covers bytes {} to {}, but {} has only {}", what, offset, offset + length,
                  container, limit);
    }
}

void check_views(const Json& root) {
    const Json& views = array_in(root, "bufferViews");
    for (std::size_t i = 0; i < views.size(); ++i) {
        const Json& view = views[i];
        const std::size_t buffer = size_in(view, "buffer");
        check_range(fmt::format("bufferViews[{}]", i), size_in(view, "byteOffset"),
                    size_in(view, "byteLength"), size_in(root["buffers"][buffer], "byteLength"),
                    fmt::format("buffers[{}]", buffer));
        const std::size_t stride = size_in(view, "byteStride", 4);
        if (stride < 4 || stride > 252) {
            fail_gltf("bufferViews[{}].byteStride is {}, outside 4 to 252", i, stride);
        }
        for (const char* extension : meshopt_extensions) {
            const Json* packed = find(view, "extensions", extension);
            if (packed == nullptr) continue;
            const std::size_t source = size_in(*packed, "buffer");
            check_range(fmt::format("bufferViews[{}].extensions.{}", i, extension),
                        size_in(*packed, "byteOffset"), size_in(*packed, "byteLength"),
                        size_in(root["buffers"][source], "byteLength"),
                        fmt::format("buffers[{}]", source));
        }
    }
}

/// That `count` elements fit into a view.
void check_elements(const Json& root, const std::string& what, const Json& holder,
                    std::size_t count, std::size_t element_size) {
    const std::size_t number = size_in(holder, "bufferView");
    const Json& view = root["bufferViews"][number];
    const std::size_t stride = size_in(view, "byteStride", element_size);
    const std::size_t view_length = size_in(view, "byteLength");
    const std::size_t length = count == 0 ? 0 : (count - 1) * stride + element_size;
    // With counts below 2^53 and strides below 2^8 nothing wraps in 64 bits.
    check_range(what, size_in(holder, "byteOffset"), length, view_length,
                fmt::format("bufferViews[{}]", number));
}

void check_sparse(const Json& root, const Json& accessor, const std::string& name) {
    const Json* sparse = find(accessor, "sparse");
    if (sparse == nullptr) return;
    const std::size_t count = size_in(*sparse, "count");
    if (count > size_in(accessor, "count")) {
        fail_gltf("{}.sparse.count is {}, but there are only {} elements", name, count,
                  size_in(accessor, "count"));
    }
    const Json& indices = (*sparse)["indices"];
    const std::size_t type = size_in(indices, "componentType");
    if (type != 5121 && type != 5123 && type != 5125) {
        fail_gltf("{}.sparse.indices.componentType is {}", name, type);
    }
    check_elements(root, name + ".sparse.indices", indices, count,
                   component_size(static_cast<int>(type)));
    check_elements(root, name + ".sparse.values", (*sparse)["values"], count,
                   element_layout(accessor).size);
}

void check_accessors(const Json& root) {
    const Json& accessors = array_in(root, "accessors");
    for (std::size_t i = 0; i < accessors.size(); ++i) {
        const Json& accessor = accessors[i];
        const std::string name = fmt::format("accessors[{}]", i);
        if (component_size(static_cast<int>(
                std::min<std::size_t>(size_in(accessor, "componentType"), 100'000))) == 0) {
            fail_gltf("{}.componentType is {}", name, size_in(accessor, "componentType"));
        }
        if (component_count(text_in(accessor, "type")) == 0) {
            fail_gltf("{}.type is '{}'", name, text_in(accessor, "type"));
        }
        const std::size_t count = size_in(accessor, "count");
        if (accessor.contains("bufferView")) {
            check_elements(root, name, accessor, count, element_layout(accessor).size);
        } else if (count > most_zero_elements) {
            fail_gltf("{} has no data for {} elements, more than {}", name, count,
                      most_zero_elements);
        }
        check_sparse(root, accessor, name);
    }
}

void check_primitives(const Json& root) {
    const Json& meshes = array_in(root, "meshes");
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const Json& primitives = meshes[i]["primitives"];
        for (std::size_t k = 0; k < primitives.size(); ++k) {
            if (size_in(primitives[k], "mode", 4) > 6) {
                fail_gltf("meshes[{}].primitives[{}].mode is {}, more than 6", i, k,
                          size_in(primitives[k], "mode"));
            }
        }
    }
}

void check_animations(const Json& root) {
    const Json& animations = array_in(root, "animations");
    for (std::size_t i = 0; i < animations.size(); ++i) {
        const std::size_t samplers = animations[i]["samplers"].size();
        const Json& channels = animations[i]["channels"];
        for (std::size_t k = 0; k < channels.size(); ++k) {
            if (size_in(channels[k], "sampler") < samplers) continue;
            fail_gltf("animations[{}].channels[{}].sampler is {}, but there are only {}", i, k,
                      size_in(channels[k], "sampler"), samplers);
        }
    }
}

/// Every node has one parent at most and is below a root: no cycles, and no walk over the nodes
/// takes longer than there are nodes.
void check_nodes(const Json& root) {
    const Json& nodes = array_in(root, "nodes");
    std::vector<bool> has_parent(nodes.size(), false);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const Json& child : array_in(nodes[i], "children")) {
            const auto number = child.get<std::size_t>();
            if (has_parent[number]) fail_gltf("nodes[{}] has more than one parent", number);
            has_parent[number] = true;
        }
    }
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!has_parent[i]) open.push_back(i);
    }
    std::size_t reached = 0;
    std::vector<bool> is_reached(nodes.size(), false);
    while (!open.empty()) {
        const std::size_t node = open.back();
        open.pop_back();
        is_reached[node] = true;
        ++reached;
        for (const Json& child : array_in(nodes[node], "children")) {
            open.push_back(child.get<std::size_t>());
        }
    }
    if (reached == nodes.size()) return;
    const auto lost = std::find(is_reached.begin(), is_reached.end(), false) - is_reached.begin();
    fail_gltf("nodes[{}] is its own ancestor", lost);
}

}  // namespace

void check_gltf(const Json& root) {
    check_schema(root);
    check_version(root);
    check_required_extensions(root);
    check_views(root);
    check_accessors(root);
    check_primitives(root);
    check_animations(root);
    check_nodes(root);
}

}  // namespace relief

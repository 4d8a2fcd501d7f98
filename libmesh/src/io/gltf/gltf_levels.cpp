// SPDX-License-Identifier: Apache-2.0
// Levels of detail of a document, by MSFT_lod: a node lists the nodes of its lower levels, which
// stand in its place. They have no parent and are in no scene.
#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "io/gltf/gltf_contents.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr const char* lod_extension = "MSFT_lod";

bool is_animated(const Json& root, std::size_t node) {
    for (const Json& animation : array_in(root, "animations")) {
        for (const Json& channel : array_in(animation, "channels")) {
            const Json* target = find(channel, "target");
            if (target != nullptr && index_in(*target, "node") == node) return true;
        }
    }
    return false;
}

/// Returns whether a node is more than a place for its mesh. The nodes of lower levels are copies,
/// so they cannot have children, and animations would not move them.
bool has_more_than_a_mesh(const Json& root, std::size_t node) {
    const Json& json = root["nodes"][node];
    if (!array_in(json, "children").empty() || json.contains("camera")) return true;
    if (const Json* extensions = find(json, "extensions")) {
        for (const auto& [name, extension] : extensions->items()) {
            if (name != "EXT_mesh_gpu_instancing") return true;
        }
    }
    return is_animated(root, node);
}

/// Moves the mesh of a node to a new child. \return the child
std::size_t moved_to_child(Json& root, std::size_t node) {
    const std::size_t child = root["nodes"].size();
    Json leaf = Json::object();
    Json& json = root["nodes"][node];
    for (const char* key : {"mesh", "skin", "weights"}) {
        if (!json.contains(key)) continue;
        leaf[key] = json[key];
        json.erase(key);
    }
    if (json.contains("name")) leaf["name"] = json["name"];
    if (const Json* instances = find(json, "extensions", "EXT_mesh_gpu_instancing")) {
        leaf["extensions"]["EXT_mesh_gpu_instancing"] = *instances;
        json["extensions"].erase("EXT_mesh_gpu_instancing");
        if (json["extensions"].empty()) json.erase("extensions");
    }
    json["children"].push_back(child);
    root["nodes"].push_back(std::move(leaf));
    if (!root.contains("animations")) return child;
    for (Json& animation : root["animations"]) {
        for (Json& channel : animation["channels"]) {
            Json& target = channel["target"];
            if (index_in(target, "node") == node && text_in(target, "path") == "weights")
                target["node"] = child;
        }
    }
    return child;
}

void add_levels(Json& root, std::size_t node, std::span<const GltfLevel> levels, bool with_names) {
    if (has_more_than_a_mesh(root, node)) node = moved_to_child(root, node);
    const std::string name = text_in(root["nodes"][node], "name");
    const std::string base = name.empty() ? fmt::format("node{}", node) : name;
    Json ids = Json::array();
    Json coverages = Json::array();
    for (std::size_t i = 0; i < levels.size(); ++i) {
        Json lower = root["nodes"][node];
        lower["mesh"] = levels[i].mesh;
        if (with_names) lower["name"] = fmt::format("{}_LOD{}", base, i + 1);
        ids.push_back(root["nodes"].size());
        coverages.push_back(levels[i].max_coverage);
        root["nodes"].push_back(std::move(lower));
    }
    coverages.push_back(0.0);  // The lowest level is drawn however small it is.
    Json& json = root["nodes"][node];
    if (with_names) json["name"] = base + "_LOD0";
    json["extensions"][lod_extension] = {{"ids", std::move(ids)}};
    json["extras"]["MSFT_screencoverage"] = std::move(coverages);
}

}  // namespace

std::size_t GltfDocument::copy_mesh(std::size_t mesh) {
    Json& root = contents_->data.root;
    const std::size_t count = array_in(root, "meshes").size();
    if (mesh >= count) fail_gltf("mesh {} does not exist, there are only {}", mesh, count);
    Json copy = root["meshes"][mesh];
    root["meshes"].push_back(std::move(copy));
    return count;
}

void GltfDocument::remove_last_mesh() {
    Json& root = contents_->data.root;
    const std::size_t count = array_in(root, "meshes").size();
    if (count == 0) fail_gltf("there is no mesh to remove");
    for (const Json& node : array_in(root, "nodes")) {
        if (index_in(node, "mesh") == count - 1)
            fail_gltf("mesh {} cannot be removed: a node uses it", count - 1);
    }
    const auto retire = [&](const Json& attributes) {
        for (const auto& [name, accessor] : attributes.items())
            contents_->data.retired_accessors.insert(accessor.get<std::size_t>());
    };
    for (const Json& primitive : array_in(root["meshes"].back(), "primitives")) {
        retire(primitive["attributes"]);
        for (const Json& target : array_in(primitive, "targets"))
            retire(target);
        if (const auto indices = index_in(primitive, "indices"))
            contents_->data.retired_accessors.insert(*indices);
    }
    root["meshes"].erase(count - 1);
}

bool GltfDocument::has_levels_of_detail() const {
    return std::ranges::any_of(array_in(contents_->data.root, "nodes"), [](const Json& node) {
        return find(node, "extensions", lod_extension) != nullptr;
    });
}

void GltfDocument::set_levels_of_detail(std::size_t mesh, std::span<const GltfLevel> levels,
                                        bool with_names) {
    Json& root = contents_->data.root;
    const std::size_t nodes = array_in(root, "nodes").size();
    for (std::size_t n = 0; n < nodes; ++n) {
        const Json& node = root["nodes"][n];
        if (index_in(node, "mesh") != mesh) continue;
        if (find(node, "extensions", lod_extension) != nullptr)
            fail_gltf("node {} already has levels of detail", n);
        const Json* extras = find(node, "extras");
        if (extras != nullptr && !extras->is_object())
            fail_gltf("the extras of node {} are not an object, so they cannot hold coverages", n);
    }
    bool is_used = false;
    for (std::size_t n = 0; n < nodes; ++n) {
        if (index_in(root["nodes"][n], "mesh") != mesh) continue;
        add_levels(root, n, levels, with_names);
        is_used = true;
    }
    if (!is_used) return;
    Json& used = root["extensionsUsed"];
    if (std::find(used.begin(), used.end(), lod_extension) == used.end())
        used.push_back(lod_extension);
}

}  // namespace relief

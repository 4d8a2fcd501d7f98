// SPDX-License-Identifier: Apache-2.0
// The memory that the contents of a document take once they are decoded. A document of some hundred
// bytes can stand for gigabytes: by accessors without data, and by references to the same data from
// many primitives, nodes, skins, channels and images. All are counted here, before anything is
// decoded. Tests: tests/mesh/io/gltf/gltf_budget_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "relief/mesh/gltf_document.h"

namespace relief {
using namespace relief::detail;

namespace {

std::size_t element_count(const Json& root, std::size_t accessor) {
    return size_in(root["accessors"][accessor], "count");
}

/// The vertices that a primitive uses at most, and its indices.
struct PrimitiveSize {
    std::size_t vertices = 0;
    std::size_t corners = 0;
};

PrimitiveSize primitive_size(const Json& root, const Json& primitive, std::size_t position) {
    const auto indices = index_in(primitive, "indices");
    const std::size_t vertices = element_count(root, position);
    const std::size_t corners = indices ? element_count(root, *indices) : vertices;
    return {std::min(vertices, corners), corners};
}

/// The size of a triangle list's index, or of the triangle that a corner of a strip or a fan makes.
std::size_t corner_size(const Json& primitive) {
    const bool is_list = size_in(primitive, "mode", gltf_code::triangles) <= 4;
    return is_list ? sizeof(std::uint32_t) : 3 * sizeof(std::uint32_t);
}

class ContentCount {
  public:
    explicit ContentCount(GltfContents& contents)
        : root_(contents.root), budget_(contents.budget) {}

    void take_all() {
        take_accessors();
        take_materials();
        take_primitives();
        take_instances();
        take_skins();
        take_channels();
        take_images();
    }

  private:
    [[nodiscard]] const Json& accessor(std::size_t number) const {
        return root_["accessors"][number];
    }

    [[nodiscard]] std::size_t count_of(std::size_t number) const {
        return element_count(root_, number);
    }

    /// Elements that no bytes of the file stand for.
    void take_accessors() {
        const Json& accessors = array_in(root_, "accessors");
        for (std::size_t i = 0; i < accessors.size(); ++i) {
            if (accessors[i].contains("bufferView") && !accessors[i].contains("sparse")) continue;
            budget_.take(count_of(i), element_layout(accessors[i]).size,
                         [&] { return fmt::format("accessors[{}]", i); });
        }
    }

    void take_materials() {
        constexpr std::size_t bytes_per_material = 2048;
        budget_.take(array_in(root_, "materials").size(), bytes_per_material,
                     [] { return "materials"; });
    }

    void take_primitives() {
        const Json& meshes = array_in(root_, "meshes");
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            const Json& primitives = meshes[i]["primitives"];
            for (std::size_t k = 0; k < primitives.size(); ++k)
                take_primitive(primitives[k], i, k);
        }
    }

    /// Takes the memory that drawing a primitive needs, half of it for its buffers and uniforms,
    /// and half for the reasons of its effects; and its arrays: floats and indices of 32 bits, for
    /// the vertices that it uses.
    void take_primitive(const Json& primitive, std::size_t mesh, std::size_t number) {
        constexpr std::size_t bytes_per_primitive = 20480;
        const auto name = [&] { return fmt::format("meshes[{}].primitives[{}]", mesh, number); };
        const auto position = index_in(primitive["attributes"], "POSITION");
        if (!position) return;
        const PrimitiveSize size = primitive_size(root_, primitive, *position);
        budget_.take(1, bytes_per_primitive, name);
        budget_.take(size.corners, corner_size(primitive), name);
        const auto take_attributes = [&](const Json& attributes) {
            for (const auto& [semantic, index] : attributes.items()) {
                const Json& values = accessor(index.get<std::size_t>());
                budget_.take(size.vertices, element_layout(values).components * sizeof(float),
                             name);
            }
        };
        take_attributes(primitive["attributes"]);
        for (const Json& target : array_in(primitive, "targets"))
            take_attributes(target);
    }

    /// A matrix, a name and what drawing needs, for each primitive of a node and each of its
    /// instances.
    void take_instances() {
        constexpr std::size_t bytes_per_instance = 2560;
        constexpr std::size_t bytes_per_pose = 16384;  // Textures, and an effect plan of its own.
        constexpr std::size_t bytes_per_joint = 4 * sizeof(glm::mat4);
        const Json& nodes = array_in(root_, "nodes");
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const auto mesh = index_in(nodes[i], "mesh");
            if (!mesh) continue;
            std::size_t instances = 1;
            if (const Json* attributes =
                    find(nodes[i], "extensions", "EXT_mesh_gpu_instancing", "attributes")) {
                for (const auto& [name, index] : attributes->items())
                    instances = std::max(instances, count_of(index.get<std::size_t>()));
            }
            const std::size_t primitives = root_["meshes"][*mesh]["primitives"].size();
            std::size_t bytes = bytes_per_instance;
            if (const auto skin = index_in(nodes[i], "skin"))
                bytes += bytes_per_pose + bytes_per_joint * root_["skins"][*skin]["joints"].size();
            budget_.take(instances, bytes * primitives,
                         [&] { return fmt::format("nodes[{}]", i); });
        }
    }

    void take_skins() {
        const Json& skins = array_in(root_, "skins");
        for (std::size_t i = 0; i < skins.size(); ++i) {
            const auto matrices = index_in(skins[i], "inverseBindMatrices");
            if (!matrices) continue;
            budget_.take(count_of(*matrices), sizeof(glm::mat4),
                         [&] { return fmt::format("skins[{}]", i); });
        }
    }

    void take_channels() {
        const Json& animations = array_in(root_, "animations");
        for (std::size_t i = 0; i < animations.size(); ++i) {
            const Json& samplers = animations[i]["samplers"];
            const Json& channels = animations[i]["channels"];
            for (std::size_t k = 0; k < channels.size(); ++k) {
                const auto name = [&] { return fmt::format("animations[{}].channels[{}]", i, k); };
                const Json& sampler = samplers[size_in(channels[k], "sampler")];
                budget_.take(count_of(size_in(sampler, "input")), sizeof(float), name);
                budget_.take(count_of(size_in(sampler, "output")), sizeof(glm::vec4), name);
            }
        }
    }

    void take_images() {
        const Json& images = array_in(root_, "images");
        for (std::size_t i = 0; i < images.size(); ++i) {
            const auto view = index_in(images[i], "bufferView");
            if (!view) continue;
            budget_.take(size_in(root_["bufferViews"][*view], "byteLength"), 1,
                         [&] { return fmt::format("images[{}]", i); });
        }
    }

    const Json& root_;
    MemoryBudget& budget_;
};

}  // namespace

void detail::take_contents(GltfContents& contents) {
    ContentCount(contents).take_all();
}

void GltfDocument::require_memory_of_instances() const {
    // Position, normal, texture coordinates, and a color or a tangent.
    constexpr std::size_t bytes_per_vertex = 12 * sizeof(float);
    const Json& root = contents_->data.root;
    MemoryBudget budget = contents_->data.budget;
    for (const auto& item : view().primitives) {
        const auto name = [&] { return fmt::format("nodes[{}]", item.node); };
        const Json& primitive = root["meshes"][item.what.mesh]["primitives"][item.what.primitive];
        const auto position = index_in(primitive["attributes"], "POSITION");
        if (!position) continue;
        const PrimitiveSize size = primitive_size(root, primitive, *position);
        // Facets do not share vertices.
        const bool is_flat = !primitive["attributes"].contains("NORMAL");
        budget.take(is_flat ? size.corners : size.vertices, bytes_per_vertex, name);
        budget.take(size.corners, corner_size(primitive), name);
    }
}

}  // namespace relief

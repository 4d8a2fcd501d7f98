// SPDX-License-Identifier: Apache-2.0
// Compressed primitives decoded into the accessors that describe them, in object space.
//
// Accessors that several primitives share stay shared where the same data fills them; one that
// already got other data is doubled. Strips become the triangles that they are. Source: the
// glTF extension KHR_draco_mesh_compression. Tests: tests/mesh/io/gltf/gltf_draco_test.cpp.
#include "io/gltf/gltf_draco.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "io/gltf/draco_mesh.h"
#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_edit.h"
#include "progress_stage.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// Where decoded data came from: a buffer view, and in it an attribute, or the indices.
using Source = std::pair<std::size_t, std::size_t>;
constexpr std::size_t indices_source = static_cast<std::size_t>(-1);

/// The extension of a primitive, or null.
const Json* draco_of(const Json& primitive) {
    return find(primitive, "extensions", draco_extension);
}

DracoComponent component_of(const ElementLayout& layout) {
    switch (layout.component_type) {
        case gltf_code::int8:
            return DracoComponent::int8;
        case gltf_code::uint8:
            return DracoComponent::uint8;
        case gltf_code::int16:
            return DracoComponent::int16;
        case gltf_code::uint16:
            return DracoComponent::uint16;
        case gltf_code::uint32:
            return DracoComponent::uint32;
        default:
            return DracoComponent::float32;
    }
}

/// Indices in the type that an accessor gives them.
std::string packed_indices(const std::vector<std::uint32_t>& indices, const ElementLayout& layout) {
    const std::size_t size = component_size(layout.component_type);
    std::string bytes;
    bytes.reserve(indices.size() * size);
    for (const std::uint32_t index : indices) {
        if (size < 4 && index >> (8 * size) != 0)
            throw InvalidInput(
                fmt::format("index {} of its Draco data does not fit into {} bytes", index, size));
        bytes.append(reinterpret_cast<const char*>(&index), size);
    }
    return bytes;
}

/// Decodes the primitives of one document.
class Unpacking {
  public:
    Unpacking(GltfContents& contents, Report& report) : contents_(contents), report_(report) {}

    /// Whether there is something that only the compressed data has.
    [[nodiscard]] bool is_needed(const Json& primitive) const;
    void unpack(Json& primitive);

  private:
    [[nodiscard]] bool has_data(std::size_t accessor) const {
        return contents_.root["accessors"][accessor].contains("bufferView");
    }
    const DracoMesh& decoded(std::size_t view);
    std::size_t fill(std::size_t accessor, Source source, const std::string& elements, int target);
    std::size_t fill_attribute(std::size_t accessor, std::size_t view, const Json& unique_id);
    std::size_t fill_indices(std::optional<std::size_t> accessor, std::size_t view);

    GltfContents& contents_;
    Report& report_;
    std::map<std::size_t, Source> filled_;  ///< Accessors that have got data, and which.
    std::optional<std::size_t> last_view_;
    std::optional<DracoMesh> last_mesh_;
};

bool Unpacking::is_needed(const Json& primitive) const {
    const Json* draco = draco_of(primitive);
    if (draco == nullptr) return false;
    const auto is_missing = [&](std::optional<std::size_t> accessor) {
        return !accessor || !has_data(*accessor) || filled_.contains(*accessor);
    };
    if (is_missing(index_in(primitive, "indices"))) return true;
    for (const auto& [name, unique_id] : (*draco)["attributes"].items()) {
        if (is_missing(index_in(primitive["attributes"], name.c_str()))) return true;
    }
    return false;
}

/// Primitives with the same data usually follow each other: one is kept.
const DracoMesh& Unpacking::decoded(std::size_t view) {
    if (last_view_ != view) {
        const Json& json = contents_.root["bufferViews"][view];
        const std::string_view bytes = contents_.buffers[size_in(json, "buffer")].bytes();
        last_mesh_.emplace(bytes.substr(size_in(json, "byteOffset"), size_in(json, "byteLength")));
        last_view_ = view;
    }
    return *last_mesh_;
}

/// Gives an accessor its elements. \return its number, or that of its double
std::size_t Unpacking::fill(std::size_t accessor, Source source, const std::string& elements,
                            int target) {
    if (const auto done = filled_.find(accessor); done != filled_.end() || has_data(accessor)) {
        if (done != filled_.end() && done->second == source) return accessor;
        if (done == filled_.end()) contents_.retired_accessors.insert(accessor);
        Json copy = contents_.root["accessors"][accessor];
        for (const char* key : {"bufferView", "byteOffset"})
            copy.erase(key);
        contents_.root["accessors"].push_back(std::move(copy));
        accessor = contents_.root["accessors"].size() - 1;
    }
    const std::size_t size = element_layout(contents_.root["accessors"][accessor]).size;
    const std::size_t view = add_elements(contents_, size, elements, target);
    Json& json = contents_.root["accessors"][accessor];
    const std::size_t count = elements.size() / size;
    if (size_in(json, "count") != count) {
        report_.add("accessor count that is not its Draco data's", "accessor", accessor,
                    "the data's is taken");
    }
    json["bufferView"] = view;
    json["count"] = count;
    json.erase("byteOffset");
    if (!json.contains("sparse")) renew_bounds(json, elements);
    filled_[accessor] = source;
    return accessor;
}

std::size_t Unpacking::fill_attribute(std::size_t accessor, std::size_t view,
                                      const Json& unique_id) {
    if (!unique_id.is_number_unsigned() || unique_id.get<std::uint64_t>() > 0xFFFF'FFFFU)
        throw InvalidInput("the number of an attribute in its Draco data is not an index");
    const auto id = unique_id.get<std::uint32_t>();
    const Json& json = contents_.root["accessors"][accessor];
    const ElementLayout layout = element_layout(json);
    if (text_in(json, "type").starts_with("MAT"))
        throw InvalidInput(
            fmt::format("accessors[{}] holds matrices, which Draco has not", accessor));
    return fill(accessor, {view, id},
                decoded(view).attribute(id, layout.components, component_of(layout)),
                gltf_code::array_buffer);
}

std::size_t Unpacking::fill_indices(std::optional<std::size_t> accessor, std::size_t view) {
    const std::vector<std::uint32_t> indices = decoded(view).indices();
    if (!accessor) {
        contents_.root["accessors"].push_back(
            {{"componentType", gltf_code::uint32}, {"count", indices.size()}, {"type", "SCALAR"}});
        accessor = contents_.root["accessors"].size() - 1;
    }
    const ElementLayout layout = index_layout(contents_, *accessor);
    return fill(*accessor, {view, indices_source}, packed_indices(indices, layout),
                gltf_code::element_array_buffer);
}

void Unpacking::unpack(Json& primitive) {
    constexpr std::size_t triangles = 4;
    constexpr std::size_t triangle_strip = 5;
    const Json draco = *draco_of(primitive);
    const std::size_t mode = size_in(primitive, "mode", triangles);
    if (mode != triangles && mode != triangle_strip)
        throw InvalidInput(fmt::format("Draco has no primitives of mode {}", mode));
    const std::size_t view = size_in(draco, "bufferView");
    auto indices = index_in(primitive, "indices");
    if (mode == triangle_strip && indices) {
        // A strip has fewer indices than its triangles: no contradiction.
        Json copy = contents_.root["accessors"][*indices];
        copy["count"] = decoded(view).indices().size();
        contents_.retired_accessors.insert(*indices);
        contents_.root["accessors"].push_back(std::move(copy));
        indices = contents_.root["accessors"].size() - 1;
        primitive.erase("mode");
    }
    primitive["indices"] = fill_indices(indices, view);
    for (const auto& [name, unique_id] : draco["attributes"].items()) {
        const auto accessor = index_in(primitive["attributes"], name.c_str());
        if (!accessor)
            throw InvalidInput(fmt::format("its Draco data has {}, but the primitive not", name));
        primitive["attributes"][name] = fill_attribute(*accessor, view, unique_id);
    }
    erase_extension(primitive, draco_extension);
    contents_.retired_views.insert(view);
    ++contents_.unpacked[draco_extension];
}

}  // namespace

void unpack_draco(GltfContents& contents, Report& report) {
    Unpacking unpacking(contents, report);
    const std::size_t mesh_count = array_in(contents.root, "meshes").size();
    bool any = false;
    const ProgressStage stage("unpacking");
    for (std::size_t i = 0; i < mesh_count; ++i) {
        Json& primitives = contents.root["meshes"][i]["primitives"];
        for (std::size_t k = 0; k < primitives.size(); ++k) {
            check_cancelled();
            if (!unpacking.is_needed(primitives[k])) continue;
            try {
                unpacking.unpack(primitives[k]);
            } catch (const InvalidInput& error) {
                throw InvalidInput(
                    fmt::format("meshes[{}].primitives[{}]: {}", i, k, error.what()));
            }
            any = true;
        }
    }
    if (any) forget_if_unused(contents.root, draco_extension);
}

}  // namespace relief

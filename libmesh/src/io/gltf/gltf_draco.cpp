// SPDX-License-Identifier: Apache-2.0
// Decodes primitives that KHR_draco_mesh_compression has compressed. This is the only file that
// uses Draco.
//
// Draco's decoder validates its input. Its result is validated again before it is used: the value
// index of each vertex, and that values lie inside the attribute's buffer.
#include "io/gltf/gltf_compression.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

/// Number types that glTF and Draco have in common.
enum class DracoComponent { int8, uint8, int16, uint16, uint32, float32 };

class DracoMesh {
  public:
    /// Decodes the data; quantized attributes become the numbers that they stand for.
    /// \throws InvalidInput if the data is damaged or holds points without triangles
    explicit DracoMesh(std::string_view bytes);

    [[nodiscard]] std::size_t vertex_count() const;

    /// Returns three indices for each triangle. \throws InvalidInput if one is out of range
    [[nodiscard]] std::vector<std::uint32_t> indices() const;

    /// Returns the attribute with a unique id: `components` packed numbers of a type for each
    /// vertex. Numbers that Draco stores in another type are converted by value. \throws
    /// InvalidInput if there is no such attribute, if it has another number of components,
    ///         or if a number does not fit
    [[nodiscard]] std::string attribute(std::uint32_t unique_id, std::size_t components,
                                        DracoComponent component) const;

  private:
    std::unique_ptr<draco::Mesh> mesh_;
};

draco::DataType draco_type(DracoComponent component) {
    switch (component) {
        case DracoComponent::int8:
            return draco::DT_INT8;
        case DracoComponent::uint8:
            return draco::DT_UINT8;
        case DracoComponent::int16:
            return draco::DT_INT16;
        case DracoComponent::uint16:
            return draco::DT_UINT16;
        case DracoComponent::uint32:
            return draco::DT_UINT32;
        case DracoComponent::float32:
            return draco::DT_FLOAT32;
    }
    return draco::DT_INVALID;
}

/// Returns the value index of a vertex. \throws InvalidInput if it is out of range
draco::AttributeValueIndex value_of(const draco::PointAttribute& attribute, std::uint32_t vertex) {
    const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(vertex));
    if (value.value() >= attribute.size())
        throw InvalidInput(fmt::format("its Draco data has no value for vertex {}", vertex));
    return value;
}

/// Copies values of the stored type.
void copy_values(const draco::PointAttribute& attribute, std::size_t size, std::string& values) {
    for (std::size_t i = 0; i * size < values.size(); ++i) {
        const auto value = value_of(attribute, static_cast<std::uint32_t>(i));
        std::memcpy(values.data() + i * size, attribute.GetAddress(value), size);
    }
}

/// Converts values from another stored type.
template <typename Component>
void convert_values(const draco::PointAttribute& attribute, std::size_t components,
                    std::string& values) {
    std::vector<Component> element(components);
    const std::size_t size = components * sizeof(Component);
    for (std::size_t i = 0; i * size < values.size(); ++i) {
        const auto vertex = static_cast<std::uint32_t>(i);
        if (!attribute.ConvertValue<Component>(value_of(attribute, vertex),
                                               static_cast<std::int8_t>(components),
                                               element.data())) {
            throw InvalidInput(
                fmt::format("a number of vertex {} in its Draco data does not fit", vertex));
        }
        std::memcpy(values.data() + i * size, element.data(), size);
    }
}

/// Checks that all values lie inside the attribute's buffer.
void check_buffer(const draco::PointAttribute& attribute, std::size_t element_size) {
    const draco::DataBuffer* buffer = attribute.buffer();
    const auto stride = static_cast<std::size_t>(attribute.byte_stride());
    const auto offset = static_cast<std::size_t>(attribute.byte_offset());
    const std::size_t needed =
        attribute.size() == 0 ? 0 : offset + (attribute.size() - 1) * stride + element_size;
    if (buffer == nullptr || needed > buffer->data_size())
        throw InvalidInput("its Draco data lacks values of an attribute");
}

DracoMesh::DracoMesh(std::string_view bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    const auto type = draco::Decoder::GetEncodedGeometryType(&buffer);
    if (!type.ok())
        throw InvalidInput(
            fmt::format("its Draco data is damaged: {}", type.status().error_msg_string()));
    if (type.value() != draco::TRIANGULAR_MESH)
        throw InvalidInput("its Draco data contains points, not triangles");
    draco::Decoder decoder;
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok())
        throw InvalidInput(
            fmt::format("its Draco data is damaged: {}", mesh.status().error_msg_string()));
    mesh_ = std::move(mesh).value();
}

std::size_t DracoMesh::vertex_count() const {
    return mesh_->num_points();
}

std::vector<std::uint32_t> DracoMesh::indices() const {
    std::vector<std::uint32_t> result;
    result.reserve(3 * std::size_t{mesh_->num_faces()});
    for (draco::FaceIndex i(0); i < mesh_->num_faces(); ++i) {
        for (const draco::PointIndex& vertex : mesh_->face(i)) {
            if (vertex.value() >= mesh_->num_points()) {
                throw InvalidInput(
                    fmt::format("its Draco data names vertex {}, but there are only {}",
                                vertex.value(), mesh_->num_points()));
            }
            result.push_back(vertex.value());
        }
    }
    return result;
}

std::string DracoMesh::attribute(std::uint32_t unique_id, std::size_t components,
                                 DracoComponent component) const {
    const draco::PointAttribute* attribute = mesh_->GetAttributeByUniqueId(unique_id);
    if (attribute == nullptr)
        throw InvalidInput(fmt::format("its Draco data has no attribute {}", unique_id));
    if (attribute->num_components() != components) {
        throw InvalidInput(fmt::format("attribute {} of its Draco data has {} components, not {}",
                                       unique_id, attribute->num_components(), components));
    }
    const draco::DataType type = draco_type(component);
    const auto component_size = static_cast<std::size_t>(draco::DataTypeLength(type));
    check_buffer(*attribute, components * static_cast<std::size_t>(
                                              draco::DataTypeLength(attribute->data_type())));
    std::string values(vertex_count() * components * component_size, '\0');
    if (attribute->data_type() == type) {
        copy_values(*attribute, components * component_size, values);
        return values;
    }
    switch (component) {
        case DracoComponent::int8:
            convert_values<std::int8_t>(*attribute, components, values);
            break;
        case DracoComponent::uint8:
            convert_values<std::uint8_t>(*attribute, components, values);
            break;
        case DracoComponent::int16:
            convert_values<std::int16_t>(*attribute, components, values);
            break;
        case DracoComponent::uint16:
            convert_values<std::uint16_t>(*attribute, components, values);
            break;
        case DracoComponent::uint32:
            convert_values<std::uint32_t>(*attribute, components, values);
            break;
        case DracoComponent::float32:
            convert_values<float>(*attribute, components, values);
            break;
    }
    return values;
}

/// The source of decoded data: a buffer view, and an attribute in it or `indices_source`.
using Source = std::pair<std::size_t, std::size_t>;
constexpr std::size_t indices_source = static_cast<std::size_t>(-1);

/// Returns the Draco extension of a primitive, or null.
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

/// Packs indices in the type of an accessor.
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

    /// Returns true if the primitive lacks data that its compressed copy has.
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
    std::map<std::size_t, Source>
        filled_;  ///< Accessors that were filled, and the source of their data.
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

/// Decodes a view. The last result is kept, because primitives with the same data usually are
/// neighbors.
const DracoMesh& Unpacking::decoded(std::size_t view) {
    if (last_view_ != view) {
        const Json& json = contents_.root["bufferViews"][view];
        const std::string_view bytes = contents_.buffers[size_in(json, "buffer")].bytes();
        last_mesh_.emplace(bytes.substr(size_in(json, "byteOffset"), size_in(json, "byteLength")));
        last_view_ = view;
        // A view that several primitives use in turn is decoded each time.
        contents_.budget.take(last_mesh_->vertex_count(), sizeof(glm::vec3),
                              [&] { return fmt::format("bufferViews[{}]", view); });
    }
    return *last_mesh_;
}

/// Gives an accessor its elements. \return its index, or that of a copy if it already has other
/// data
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
    contents_.budget.take(elements.size(), 1,
                          [&] { return fmt::format("accessors[{}]", accessor); });
    const std::size_t size = element_layout(contents_.root["accessors"][accessor]).size;
    const std::size_t view = add_elements(contents_, size, elements, target);
    Json& json = contents_.root["accessors"][accessor];
    const std::size_t count = elements.size() / size;
    if (size_in(json, "count") != count) {
        report_.add("accessor count that is not its Draco data's", "accessor", accessor,
                    "that of the data is used");
    }
    json["bufferView"] = view;
    json["count"] = count;
    json.erase("byteOffset");
    if (!json.contains("sparse")) update_bounds(json, elements);
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
            fmt::format("accessors[{}] contains matrices, which Draco does not support", accessor));
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
    const Json draco = *draco_of(primitive);
    const std::size_t mode = size_in(primitive, "mode", gltf_code::triangles);
    if (mode != gltf_code::triangles && mode != gltf_code::triangle_strip)
        throw InvalidInput(fmt::format("Draco has no primitives of mode {}", mode));
    const std::size_t view = size_in(draco, "bufferView");
    auto indices = index_in(primitive, "indices");
    if (mode == gltf_code::triangle_strip && indices) {
        // A strip has fewer indices than its triangles, so the counts may differ.
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
            throw InvalidInput(
                fmt::format("its Draco data has {}, but the primitive does not", name));
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
    if (any) remove_unused_extension(contents.root, draco_extension);
}

}  // namespace relief::detail

// SPDX-License-Identifier: Apache-2.0
// Decoding Draco. The only file that knows it.
//
// Draco's decoder checks what it reads, but its result is looked at again before it is trusted:
// which value belongs to a vertex, and whether that lies in the attribute's buffer.
// Tests: tests/mesh/io/gltf/gltf_draco_test.cpp.
#include "io/gltf/draco_mesh.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <cstring>

#include "relief/mesh/error.h"

namespace relief {
namespace {

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

/// The value of a vertex, checked to exist.
draco::AttributeValueIndex value_of(const draco::PointAttribute& attribute, std::uint32_t vertex) {
    const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(vertex));
    if (value.value() >= attribute.size())
        throw InvalidInput(fmt::format("its Draco data has no value for vertex {}", vertex));
    return value;
}

/// Values of the type that Draco stores, byte for byte.
void copy_values(const draco::PointAttribute& attribute, std::size_t size, std::string& values) {
    for (std::size_t i = 0; i * size < values.size(); ++i) {
        const auto value = value_of(attribute, static_cast<std::uint32_t>(i));
        std::memcpy(values.data() + i * size, attribute.GetAddress(value), size);
    }
}

/// Values of another type than Draco stores.
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

/// That all values lie in the attribute's buffer.
void check_buffer(const draco::PointAttribute& attribute, std::size_t element_size) {
    const draco::DataBuffer* buffer = attribute.buffer();
    const auto stride = static_cast<std::size_t>(attribute.byte_stride());
    const auto offset = static_cast<std::size_t>(attribute.byte_offset());
    const std::size_t needed =
        attribute.size() == 0 ? 0 : offset + (attribute.size() - 1) * stride + element_size;
    if (buffer == nullptr || needed > buffer->data_size())
        throw InvalidInput("its Draco data lacks values of an attribute");
}

}  // namespace

struct DracoMesh::Decoded {
    std::unique_ptr<draco::Mesh> mesh;
};

DracoMesh::DracoMesh(std::string_view bytes) : decoded_(std::make_unique<Decoded>()) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    const auto type = draco::Decoder::GetEncodedGeometryType(&buffer);
    if (!type.ok())
        throw InvalidInput(
            fmt::format("its Draco data is damaged: {}", type.status().error_msg_string()));
    if (type.value() != draco::TRIANGULAR_MESH)
        throw InvalidInput("its Draco data holds points, not triangles");
    draco::Decoder decoder;
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok())
        throw InvalidInput(
            fmt::format("its Draco data is damaged: {}", mesh.status().error_msg_string()));
    decoded_->mesh = std::move(mesh).value();
}

DracoMesh::DracoMesh(DracoMesh&&) noexcept = default;
DracoMesh& DracoMesh::operator=(DracoMesh&&) noexcept = default;
DracoMesh::~DracoMesh() = default;

std::size_t DracoMesh::vertex_count() const {
    return decoded_->mesh->num_points();
}

std::vector<std::uint32_t> DracoMesh::indices() const {
    std::vector<std::uint32_t> result;
    result.reserve(3 * std::size_t{decoded_->mesh->num_faces()});
    for (draco::FaceIndex i(0); i < decoded_->mesh->num_faces(); ++i) {
        for (const draco::PointIndex& vertex : decoded_->mesh->face(i)) {
            if (vertex.value() >= decoded_->mesh->num_points()) {
                throw InvalidInput(
                    fmt::format("its Draco data names vertex {}, but there are only {}",
                                vertex.value(), decoded_->mesh->num_points()));
            }
            result.push_back(vertex.value());
        }
    }
    return result;
}

std::string DracoMesh::attribute(std::uint32_t unique_id, std::size_t components,
                                 DracoComponent component) const {
    const draco::PointAttribute* attribute = decoded_->mesh->GetAttributeByUniqueId(unique_id);
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

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Elements of glTF accessors. Ranges have been checked when the document was read (gltf_check.h);
// what only the data can tell, sparse indices, throws InvalidInput here.
// Source: glTF 2.0 (ISO/IEC 12113), sections 3.6.2 and 3.11 (fractions: c / max, at least -1).
// Tests: tests/mesh/io/gltf/gltf_document_test.cpp.
#include "io/gltf/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "large_memory.h"
#include "progress_stage.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// The bytes of a view from an offset on.
std::string_view view_bytes(const GltfContents& contents, const Json& holder) {
    const Json& view = contents.root["bufferViews"][size_in(holder, "bufferView")];
    const std::string_view buffer = contents.buffers[size_in(view, "buffer")].bytes();
    return buffer.substr(size_in(view, "byteOffset"), size_in(view, "byteLength"))
        .substr(size_in(holder, "byteOffset"));
}

template <typename Component>
Component component_at(const char* bytes) {
    Component value;
    std::memcpy(&value, bytes, sizeof(value));
    return value;
}

std::uint32_t index_at(const char* bytes, int component_type) {
    switch (component_type) {
        case gltf_code::uint8:
            return component_at<std::uint8_t>(bytes);
        case gltf_code::uint16:
            return component_at<std::uint16_t>(bytes);
        default:
            return component_at<std::uint32_t>(bytes);
    }
}

/// Puts the values of a sparse accessor over the packed elements.
void apply_sparse(const GltfContents& contents, const Json& accessor, std::size_t number,
                  std::string& elements) {
    const Json* sparse = find(accessor, "sparse");
    if (sparse == nullptr) return;
    const std::size_t size = element_layout(accessor).size;
    const std::size_t count = size_in(accessor, "count");
    const Json& indices = (*sparse)["indices"];
    const auto type = static_cast<int>(size_in(indices, "componentType"));
    const std::string_view index_bytes = view_bytes(contents, indices);
    const std::string_view values = view_bytes(contents, (*sparse)["values"]);
    for (std::size_t i = 0; i < size_in(*sparse, "count"); ++i) {
        const std::uint32_t index = index_at(index_bytes.data() + i * component_size(type), type);
        if (index >= count) {
            throw InvalidInput(
                fmt::format("accessors[{}].sparse names element {}, but there are "
                            "only {}",
                            number, index, count));
        }
        std::memcpy(elements.data() + index * size, values.data() + i * size, size);
    }
}

/// Signed fractions reach from -1 to 1, so that the most negative code has no place of its own.
template <typename Component>
float converted(Component value, bool is_fraction) {
    if constexpr (std::numeric_limits<Component>::is_integer) {
        if (is_fraction) {
            constexpr float largest = static_cast<float>(std::numeric_limits<Component>::max());
            return std::max(static_cast<float>(value) / largest, -1.0F);
        }
    }
    return static_cast<float>(value);
}

template <typename Component, typename Vector>
void convert(std::string_view elements, std::size_t element_size, bool is_fraction,
             std::vector<Vector>& result) {
    for (std::size_t i = 0; i < result.size(); ++i) {
        check_cancelled(i);
        const char* at = elements.data() + i * element_size;
        for (int k = 0; k < Vector::length(); ++k) {
            result[i][k] = converted(
                component_at<Component>(at + sizeof(Component) * static_cast<std::size_t>(k)),
                is_fraction);
        }
    }
}

/// Bytes as the values that they are.
template <typename Value>
std::vector<Value> copied(std::string_view bytes) {
    const std::size_t count = bytes.size() / sizeof(Value);
    std::vector<Value> values;
    reserve_to_fill(values, count);
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(Value) == 0) {
        // Without zeros beforehand, which would cost as much as the copy.
        const auto* const begin = reinterpret_cast<const Value*>(bytes.data());
        values.assign(begin, begin + count);
    } else {
        values.resize(count);
        std::memcpy(values.data(), bytes.data(), count * sizeof(Value));
    }
    return values;
}

}  // namespace

std::size_t component_size(int component_type) {
    switch (component_type) {
        case gltf_code::int8:
        case gltf_code::uint8:
            return 1;
        case gltf_code::int16:
        case gltf_code::uint16:
            return 2;
        case gltf_code::uint32:
        case gltf_code::float32:
            return 4;
        default:
            return 0;
    }
}

std::size_t component_count(std::string_view type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4" || type == "MAT2") return 4;
    if (type == "MAT3") return 9;
    if (type == "MAT4") return 16;
    return 0;
}

ElementLayout element_layout(const Json& accessor) {
    const auto& type = accessor["type"].get_ref<const std::string&>();
    ElementLayout layout;
    layout.component_type = accessor["componentType"].get<int>();
    layout.components = component_count(type);
    const std::size_t bytes = component_size(layout.component_type);
    layout.size = layout.components * bytes;
    if (type.starts_with("MAT")) {
        // Every column begins at a multiple of four bytes.
        const std::size_t columns = type == "MAT2" ? 2 : type == "MAT3" ? 3 : 4;
        layout.size = columns * ((columns * bytes + 3) / 4 * 4);
    }
    return layout;
}

ElementLayout index_layout(const GltfContents& contents, std::size_t accessor) {
    const ElementLayout layout = element_layout(contents.root["accessors"][accessor]);
    if (layout.components != 1 ||
        (layout.component_type != gltf_code::uint8 && layout.component_type != gltf_code::uint16 &&
         layout.component_type != gltf_code::uint32)) {
        throw InvalidInput(
            fmt::format("accessors[{}] holds no indices, which are unsigned scalars", accessor));
    }
    return layout;
}

PackedElements packed_elements(const GltfContents& contents, std::size_t accessor) {
    const Json& json = contents.root["accessors"][accessor];
    const std::size_t size = element_layout(json).size;
    const std::size_t count = size_in(json, "count");
    PackedElements elements;
    std::string_view bytes;
    std::size_t stride = size;
    if (json.contains("bufferView") && count > 0) {
        bytes = view_bytes(contents, json);
        const Json& view = contents.root["bufferViews"][size_in(json, "bufferView")];
        stride = size_in(view, "byteStride", size);
        if (stride == size && !json.contains("sparse")) {
            elements.in_buffer = bytes.substr(0, count * size);
            return elements;
        }
    }
    elements.copy.resize(count * size);
    for (std::size_t i = 0; !bytes.empty() && i < count; ++i) {
        check_cancelled(i);
        std::memcpy(elements.copy.data() + i * size, bytes.data() + i * stride, size);
    }
    apply_sparse(contents, json, accessor, elements.copy);
    return elements;
}

std::string raw_elements(const GltfContents& contents, std::size_t accessor) {
    return std::string(packed_elements(contents, accessor).bytes());
}

template <typename Vector>
std::vector<Vector> float_elements(const GltfContents& contents, std::size_t accessor) {
    const Json& json = contents.root["accessors"][accessor];
    const ElementLayout layout = element_layout(json);
    if (layout.components != static_cast<std::size_t>(Vector::length()) ||
        text_in(json, "type").starts_with("MAT")) {
        throw InvalidInput(fmt::format("accessors[{}] is of type {}, but VEC{} is needed", accessor,
                                       text_in(json, "type"), Vector::length()));
    }
    const PackedElements packed = packed_elements(contents, accessor);
    const std::string_view elements = packed.bytes();
    if (layout.component_type == gltf_code::float32) return copied<Vector>(elements);
    std::vector<Vector> result(size_in(json, "count"));
    const bool is_fraction = bool_in(json, "normalized");
    switch (layout.component_type) {
        case gltf_code::int8:
            convert<std::int8_t>(elements, layout.size, is_fraction, result);
            break;
        case gltf_code::uint8:
            convert<std::uint8_t>(elements, layout.size, is_fraction, result);
            break;
        case gltf_code::int16:
            convert<std::int16_t>(elements, layout.size, is_fraction, result);
            break;
        case gltf_code::uint16:
            convert<std::uint16_t>(elements, layout.size, is_fraction, result);
            break;
        default:
            convert<std::uint32_t>(elements, layout.size, is_fraction, result);
            break;
    }
    return result;
}

template std::vector<glm::vec1> float_elements(const GltfContents&, std::size_t);
template std::vector<glm::vec2> float_elements(const GltfContents&, std::size_t);
template std::vector<glm::vec3> float_elements(const GltfContents&, std::size_t);
template std::vector<glm::vec4> float_elements(const GltfContents&, std::size_t);

std::vector<std::uint32_t> index_elements(const GltfContents& contents, std::size_t accessor) {
    const ElementLayout layout = index_layout(contents, accessor);
    const PackedElements packed = packed_elements(contents, accessor);
    const std::string_view elements = packed.bytes();
    std::vector<std::uint32_t> result(elements.size() / layout.size);
    for (std::size_t i = 0; i < result.size(); ++i) {
        check_cancelled(i);
        result[i] = index_at(elements.data() + i * layout.size, layout.component_type);
    }
    return result;
}

std::vector<glm::uvec3> index_triples(const GltfContents& contents, std::size_t accessor) {
    const ElementLayout layout = index_layout(contents, accessor);
    const PackedElements packed = packed_elements(contents, accessor);
    const std::string_view elements = packed.bytes();
    const std::size_t count = elements.size() / layout.size;
    if (count % 3 != 0) {
        throw InvalidInput(fmt::format("{} indices make no whole triangles", count));
    }
    if (layout.component_type == gltf_code::uint32) return copied<glm::uvec3>(elements);
    std::vector<glm::uvec3> result(count / 3);
    for (std::size_t i = 0; i < count; ++i) {
        check_cancelled(i);
        result[i / 3][static_cast<int>(i % 3)] =
            index_at(elements.data() + i * layout.size, layout.component_type);
    }
    return result;
}

}  // namespace relief

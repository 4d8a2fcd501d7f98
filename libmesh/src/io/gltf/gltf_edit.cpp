// SPDX-License-Identifier: Apache-2.0
// Additions to a glTF document, removal of extensions, and replacement of a primitive's mesh.
//
// Added data goes into one buffer, each view at a multiple of four bytes; the writer joins it with
// the other buffers. Replaced accessors are retired, and the writer leaves them out unless others
// use them.
#include "io/gltf/gltf_contents.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "io/gltf/gltf_accessor.h"
#include "large_memory.h"
#include "parallel.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Returns the buffer of added data.
GltfBuffer& added_buffer(GltfContents& contents) {
    if (contents.added_buffer == static_cast<std::size_t>(-1)) {
        contents.added_buffer = contents.buffers.size();
        contents.buffers.emplace_back();
        contents.root["buffers"].push_back(Json::object());
    }
    return contents.buffers[contents.added_buffer];
}

template <typename Component>
void widen_bounds(std::string_view elements, std::size_t element_size, std::size_t component,
                  double& least, double& most) {
    for (std::size_t at = component * sizeof(Component); at < elements.size(); at += element_size) {
        Component value;
        std::memcpy(&value, elements.data() + at, sizeof(value));
        least = std::min(least, static_cast<double>(value));
        most = std::max(most, static_cast<double>(value));
    }
}

/// Widens bounds by `count` elements, several pieces at a time. Of equal values, the first counts.
template <typename Number, typename Widen>
void widen_in_pieces(std::size_t count, Number& least, Number& most, const Widen& widen) {
    constexpr std::size_t grain = 65536;
    struct Piece {
        Number least;
        Number most;
    };
    std::vector<Piece> pieces((count + grain - 1) / grain, {least, most});
    parallel_for(pieces.size(), 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            widen(i * grain, std::min(count, (i + 1) * grain), pieces[i].least, pieces[i].most);
    });
    for (const Piece& piece : pieces) {
        least = std::min(least, piece.least);
        most = std::max(most, piece.most);
    }
}

}  // namespace

void detail::reserve_bytes(GltfContents& contents, std::size_t count) {
    GltfBuffer& buffer = added_buffer(contents);
    const std::size_t size = buffer.storage.size();
    buffer.storage.reserve(size + count);
    expect_filling(buffer.storage.data() + size, count);
}

std::size_t detail::append_bytes(GltfContents& contents, std::string_view bytes) {
    GltfBuffer& buffer = added_buffer(contents);
    buffer.storage.resize((buffer.storage.size() + 3) / 4 * 4, '\0');
    const std::size_t offset = buffer.storage.size();
    buffer.storage += bytes;
    buffer.size = buffer.storage.size();
    contents.root["buffers"][contents.added_buffer]["byteLength"] = buffer.size;
    return offset;
}

std::size_t detail::add_borrowed_view(GltfContents& contents, std::string_view bytes) {
    const std::size_t index = contents.buffers.size();
    GltfBuffer& buffer = contents.buffers.emplace_back();
    buffer.borrowed = bytes;
    buffer.size = bytes.size();
    contents.root["buffers"].push_back({{"byteLength", bytes.size()}});
    Json& views = contents.root["bufferViews"];
    views.push_back({{"buffer", index}, {"byteOffset", 0}, {"byteLength", bytes.size()}});
    return views.size() - 1;
}

std::size_t detail::add_view(GltfContents& contents, std::string_view bytes) {
    const std::size_t offset = append_bytes(contents, bytes);
    Json& views = contents.root["bufferViews"];
    views.push_back(
        {{"buffer", contents.added_buffer}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
    return views.size() - 1;
}

std::size_t detail::add_elements(GltfContents& contents, std::size_t size,
                                 const std::string& elements, int target) {
    const std::size_t count = elements.size() / size;
    // Vertex attributes must begin at multiples of four bytes.
    const std::size_t stride = target == gltf_code::array_buffer ? (size + 3) / 4 * 4 : size;
    std::size_t view = 0;
    if (stride == size) {
        view = add_view(contents, elements);
    } else {
        std::string padded(count * stride, '\0');
        for (std::size_t i = 0; i < count; ++i) {
            std::memcpy(padded.data() + i * stride, elements.data() + i * size, size);
        }
        view = add_view(contents, padded);
        contents.root["bufferViews"][view]["byteStride"] = stride;
    }
    contents.root["bufferViews"][view]["target"] = target;
    return view;
}

std::size_t detail::add_accessor(GltfContents& contents, Json accessor, const std::string& elements,
                                 int target) {
    const std::size_t size = element_layout(accessor).size;
    accessor["bufferView"] = add_elements(contents, size, elements, target);
    accessor["count"] = elements.size() / size;
    accessor.erase("byteOffset");
    accessor.erase("sparse");
    Json& accessors = contents.root["accessors"];
    accessors.push_back(std::move(accessor));
    return accessors.size() - 1;
}

std::size_t detail::add_shared_accessor(GltfContents& contents, Json accessor,
                                        const std::string& elements, int target) {
    for (const char* key : {"bufferView", "byteOffset", "sparse"})
        accessor.erase(key);
    accessor["count"] = elements.size() / element_layout(accessor).size;
    const std::size_t hash = std::hash<std::string>()(elements);
    const auto [begin, end] = contents.shared_accessors.equal_range(hash);
    for (auto it = begin; it != end; ++it) {
        Json other = contents.root["accessors"][it->second];
        const Json& view = contents.root["bufferViews"][size_in(other, "bufferView")];
        const bool is_same_kind = size_in(view, "target") == static_cast<std::size_t>(target);
        other.erase("bufferView");
        if (is_same_kind && other == accessor && raw_elements(contents, it->second) == elements)
            return it->second;
    }
    const std::size_t number = add_accessor(contents, std::move(accessor), elements, target);
    contents.shared_accessors.emplace(hash, number);
    return number;
}

void detail::update_bounds(Json& accessor, std::string_view elements) {
    const ElementLayout layout = element_layout(accessor);
    Json least = Json::array();
    Json most = Json::array();
    for (std::size_t k = 0; k < layout.components; ++k) {
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        const auto widen = [&]<typename Component>(Component) {
            widen_in_pieces(
                elements.size() / layout.size, low, high,
                [&](std::size_t begin, std::size_t end, double& least_of_piece,
                    double& most_of_piece) {
                    widen_bounds<Component>(
                        elements.substr(begin * layout.size, (end - begin) * layout.size),
                        layout.size, k, least_of_piece, most_of_piece);
                });
        };
        switch (layout.component_type) {
            case gltf_code::int8:
                widen(std::int8_t{});
                break;
            case gltf_code::uint8:
                widen(std::uint8_t{});
                break;
            case gltf_code::int16:
                widen(std::int16_t{});
                break;
            case gltf_code::uint16:
                widen(std::uint16_t{});
                break;
            case gltf_code::uint32:
                widen(std::uint32_t{});
                break;
            default:
                widen(float{});
        }
        if (!(std::abs(low) <= std::numeric_limits<float>::max()) ||
            !(std::abs(high) <= std::numeric_limits<float>::max())) {
            return;  // JSON cannot hold these bounds.
        }
        const bool is_float = layout.component_type == gltf_code::float32;
        least.push_back(is_float ? Json(low) : Json(static_cast<std::int64_t>(low)));
        most.push_back(is_float ? Json(high) : Json(static_cast<std::int64_t>(high)));
    }
    if (accessor.contains("min")) accessor["min"] = least;
    if (accessor.contains("max")) accessor["max"] = most;
}

void detail::set_bounds(Json& accessor, std::span<const glm::vec3> positions) {
    Json least = Json::array();
    Json most = Json::array();
    for (int k = 0; k < 3; ++k) {
        float low = std::numeric_limits<float>::infinity();
        float high = -low;
        widen_in_pieces(
            positions.size(), low, high,
            [&](std::size_t begin, std::size_t end, float& lowest, float& highest) {
                for (const glm::vec3& position : positions.subspan(begin, end - begin)) {
                    if (!std::isfinite(position[k])) continue;
                    lowest = std::min(lowest, position[k]);
                    highest = std::max(highest, position[k]);
                }
            });
        least.push_back(low <= high ? low : 0.0F);
        most.push_back(low <= high ? high : 0.0F);
    }
    accessor["min"] = std::move(least);
    accessor["max"] = std::move(most);
}

void detail::erase_extension(Json& holder, const char* extension) {
    if (find(holder, "extensions", extension) == nullptr) return;
    holder["extensions"].erase(extension);
    if (holder["extensions"].empty()) holder.erase("extensions");
}

void detail::remove_unused_extension(Json& root, std::string_view extension) {
    if (has_extension(root, extension)) return;
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        if (!root.contains(list)) continue;
        Json& names = root[list];
        for (std::size_t i = names.size(); i-- > 0;) {
            if (names[i] == extension) names.erase(i);
        }
        if (names.empty()) root.erase(list);
    }
}

namespace {

constexpr std::array carried_attributes = {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0",
                                           "COLOR_0"};

/// Names what the primitive has but a mesh cannot hold; "" if nothing.
std::string unsupported_content(const Json& primitive) {
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

Json attributes_of(GltfContents& contents, const Mesh& mesh) {
    Json attributes = Json::object();
    const auto add = [&](const char* name, const auto& values, const char* type) {
        if (values.empty()) return;
        attributes[name] =
            add_values(contents, values, type, gltf_code::float32, gltf_code::array_buffer);
    };
    add("POSITION", mesh.positions, "VEC3");
    set_bounds(contents.root["accessors"].back(), mesh.positions);
    add("NORMAL", mesh.normals, "VEC3");
    if (!mesh.normals.empty()) add("TANGENT", mesh.tangents, "VEC4");
    add("TEXCOORD_0", mesh.texcoords, "VEC2");
    add("COLOR_0", mesh.colors, "VEC4");
    return attributes;
}

}  // namespace

void GltfDocument::set_geometry(GltfPrimitiveId id, const Mesh& mesh) {
    GltfContents& contents = contents_->data;
    const Json before = primitive_json(contents, id);
    const std::string more = unsupported_content(before);
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
    primitive.erase("mode");  // Triangles are the default mode.
}

}  // namespace relief

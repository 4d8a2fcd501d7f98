// SPDX-License-Identifier: Apache-2.0
// Accessors and primitives of a glTF document as plain arrays: object space, v downwards as in
// glTF.
//
// Ranges were checked when the document was read (gltf_contents.h). Errors that only the data shows
// (sparse indices, vertex indices out of range, attributes of different lengths) throw
// InvalidInput. Source: glTF 2.0 (ISO/IEC 12113), sections 3.6.2, 3.7.2 and 3.11 (fractions: c /
// max, at least -1).
#include "io/gltf/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "geometry/check_triangles.h"
#include "large_memory.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Returns the bytes of a view, starting at the holder's offset.
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

/// Writes the values of a sparse accessor over the packed elements.
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

/// Signed fractions are clamped to [-1, 1]: the most negative code equals the next one.
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

/// Copies bytes into values of a type.
template <typename Value>
std::vector<Value> copied(std::string_view bytes) {
    const std::size_t count = bytes.size() / sizeof(Value);
    std::vector<Value> values;
    reserve_to_fill(values, count);
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(Value) == 0) {
        // assign() writes no zeros first, which would cost as much as the copy.
        const auto* const begin = reinterpret_cast<const Value*>(bytes.data());
        values.assign(begin, begin + count);
    } else {
        values.resize(count);
        std::memcpy(values.data(), bytes.data(), count * sizeof(Value));
    }
    return values;
}

}  // namespace

std::size_t detail::component_size(int component_type) {
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

std::size_t detail::component_count(std::string_view type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4" || type == "MAT2") return 4;
    if (type == "MAT3") return 9;
    if (type == "MAT4") return 16;
    return 0;
}

ElementLayout detail::element_layout(const Json& accessor) {
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

ElementLayout detail::index_layout(const GltfContents& contents, std::size_t accessor) {
    const ElementLayout layout = element_layout(contents.root["accessors"][accessor]);
    if (layout.components != 1 ||
        (layout.component_type != gltf_code::uint8 && layout.component_type != gltf_code::uint16 &&
         layout.component_type != gltf_code::uint32)) {
        throw InvalidInput(fmt::format(
            "accessors[{}] is used for indices, but does not have unsigned scalars", accessor));
    }
    return layout;
}

PackedElements detail::packed_elements(const GltfContents& contents, std::size_t accessor) {
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
    require_memory(count, size);
    elements.copy.resize(count * size);
    for (std::size_t i = 0; !bytes.empty() && i < count; ++i) {
        check_cancelled(i);
        std::memcpy(elements.copy.data() + i * size, bytes.data() + i * stride, size);
    }
    apply_sparse(contents, json, accessor, elements.copy);
    return elements;
}

std::string detail::raw_elements(const GltfContents& contents, std::size_t accessor) {
    return std::string(packed_elements(contents, accessor).bytes());
}

namespace {

/// Converts packed elements. \throws InvalidInput if the accessor has another number of components
template <typename Vector>
std::vector<Vector> floats_of(const Json& json, std::size_t accessor, std::string_view elements) {
    const ElementLayout layout = element_layout(json);
    if (layout.components != static_cast<std::size_t>(Vector::length()) ||
        text_in(json, "type").starts_with("MAT")) {
        throw InvalidInput(fmt::format("accessors[{}] is of type {}, but VEC{} is needed", accessor,
                                       text_in(json, "type"), Vector::length()));
    }
    if (layout.component_type == gltf_code::float32) return copied<Vector>(elements);
    std::vector<Vector> result(elements.size() / layout.size);
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

/// Returns some elements, tightly packed. Reads no others, unless the accessor is sparse.
std::string chosen_elements(const GltfContents& contents, const Json& json, std::size_t accessor,
                            std::span<const std::uint32_t> chosen) {
    const std::size_t size = element_layout(json).size;
    std::string result(chosen.size() * size, '\0');
    PackedElements packed;
    std::string_view bytes;
    std::size_t stride = size;
    if (json.contains("bufferView") && !json.contains("sparse")) {
        bytes = view_bytes(contents, json);
        const Json& view = contents.root["bufferViews"][size_in(json, "bufferView")];
        stride = size_in(view, "byteStride", size);
    } else {
        packed = packed_elements(contents, accessor);
        bytes = packed.bytes();
    }
    for (std::size_t i = 0; i < chosen.size(); ++i)
        std::memcpy(result.data() + i * size, bytes.data() + chosen[i] * stride, size);
    return result;
}

}  // namespace

template <typename Vector>
std::vector<Vector> detail::float_elements(const GltfContents& contents, std::size_t accessor) {
    const Json& json = contents.root["accessors"][accessor];
    return floats_of<Vector>(json, accessor, packed_elements(contents, accessor).bytes());
}

template <typename Vector>
std::vector<Vector> detail::float_elements(const GltfContents& contents, std::size_t accessor,
                                           std::span<const std::uint32_t> chosen) {
    const Json& json = contents.root["accessors"][accessor];
    return floats_of<Vector>(json, accessor, chosen_elements(contents, json, accessor, chosen));
}

template std::vector<glm::vec1> detail::float_elements(const GltfContents&, std::size_t);
template std::vector<glm::vec2> detail::float_elements(const GltfContents&, std::size_t);
template std::vector<glm::vec3> detail::float_elements(const GltfContents&, std::size_t);
template std::vector<glm::vec4> detail::float_elements(const GltfContents&, std::size_t);
template std::vector<glm::vec2> detail::float_elements(const GltfContents&, std::size_t,
                                                       std::span<const std::uint32_t>);
template std::vector<glm::vec3> detail::float_elements(const GltfContents&, std::size_t,
                                                       std::span<const std::uint32_t>);
template std::vector<glm::vec4> detail::float_elements(const GltfContents&, std::size_t,
                                                       std::span<const std::uint32_t>);

std::vector<std::uint32_t> detail::index_elements(const GltfContents& contents,
                                                  std::size_t accessor) {
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

std::vector<glm::uvec3> detail::index_triples(const GltfContents& contents, std::size_t accessor) {
    const ElementLayout layout = index_layout(contents, accessor);
    const PackedElements packed = packed_elements(contents, accessor);
    const std::string_view elements = packed.bytes();
    const std::size_t count = elements.size() / layout.size;
    if (count % 3 != 0) {
        throw InvalidInput(fmt::format("{} indices are not a multiple of 3", count));
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

namespace {

/// Splits strips and fans into triangles. Every second triangle of a strip is reversed.
std::vector<glm::uvec3> unrolled(const std::vector<std::uint32_t>& indices, std::size_t mode) {
    std::vector<glm::uvec3> triangles;
    for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
        if (mode == gltf_code::triangle_fan) {
            triangles.emplace_back(indices[i + 1], indices[i + 2], indices[0]);
        } else {
            triangles.emplace_back(indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]);
        }
    }
    return triangles;
}

/// The triangles of a primitive's indices.
std::vector<glm::uvec3> indexed_triangles(const GltfContents& contents, std::size_t accessor,
                                          std::size_t mode, std::size_t vertex_count) {
    const auto refuse = [&](std::size_t index, std::uint32_t vertex) {
        throw InvalidInput(fmt::format("index {} names vertex {}, but there are only {}", index,
                                       vertex, vertex_count));
    };
    if (mode == gltf_code::triangle_strip || mode == gltf_code::triangle_fan) {
        const std::vector<std::uint32_t> indices = index_elements(contents, accessor);
        for (std::size_t i = 0; i < indices.size(); ++i) {
            if (indices[i] >= vertex_count) refuse(i, indices[i]);
        }
        return unrolled(indices, mode);
    }
    std::vector<glm::uvec3> triangles = index_triples(contents, accessor);
    if (const auto corner = corner_beyond(triangles, vertex_count)) {
        refuse(*corner, triangles[*corner / 3][static_cast<int>(*corner % 3)]);
    }
    return triangles;
}

/// Returns the triangles of a primitive without indices.
std::vector<glm::uvec3> plain_triangles(std::size_t vertex_count, std::size_t mode) {
    if (vertex_count > std::numeric_limits<std::uint32_t>::max()) {
        throw InvalidInput(fmt::format("{} vertices are too many", vertex_count));
    }
    const auto count = static_cast<std::uint32_t>(vertex_count);
    if (mode == gltf_code::triangle_strip || mode == gltf_code::triangle_fan) {
        std::vector<std::uint32_t> indices(count);
        std::iota(indices.begin(), indices.end(), 0U);
        return unrolled(indices, mode);
    }
    if (count % 3 != 0) {
        throw InvalidInput(fmt::format("{} indices are not a multiple of 3", count));
    }
    std::vector<glm::uvec3> triangles;
    triangles.reserve(count / 3);
    for (std::uint32_t i = 0; i < count; i += 3)
        triangles.emplace_back(i, i + 1, i + 2);
    return triangles;
}

/// Returns whether triangles use so few of the vertices that sorting their corners is cheaper than
/// arrays of all vertices.
bool use_few(const std::vector<glm::uvec3>& triangles, std::size_t vertex_count) {
    return triangles.size() < vertex_count / 128;
}

/// The vertices that the triangles use; nullopt if they use all.
std::optional<std::vector<std::uint32_t>> used_vertices(const std::vector<glm::uvec3>& triangles,
                                                        std::size_t vertex_count) {
    std::vector<std::uint32_t> used;
    if (use_few(triangles, vertex_count)) {
        for (const glm::uvec3& t : triangles)
            used.insert(used.end(), {t.x, t.y, t.z});
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
        return used;
    }
    std::vector<bool> is_used(vertex_count, false);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        check_cancelled(t);
        for (int k = 0; k < 3; ++k)
            is_used[triangles[t][k]] = true;
    }
    for (std::uint32_t i = 0; i < vertex_count; ++i) {
        if (is_used[i]) used.push_back(i);
    }
    if (used.size() == vertex_count) return std::nullopt;
    return used;
}

/// Returns an attribute as floats, for all vertices or the used ones; empty if it is absent.
template <typename Vector>
std::vector<Vector> attribute(const GltfContents& contents, const Json& primitive,
                              const std::string& name,
                              const std::optional<std::vector<std::uint32_t>>& used = {}) {
    const auto accessor = index_in(primitive["attributes"], name.c_str());
    if (!accessor) return {};
    return used ? float_elements<Vector>(contents, *accessor, *used)
                : float_elements<Vector>(contents, *accessor);
}

/// Returns the vertex colors; RGB gets alpha 1.
std::vector<glm::vec4> colors(const GltfContents& contents, const Json& primitive,
                              const std::optional<std::vector<std::uint32_t>>& used) {
    const auto accessor = index_in(primitive["attributes"], "COLOR_0");
    if (!accessor) return {};
    if (text_in(contents.root["accessors"][*accessor], "type") != "VEC3") {
        return attribute<glm::vec4>(contents, primitive, "COLOR_0", used);
    }
    std::vector<glm::vec4> result;
    for (const auto& rgb : attribute<glm::vec3>(contents, primitive, "COLOR_0", used)) {
        result.emplace_back(rgb, 1.0F);
    }
    return result;
}

template <typename Vector>
void keep_only(const std::vector<std::uint32_t>& used, std::vector<Vector>& values) {
    if (values.empty()) return;
    std::vector<Vector> kept;
    kept.reserve(used.size());
    for (const std::uint32_t vertex : used)
        kept.push_back(values[vertex]);
    values = std::move(kept);
}

/// Returns true if reading the primitive takes less time than starting a thread.
bool is_small(const GltfContents& contents, const Json& primitive) {
    constexpr std::size_t few_vertices = 1 << 16;
    const auto position = index_in(primitive["attributes"], "POSITION");
    return !position || size_in(contents.root["accessors"][*position], "count") < few_vertices;
}

/// Returns the same triangles, over the used vertices only.
std::vector<glm::uvec3> compacted(GltfTriangles all) {
    if (!all.used) return std::move(all.triangles);
    if (use_few(all.triangles, all.vertex_count)) {
        const std::vector<std::uint32_t>& used = *all.used;
        for (glm::uvec3& triangle : all.triangles) {
            for (int k = 0; k < 3; ++k) {
                const auto found = std::lower_bound(used.begin(), used.end(), triangle[k]);
                triangle[k] = static_cast<std::uint32_t>(found - used.begin());
            }
        }
        return std::move(all.triangles);
    }
    std::vector<std::uint32_t> place(all.vertex_count, 0);
    for (std::uint32_t i = 0; i < all.used->size(); ++i)
        place[(*all.used)[i]] = i;
    std::vector<glm::uvec3> result;
    for (const glm::uvec3& t : all.triangles)
        result.emplace_back(place[t.x], place[t.y], place[t.z]);
    return result;
}

}  // namespace

void detail::check_counts(const GltfContents& contents, const Json& primitive,
                          std::size_t vertex_count) {
    for (const auto& [name, accessor] : primitive["attributes"].items()) {
        const std::size_t count =
            size_in(contents.root["accessors"][accessor.get<std::size_t>()], "count");
        if (count != vertex_count) {
            throw InvalidInput(fmt::format("there are {} elements of {}, but {} of POSITION", count,
                                           name, vertex_count));
        }
    }
    for (const Json& target : array_in(primitive, "targets")) {
        for (const auto& [name, accessor] : target.items()) {
            const std::size_t count =
                size_in(contents.root["accessors"][accessor.get<std::size_t>()], "count");
            if (count != vertex_count) {
                throw InvalidInput(
                    fmt::format("a morph target has {} elements of {}, but there "
                                "are {} of POSITION",
                                count, name, vertex_count));
            }
        }
    }
}

const Json& detail::primitive_json(const GltfContents& contents, GltfPrimitiveId id) {
    const Json& meshes = array_in(contents.root, "meshes");
    if (id.mesh >= meshes.size() || id.primitive >= meshes[id.mesh]["primitives"].size()) {
        throw InvalidInput(
            fmt::format("there is no primitive {} of mesh {}", id.primitive, id.mesh));
    }
    return meshes[id.mesh]["primitives"][id.primitive];
}

std::string detail::describe_primitive(const GltfContents& contents, GltfPrimitiveId id) {
    const Json& meshes = array_in(contents.root, "meshes");
    const std::string name =
        id.mesh < meshes.size() ? text_in(meshes[id.mesh], "name") : std::string();
    return name.empty() ? fmt::format("mesh {} primitive {}", id.mesh, id.primitive)
                        : fmt::format("mesh '{}' primitive {}", name, id.primitive);
}

std::string GltfDocument::describe(GltfPrimitiveId id) const {
    return describe_primitive(contents_->data, id);
}

bool detail::shares_vertices(const GltfContents& contents, const Json& primitive) {
    const auto position = index_in(primitive["attributes"], "POSITION");
    return position && *position < contents.position_uses.size() &&
           contents.position_uses[*position] > 1;
}

GltfTriangles detail::read_triangles(const GltfContents& contents, GltfPrimitiveId id) {
    const Json& primitive = primitive_json(contents, id);
    const auto position = index_in(primitive["attributes"], "POSITION");
    if (!position) throw InvalidInput("it has no positions");
    GltfTriangles result;
    result.vertex_count = size_in(contents.root["accessors"][*position], "count");
    check_counts(contents, primitive, result.vertex_count);
    const std::size_t mode = size_in(primitive, "mode", 4);
    if (mode < 4) throw InvalidInput("it is made of points or lines");
    const auto indices = index_in(primitive, "indices");
    result.triangles = indices ? indexed_triangles(contents, *indices, mode, result.vertex_count)
                               : plain_triangles(result.vertex_count, mode);
    const bool is_shared = shares_vertices(contents, primitive);
    // Outlines refer to vertices by number, so the numbers must not change.
    const bool has_outline =
        find(primitive, "extensions", "CESIUM_primitive_outline", "indices") != nullptr;
    if (is_shared && !has_outline)
        result.used = used_vertices(result.triangles, result.vertex_count);
    return result;
}

Mesh GltfDocument::mesh(GltfPrimitiveId id, int texcoord_set) const {
    const GltfContents& contents = contents_->data;
    try {
        const Json& primitive = primitive_json(contents, id);
        Mesh mesh;
        mesh.name = text_in(contents.root["meshes"][id.mesh], "name");
        GltfTriangles triangles;
        const std::string texcoord = fmt::format("TEXCOORD_{}", texcoord_set);
        std::optional<std::vector<std::uint32_t>> used;
        const auto read = [&]<typename Vector>(std::vector<Vector>& values, std::string name) {
            return [&, name] { values = attribute<Vector>(contents, primitive, name, used); };
        };
        std::vector<std::function<void()>> tasks = {
            read(mesh.positions, "POSITION"), read(mesh.normals, "NORMAL"),
            read(mesh.tangents, "TANGENT"), read(mesh.texcoords, texcoord),
            [&] { mesh.colors = colors(contents, primitive, used); }};
        const auto read_indices = [&] { triangles = read_triangles(contents, id); };
        if (shares_vertices(contents, primitive)) {
            read_indices();
            used = triangles.used;
        } else {
            tasks.insert(tasks.begin(), read_indices);
        }
        parallel_tasks(tasks, is_small(contents, primitive));
        mesh.triangles = compacted(std::move(triangles));
        if (!mesh.triangles.empty()) {
            const auto material = index_in(primitive, "material");
            mesh.material_ranges.push_back(
                {0, static_cast<std::uint32_t>(mesh.triangles.size()),
                 material ? std::optional(static_cast<std::uint32_t>(*material)) : std::nullopt});
        }
        return mesh;
    } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("{}: {}", describe_primitive(contents, id), error.what()));
    }
}

namespace {

/// Returns the displacements of a morph target; empty if it has none.
std::vector<glm::vec3> displacements_in(const GltfContents& contents, const Json& target,
                                        const char* name) {
    const auto accessor = index_in(target, name);
    return accessor ? float_elements<glm::vec3>(contents, *accessor) : std::vector<glm::vec3>();
}

/// Returns JOINTS_n and WEIGHTS_n; empty if one of them is absent.
GltfJoints joints_in(const GltfContents& contents, const Json& primitive, int set) {
    GltfJoints result;
    const auto numbers = attribute<glm::vec4>(contents, primitive, fmt::format("JOINTS_{}", set));
    result.weights = attribute<glm::vec4>(contents, primitive, fmt::format("WEIGHTS_{}", set));
    if (numbers.size() != result.weights.size()) return {};
    for (const glm::vec4& joints : numbers) {
        glm::uvec4& indices = result.joints.emplace_back(0U);
        for (int k = 0; k < 4; ++k) {  // Floats, which glTF forbids, may be anything.
            if (joints[k] > 0.0F && joints[k] <= 65535.0F)
                indices[k] = static_cast<std::uint32_t>(joints[k]);
        }
    }
    return result;
}

}  // namespace

GltfDeformation GltfDocument::deformation(GltfPrimitiveId id) const {
    const GltfContents& contents = contents_->data;
    try {
        const Json& primitive = primitive_json(contents, id);
        GltfDeformation result;
        for (const Json& target : array_in(primitive, "targets")) {
            result.targets.push_back({displacements_in(contents, target, "POSITION"),
                                      displacements_in(contents, target, "NORMAL"),
                                      displacements_in(contents, target, "TANGENT")});
        }
        for (int set = 0; primitive["attributes"].contains(fmt::format("JOINTS_{}", set)); ++set) {
            GltfJoints joints = joints_in(contents, primitive, set);
            if (!joints.joints.empty()) result.joints.push_back(std::move(joints));
        }
        const GltfTriangles triangles = read_triangles(contents, id);
        if (!triangles.used) return result;
        for (GltfMorphTarget& target : result.targets) {
            keep_only(*triangles.used, target.positions);
            keep_only(*triangles.used, target.normals);
            keep_only(*triangles.used, target.tangents);
        }
        for (GltfJoints& joints : result.joints) {
            keep_only(*triangles.used, joints.joints);
            keep_only(*triangles.used, joints.weights);
        }
        return result;
    } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("{}: {}", describe_primitive(contents, id), error.what()));
    }
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// A glTF primitive as plain arrays: strips and fans unrolled, attributes made float.
//
// Object space, v downwards as glTF has it. Indices out of range, a rest that makes no triangle and
// attributes of different lengths throw InvalidInput. Source: glTF 2.0 (ISO/IEC 12113), section
// 3.7.2. Tests: tests/mesh/io/gltf/gltf_document_test.cpp.
#include "io/gltf/gltf_primitive.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "geometry/check_triangles.h"
#include "io/gltf/gltf_accessor.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr std::size_t triangle_strip = 5;
constexpr std::size_t triangle_fan = 6;

/// Strips and fans taken apart. Every second triangle of a strip is turned.
std::vector<glm::uvec3> unrolled(const std::vector<std::uint32_t>& indices, std::size_t mode) {
    std::vector<glm::uvec3> triangles;
    for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
        if (mode == triangle_fan) {
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
    if (mode == triangle_strip || mode == triangle_fan) {
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

/// The triangles of vertices in their order.
std::vector<glm::uvec3> plain_triangles(std::size_t vertex_count, std::size_t mode) {
    if (vertex_count > std::numeric_limits<std::uint32_t>::max()) {
        throw InvalidInput(fmt::format("{} vertices are too many", vertex_count));
    }
    const auto count = static_cast<std::uint32_t>(vertex_count);
    if (mode == triangle_strip || mode == triangle_fan) {
        std::vector<std::uint32_t> indices(count);
        std::iota(indices.begin(), indices.end(), 0U);
        return unrolled(indices, mode);
    }
    if (count % 3 != 0) {
        throw InvalidInput(fmt::format("{} indices make no whole triangles", count));
    }
    std::vector<glm::uvec3> triangles;
    triangles.reserve(count / 3);
    for (std::uint32_t i = 0; i < count; i += 3)
        triangles.emplace_back(i, i + 1, i + 2);
    return triangles;
}

void check_counts(const GltfContents& contents, const Json& primitive, std::size_t vertex_count) {
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

/// The vertices that the triangles use, or nothing if they use all.
std::optional<std::vector<std::uint32_t>> used_vertices(const std::vector<glm::uvec3>& triangles,
                                                        std::size_t vertex_count) {
    std::vector<bool> is_used(vertex_count, false);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        check_cancelled(t);
        for (int k = 0; k < 3; ++k)
            is_used[triangles[t][k]] = true;
    }
    std::vector<std::uint32_t> used;
    for (std::uint32_t i = 0; i < vertex_count; ++i) {
        if (is_used[i]) used.push_back(i);
    }
    if (used.size() == vertex_count) return std::nullopt;
    return used;
}

/// An attribute as floats; empty where it is absent.
template <typename Vector>
std::vector<Vector> attribute(const GltfContents& contents, const Json& primitive,
                              const std::string& name) {
    const auto accessor = index_in(primitive["attributes"], name.c_str());
    return accessor ? float_elements<Vector>(contents, *accessor) : std::vector<Vector>();
}

/// Colours with or without alpha.
std::vector<glm::vec4> colors(const GltfContents& contents, const Json& primitive) {
    const auto accessor = index_in(primitive["attributes"], "COLOR_0");
    if (!accessor) return {};
    if (text_in(contents.root["accessors"][*accessor], "type") != "VEC3") {
        return attribute<glm::vec4>(contents, primitive, "COLOR_0");
    }
    std::vector<glm::vec4> result;
    for (const auto& rgb : attribute<glm::vec3>(contents, primitive, "COLOR_0")) {
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

/// Whether reading it takes no longer than starting a thread.
bool is_small(const GltfContents& contents, const Json& primitive) {
    constexpr std::size_t few_vertices = 1 << 16;
    const auto position = index_in(primitive["attributes"], "POSITION");
    return !position || size_in(contents.root["accessors"][*position], "count") < few_vertices;
}

/// The same triangles, over the used vertices alone.
std::vector<glm::uvec3> compacted(GltfTriangles all) {
    if (!all.used) return std::move(all.triangles);
    std::vector<std::uint32_t> place(all.vertex_count, 0);
    for (std::uint32_t i = 0; i < all.used->size(); ++i)
        place[(*all.used)[i]] = i;
    std::vector<glm::uvec3> result;
    for (const glm::uvec3& t : all.triangles)
        result.emplace_back(place[t.x], place[t.y], place[t.z]);
    return result;
}

}  // namespace

const Json& primitive_json(const GltfContents& contents, GltfPrimitiveId id) {
    const Json& meshes = array_in(contents.root, "meshes");
    if (id.mesh >= meshes.size() || id.primitive >= meshes[id.mesh]["primitives"].size()) {
        throw InvalidInput(
            fmt::format("there is no primitive {} of mesh {}", id.primitive, id.mesh));
    }
    return meshes[id.mesh]["primitives"][id.primitive];
}

std::string describe_primitive(const GltfContents& contents, GltfPrimitiveId id) {
    const Json& meshes = array_in(contents.root, "meshes");
    const std::string name =
        id.mesh < meshes.size() ? text_in(meshes[id.mesh], "name") : std::string();
    return name.empty() ? fmt::format("mesh {} primitive {}", id.mesh, id.primitive)
                        : fmt::format("mesh '{}' primitive {}", name, id.primitive);
}

bool shares_vertices(const GltfContents& contents, const Json& primitive) {
    const auto position = index_in(primitive["attributes"], "POSITION");
    return position && *position < contents.position_uses.size() &&
           contents.position_uses[*position] > 1;
}

GltfTriangles read_triangles(const GltfContents& contents, GltfPrimitiveId id) {
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
    // Outlines name vertices by number, so those must stay.
    const bool has_outline =
        find(primitive, "extensions", "CESIUM_primitive_outline", "indices") != nullptr;
    if (is_shared && !has_outline)
        result.used = used_vertices(result.triangles, result.vertex_count);
    return result;
}

Mesh read_primitive(const GltfContents& contents, GltfPrimitiveId id, int texcoord_set) {
    try {
        const Json& primitive = primitive_json(contents, id);
        Mesh mesh;
        mesh.name = text_in(contents.root["meshes"][id.mesh], "name");
        GltfTriangles triangles;
        const std::string texcoord = fmt::format("TEXCOORD_{}", texcoord_set);
        const auto read = [&]<typename Vector>(std::vector<Vector>& values, std::string name) {
            return [&, name] { values = attribute<Vector>(contents, primitive, name); };
        };
        parallel_tasks(
            {[&] { triangles = read_triangles(contents, id); }, read(mesh.positions, "POSITION"),
             read(mesh.normals, "NORMAL"), read(mesh.tangents, "TANGENT"),
             read(mesh.texcoords, texcoord), [&] { mesh.colors = colors(contents, primitive); }},
            is_small(contents, primitive));
        if (triangles.used) {
            keep_only(*triangles.used, mesh.positions);
            keep_only(*triangles.used, mesh.normals);
            keep_only(*triangles.used, mesh.tangents);
            keep_only(*triangles.used, mesh.texcoords);
            keep_only(*triangles.used, mesh.colors);
        }
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

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Writes PLY in binary form, little-endian.
//
// Floats keep their bits, except v: it is flipped in float, because the format has no other
// convention, and 1 - (1 - v) can differ from v by 6e-8. PLY cannot hold materials. Source:
// [Turk 1994].
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "file_replacement.h"
#include "io/mesh/mesh_formats.h"

namespace relief::detail {
namespace {

bool are_bytes(const std::vector<glm::vec4>& colors) {
    const auto is_byte = [](float value) {
        return value >= 0.0F && value <= 1.0F &&
               static_cast<float>(std::round(static_cast<double>(value) * 255.0) / 255.0) == value;
    };
    return std::all_of(colors.begin(), colors.end(), [&](const glm::vec4& c) {
        return is_byte(c.r) && is_byte(c.g) && is_byte(c.b) && is_byte(c.a);
    });
}

std::string header_text(const Mesh& mesh, bool has_origin, bool has_byte_colors) {
    std::string text = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n",
                                   mesh.positions.size());
    const auto properties = [&](const char* type, std::initializer_list<const char*> names) {
        for (const char* name : names)
            text += fmt::format("property {} {}\n", type, name);
    };
    properties(has_origin ? "double" : "float", {"x", "y", "z"});
    if (!mesh.normals.empty()) properties("float", {"nx", "ny", "nz"});
    if (!mesh.texcoords.empty()) properties("float", {"s", "t"});
    if (!mesh.colors.empty()) {
        properties(has_byte_colors ? "uchar" : "float", {"red", "green", "blue", "alpha"});
    }
    const bool fits_int = mesh.positions.size() <= std::numeric_limits<std::int32_t>::max();
    return text +
           fmt::format("element face {}\nproperty list uchar {} vertex_indices\nend_header\n",
                       mesh.triangles.size(), fits_int ? "int" : "uint");
}

template <typename Value>
void append(std::string& bytes, const Value& value) {
    const std::size_t size = bytes.size();
    bytes.resize(size + sizeof(value));
    std::memcpy(bytes.data() + size, &value, sizeof(value));
}

}  // namespace

void write_ply(const std::filesystem::path& file, const MeshFile& contents) {
    static_assert(std::endian::native == std::endian::little);
    const Mesh& mesh = contents.mesh;
    const bool has_byte_colors = are_bytes(mesh.colors);
    const bool has_origin = contents.origin != glm::dvec3(0.0);
    std::string bytes = header_text(mesh, has_origin, has_byte_colors);
    bytes.reserve(bytes.size() + mesh.positions.size() * 48 + mesh.triangles.size() * 13);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        if (has_origin)
            append(bytes, contents.origin + glm::dvec3(mesh.positions[i]));
        else
            append(bytes, mesh.positions[i]);
        if (!mesh.normals.empty()) append(bytes, mesh.normals[i]);
        if (!mesh.texcoords.empty()) {
            append(bytes, glm::vec2(mesh.texcoords[i].x, 1.0F - mesh.texcoords[i].y));
        }
        if (mesh.colors.empty()) continue;
        if (has_byte_colors) {
            append(bytes, glm::u8vec4(glm::round(mesh.colors[i] * 255.0F)));
        } else {
            append(bytes, mesh.colors[i]);
        }
    }
    for (const glm::uvec3& triangle : mesh.triangles) {
        append(bytes, std::uint8_t{3});
        append(bytes, triangle);
    }
    replace_file(file, std::as_bytes(std::span(bytes)));
}

}  // namespace relief::detail

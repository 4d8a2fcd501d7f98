// SPDX-License-Identifier: Apache-2.0
// A mesh to OBJ and its materials to MTL.
//
// Floats are written with as many digits as it takes to read the same float back; v is turned up
// in double, so that read_obj turns it back exactly (but for |v| < 2e-9, where 1 - v has no room
// for it). Triangles without a material come first: OBJ cannot go back to none.
// Tests: tests/mesh/io/mesh/obj_test.cpp.
#include "io/mesh/obj_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "file_replacement.h"

namespace relief {
namespace {

/// Names that OBJ can tell apart: no blanks at the ends, no line breaks, none empty, none twice.
std::vector<std::string> material_names(const std::vector<MtlMaterial>& materials) {
    std::vector<std::string> names;
    std::set<std::string> taken;
    for (const MtlMaterial& material : materials) {
        std::string name = material.name.empty() ? "material" : material.name;
        std::replace_if(
            name.begin(), name.end(), [](char c) { return c >= 0 && c <= ' '; }, '_');
        const std::string base = name;
        for (int i = 2; !taken.insert(name).second; ++i)
            name = fmt::format("{}_{}", base, i);
        names.push_back(name);
    }
    return names;
}

std::string mtl_text(const MeshFile& contents, const std::vector<std::string>& names,
                     const std::filesystem::path& folder) {
    std::string text;
    auto out = std::back_inserter(text);
    const auto color = [&](const char* key, const glm::vec3& c) {
        fmt::format_to(out, "{} {} {} {}\n", key, c.r, c.g, c.b);
    };
    const auto map = [&](const std::string& key,
                         const std::optional<std::filesystem::path>& image) {
        if (!image) return;
        const auto beside = std::filesystem::absolute(*image).lexically_proximate(folder);
        fmt::format_to(out, "{} {}\n", key, beside.generic_string());
    };
    for (std::size_t i = 0; i < contents.materials.size(); ++i) {
        const MtlMaterial& material = contents.materials[i];
        fmt::format_to(out, "newmtl {}\n", names[i]);
        color("Ka", material.ambient);
        color("Kd", material.diffuse);
        color("Ks", material.specular);
        color("Ke", material.emission);
        fmt::format_to(out, "Ns {}\nd {}\nillum {}\n", material.shininess, material.opacity,
                       material.illumination_model);
        if (material.refractive_index != 1.0F)
            fmt::format_to(out, "Ni {}\n", material.refractive_index);
        map("map_Kd", material.diffuse_map);
        map("map_Ks", material.specular_map);
        map("map_Ke", material.emission_map);
        map("map_d", material.opacity_map);
        map("norm", material.normal_map);
        map(material.bump_strength == 1.0F ? "map_Bump"
                                           : fmt::format("map_Bump -bm {}", material.bump_strength),
            material.bump_map);
        text += '\n';
    }
    return text;
}

void add_vertices(const Mesh& mesh, const glm::dvec3& origin, std::string& text) {
    auto out = std::back_inserter(text);
    const bool has_alpha = std::any_of(mesh.colors.begin(), mesh.colors.end(),
                                       [](const glm::vec4& color) { return color.a != 1.0F; });
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3& p = mesh.positions[i];
        if (origin == glm::dvec3(0.0)) {
            fmt::format_to(out, "v {} {} {}", p.x, p.y, p.z);
        } else {
            const glm::dvec3 far = origin + glm::dvec3(p);
            fmt::format_to(out, "v {} {} {}", far.x, far.y, far.z);
        }
        if (!mesh.colors.empty()) {
            const glm::vec4& c = mesh.colors[i];
            fmt::format_to(out, " {} {} {}", c.r, c.g, c.b);
            if (has_alpha) fmt::format_to(out, " {}", c.a);
        }
        text += '\n';
    }
    for (const glm::vec2& t : mesh.texcoords) {
        fmt::format_to(out, "vt {} {}\n", t.x, 1.0 - static_cast<double>(t.y));
    }
    for (const glm::vec3& n : mesh.normals)
        fmt::format_to(out, "vn {} {} {}\n", n.x, n.y, n.z);
}

void add_faces(const Mesh& mesh, const MaterialRange& range, std::string& text) {
    auto out = std::back_inserter(text);
    const bool has_texcoords = !mesh.texcoords.empty();
    const bool has_normals = !mesh.normals.empty();
    for (std::uint32_t i = 0; i < range.triangle_count; ++i) {
        if (!mesh.smoothing_groups.empty()) {
            const std::uint32_t group = mesh.smoothing_groups[range.first_triangle + i];
            if (i == 0 || group != mesh.smoothing_groups[range.first_triangle + i - 1])
                fmt::format_to(out, "s {}\n", group);
        }
        text += 'f';
        const glm::uvec3& triangle = mesh.triangles[range.first_triangle + i];
        for (int k = 0; k < 3; ++k) {
            const std::uint64_t number = std::uint64_t{triangle[k]} + 1;
            if (has_texcoords && has_normals) {
                fmt::format_to(out, " {}/{}/{}", number, number, number);
            } else if (has_texcoords) {
                fmt::format_to(out, " {}/{}", number, number);
            } else if (has_normals) {
                fmt::format_to(out, " {}//{}", number, number);
            } else {
                fmt::format_to(out, " {}", number);
            }
        }
        text += '\n';
    }
}

std::vector<MaterialRange> ranges_without_material_first(const Mesh& mesh) {
    std::vector<MaterialRange> ranges = mesh.material_ranges;
    if (ranges.empty()) {
        ranges.push_back({0, static_cast<std::uint32_t>(mesh.triangles.size()), std::nullopt});
    }
    std::stable_partition(ranges.begin(), ranges.end(),
                          [](const MaterialRange& range) { return !range.material; });
    return ranges;
}

}  // namespace

void write_obj(const std::filesystem::path& file, const MeshFile& contents) {
    const Mesh& mesh = contents.mesh;
    const std::vector<std::string> names = material_names(contents.materials);
    std::string text;
    if (!names.empty()) {
        std::filesystem::path mtl_file = file;
        mtl_file.replace_extension(".mtl");
        const auto folder = std::filesystem::absolute(file).lexically_normal().parent_path();
        const std::string mtl = mtl_text(contents, names, folder);
        replace_file(mtl_file, std::as_bytes(std::span(mtl)));
        text += fmt::format("mtllib {}\n", mtl_file.filename().string());
    }
    if (!mesh.name.empty()) {
        std::string name = mesh.name;
        std::replace_if(
            name.begin(), name.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
        text += fmt::format("o {}\n", name);
    }
    add_vertices(mesh, contents.origin, text);
    for (const MaterialRange& range : ranges_without_material_first(mesh)) {
        if (range.material) text += fmt::format("usemtl {}\n", names[*range.material]);
        add_faces(mesh, range, text);
    }
    replace_file(file, std::as_bytes(std::span(text)));
}

}  // namespace relief

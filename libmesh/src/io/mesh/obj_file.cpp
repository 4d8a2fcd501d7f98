// SPDX-License-Identifier: Apache-2.0
// OBJ files with MTL materials: read_obj() and write_obj().
//
// Reading: object space as written. Corners are completed (a corner without attributes that others
// have gets a stated value, which the report counts), merged into vertices, cut into triangles and
// grouped by material. tinyobjloader parses MTL. Colors are linear as given; a material without an
// illum statement has model 2. Materials that no MTL file defines keep their name and get default
// values; the report counts them.
//
// Writing: floats have as many digits as a round trip needs. v is flipped in double, so that
// read_obj() restores it exactly (except if |v| < 2e-9, which 1 - v cannot represent). Triangles
// without a material come first, because OBJ has no statement for "no material".
#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "file_replacement.h"
#include "files.h"
#include "io/mesh/mesh_formats.h"
#include "io/mesh/obj_parser.h"
#include "io/mesh/polygon_mesh.h"
#include "progress_stage.h"
#include "relief/mesh/limits.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

/// Objects that have faces, in order of first use. Equal names are the same object.
struct ObjObjects {
    std::vector<std::string> names;
    std::vector<std::uint32_t> of_face;  ///< Empty if there is at most one name.
};

/// Objects by o, or by g in a file without o; "" for faces before the first one. No names if there
/// is neither.
ObjObjects objects_of(const ObjStatements& statements) {
    const std::vector<ObjRun>& runs =
        statements.objects.empty() ? statements.groups : statements.objects;
    ObjObjects objects;
    if (runs.empty()) return objects;
    std::map<std::string, std::uint32_t> numbers;
    /// The number of each run, and its end.
    std::vector<std::pair<std::uint32_t, std::size_t>> numbered;
    const auto add = [&](const std::string& name, std::size_t first, std::size_t end) {
        if (first == end) return;
        const auto next = static_cast<std::uint32_t>(objects.names.size());
        const auto [known, is_new] = numbers.emplace(name, next);
        if (is_new) objects.names.push_back(name);
        numbered.emplace_back(known->second, end);
    };
    add("", 0, runs.front().first_face);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const bool is_last = i + 1 == runs.size();
        add(runs[i].name, runs[i].first_face,
            is_last ? statements.faces.size() : runs[i + 1].first_face);
    }
    if (objects.names.size() < 2) return objects;
    objects.of_face.reserve(statements.faces.size());
    for (const auto& [number, end] : numbered)
        objects.of_face.resize(end, number);
    return objects;
}

/// Resolves a path below a folder. Some tools write backslashes.
std::filesystem::path resolved(const std::filesystem::path& folder, std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    return (folder / name).lexically_normal();
}

/// Returns true if an OBJ file in a folder may name a file: it lies in the folder or below, or the
/// limits of the process permit others. Symbolic links are followed wherever they lead.
bool is_permitted(const std::filesystem::path& folder, const std::filesystem::path& file) {
    if (input_limits().outside_files) return true;
    const auto whole = [](const std::filesystem::path& path) {
        return std::filesystem::absolute(path.empty() ? "." : path).lexically_normal();
    };
    const std::filesystem::path relative = whole(file).lexically_relative(whole(folder));
    return !relative.empty() && *relative.begin() != "..";
}

/// Lists the maps of a material that an OBJ file in a folder may not name.
void list_outside_maps(const std::filesystem::path& folder, MtlMaterial& material) {
    for (const auto* map : {&material.diffuse_map, &material.specular_map, &material.emission_map,
                            &material.opacity_map, &material.normal_map, &material.bump_map}) {
        if (*map && !is_permitted(folder, **map)) material.outside_maps.push_back(**map);
    }
}

/// Returns the files of one mtllib statement: the whole text if such a file exists, otherwise each
/// word.
std::vector<std::filesystem::path> library_files(const std::filesystem::path& folder,
                                                 const std::string& statement) {
    const std::filesystem::path whole = resolved(folder, statement);
    std::error_code ignored;
    if (std::filesystem::is_regular_file(whole, ignored)) return {whole};
    std::vector<std::filesystem::path> files;
    std::istringstream words(statement);
    for (std::string word; words >> word;)
        files.push_back(resolved(folder, word));
    return files;
}

/// Statements and texture options that MtlMaterial cannot hold.
std::vector<std::string> statements_beyond(const tinyobj::material_t& material) {
    std::vector<std::string> more;
    const auto add_map = [&](const char* statement, const std::string& name) {
        if (!name.empty()) more.emplace_back(statement);
    };
    // The diffuse map also tints ambient light, so the same map adds nothing.
    if (material.ambient_texname != material.diffuse_texname)
        add_map("map_Ka", material.ambient_texname);
    add_map("map_Ns", material.specular_highlight_texname);
    add_map("disp", material.displacement_texname);
    add_map("refl", material.reflection_texname);
    bool scaled = false;
    bool shifted = false;
    for (const tinyobj::texture_option_t* option :
         {&material.diffuse_texopt, &material.specular_texopt, &material.emissive_texopt,
          &material.alpha_texopt, &material.normal_texopt, &material.bump_texopt}) {
        for (int i = 0; i < 2; ++i) {
            scaled = scaled || option->scale[i] != 1.0F;
            shifted = shifted || option->origin_offset[i] != 0.0F;
        }
    }
    if (scaled) more.emplace_back("-s");
    if (shifted) more.emplace_back("-o");
    return more;
}

MtlMaterial translated(const tinyobj::material_t& material, const std::filesystem::path& folder) {
    const auto vector = [](const tinyobj::real_t* v) { return glm::vec3(v[0], v[1], v[2]); };
    const auto path = [&](const std::string& name) {
        return name.empty() ? std::nullopt : std::optional(resolved(folder, name));
    };
    MtlMaterial result;
    result.name = material.name;
    result.ambient = vector(material.ambient);
    result.diffuse = vector(material.diffuse);
    result.specular = vector(material.specular);
    result.emission = vector(material.emission);
    result.shininess = material.shininess;
    result.opacity = material.dissolve;
    result.refractive_index = material.ior;
    result.illumination_model = material.illum;
    result.diffuse_map = path(material.diffuse_texname);
    result.specular_map = path(material.specular_texname);
    result.emission_map = path(material.emissive_texname);
    result.opacity_map = path(material.alpha_texname);
    result.normal_map = path(material.normal_texname);
    result.bump_map = path(material.bump_texname);
    result.bump_strength = material.bump_texopt.bump_multiplier;
    result.more = statements_beyond(material);
    return result;
}

/// Inserts illum 2 before the statements of each material: tinyobjloader's default is 0, which
/// means no lighting.
std::string with_default_illumination(std::string mtl) {
    std::replace(mtl.begin(), mtl.end(), '\r', '\n');
    std::istringstream lines(mtl);
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        text += line + '\n';
        std::istringstream words(line);
        std::string statement;
        if (words >> statement && statement == "newmtl") text += "illum 2\n";
    }
    return text;
}

/// Returns the materials that an OBJ file names, in the same order, as its MTL files define them.
///
/// \param names      as after usemtl
/// \param libraries  as after mtllib: a file name, which may contain blanks, or several names;
///         relative to the folder of `file`
/// \param sources    receives the MTL files that were read
/// \param report     counts MTL files that are missing, unreadable or outside of the folder, and
///         materials that none of them defines: these have only a name and default values
std::vector<MtlMaterial> read_materials(const std::filesystem::path& file,
                                        const std::vector<std::string>& names,
                                        const std::vector<std::string>& libraries,
                                        std::vector<std::filesystem::path>& sources,
                                        Report& report) {
    std::map<std::string, MtlMaterial> known;
    for (std::size_t i = 0; i < libraries.size(); ++i) {
        for (const auto& library : library_files(file.parent_path(), libraries[i])) {
            if (!is_permitted(file.parent_path(), library)) {
                report.add("MTL file outside the model's folder", "mtllib statement", i,
                           "left out");
                continue;
            }
            try {
                std::istringstream text(with_default_illumination(read_file(library)));
                sources.push_back(library);
                std::map<std::string, int> numbers;
                std::vector<tinyobj::material_t> materials;
                std::string ignored;
                tinyobj::LoadMtl(&numbers, &materials, &text, &ignored, &ignored);
                for (const auto& material : materials) {
                    known.try_emplace(material.name, translated(material, library.parent_path()));
                }
            } catch (const FileError&) {
                report.add("unreadable MTL file", "mtllib statement", i, "left out");
            }
        }
    }
    std::vector<MtlMaterial> result;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto found = known.find(names[i]);
        if (found != known.end()) {
            result.push_back(found->second);
            list_outside_maps(file.parent_path(), result.back());
            continue;
        }
        report.add("unknown material", "material", i, "has its name and default values");
        result.emplace_back().name = names[i];
    }
    return result;
}

/// Unit normal of a polygon from the vector area of its fan; (0,0,1) if that is zero.
glm::vec3 face_normal(const ObjStatements& statements, const ObjFace& face) {
    const auto position = [&](std::uint32_t k) {
        const ObjCorner& corner = statements.corners[face.first_corner + k];
        return glm::dvec3(statements.positions[static_cast<std::size_t>(corner.position)]);
    };
    glm::dvec3 area(0.0);
    for (std::uint32_t k = 1; k + 1 < face.corner_count; ++k) {
        area += glm::cross(position(k) - position(0), position(k + 1) - position(0));
    }
    const double length = glm::length(area);
    return length > 0.0 && std::isfinite(length) ? glm::vec3(area / length) : glm::vec3(0, 0, 1);
}

/// Gives each corner a texture coordinate if any has one, and a normal if any has one.
void complete_corners(ObjStatements& statements, Report& report) {
    const auto have = [&](std::int32_t ObjCorner::*index) {
        return std::count_if(statements.corners.begin(), statements.corners.end(),
                             [index](const ObjCorner& corner) { return corner.*index >= 0; });
    };
    const auto count = static_cast<std::ptrdiff_t>(statements.corners.size());
    const std::ptrdiff_t with_texcoord = have(&ObjCorner::texcoord);
    const std::ptrdiff_t with_normal = have(&ObjCorner::normal);
    const bool any_texcoord = with_texcoord > 0;
    const bool any_normal = with_normal > 0;
    if (count == 0 || (with_texcoord % count == 0 && with_normal % count == 0)) return;
    for (std::size_t i = 0; i < statements.faces.size(); ++i) {
        check_cancelled(i);
        const ObjFace& face = statements.faces[i];
        std::int32_t own_normal = -1;
        for (std::uint32_t k = 0; k < face.corner_count; ++k) {
            ObjCorner& corner = statements.corners[face.first_corner + k];
            if (any_texcoord && corner.texcoord < 0) {
                report.add("corner without texture coordinates", "corner", face.first_corner + k,
                           "has (0, 0)");
                corner.texcoord = static_cast<std::int32_t>(statements.texcoords.size());
                statements.texcoords.emplace_back(0.0F);
            }
            if (any_normal && corner.normal < 0) {
                report.add("corner without a normal", "corner", face.first_corner + k,
                           "gets that of its face");
                if (own_normal < 0) {
                    own_normal = static_cast<std::int32_t>(statements.normals.size());
                    statements.normals.push_back(face_normal(statements, face));
                }
                corner.normal = own_normal;
            }
        }
    }
}

/// Groups triangles by material, in order of first use and stable. A file without materials gets no
/// ranges.
void group_by_material(CutPolygons cut, const ObjStatements& statements, MeshFile& file) {
    Mesh& mesh = file.mesh;
    ObjObjects objects = objects_of(statements);
    file.objects = std::move(objects.names);
    if (!objects.of_face.empty()) file.object_of.resize(cut.triangles.size());
    const auto face_of = [&](std::size_t triangle) -> const ObjFace& {
        return statements.faces[cut.polygons[triangle]];
    };
    if (statements.materials.empty() && !statements.has_smoothing_groups &&
        objects.of_face.empty()) {
        mesh.triangles = std::move(cut.triangles);
        return;
    }
    if (statements.has_smoothing_groups) mesh.smoothing_groups.resize(cut.triangles.size());
    const auto place = [&](std::size_t triangle, std::size_t at) {
        check_cancelled(triangle);
        mesh.triangles[at] = cut.triangles[triangle];
        if (!objects.of_face.empty()) file.object_of[at] = objects.of_face[cut.polygons[triangle]];
        if (statements.has_smoothing_groups)
            mesh.smoothing_groups[at] = face_of(triangle).smoothing_group;
    };
    mesh.triangles.resize(cut.triangles.size());
    if (statements.materials.empty()) {
        for (std::size_t i = 0; i < cut.triangles.size(); ++i)
            place(i, i);
        return;
    }
    // Slot 0 is for triangles before any usemtl, which come first in the file.
    const std::size_t slot_count = statements.materials.size() + 1;
    const auto slot_of = [&](std::size_t triangle) {
        return static_cast<std::size_t>(face_of(triangle).material + 1);
    };
    std::vector<std::uint32_t> starts(slot_count + 1, 0);
    for (std::size_t i = 0; i < cut.triangles.size(); ++i)
        ++starts[slot_of(i) + 1];
    for (std::size_t slot = 0; slot < slot_count; ++slot) {
        const std::uint32_t count = starts[slot + 1];
        starts[slot + 1] += starts[slot];
        if (count == 0) continue;
        const auto material =
            slot == 0 ? std::nullopt : std::optional(static_cast<std::uint32_t>(slot - 1));
        mesh.material_ranges.push_back({starts[slot], count, material});
    }
    for (std::size_t i = 0; i < cut.triangles.size(); ++i)
        place(i, starts[slot_of(i)]++);
}

}  // namespace

MeshFile read_obj(const std::filesystem::path& file, const glm::dvec3& origin, Report& report) {
    ObjStatements statements = parse_obj(FileContents(file).text(), file, origin, report);
    if (statements.corners.size() > std::numeric_limits<std::int32_t>::max()) {
        throw FileError(file, fmt::format("has {} face corners, more than 2147483647",
                                          statements.corners.size()));
    }
    complete_corners(statements, report);
    MeshFile result;
    result.mesh.name = statements.name.empty() ? file.stem().string() : statements.name;
    Polygons polygons;
    polygons.corners = unify_vertices(statements, result.mesh);
    polygons.corner_counts.reserve(statements.faces.size());
    for (const ObjFace& face : statements.faces)
        polygons.corner_counts.push_back(face.corner_count);
    CutPolygons cut = cut_polygons(result.mesh, polygons, report);
    if (cut.triangles.empty()) throw FileError(file, "has no triangle");
    group_by_material(std::move(cut), statements, result);
    result.sources = {file};
    result.materials = read_materials(file, statements.materials, statements.material_libraries,
                                      result.sources, report);
    return result;
}

namespace {

/// Replaces what would end a line, or join it with the next one.
std::string name_in_statement(std::string name) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c >= 0 && c < ' '; }, '_');
    if (name.ends_with('\\')) name.back() = '_';
    return name;
}

/// Unique names that OBJ can represent: not empty, without blanks and line breaks.
std::vector<std::string> material_names(const std::vector<MtlMaterial>& materials, Report& report) {
    std::vector<std::string> names;
    std::set<std::string> taken;
    for (const MtlMaterial& material : materials) {
        std::string name = name_in_statement(material.name.empty() ? "material" : material.name);
        std::replace(name.begin(), name.end(), ' ', '_');
        const std::string base = name;
        for (int i = 2; !taken.insert(name).second; ++i)
            name = fmt::format("{}_{}", base, i);
        if (name != material.name) {
            report.add("material name that OBJ cannot store", "material", names.size(),
                       "is written with _ for blanks, and with a number if it is taken");
        }
        names.push_back(name);
    }
    return names;
}

/// Returns the name of a file, which stands in a line of its own.
/// \throws FileError if reading the line would give another name
std::string name_in_line(const std::filesystem::path& name, const std::filesystem::path& file) {
    std::string text = name.generic_string();
    if (text.empty() || text.find_first_of("\r\n\\") != text.npos || is_blank(text.front()) ||
        is_blank(text.back())) {
        throw FileError(file, fmt::format("cannot name the file '{}', whose blanks, line breaks or "
                                          "backslashes would be read differently (rename it)",
                                          text));
    }
    return text.front() == '-' ? "./" + text : text;  // Options of maps begin with '-'.
}

std::string mtl_text(const MeshFile& contents, const std::vector<std::string>& names,
                     const std::filesystem::path& file) {
    const auto folder = std::filesystem::absolute(file).lexically_normal().parent_path();
    std::string text;
    auto out = std::back_inserter(text);
    const auto color = [&](const char* key, const glm::vec3& c) {
        fmt::format_to(out, "{} {} {} {}\n", key, c.r, c.g, c.b);
    };
    const auto map = [&](const std::string& key,
                         const std::optional<std::filesystem::path>& image) {
        if (!image) return;
        const auto beside = std::filesystem::absolute(*image).lexically_proximate(folder);
        fmt::format_to(out, "{} {}\n", key, name_in_line(beside, file));
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
        check_cancelled(i);
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
    for (std::size_t i = 0; i < mesh.texcoords.size(); ++i) {
        check_cancelled(i);
        const glm::vec2& t = mesh.texcoords[i];
        fmt::format_to(out, "vt {} {}\n", t.x, 1.0 - static_cast<double>(t.y));
    }
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        check_cancelled(i);
        const glm::vec3& n = mesh.normals[i];
        fmt::format_to(out, "vn {} {} {}\n", n.x, n.y, n.z);
    }
}

void add_faces(const Mesh& mesh, const MaterialRange& range, std::string& text) {
    auto out = std::back_inserter(text);
    const bool has_texcoords = !mesh.texcoords.empty();
    const bool has_normals = !mesh.normals.empty();
    for (std::uint32_t i = 0; i < range.triangle_count; ++i) {
        check_cancelled(i);
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

/// Throws if the MTL file would replace one of the OBJ file that was read, which stays.
void check_materials_place(const std::filesystem::path& mtl_file, const std::filesystem::path& file,
                           const std::vector<std::filesystem::path>& sources) {
    std::error_code missing;
    if (sources.empty() || std::filesystem::equivalent(file, sources[0], missing)) return;
    for (const std::filesystem::path& source : sources) {
        if (!std::filesystem::equivalent(mtl_file, source, missing)) continue;
        throw FileError(mtl_file, fmt::format("has the materials of {}; use another name",
                                              sources[0].string()));
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

void write_obj(const std::filesystem::path& file, const MeshFile& contents, Report& report) {
    const Mesh& mesh = contents.mesh;
    const std::vector<std::string> names = material_names(contents.materials, report);
    std::string text;
    FileSet files;
    FileReplacement obj(file);
    if (!names.empty()) {
        std::filesystem::path mtl_file = file;
        mtl_file.replace_extension(".mtl");
        text += fmt::format("mtllib {}\n", name_in_line(mtl_file.filename(), file));
        check_materials_place(mtl_file, file, contents.sources);
        const std::string mtl = mtl_text(contents, names, mtl_file);
        replace_file(mtl_file, std::as_bytes(std::span(mtl)));
    }
    if (!mesh.name.empty()) {
        const std::string name = name_in_statement(mesh.name);
        if (name != mesh.name)
            report.add("mesh name that OBJ cannot store", "mesh", 0,
                       "is written with _ for line breaks");
        text += fmt::format("o {}\n", name);
    }
    add_vertices(mesh, contents.origin, text);
    for (const MaterialRange& range : ranges_without_material_first(mesh)) {
        if (range.material) text += fmt::format("usemtl {}\n", names[*range.material]);
        add_faces(mesh, range, text);
    }
    write_all(obj, std::as_bytes(std::span(text)));
    obj.commit();
    files.commit();
}

}  // namespace relief::detail

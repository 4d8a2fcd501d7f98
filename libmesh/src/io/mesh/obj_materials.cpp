// SPDX-License-Identifier: Apache-2.0
// MTL files through tinyobjloader, and image names to paths.
//
// Colours are linear as given. A material without an illum statement has model 2. What an OBJ file
// names but no MTL file defines keeps its name and gets default values, counted in the report.
// Tests: tests/mesh/io/mesh/obj_test.cpp.
#include "io/mesh/obj_materials.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "file_bytes.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// A path as some tools write it, with backslashes, below a folder.
std::filesystem::path resolved(const std::filesystem::path& folder, std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    return (folder / name).lexically_normal();
}

/// The files that one mtllib statement means: all of it as one name, or else each word.
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

/// Statements and texture options that MtlMaterial has no place for.
std::vector<std::string> statements_beyond(const tinyobj::material_t& material) {
    std::vector<std::string> more;
    const auto add_map = [&](const char* statement, const std::string& name) {
        if (!name.empty()) more.emplace_back(statement);
    };
    // The diffuse map tints ambient light too; so the same map says nothing new.
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

/// The text with illum 2 ahead of what every material says: where it says nothing, tinyobjloader
/// gives 0, which asks for no lighting.
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

}  // namespace

std::vector<MtlMaterial> read_materials(const std::filesystem::path& file,
                                        const std::vector<std::string>& names,
                                        const std::vector<std::string>& libraries, Report& report) {
    std::map<std::string, MtlMaterial> known;
    for (std::size_t i = 0; i < libraries.size(); ++i) {
        for (const auto& library : library_files(file.parent_path(), libraries[i])) {
            try {
                std::istringstream text(with_default_illumination(read_file(library)));
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
            continue;
        }
        report.add("unknown material", "material", i, "has its name and default values");
        result.emplace_back().name = names[i];
    }
    return result;
}

}  // namespace relief

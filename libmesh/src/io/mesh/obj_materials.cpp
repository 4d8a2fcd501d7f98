// SPDX-License-Identifier: Apache-2.0
// MTL files through tinyobjloader, and image names to paths.
//
// Colours are linear as given. What an OBJ file names but no MTL file defines keeps its name and
// gets default values, counted in the report. Tests: tests/mesh/io/mesh/obj_test.cpp.
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
    result.illumination_model = material.illum;
    result.diffuse_map = path(material.diffuse_texname);
    result.emission_map = path(material.emissive_texname);
    result.normal_map = path(material.normal_texname);
    result.bump_map = path(material.bump_texname);
    result.bump_strength = material.bump_texopt.bump_multiplier;
    return result;
}

}  // namespace

std::vector<MtlMaterial> read_materials(const std::filesystem::path& file,
                                        const std::vector<std::string>& names,
                                        const std::vector<std::string>& libraries, Report& report) {
    std::map<std::string, MtlMaterial> known;
    for (std::size_t i = 0; i < libraries.size(); ++i) {
        for (const auto& library : library_files(file.parent_path(), libraries[i])) {
            try {
                std::istringstream text(read_file(library));
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

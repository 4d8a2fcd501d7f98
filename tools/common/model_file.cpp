// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/relief_mesh_test.cpp, map_models_test.cpp.
#include "common/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "common/command.h"
#include "common/text.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;

struct FormatRow {
    ModelFormat format;
    const char* extension;
    const char* name;
    bool writable;
};

constexpr std::array formats = {
    FormatRow{ModelFormat::glb, ".glb", "glTF (binary)", true},
    FormatRow{ModelFormat::gltf, ".gltf", "glTF", true},
    FormatRow{ModelFormat::obj, ".obj", "Wavefront OBJ", true},
    FormatRow{ModelFormat::ply, ".ply", "PLY", true},
    FormatRow{ModelFormat::stl, ".stl", "STL", false},
    FormatRow{ModelFormat::off, ".off", "OFF", false},
};

ModelFormat format_of(const std::filesystem::path& file, bool to_write) {
    if (std::filesystem::is_directory(file)) {
        throw UsageError(file.string() + ": is a folder",
                         to_write ? "give it with -o" : "name the files in it");
    }
    const std::string extension = extension_of(file);
    std::string known;
    for (const FormatRow& row : formats) {
        if (to_write && !row.writable) continue;
        if (extension == row.extension) return row.format;
        known += std::string(known.empty() ? "" : ", ") + row.extension;
    }
    const std::string problem = extension.empty()
                                    ? "has no extension"
                                    : fmt::format("{} is not a format that can be {}", extension,
                                                  to_write ? "written" : "read");
    throw UsageError(fmt::format("{}: {}", file.string(), problem), "use one of " + known);
}

const FormatRow& row_of(ModelFormat format) {
    return *std::find_if(formats.begin(), formats.end(),
                         [format](const FormatRow& row) { return row.format == format; });
}

std::vector<std::string> write_as_mesh(const std::filesystem::path& file, const MeshFile& contents,
                                       bool has_tangents) {
    std::vector<std::string> omitted;
    if (has_tangents) omitted.emplace_back("tangents");
    if (writable_format(file) == ModelFormat::ply && !contents.materials.empty())
        omitted.push_back(counted(contents.materials.size(), "material"));
    write_mesh(file, contents);
    return omitted;
}

std::vector<std::string> write_document(const std::filesystem::path& file,
                                        const GltfDocument& document,
                                        const std::filesystem::path& input, bool has_tangents) {
    if (is_document(writable_format(file))) {
        document.write(file);
        return {};
    }
    const MeshFile flat = about(input, [&] { return flattened(document); });
    std::vector<std::string> omitted = document.unsupported_contents();
    for (std::string& more : write_as_mesh(file, flat, has_tangents))
        omitted.push_back(std::move(more));
    return omitted;
}

/// Returns the name of a model in an output folder.
fs::path name_in_folder(const fs::path& input, std::optional<ModelFormat> format) {
    const ModelFormat input_format = readable_format(input);
    fs::path name = input.filename();
    if (format) return name.replace_extension(extension_for(*format));
    const bool is_writable = !name_of(input_format, writable_choices()).empty();
    return is_writable ? name : name.replace_extension(extension_for(ModelFormat::glb));
}

void refuse_format(ModelFormat format, const fs::path& output) {
    throw UsageError(fmt::format("--format {}: the name {} already has a format",
                                 name_of(format, writable_choices()), output.string()),
                     "omit --format, or give a folder: -o out/");
}

}  // namespace

ModelFormat readable_format(const std::filesystem::path& file) {
    return format_of(file, false);
}

ModelFormat writable_format(const std::filesystem::path& file) {
    return format_of(file, true);
}

bool is_document(ModelFormat format) {
    return format == ModelFormat::gltf || format == ModelFormat::glb;
}

Choices<ModelFormat> writable_choices() {
    Choices<ModelFormat> choices;
    for (const FormatRow& row : formats) {
        if (row.writable)
            choices.emplace_back(std::string_view(row.extension).substr(1), row.format);
    }
    return choices;
}

std::string extension_for(ModelFormat format) {
    return row_of(format).extension;
}

std::string format_name(ModelFormat format) {
    return row_of(format).name;
}

Model read_model(const std::filesystem::path& file, Report& report) {
    return about(file, [&]() -> Model {
        if (is_document(readable_format(file))) return GltfDocument::read(file, report);
        return read_mesh(file, report);
    });
}

std::vector<std::string> compression_text(const GltfDocument& document, bool only_decoded) {
    std::vector<std::string> words;
    for (const GltfCompression& entry : document.compression()) {
        if (entry.decoded > 0) {
            words.push_back(
                fmt::format("{} of {}", entry.extension, counted(entry.decoded, entry.element)));
        }
        if (entry.copies > 0 && !only_decoded) {
            words.push_back(fmt::format("{} beside the plain data of {}", entry.extension,
                                        counted(entry.copies, entry.element)));
        }
    }
    return words;
}

JobList model_jobs_of(const FileWords& words, std::optional<ModelFormat> format) {
    JobList list = jobs_of(words, "model",
                           [&](const fs::path& input) { return name_in_folder(input, format); });
    if (format && !list.folder) refuse_format(*format, list.jobs.front().output);
    return list;
}

std::vector<std::string> write_model(const std::filesystem::path& file, const Model& model,
                                     const std::filesystem::path& input, bool has_tangents,
                                     Report& report) {
    if (const auto* document = std::get_if<GltfDocument>(&model))
        return write_document(file, *document, input, has_tangents);
    const auto& contents = std::get<MeshFile>(model);
    if (!is_document(writable_format(file))) return write_as_mesh(file, contents, has_tangents);
    GltfDocument::from_mesh(contents, report).write(file);
    return {};
}

// Models for maps.

namespace {

MapModelPart part_of(const GltfDocument& document, GltfPrimitiveId id, Report& report) {
    const int set = document.tangent_texcoords(id).set;
    Mesh mesh = document.mesh(id, set);
    if (mesh.normals.empty()) {
        if (!mesh.tangents.empty()) {
            report.add("tangents without normals", "primitive", id.primitive,
                       "are ignored, as glTF requires");
        }
        FrameOptions options;
        options.if_missing = NormalMode::flat;
        options.tangents = TangentMode::none;
        mesh = with_frames(std::move(mesh), options, report).mesh;
    }
    return {document.describe(id), std::move(mesh), {}, {}, set};
}

/// Converts materials by the rules of GltfDocument::from_mesh().
MapAppearance appearance_of(const std::vector<MtlMaterial>& materials) {
    MapAppearance appearance;
    const auto texture = [&](const std::optional<std::filesystem::path>& file) {
        std::optional<GltfTexture> result;
        if (file) {
            result.emplace();
            result->image = appearance.images.size();
            appearance.images.push_back({file->filename().string(), *file});
        }
        return result;
    };
    for (const MtlMaterial& material : materials) {
        GltfMaterial converted;
        converted.name = material.name;
        converted.base_color = glm::vec4(glm::clamp(material.diffuse, 0.0F, 1.0F), 1.0F);
        converted.base_color_texture = texture(material.diffuse_map);
        converted.normal_texture = texture(material.normal_map);
        appearance.materials.push_back(std::move(converted));
    }
    return appearance;
}

/// If some parts have tangents, the others get those of MikkTSpace.
void add_missing_tangents(MapModel& model, Report& report) {
    const auto has_tangents = [](const MapModelPart& part) { return !part.mesh.tangents.empty(); };
    if (std::none_of(model.parts.begin(), model.parts.end(), has_tangents)) return;
    for (MapModelPart& part : model.parts) {
        if (has_tangents(part) || part.mesh.texcoords.empty()) continue;
        FrameOptions options;
        options.tangents = TangentMode::mikktspace;
        part.mesh = with_frames(std::move(part.mesh), options, report).mesh;
    }
}

MapModel model_of(const GltfDocument& document, ModelSpace space, Report& report) {
    MapModel model;
    if (space == ModelSpace::object) {
        for (const GltfPrimitiveId id : document.triangle_primitives())
            model.parts.push_back(part_of(document, id, report));
        return model;
    }
    GltfView view = document.view();
    for (const GltfMaterial& material : view.materials)
        model.materials.push_back(material.name);
    for (const auto& primitive : view.primitives) {
        MapModelPart part = part_of(document, primitive.what, report);
        part.objects = {primitive.name};
        part.mesh = placed(std::move(part.mesh), primitive.world_from_object);
        model.parts.push_back(std::move(part));
    }
    model.appearance = {std::move(view.materials), std::move(view.images)};
    add_missing_tangents(model, report);
    if (view.primitives.size() == 1)
        model.world_from_object = glm::dmat3(glm::dmat4(view.primitives[0].world_from_object));
    return model;
}

/// Parts without colors are white if others have colors.
std::vector<glm::vec4> joined_colors(const std::vector<MapModelPart>& parts) {
    const auto has_colors = [](const MapModelPart& part) { return !part.mesh.colors.empty(); };
    std::vector<glm::vec4> all;
    if (std::none_of(parts.begin(), parts.end(), has_colors)) return all;
    for (const MapModelPart& part : parts) {
        all.insert(all.end(), part.mesh.colors.begin(), part.mesh.colors.end());
        if (!has_colors(part)) all.resize(all.size() + part.mesh.positions.size(), glm::vec4(1.0F));
    }
    return all;
}

/// Joins an attribute of all parts. The result is empty if a part lacks it.
template <typename Value>
std::vector<Value> joined(const std::vector<MapModelPart>& parts,
                          std::vector<Value> Mesh::*attribute) {
    std::vector<Value> all;
    for (const MapModelPart& part : parts) {
        const std::vector<Value>& values = part.mesh.*attribute;
        if (values.empty() && !part.mesh.positions.empty()) return {};
        all.insert(all.end(), values.begin(), values.end());
    }
    return all;
}

/// Appends the material ranges of a part, before its triangles are added.
void append_ranges(Mesh& all, const Mesh& part) {
    const auto first = static_cast<std::uint32_t>(all.triangles.size());
    const auto count = static_cast<std::uint32_t>(part.triangles.size());
    if (part.material_ranges.empty() && count > 0)
        all.material_ranges.push_back({first, count, std::nullopt});
    for (MaterialRange range : part.material_ranges) {
        range.first_triangle += first;
        all.material_ranges.push_back(range);
    }
}

}  // namespace

MapModel read_map_model(const std::filesystem::path& file, ModelSpace space, Report& report) {
    Model read = read_model(file, report);
    return about(file, [&] {
        if (const auto* document = std::get_if<GltfDocument>(&read))
            return model_of(*document, space, report);
        auto& contents = std::get<MeshFile>(read);
        MapModel model;
        model.parts.push_back({"", std::move(contents.mesh), std::move(contents.objects),
                               std::move(contents.object_of), 0});
        for (const MtlMaterial& material : contents.materials)
            model.materials.push_back(material.name);
        model.appearance = appearance_of(contents.materials);
        model.origin = contents.origin;
        model.world_from_object = glm::dmat3(1.0);
        return model;
    });
}

void require_texcoords(const std::filesystem::path& file, const MapModel& model,
                       const std::string& problem, const std::string& remedy) {
    for (const MapModelPart& part : model.parts) {
        if (!part.mesh.texcoords.empty()) continue;
        throw failure(file, part.name.empty() ? problem : part.name + ": " + problem, remedy);
    }
}

Mesh joined(std::vector<MapModelPart> parts) {
    if (parts.size() == 1) return std::move(parts.front().mesh);
    Mesh all;
    all.positions = joined(parts, &Mesh::positions);
    all.normals = joined(parts, &Mesh::normals);
    all.tangents = joined(parts, &Mesh::tangents);
    all.texcoords = joined(parts, &Mesh::texcoords);
    all.colors = joined_colors(parts);
    if (all.positions.size() > std::numeric_limits<std::uint32_t>::max()) {
        throw InvalidInput(
            fmt::format("{} vertices are too many for one mesh", all.positions.size()));
    }
    std::uint32_t first = 0;
    for (const MapModelPart& part : parts) {
        append_ranges(all, part.mesh);
        for (const glm::uvec3& triangle : part.mesh.triangles)
            all.triangles.push_back(triangle + first);
        first += static_cast<std::uint32_t>(part.mesh.positions.size());
    }
    return all;
}

void move_to(MapModel& model, const glm::dvec3& origin) {
    const glm::dvec3 by = model.origin - origin;
    model.origin = origin;
    if (by == glm::dvec3(0.0)) return;
    for (MapModelPart& part : model.parts) {
        for (glm::vec3& position : part.mesh.positions)
            position = glm::vec3(glm::dvec3(position) + by);
    }
}

}  // namespace relief::tools

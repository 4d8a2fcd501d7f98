// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/relief_mesh_test.cpp, map_models_test.cpp.
#include "common/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "common/command.h"
#include "common/text.h"
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
                                       bool has_tangents, Report& report) {
    std::vector<std::string> omitted;
    if (has_tangents) omitted.emplace_back("tangents");
    if (writable_format(file) == ModelFormat::ply && !contents.materials.empty())
        omitted.push_back(counted(contents.materials.size(), "material"));
    write_mesh(file, contents, report);
    return omitted;
}

std::vector<std::string> write_document(const std::filesystem::path& file,
                                        const GltfDocument& document,
                                        const std::filesystem::path& input, bool has_tangents,
                                        Report& report) {
    if (is_document(writable_format(file))) {
        document.write(file, report);
        return {};
    }
    const MeshFile flat = about(input, [&] { return flattened(document); });
    std::vector<std::string> omitted = document.unsupported_contents();
    for (std::string& more : write_as_mesh(file, flat, has_tangents, report))
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

bool has_model_extension(const std::filesystem::path& file) {
    return std::ranges::find(formats, extension_of(file), &FormatRow::extension) != formats.end();
}

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

void add_model_files(CLI::App& app, FileWords& words, std::optional<ModelFormat>& format) {
    add_files(app, "FILE...", words.files,
              "IN OUT: the model to read (.glb .gltf .obj .ply .stl .off) and the file to write "
              "(.glb .gltf .obj .ply), which may be IN itself: it is replaced when the new file is "
              "complete. With -o: any number of models to read. glTF compressed with Draco or "
              "meshopt is written uncompressed.");
    add_value(
        app, "-o,--output", "PATH",
        "The output: a folder (with / at the end, or existing), or a file for one model. In a "
        "folder, each model keeps its name. If a model fails, the others are still processed.",
        [&words](const std::string&, const std::string& text) { words.output = text; })
        .group("Output");
    add_choice(app, "--format", format, writable_choices(),
               "The format of the files in an output folder. Default: the format of the input, or "
               "glb for .stl and .off, which cannot be written.")
        .group("Output");
}

bool may_share_companions(const std::vector<Job>& jobs) {
    return std::any_of(jobs.begin(), jobs.end(), [](const Job& job) {
        return writable_format(job.output) == ModelFormat::gltf;
    });
}

std::vector<std::string> write_model(const std::filesystem::path& file, const Model& model,
                                     const std::filesystem::path& input, bool has_tangents,
                                     Report& report) {
    if (const auto* document = std::get_if<GltfDocument>(&model))
        return write_document(file, *document, input, has_tangents, report);
    const auto& contents = std::get<MeshFile>(model);
    if (!is_document(writable_format(file)))
        return write_as_mesh(file, contents, has_tangents, report);
    GltfDocument::write_mesh(file, contents, report);
    return {};
}

void add_omitted(Summary& summary, const std::vector<std::string>& omitted,
                 const std::filesystem::path& file) {
    const std::string text =
        fmt::format("{} (cannot be stored in {})", fmt::join(omitted, ", "), extension_of(file));
    summary.add("omitted", omitted.empty() ? "" : text, {{"left_behind", omitted}});
}

// Models for maps.

MapModel read_map_model(const std::filesystem::path& file, ModelSpace space, Report& report) {
    Model model = read_model(file, report);
    return about(file, [&] { return map_model(std::move(model), space, report); });
}

void require_texcoords(const std::filesystem::path& file, const MapModel& model,
                       const std::string& problem, const std::string& remedy) {
    for (const MapModelPart& part : model.parts) {
        if (!part.mesh.texcoords.empty()) continue;
        throw failure(file, part.name.empty() ? problem : part.name + ": " + problem, remedy);
    }
}

}  // namespace relief::tools

// SPDX-License-Identifier: Apache-2.0
/// \file
/// The model formats that the tools read and write, by extension, and models with the data that
/// maps need: meshes, objects and materials. Tests: tests/tools/relief_mesh_test.cpp,
/// map_models_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/file_jobs.h"
#include "common/options.h"
#include "common/summary.h"
#include "relief/mesh/model.h"
#include "relief/mesh/report.h"

namespace relief::tools {

enum class ModelFormat { gltf, glb, obj, ply, stl, off };

/// Returns whether the name of a file has the extension of a model.
bool has_model_extension(const std::filesystem::path& file);

/// Returns the format of a file to read or to write. \throws UsageError with the valid extensions
ModelFormat readable_format(const std::filesystem::path& file);
ModelFormat writable_format(const std::filesystem::path& file);

/// Returns the formats that can be written, by option word: "glb", ...
Choices<ModelFormat> writable_choices();

/// ".glb", ...
std::string extension_for(ModelFormat format);

/// Returns whether files of a format contain a scene instead of one mesh.
bool is_document(ModelFormat format);

/// "glTF", "Wavefront OBJ", ...
std::string format_name(ModelFormat format);

Model read_model(const std::filesystem::path& file, Report& report);

/// Describes the compression of a document: "KHR_draco_mesh_compression of 2 primitives".
/// \param only_decoded  omits content that stays compressed
std::vector<std::string> compression_text(const GltfDocument& document, bool only_decoded);

/// Returns the input and output files of a command line. In an output folder, a model keeps its
/// name. STL and OFF, which cannot be written, become .glb unless `format` is given.
///
/// \param format  the format of files in an output folder; default: that of the input
/// \throws UsageError as jobs_of(), for a `format` beside an output file name, and for an input of
///         unknown format
JobList model_jobs_of(const FileWords& words, std::optional<ModelFormat> format);

/// Adds the file arguments IN OUT or IN... with -o, and --format, for model_jobs_of().
void add_model_files(CLI::App& app, FileWords& words, std::optional<ModelFormat>& format);

/// Returns whether two jobs could write the same file: buffers and images beside two .gltf files
/// may have the same name.
bool may_share_companions(const std::vector<Job>& jobs);

/// Writes a model in the format of the file.
///
/// \param input         the file name in errors about the model
/// \param has_tangents  whether the model has tangents, which mesh files cannot store
/// \param report        receives textures that are omitted because their files are missing, names
///                      that the format cannot hold, and repairs of what glTF forbids
/// \return the content that the format cannot store: "tangents", "2 animations", ...
std::vector<std::string> write_model(const std::filesystem::path& file, const Model& model,
                                     const std::filesystem::path& input, bool has_tangents,
                                     Report& report);

/// Adds the result of write_model() to a summary.
void add_omitted(Summary& summary, const std::vector<std::string>& omitted,
                 const std::filesystem::path& file);

// Models for maps.

/// Reads a model by map_model(). \throws FileError, UsageError if the file cannot be read
MapModel read_map_model(const std::filesystem::path& file, ModelSpace space, Report& report);

/// Checks that every part has texture coordinates.
/// \throws FileError with the part, the problem and the remedy
void require_texcoords(const std::filesystem::path& file, const MapModel& model,
                       const std::string& problem, const std::string& remedy);

}  // namespace relief::tools

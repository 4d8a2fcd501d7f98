// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which model files the tools read and write, by extension, and reading one of either kind.
/// Tests: tests/tools/relief_mesh_test.cpp.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "common/options.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"

namespace relief::tools {

enum class ModelFormat { gltf, glb, obj, ply, stl, off };

/// The format of a file to read or to write. \throws UsageError naming the extensions that serve
ModelFormat readable_format(const std::filesystem::path& file);
ModelFormat writable_format(const std::filesystem::path& file);

/// The formats that can be written, by the words for them: "glb", ...
Choices<ModelFormat> writable_choices();

/// ".glb", ...
std::string extension_for(ModelFormat format);

/// A document with a scene, rather than one mesh.
bool is_document(ModelFormat format);

/// "glTF", "Wavefront OBJ", ...
std::string format_name(ModelFormat format);

/// What was read: a glTF document, or a mesh with its materials.
using Model = std::variant<GltfDocument, MeshFile>;

Model read_model(const std::filesystem::path& file, Report& report);

/// How parts of a document were compressed, in words: "KHR_draco_mesh_compression of 2 primitives".
/// \param only_decoded  leaves out those that are written as they were
std::vector<std::string> compression_in_words(const GltfDocument& document, bool only_decoded);

/// Writes a model in the format of the file, whichever kind it is of.
///
/// \param input         what to name in errors about the model
/// \param has_tangents  whether there are any, which mesh files cannot hold
/// \param report        names textures that are left out because their files are missing
/// \return what the format leaves behind: "tangents", "2 animations", ...
std::vector<std::string> write_model(const std::filesystem::path& file, const Model& model,
                                     const std::filesystem::path& input, bool has_tangents,
                                     Report& report);

}  // namespace relief::tools

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Files with the mesh of a stage: a node for each part, and a material for each alpha mode, so
/// that other programs show and keep them. Part of the library relief::make. Tests:
/// tests/make/stage_file_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/make/asset.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {
namespace make {

/// Successive triangles or vertices, and the primitives of a file that have them. A vertex at the
/// border between materials is in several.
struct StageRun {
    std::uint32_t count = 0;
    std::vector<std::uint32_t> primitives;

    friend bool operator==(const StageRun&, const StageRun&) = default;
};

/// The order in which a mesh had the triangles and vertices of its file. Both are empty for a file
/// of one primitive without parts.
struct StageLayout {
    bool has_parts = false;  ///< The nodes are parts.
    std::vector<StageRun> triangles;
    std::vector<StageRun> vertices;
};

/// Writes the mesh after a stage as .glb or .gltf, without the materials of the source.
///
/// \param name    of the only node of a mesh without parts
/// \param origin  of the positions
/// \param report  counts values that glTF forbids and that are repaired
/// \return the layout that read_stage_file() needs
/// \throws FileError if the file cannot be written; InvalidInput if the mesh is not valid
StageLayout write_stage_file(const std::filesystem::path& file, const std::string& name,
                             const StageMesh& stage, const glm::dvec3& origin, Report& report);

/// The contents of a file.
struct StageContents {
    Mesh mesh;
    NamedParts parts;                    ///< None if it has one node.
    std::vector<AlphaMode> alpha_modes;  ///< By triangle; empty if all have the same.
};

/// Reads a file that write_stage_file() wrote.
/// \return the mesh, also with the same order; its positions are relative to the origin of the file
/// \throws FileError if the file cannot be read, or if it has another layout
StageContents read_stage_file(const std::filesystem::path& file, const StageLayout& layout);

}  // namespace make
}  // namespace relief

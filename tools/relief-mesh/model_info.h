// SPDX-License-Identifier: Apache-2.0
/// \file
/// What is in a model file: counts, attributes, bounds, materials, and what only a scene has.
/// Tests: tests/tools/relief_mesh_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/findings.h"
#include "relief/mesh/mesh.h"

namespace relief::tools {

/// Bytes of a mesh's arrays, in memory as on the GPU: floats, and indices of 32 bits.
struct MeshBytes {
    std::size_t attributes = 0;
    std::size_t indices = 0;
};

/// One triangle primitive, or the one mesh of a mesh file.
struct PartInfo {
    std::string name;
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    std::vector<std::string> attributes;  ///< Besides positions: "normals", "texcoords", ...
    std::vector<std::string> materials;   ///< Names of those it uses.
    Bounds bounds;                        ///< Object space.
    MeshBytes memory;
};

struct MaterialInfo {
    std::string name;
    std::vector<std::string> textures;  ///< "base color", "normal", ...
};

struct ModelInfo {
    std::string format;
    std::uintmax_t bytes = 0;
    std::vector<PartInfo> parts;
    std::size_t instances = 0;  ///< Parts as placed in the scene; a part may stand in many places.
    std::size_t vertices = 0;   ///< Of all parts, each counted once.
    std::size_t triangles = 0;
    MeshBytes memory;  ///< Of all parts, each counted once.
    Bounds bounds;     ///< Of all instances in world space.
    std::vector<MaterialInfo> materials;
    std::size_t images = 0;
    std::size_t lights = 0;
    std::size_t cameras = 0;
    std::vector<std::string> beyond_a_mesh;  ///< "2 animations", "1 skin", ...
    std::vector<std::string> compression;    ///< "EXT_meshopt_compression of 3 buffer views", ...
    Findings findings;
};

/// \throws FileError if the file cannot be read
ModelInfo model_info(const std::filesystem::path& file);

}  // namespace relief::tools

// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far apart the normals and tangents of two model files are, as text for people and as JSON.
/// Tests: tests/tools/relief_mesh_compare_test.cpp.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/model_file.h"
#include "relief/mesh/compare.h"

namespace relief::tools {

struct CompareRequest {
    std::filesystem::path a;
    std::filesystem::path b;
    std::optional<double> tolerance;     ///< Of positions, in the models' unit.
    std::optional<double> uv_tolerance;  ///< Of texture coordinates.
    bool ignore_uv = false;
    bool in_world_space = false;  ///< Two glTF files too.
};

/// A primitive in the joined mesh.
struct ComparedPart {
    std::string name;  ///< Empty for a file with one mesh.
    std::size_t first_triangle = 0;
    std::size_t triangle_count = 0;
    bool has_normals = false;
    bool has_tangents = false;
    std::size_t unmatched = 0;   ///< Triangles.
    FrameComparison comparison;  ///< Of the first file's primitives alone.
};

/// All primitives of a file as one mesh with a range for each.
struct ComparedModel {
    std::filesystem::path file;
    std::string format;
    Mesh mesh;
    std::vector<ComparedPart> parts;
};

struct ComparedModels {
    ComparedModel a;
    ComparedModel b;
    MatchOptions options;  ///< The tolerances that were used.
    bool in_world_space = false;
    CornerMatch match;
    FrameComparison all;
    /// Matched corners that have normals, or tangents, in one of the files alone.
    std::size_t normals_in_one = 0;
    std::size_t tangents_in_one = 0;

    /// Whether all matched corners are within some degrees, and no sign differs.
    [[nodiscard]] bool is_within(double degrees) const;
    /// Whether all triangles have one certain partner, and all directions that one of the files has
    /// could be compared.
    [[nodiscard]] bool is_complete() const;
    /// Whether any normals or tangents were compared.
    [[nodiscard]] bool has_any() const;
};

/// Two glTF files are compared in the object space of each primitive, unless they are to be in
/// world space, once for each place; a glTF file and one of another format always in world space,
/// since that is what it was written in.
///
/// \throws FileError if a file cannot be read, or holds no triangles
ComparedModels compare_models(const CompareRequest& request);

void print_text(const ComparedModels& compared);

nlohmann::ordered_json json_of(const ComparedModels& compared);

}  // namespace relief::tools

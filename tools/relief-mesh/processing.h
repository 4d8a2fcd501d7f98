// SPDX-License-Identifier: Apache-2.0
/// \file
/// Giving every triangle primitive of a model its normals and tangents, and writing the model in
/// the format of the output file, with a record of what was done and what that format left behind.
/// Tests: tests/tools/relief_mesh_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "common/findings.h"
#include "common/model_file.h"
#include "relief/mesh/frames.h"

namespace relief::tools {

struct ProcessRequest {
    std::filesystem::path input;
    std::filesystem::path output;
    NormalMode normals = NormalMode::keep;
    TangentMode tangents = TangentMode::keep;
    std::optional<int> uv_set;  ///< Of computed tangents; absent: the normal texture's.
    std::optional<double>
        crease_degrees;  ///< As the following, for averaged normals; see frames.h.
    double weld_tolerance = 0.0;
    bool ignore_smoothing_groups = false;
    bool repair_normals = false;  ///< Of the normals that are kept, those that are broken.
};

/// What became of an attribute of one primitive.
enum class Fate { kept, computed, removed, absent };

/// The texture coordinates that tangents were computed from.
struct TangentTexcoords {
    int set = 0;
    bool is_only = true;  ///< There are no others.
    std::string reason;   ///< "asked for", "of the normal texture", ..., "the first".
};

/// What was done to one primitive.
struct ProcessedPart {
    std::string name;  ///< "mesh 'Body' primitive 0"; empty for a file with one mesh.
    std::size_t triangles = 0;
    std::size_t vertices_read = 0;
    std::size_t vertices_written = 0;  ///< More where vertices were split.
    Fate normals = Fate::absent;
    NormalMode normal_mode = NormalMode::keep;  ///< How they were computed, where they were.
    std::size_t normals_by_area = 0;            ///< Vertices, where the mode is automatic.
    bool smoothing_groups = false;              ///< They followed the file's.
    Fate tangents = Fate::absent;
    TangentMode tangent_mode = TangentMode::keep;  ///< How they were computed, where they were.
    TangentTexcoords texcoords;                    ///< What from.
    std::vector<std::string> notes;  ///< What is worth knowing, but nothing wrong in the input.
};

struct Processed {
    std::vector<ProcessedPart> parts;
    std::vector<std::string> decompressed;  ///< What was compressed when read, and is not now.
    std::vector<std::string> left_behind;   ///< What the output format cannot hold.
    Findings findings;
};

/// Reads, computes, writes.
///
/// \throws FileError if a file cannot be read or written, if it holds no triangles, or if tangents
///         are asked for and no primitive has texture coordinates, or none of the set asked for;
///         then nothing is written
Processed process(const ProcessRequest& request, Stages& stages);

}  // namespace relief::tools

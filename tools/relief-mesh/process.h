// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes normals and tangents for each triangle primitive of a model, and writes the model in
/// the format of the output file. Tests: tests/tools/relief_mesh_test.cpp, process_batch_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "common/file_jobs.h"
#include "common/findings.h"
#include "common/model_file.h"
#include "relief/mesh/frames.h"

namespace relief::tools {

struct ProcessRequest {
    std::filesystem::path input;
    std::filesystem::path output;
    NormalMode normals = NormalMode::keep;
    TangentMode tangents = TangentMode::keep;
    std::optional<int> uv_set;  ///< For computed tangents. Default: the set of the normal texture.
    std::optional<double> crease_degrees;  ///< For averaged normals, see frames.h.
    double weld_tolerance = 0.0;           ///< For averaged or repaired normals, see frames.h.
    bool ignore_smoothing_groups = false;
    bool repair_normals = false;  ///< Replaces invalid normals among those that are kept.
};

/// The outcome for an attribute of a primitive.
enum class Fate { kept, computed, removed, absent };

/// The texture coordinates from which tangents were computed.
struct TangentTexcoords {
    int set = 0;
    bool is_only = true;  ///< The primitive has no other set.
    std::string reason;   ///< "asked for", "of the normal texture", ..., "the first".
};

/// The outcome for a primitive.
struct ProcessedPart {
    std::string name;  ///< "mesh 'Body' primitive 0"; empty for a file with one mesh.
    std::size_t triangles = 0;
    std::size_t vertices_read = 0;
    std::size_t vertices_written = 0;  ///< Larger than `vertices_read` if vertices were split.
    Fate normals = Fate::absent;
    NormalMode normal_mode = NormalMode::keep;  ///< The method of computed normals.
    std::size_t normals_by_area = 0;  ///< Vertices for which the automatic mode used area weights.
    bool smoothing_groups = false;    ///< The normals followed the smoothing groups of the file.
    Fate tangents = Fate::absent;
    TangentMode tangent_mode = TangentMode::keep;  ///< The method of computed tangents.
    TangentTexcoords texcoords;
    std::vector<std::string> notes;  ///< Notes that do not concern a defect of the input.
};

struct Processed {
    std::vector<ProcessedPart> parts;
    std::vector<std::string> decompressed;  ///< Compressed content that is written uncompressed.
    std::vector<std::string> omitted;       ///< Content that the output format cannot store.
    Findings findings;
};

/// Reads a model, computes normals and tangents, and writes it.
///
/// \throws FileError if a file cannot be read or written, if it has no triangles, or if tangents
///         are requested and no primitive has the texture coordinates; then no file is written
Processed process(const ProcessRequest& request, Stages& stages);

/// Returns the input and output files of a command line. In an output folder, a model keeps its
/// name. STL and OFF, which cannot be written, become .glb unless `format` is given.
///
/// \param format  the format of files in an output folder; default: that of the input
/// \throws UsageError as jobs_of(), for a `format` beside an output file name, and for an input of
///         unknown format
JobList model_jobs_of(const FileWords& words, std::optional<ModelFormat> format);

}  // namespace relief::tools

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Giving a model other triangles: every mesh of a glTF document, all its primitives together so
/// that no gap opens between materials, or the one mesh of a mesh file.
/// Tests: tests/tools/reshaping_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/command.h"
#include "common/findings.h"
#include "common/options.h"
#include "common/report_options.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/report.h"

namespace relief::tools {

/// Makes other triangles of a mesh. `source_vertex` of the result is empty where its vertices are
/// no copies of the mesh's. `all_triangles` is how many the whole model has.
using MeshChange =
    std::function<FramedMesh(const Mesh& mesh, std::size_t all_triangles, Report& report)>;

struct ReshapeRequest {
    std::filesystem::path input;
    std::filesystem::path output;
    NormalMode normals = NormalMode::keep;
    ReportOptions report;
    GeneralOptions general;
};

struct Reshaped {
    std::size_t triangles_read = 0;
    std::size_t triangles_written = 0;
    std::size_t vertices_read = 0;
    std::size_t vertices_written = 0;
    bool has_tangents = false;
    std::vector<std::string> left_behind;  ///< What the output format cannot hold.
    Findings findings;
};

/// IN, OUT, --normals, --report, --strict, --threads, --quiet.
void add_reshape_options(CLI::App& app, ReshapeRequest& request, const std::string& about_normals);

/// Reads, changes, writes, reports.
///
/// \param options  of the command, for the report
/// \throws UsageError, FileError; then nothing is written
ExitCode reshape(const CLI::App& app, const ReshapeRequest& request, const MeshChange& change,
                 const nlohmann::ordered_json& options);

}  // namespace relief::tools

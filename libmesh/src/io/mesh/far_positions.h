// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes far from where their coordinates count from, whose digits floats cannot hold.
/// Tests: tests/mesh/io/mesh/far_positions_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/glm.hpp>

#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"

namespace relief {

/// Reads a file, with an origin taken off its positions while they are still in double.
using ReadAround =
    std::function<MeshFile(const std::filesystem::path&, const glm::dvec3& origin, Report&)>;

/// Reads a file around 0, and where its positions are further from there than 16 times the mesh is
/// large, again around its middle: if floats hold more of it then, that is the result, and counted.
/// Files whose coordinates are floats already (binary ones) come back as they are.
MeshFile read_near(const std::filesystem::path& file, const ReadAround& read, Report& report);

}  // namespace relief

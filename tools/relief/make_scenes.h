// SPDX-License-Identifier: Apache-2.0
/// \file
/// A source and its asset as scenes with the same model of shading.
/// Tests: tests/make/make_page_test.cpp, make_loss_test.cpp.
#pragma once

#include <filesystem>

#include "dense_model.h"
#include "relief/shade/scene.h"

namespace relief::tools {

/// Loads the source with the materials that glTF gives it, so that both scenes have the same model
/// of shading.
///
/// \param beside  a file in the folder for a temporary file
/// \throws FileError, InvalidInput
shade::Scene source_scene(const DenseModel& source, const std::filesystem::path& beside);

/// Loads a written asset. \throws FileError
shade::Scene asset_scene(const std::filesystem::path& file);

}  // namespace relief::tools

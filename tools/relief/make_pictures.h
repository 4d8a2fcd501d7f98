// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pictures of an asset and its source for the report page. OpenGL is loaded only by this call.
/// Tests: tests/make/make_page_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "relief/make/asset.h"
#include "relief/mesh/image.h"

namespace relief::tools {

/// The source, the asset, and the asset without maps, from one camera with the same lights.
struct AssetPictures {
    Image source;
    Image asset;
    Image plain;
    std::string backend;  ///< "OSMesa"
};

/// \param source  the file of the dense model; its materials are those of glTF
/// \param asset   the written file; `made` is its content
/// \throws Error if nothing can be drawn
AssetPictures draw_asset(const std::filesystem::path& source, const std::filesystem::path& asset,
                         const make::Asset& made, std::optional<double> crease_angle,
                         const glm::ivec2& size);

/// Draws the charts of an asset.
Image draw_charts(const make::Asset& made, const glm::ivec2& size);

/// Returns a picture of at most `max_side` pixels along a side: each is the mean of a square.
Image reduced(const Image& image, int max_side);

}  // namespace relief::tools

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pictures of an asset and its source for the report page. OpenGL is loaded only by the
/// constructors of AssetScenes and AssetDrawer.
/// Tests: tests/make/make_page_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <string>

#include "dense_model.h"
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

/// A source and its asset, loaded to be drawn.
class AssetScenes {
  public:
    /// \param source  its materials are those of glTF
    /// \param asset   the written file
    /// \throws Error if nothing can be drawn
    AssetScenes(const DenseModel& source, const std::filesystem::path& asset);
    ~AssetScenes();
    AssetScenes(const AssetScenes&) = delete;
    AssetScenes& operator=(const AssetScenes&) = delete;

    /// \param made  the content of the asset's file
    AssetPictures draw(const make::Asset& made, const glm::ivec2& size);

    /// Returns a page (docs/page.md) with the source on the left of a line, and the asset or the
    /// asset without maps on its right. A source of more than 250,000 triangles is not in it: the
    /// asset without maps is on the left then.
    /// \throws Error if a page cannot draw the scenes
    std::string page(const make::Asset& made, const glm::ivec2& size);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Draws written assets. \throws Error if nothing can be drawn
class AssetDrawer {
  public:
    AssetDrawer();
    ~AssetDrawer();
    AssetDrawer(const AssetDrawer&) = delete;
    AssetDrawer& operator=(const AssetDrawer&) = delete;

    /// Draws the asset of a file from the direction that shows most of it.
    Image draw(const std::filesystem::path& asset, const glm::ivec2& size);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Draws the charts of an asset.
Image draw_charts(const make::Asset& made, const glm::ivec2& size);

/// Returns a picture of 8 bits with at most `max_side` pixels along a side: each is the mean of a
/// square.
/// \param image  of 8 or 16 bits
Image reduced(const Image& image, int max_side);

}  // namespace relief::tools

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pictures of an asset and its source for the report page. OpenGL is loaded only by the
/// constructors of AssetScenes, AssetDrawer and LossMeter.
/// Tests: tests/make/make_page_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "relief/make/asset.h"
#include "relief/mesh/image.h"
#include "relief/shade/fidelity.h"

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
    /// \param sources  the files of the dense model, at least one; materials are those of glTF
    /// \param asset   the written file
    /// \param crease_angle  for a source without normals
    /// \throws Error if nothing can be drawn
    AssetScenes(std::span<const std::filesystem::path> sources, const std::filesystem::path& asset,
                std::optional<double> crease_angle);
    ~AssetScenes();
    AssetScenes(const AssetScenes&) = delete;
    AssetScenes& operator=(const AssetScenes&) = delete;

    /// \param made  the content of the asset's file
    AssetPictures draw(const make::Asset& made, const glm::ivec2& size);

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

/// Measures what assets lost against one source, whose pictures are drawn once.
class LossMeter {
  public:
    /// \param sources, crease_angle  as for AssetScenes
    /// \param beside  a file in the folder for a temporary file
    /// \throws Error if nothing can be drawn
    LossMeter(std::span<const std::filesystem::path> sources, const std::filesystem::path& beside,
              std::optional<double> crease_angle);
    ~LossMeter();
    LossMeter(const LossMeter&) = delete;
    LossMeter& operator=(const LossMeter&) = delete;

    /// \param asset  the written file
    shade::Fidelity measure(const std::filesystem::path& asset, Report& report);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Draws the charts of an asset.
Image draw_charts(const make::Asset& made, const glm::ivec2& size);

/// Returns a picture of at most `max_side` pixels along a side: each is the mean of a square.
Image reduced(const Image& image, int max_side);

}  // namespace relief::tools

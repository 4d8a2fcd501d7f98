// SPDX-License-Identifier: Apache-2.0
/// \file
/// The preview of a bake: the high models, the low model with the finished map, and the low model
/// without it, side by side, with one camera and the same lights. The map is read back from its
/// file, as an engine reads it. Tests: tests/tools/relief_bake_preview_test.cpp.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mesh_request.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/shade/image_source.h"
#include "relief/shade/renderer.h"

namespace relief::tools {

/// A finished map.
struct PreviewMap {
    std::filesystem::path file;
    /// The triangles of the low mesh that it is for; absent: all.
    std::optional<std::vector<std::uint32_t>> triangles{};
    bool repeats = false;  ///< Outside the unit square; otherwise it is clamped.
};

/// The conventions of the maps.
struct PreviewReading {
    NormalMapFormat format;
    NormalSpace space = NormalSpace::tangent;
};

/// The models in one space. They are moved, because drawing reorders them.
struct PreviewModels {
    std::vector<Mesh> high;
    /// One for each high mesh, or empty. Only their normal maps are shown.
    std::vector<HighMaterials> high_materials{};
    Mesh low;
    /// The axes of an object-space map.
    glm::dmat3 world_from_low{1.0};
    bool shows_back_faces = false;  ///< Of the high models.
};

/// A view direction in radians.
struct ViewDirection {
    float azimuth = 0;
    float elevation = 0;
};

/// The direction that shows most of a mesh: the default view (camera.h) unless another of
/// fifteen, by quarter turns and from above or below, shows a quarter more of it. Occlusion is
/// ignored.
ViewDirection best_view(const Mesh& mesh);

/// A map for a picture: its file, or if a side is longer than `max_side` texels, a map reduced by
/// an integer factor. That map has means of normals, in float and green up, and is read a few rows
/// at a time.
shade::ImageSource preview_image(const std::filesystem::path& map, const NormalMapFormat& format,
                                 int max_side);

/// Draws previews. The constructor loads OpenGL, so that a machine without it fails before any
/// work.
class MeshPreview {
  public:
    /// \throws GpuError without OpenGL
    MeshPreview();

    /// Draws and writes the picture. \throws Error, whose message says that the maps are complete
    void draw(const PreviewOptions& options, PreviewModels models,
              const std::vector<PreviewMap>& maps, const PreviewReading& reading);

    /// "OSMesa"
    [[nodiscard]] const std::string& backend_name() const { return context_->backend_name(); }

  private:
    std::unique_ptr<shade::Context> context_;
};

}  // namespace relief::tools

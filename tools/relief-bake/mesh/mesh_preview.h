// SPDX-License-Identifier: Apache-2.0
/// \file
/// --preview: the high models, the low one with the finished map, and the low one without, side by
/// side, from one camera and in one light. The map is read back from its file, as an engine will.
/// Tests: tests/tools/mesh_preview_test.cpp.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mesh/preview_options.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/shade/context.h"
#include "relief/shade/scene.h"

namespace relief::tools {

/// A finished map.
struct PreviewMap {
    std::filesystem::path file;
    /// Of the low mesh, those that it is for; absent: all.
    std::optional<std::vector<std::uint32_t>> triangles{};
    bool repeats = false;  ///< Beyond the unit square; else its border goes on.
};

/// How maps are to be read.
struct PreviewReading {
    NormalMapFormat format;
    NormalSpace space = NormalSpace::tangent;
};

/// What is to be seen, in one space; taken over, as a picture needs it in another order.
struct PreviewModels {
    std::vector<Mesh> high;
    Mesh low;
    /// The axes that an object-space map belongs to.
    glm::dmat3 world_from_low{1.0};
    bool shows_back_faces = false;  ///< Of the high models.
};

/// The direction to look from, radians, in which most of a mesh is to be seen: the default view
/// (default_view.h) unless another of fifteen, by quarter turns and from above or below, shows a
/// quarter more of it. What hides what has no say.
struct ViewDirection {
    float azimuth = 0;
    float elevation = 0;
};
ViewDirection telling_view(const Mesh& mesh);

/// A map for a picture of it: as it is in its file, or, where a side is longer than `most` texels,
/// made smaller by a whole number: means of normals, in float and green up, a few rows of the file
/// at a time.
ImageSource preview_image(const std::filesystem::path& map, const NormalMapFormat& format,
                          int most);

/// Draws previews. OpenGL is loaded when one is made, so that what makes none never does, and a
/// machine without it is found out before any work.
class MeshPreview {
  public:
    /// \throws GpuError where there is no OpenGL
    MeshPreview();

    /// Draws and writes the picture. \throws Error, which says that the maps are complete
    void draw(const PreviewOptions& options, PreviewModels models,
              const std::vector<PreviewMap>& maps, const PreviewReading& reading);

    /// "OSMesa"
    [[nodiscard]] const std::string& backend_name() const { return context_->backend_name(); }

  private:
    std::unique_ptr<Context> context_;
};

}  // namespace relief::tools

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Files of the layers of a map, written row by row beside the map itself.
/// Tests: tests/tools/relief_bake_mesh_layers_test.cpp.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "mesh/layer_coding.h"
#include "mesh/mesh_options.h"
#include "mesh/mesh_sets.h"
#include "relief/mesh/bake.h"

namespace relief::tools {

/// A layer as it is written.
struct WrittenLayer {
    std::filesystem::path file;
    LayerCoding coding;
};

/// The layers of one map, `layers` for the library, and how they are coded: ranges are those asked
/// for, else what the bake cannot exceed; of curvature, what 99% of the area does not.
std::vector<WrittenLayer> planned_layers(const MeshBakeRequest& request, const MapPlan& plan,
                                         const Baker& baker, const BakeLayers& layers);

class LayerWriters {
  public:
    /// \throws FileError
    LayerWriters(const MeshBakeRequest& request, const std::vector<WrittenLayer>& layers,
                 Report& report);
    ~LayerWriters();
    LayerWriters(const LayerWriters&) = delete;
    LayerWriters& operator=(const LayerWriters&) = delete;

    void write(const BakedRows& rows);

    /// Closes the files; finish() renames them. \throws FileError
    void complete();

    /// \param map  that is in place by now
    /// \throws FileError, which says which files are complete
    void finish(const std::filesystem::path& map);

  private:
    struct Writer;
    std::vector<std::unique_ptr<Writer>> writers_;
    bool has_alpha_;
    Report& report_;
};

/// "out/height.png: height map, 16 bit, -0.1 to 0.1"
std::string layer_words(const WrittenLayer& layer);

/// How to use a height map elsewhere: as a displacement, and for relief-bake bump.
///
/// \param texel_size  of the map, in the unit of the heights; 0: not known
std::vector<std::string> height_use(const WrittenLayer& layer, double texel_size);

nlohmann::ordered_json layer_json(const WrittenLayer& layer);

/// The side of a texel, in the mesh's unit, in the mean over a map's area.
double mean_texel_size(const Mesh& low, const glm::ivec2& size);

}  // namespace relief::tools

// SPDX-License-Identifier: Apache-2.0
/// \file
/// The maps of a bake: their plan, the record of the options in their files, and the written files.
/// Tests: tests/tools/relief_bake_mesh_test.cpp, relief_bake_check_test.cpp,
/// relief_bake_layers_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/summary.h"
#include "mesh_request.h"
#include "relief/mesh/bake.h"

namespace relief::tools {

// The plan: one map, one per material (<material> in OUT), one per tile (<UDIM>), or both.

struct MapPlan {
    std::filesystem::path output;
    std::optional<std::string> material;  ///< Absent: the map is not for a single material.
    std::string material_in_files;        ///< The same in file names.
    std::optional<int> udim;
    glm::ivec2 tile{0, 0};
    std::optional<std::vector<std::uint32_t>> triangles;  ///< Absent: all.
    bool is_exceeded = false;  ///< Some of its triangles lie outside of it, at least partly.

    /// "material 'Skin', tile 1001"; empty for a single map.
    [[nodiscard]] std::string name() const;
    /// Another output file of this map, with <material> and <UDIM> replaced as in OUT.
    [[nodiscard]] std::filesystem::path named(const std::filesystem::path& file) const;
};

/// The options for a map. The plan must outlive them.
BakeMapOptions map_options(const BakeOptions& options, const MapPlan& plan);

struct MapPlans {
    std::vector<MapPlan> maps;
    Report report;              ///< Triangles outside of all maps.
    std::size_t materials = 0;  ///< Of the low mesh.
};

/// \throws UsageError if OUT has a word twice or in a folder's name, or if it contradicts an option
void check_map_names(const MeshBakeRequest& request);

/// Plans the maps for a low mesh.
///
/// File names keep letters, digits, '-', '_', '.' and non-ASCII characters of material names; other
/// characters, and a leading '.', become '_'. Triangles without a material are "no-material"; a
/// material without a name is "material-N", counted from 0.
/// \param materials  names, by the indices in the ranges of `low`
/// \throws FileError if two maps would be the same file, one would replace a model, or no texture
///         coordinates are in a tile
MapPlans plan_maps(const MeshBakeRequest& request, const Mesh& low,
                   const std::vector<std::string>& materials);

// The record of a bake in the map's file.

/// The options of a bake and their values: {"--samples", "4"}.
using BakeRecord = std::map<std::string, std::string>;

/// The metadata of a map: "relief:bake" = "--samples 4 --space tangent"; "relief:material" and
/// "relief:udim" if the map is one of several. A cage is recorded as "--cage given".
std::map<std::string, std::string> bake_metadata(const MeshBakeRequest& request,
                                                 const MapPlan& plan);

/// Reads the record of a file; empty if it has none.
/// \throws FileError if the record has unknown options
BakeRecord read_record(const std::filesystem::path& file,
                       const std::map<std::string, std::string>& metadata);

/// The recordable options of a command line.
BakeRecord record_of(const CLI::App& app);

/// Completes the options of the command line with those of the file. With --cage, the file's
/// --rays, --hardness and --offset are dropped.
BakeRecord merged(const BakeRecord& command_line, const BakeRecord& of_file);

/// Sets the options of a record. \throws UsageError like the options themselves
void apply_record(const BakeRecord& record, MeshBakeRequest& request);

/// "--samples 4 --space tangent"
std::string to_string(const BakeRecord& record);

// Written files.

struct WrittenLayer {
    std::filesystem::path file;
    LayerCoding coding;
    bool has_opacity = false;  ///< In alpha; only with colors.
};

/// The facts about the layers of all maps that follow from the models.
struct BakeFacts {
    LayerBounds bounds;
    std::vector<SurfaceId> ids;
    bool has_opacity = false;
    BakeDistances distances;
};

/// The layers of a map. Ranges are those of the options, else the largest values that the bake can
/// give; for curvature in 8 bits, the value that 99% of the area does not exceed.
std::vector<WrittenLayer> planned_layers(const MeshBakeRequest& request, const MapPlan& plan,
                                         const BakeFacts& facts);

/// "#a0b1c2 stone, #102030 wood, and 12 more (see --report)"
std::string id_text(const std::vector<SurfaceId>& ids);

/// [{"name": "stone", "color": "#a0b1c2"}, ...]
Json ids_json(const std::vector<SurfaceId>& ids);

/// Writes the files of one map, row by row: normals and layers.
class MapWriter {
  public:
    /// \throws FileError
    MapWriter(const MeshBakeRequest& request, const MapPlan& plan, const NormalMapFormat& format,
              const std::vector<WrittenLayer>& layers, Report& report);
    ~MapWriter();
    MapWriter(const MapWriter&) = delete;
    MapWriter& operator=(const MapWriter&) = delete;

    /// Row counts must be multiples of 64, except for the last rows.
    void write(const BakedRows& rows);

    /// Closes the files; finish() replaces the old ones. \throws FileError
    void complete();

    /// \throws FileError
    void finish();

  private:
    struct Files;
    std::unique_ptr<Files> files_;
};

}  // namespace relief::tools

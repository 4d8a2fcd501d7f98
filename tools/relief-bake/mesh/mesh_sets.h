// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which maps one bake makes: one, or one for each material (<material> in OUT), one for each tile
/// (<UDIM>), or both. Known, and checked, before any ray is cast.
/// Tests: tests/tools/relief_bake_sets_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh_options.h"
#include "relief/mesh/mesh.h"

namespace relief::tools {

inline constexpr std::string_view material_word = "<material>";

/// One map to be baked.
struct MapPlan {
    std::filesystem::path output;
    std::optional<std::string> material;  ///< Its name, where the map is for one.
    std::string material_in_files;        ///< The same in names of files.
    std::optional<int> udim;
    glm::ivec2 tile{0, 0};
    /// Those that it is for; absent: all.
    std::optional<std::vector<std::uint32_t>> triangles;

    /// "material 'Skin', tile 1001"; empty where it is the only map.
    [[nodiscard]] std::string name() const;
    /// Another file of this map, with the same words in its name as OUT.
    [[nodiscard]] std::filesystem::path named(const std::filesystem::path& file) const;
};

/// A bake's options for that map, which must outlive them.
BakeMapOptions map_options(const BakeOptions& options, const MapPlan& plan);

struct MapPlans {
    std::vector<MapPlan> maps;
    Report report;              ///< Triangles outside of all maps.
    std::size_t materials = 0;  ///< That the low mesh has.
};

/// \throws UsageError where OUT has a word twice, in a folder's name, or one that excludes another
///         option
void check_map_names(const MeshBakeRequest& request);

/// The maps for a low mesh.
///
/// Letters, digits, '-', '_', '.', and all beyond ASCII stay as they are in names of files; what
/// else a material's name has is '_' there, and so is a '.' that it begins with. Triangles without
/// a material are "no-material", a material without a name "material-N", counted from 0.
///
/// \param materials  names, by the numbers in the ranges of `low`
/// \throws FileError if two maps would be the same file, one would replace a model, or no
///         coordinates are in a tile
MapPlans plan_maps(const MeshBakeRequest& request, const Mesh& low,
                   const std::vector<std::string>& materials);

}  // namespace relief::tools

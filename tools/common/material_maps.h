// SPDX-License-Identifier: Apache-2.0
/// \file
/// Maps in materials of glTF files, for `relief-mesh material` and --write-into of relief-bake.
/// Tests: tests/tools/material_test.cpp, write_into_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "common/map_kind.h"
#include "common/summary.h"
#include "relief/mesh/model.h"

namespace relief::tools {

/// The alpha mode of a material with a baked base color.
struct BakedAlpha {
    AlphaMode mode = AlphaMode::blend;
    float cutoff = 0.5F;
    bool operator==(const BakedAlpha&) const = default;
};

struct MaterialMap {
    TextureSlot slot = TextureSlot::normal;
    std::filesystem::path file;  ///< PNG or JPEG.
};

/// The maps of one material.
struct MaterialMaps {
    /// Its name, or "material-N" for one without a name; absent: the only material, or all.
    std::optional<std::string> material;
    std::vector<MaterialMap> maps;
};

struct MaterialRequest {
    std::filesystem::path input;
    std::filesystem::path output;  ///< May be the input.
    std::vector<MaterialMaps> materials;
    /// If no name is given, all materials get the maps. Otherwise there must be only one.
    bool all_materials = false;
    bool embeds = false;  ///< Images become a part of a .gltf, as they always do of a .glb.
    bool adds_tangents = true;
    /// The maps were baked for the model: they must be looked up in the texture coordinates of its
    /// tangents, without a transform, and the scale of normals becomes 1.
    bool are_baked = false;
    std::optional<double> normal_scale;
    /// The baked base color has alpha. If all materials that get it are opaque, they get this mode.
    std::optional<BakedAlpha> alpha;
    AssumedKinds assumed;
};

struct StoredMaterial {
    std::string name;
    bool is_new = false;
    std::vector<MaterialMap> maps;
};

struct MaterialResult {
    std::vector<StoredMaterial> materials;
    std::size_t primitives_with_new_tangents = 0;
    Findings findings;
};

/// Reads a model, stores the maps, adds tangents for normal maps and writes the model.
/// \throws FileError; then the output is unchanged
MaterialResult store_maps(const MaterialRequest& request, Stages& stages);

/// Checks that store_maps() will find the materials and, for baked maps, their texture coordinates.
/// The files of the maps need not exist yet. \throws FileError
void check_materials(const MaterialRequest& request);

/// "material", "maps" and "tangents".
Summary summary_of(const MaterialResult& result);

/// --write-into MODEL and its options.
struct WriteIntoOptions {
    std::optional<std::filesystem::path> model;
    std::optional<std::string> material;
    std::optional<double> scale;
    bool embed = false;
    bool external = false;
};

/// Adds --write-into, --material, --embed and --external.
/// \param description  of --write-into
void add_write_into_options(CLI::App& app, WriteIntoOptions& options,
                            const std::string& description);

/// \throws UsageError if the model cannot hold glTF materials, or options have no effect
void check(const CLI::App& app, const WriteIntoOptions& options);

/// \param option  for the message: "--write-into"
/// \throws UsageError if glTF cannot hold an image in this format
void check_image(const std::string& option, const std::filesystem::path& file);

}  // namespace relief::tools

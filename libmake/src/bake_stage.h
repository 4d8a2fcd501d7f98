// SPDX-License-Identifier: Apache-2.0
/// \file
/// The stage "bake" of an asset. Tests: tests/make/asset_maps_test.cpp.
#pragma once

#include <cstdint>
#include <span>

#include "draw_modes.h"
#include "relief/make/asset.h"

namespace relief::make::detail {

/// The dense mesh, and the parts of both meshes, which are used if Asset::parts says so.
struct BakedSource {
    const Mesh& high;  ///< With the materials of the source.
    const NamedParts& high_parts;
    std::span<const std::uint32_t> low_parts;  ///< By triangle of the asset's mesh.
    const SourceAlpha& alpha;                  ///< Of the source.
    /// By triangle of the asset's mesh; empty: not known, or all the same.
    std::span<const AlphaMode> low_alpha;
};

/// Casts rays from the mesh of an asset onto the dense mesh. The asset gets its maps, the factors
/// of its material, and the results of the bake. \throws InvalidInput if no ray hits; Cancelled
void bake_maps(const AssetSource& source, const BakedSource& baked, const AssetOptions& options,
               Asset& asset, Report& report);

}  // namespace relief::make::detail

// SPDX-License-Identifier: Apache-2.0
/// \file
/// The stage "bake" of an asset. Tests: tests/make/asset_maps_test.cpp.
#pragma once

#include "relief/make/asset.h"

namespace relief::make::detail {

/// Casts rays from the mesh of an asset onto the dense mesh. The asset gets its maps, the factors
/// of its material, and the results of the bake. \param high  the dense mesh, with the materials of
/// `source` \throws InvalidInput if no ray hits; Cancelled
void bake_maps(const AssetSource& source, const Mesh& high, const AssetOptions& options,
               Asset& asset, Report& report);

}  // namespace relief::make::detail

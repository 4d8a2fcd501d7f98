// SPDX-License-Identifier: Apache-2.0
/// \file
/// The materials of an asset, which differ in their alpha. Tests: tests/make/draw_modes_test.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "relief/make/asset.h"
#include "relief/mesh/material.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief::make::detail {

/// The alpha of the triangles of a source.
struct SourceAlpha {
    /// By material, with those that are opaque in all texels as opaque; empty: all triangles are
    /// drawn as AssetSource::shared says.
    std::vector<AlphaMode> of_material;

    /// Returns the alpha of a material range.
    [[nodiscard]] AlphaMode of(const MaterialRange& range) const;
};

/// \param report  counts transparent materials that are opaque everywhere
SourceAlpha source_alpha(const AssetSource& source, Report& report);

/// Returns the alpha of each triangle of a mesh with the materials of the source; empty if all have
/// the same.
std::vector<AlphaMode> alpha_modes_of(const Mesh& mesh, const SourceAlpha& alpha);

/// Returns whether a list has two different modes.
bool is_mixed(std::span<const AlphaMode> modes);

/// The materials of an asset.
struct DrawnMaterials {
    /// Those of the source. Alpha that the asset cannot cut becomes 0 or 1 before it is baked.
    std::vector<HighMaterial> materials;
    std::vector<DrawMode> modes;  ///< One, or one for each alpha of the asset, in their order.
};

/// Decides how an asset is drawn.
///
/// \param high  the dense mesh, with the materials of the source
/// \param alpha_modes  by triangle of the asset; empty: it has one material, which blends if one of
///         the source does
/// \param report  counts materials that are drawn in another way than in the source
DrawnMaterials drawn_materials(const Mesh& high, const AssetSource& source,
                               const SourceAlpha& alpha, std::span<const AlphaMode> alpha_modes,
                               Report& report);

/// Returns the ranges of triangles of one mode, whose materials are the indices of the modes.
std::vector<MaterialRange> ranges_of(std::span<const AlphaMode> alpha_modes,
                                     std::span<const DrawMode> modes);

}  // namespace relief::make::detail

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Layers: triangles at the same three positions, such as the two sides of a doubled wall, as one
/// triangle of a surface.
///
/// One triangle of a stack (triangle_stacks.h) is its front; the others follow it. Fronts of
/// neighboring stacks have consistent windings, so the front sheet of a doubled wall is a manifold
/// wherever the wall is one.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "geometry/corners.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief::detail {

/// Identifies a layer of a stack. Layers of neighboring stacks with the same key continue each
/// other.
struct LayerKey {
    bool is_opposite = false;  ///< Its winding is opposite to that of the front.
    std::uint32_t part = 0;    ///< Material range.

    friend auto operator<=>(const LayerKey&, const LayerKey&) = default;
};

/// A triangle of a mesh in a stack of several layers.
struct Layer {
    std::uint32_t front = 0;  ///< The triangle of the mesh that stands for the stack.
    LayerKey key;
    std::uint32_t triangle = 0;

    friend auto operator<=>(const Layer&, const Layer&) = default;
};

/// The layers of all stacks of a mesh, sorted; fronts are among them.
using TriangleLayers = std::vector<Layer>;

/// Returns the layers of the stack of a front; empty if it has one only.
std::span<const Layer> layers_of(const TriangleLayers& layers, std::uint32_t front);

/// Removes all triangles but the fronts from the order of triangles.
///
/// \param classes  for each vertex, the smallest vertex with its position
/// \param part_of, wedge_of  the part of a triangle, and the number of the attributes of a vertex
///         within a part. Triangles with equal keys and attributes are repeated: they are left out.
///         With other attributes, they stay in the order
/// \param order  first corners of triangles, in an order by value
/// \param report  counts doubled and repeated triangles
TriangleLayers separate_layers(
    const Mesh& mesh, std::span<const std::uint32_t> classes,
    const std::function<std::uint32_t(std::uint32_t triangle)>& part_of,
    const std::function<std::uint32_t(std::uint32_t vertex, std::uint32_t part)>& wedge_of,
    std::vector<Corner>& order, Report& report);

/// Wedges of all layers at a position, numbered as one: by number, the wedge of each layer, sorted
/// by its key.
using LayeredWedges = std::vector<std::vector<std::pair<LayerKey, std::uint32_t>>>;

}  // namespace relief::detail

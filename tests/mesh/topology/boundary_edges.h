// SPDX-License-Identifier: Apache-2.0
/// \file
/// The number of boundary edges of a welded mesh.
#pragma once

#include <algorithm>

#include "geometry/weld.h"
#include "topology/topology.h"

namespace relief::test {

inline std::size_t boundary_edges(const Mesh& mesh) {
    Report report;
    const relief::detail::Topology surface =
        relief::detail::topology_of(mesh, relief::detail::weld_positions(mesh.positions), report);
    return static_cast<std::size_t>(
        std::count(surface.opposite.begin(), surface.opposite.end(), relief::detail::no_corner));
}

}  // namespace relief::test

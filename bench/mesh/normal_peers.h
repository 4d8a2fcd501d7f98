// SPDX-License-Identifier: Apache-2.0
/// \file
/// Vertex normals by other libraries, each behind one function that sets up once and can then be
/// timed. Which there are depends on what was installed at build time.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief::bench {

struct NormalPeer {
    std::string name;
    std::function<void()> run;
};

/// Those that this build has. The mesh must outlive them.
std::vector<NormalPeer> normal_peers(const Mesh& mesh);

}  // namespace relief::bench

// SPDX-License-Identifier: Apache-2.0
/// \file
/// The same work by other libraries. The lists contain those that were found at build time.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"

namespace relief::bench {

/// A library and its timed function. The setup is not timed.
struct Peer {
    std::string name;
    std::function<void()> run;
};

/// Vertex normals (normal_peers.cpp). The mesh must outlive the result.
std::vector<Peer> normal_peers(const Mesh& mesh);

/// Heights to a 16-bit normal map (bump_peers.cpp). The images must outlive the result.
/// \param heights  one float channel
/// \param map      three channels of 16 bits, which are overwritten
std::vector<Peer> bump_peers(const Image& heights, Image& map);

}  // namespace relief::bench

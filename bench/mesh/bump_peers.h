// SPDX-License-Identifier: Apache-2.0
/// \file
/// Other libraries that take slopes, where they are installed.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "relief/mesh/image.h"

namespace relief::bench {

struct BumpPeer {
    std::string name;
    std::function<void()> run;  ///< Makes a 16-bit normal map of the heights.
};

/// \param heights  one float channel; \param map  three channels of 16 bits; both must outlive it
std::vector<BumpPeer> bump_peers(const Image& heights, Image& map);

}  // namespace relief::bench

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Packing occlusion, roughness and metalness into the channels of one image.
/// Tests: tests/tools/relief_bake_pack_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/map_kind.h"
#include "common/text.h"
#include "engines.h"
#include "relief/mesh/image.h"

namespace relief::tools {

/// An image, or one of its channels.
struct ChannelFile {
    std::filesystem::path file;
    std::optional<int> channel;  ///< Absent: gray.
};

/// The values of one property: an image or a constant.
using ChannelInput = std::variant<double, ChannelFile>;

/// The maps to pack, and the engine that they are for.
struct PackContents {
    std::optional<ChannelInput> occlusion, roughness, smoothness, metalness;
    Engine engine = Engine::gltf;
    int bits = 8;
    AssumedKinds assumed;
};

/// A channel of the packed image and what it is made of.
struct ChannelSource {
    PackedChannel content = PackedChannel::zero;
    ChannelInput input = 0.0;
    bool is_inverted = false;
};

struct Packed {
    Image image;
    std::vector<ChannelSource> sources;
    Findings findings;
};

/// Reads the maps one after another. \throws FileError if they differ in size
Packed pack(const PackContents& contents);

/// Returns the channel to read. \throws FileError if the image has no such channel, or colors
int channel_to_read(const ChannelFile& file, const Image& image);

}  // namespace relief::tools

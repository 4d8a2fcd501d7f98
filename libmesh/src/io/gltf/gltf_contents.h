// SPDX-License-Identifier: Apache-2.0
/// \file
/// A glTF document in memory: its JSON as it was, and its bytes.
///
/// Why not tinygltf: version 2.7 gives back large integers in extras as other numbers, drops nulls,
/// empty objects, unknown properties and minVersion, drops animation channels without a node, and
/// writes null where it has dropped them all. It serves as an independent reader in the tests.
/// Tests: tests/mesh/io/gltf/gltf_document_test.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/gltf/gltf_json.h"

namespace relief {

/// Bytes of a buffer; they may be the tail of a file that was read whole.
struct GltfBuffer {
    std::string storage;
    std::size_t begin = 0;
    std::size_t size = 0;
    bool is_placeholder = false;  ///< Its bytes are nowhere: all its views are compressed.

    [[nodiscard]] std::string_view bytes() const {
        return std::string_view(storage).substr(begin, size);
    }
};

/// Bytes [begin, end) of a buffer.
struct GltfExtent {
    std::size_t buffer = 0;
    std::size_t begin = 0;
    std::size_t end = 0;
};

struct GltfContents {
    Json root;                        ///< Checked by check_gltf.
    std::filesystem::path folder;     ///< Where relative URIs begin; absolute.
    std::vector<GltfBuffer> buffers;  ///< One per entry of "buffers".
    /// Chunks of a GLB that are neither JSON nor the buffer: kept as they are.
    std::vector<std::pair<std::uint32_t, std::string>> extra_chunks;

    /// Accessors and buffer views that processing has replaced: left out when written, if nothing
    /// else refers to them.
    std::set<std::size_t> retired_accessors;
    std::set<std::size_t> retired_views;
    std::vector<GltfExtent> retired_bytes;  ///< Compressed data that has been unpacked.
    /// How many buffer views or primitives were unpacked, by extension.
    std::map<std::string, std::size_t> unpacked;
    /// The buffer that holds what processing adds; past the end until there is something.
    std::size_t added_buffer = static_cast<std::size_t>(-1);
    /// Accessors that processing has added for primitives that share theirs, by a hash of their
    /// elements.
    std::multimap<std::size_t, std::size_t> shared_accessors;
    /// How many primitives use an accessor as POSITION, as read: who shares vertices with others
    /// must not change while primitives are processed one by one.
    std::vector<std::uint32_t> position_uses;
};

/// Names of the extension that holds a compressed copy of a buffer view.
inline constexpr std::array meshopt_extensions = {"EXT_meshopt_compression",
                                                  "KHR_meshopt_compression"};

/// Name of the extension that holds a compressed copy of a primitive.
inline constexpr const char* draco_extension = "KHR_draco_mesh_compression";

}  // namespace relief

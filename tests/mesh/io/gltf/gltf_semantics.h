// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a glTF file means, whatever the layout of its buffers: for comparing files before and
/// after.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace relief::test {

/// The JSON of a file with every reference to an accessor, buffer view or image replaced by what it
/// holds: values, type, name, bytes. Two files with the same meaning compare equal.
nlohmann::json meaning_of(const std::filesystem::path& file);

/// The same without what processing may change: the accessor list, attributes, indices, modes and
/// morph targets of primitives.
nlohmann::json meaning_beside_meshes(const std::filesystem::path& file);

/// Bytes of a file's buffers that nothing refers to, padding included.
std::size_t unreferenced_bytes(const std::filesystem::path& file);

/// All .gltf and .glb files below a folder, sorted.
std::vector<std::filesystem::path> gltf_files_below(const std::filesystem::path& folder);

/// A one-chunk or two-chunk GLB, or, by extension, a .gltf, written from JSON and bytes.
void write_gltf_file(const std::filesystem::path& file, const nlohmann::json& json,
                     const std::string& buffer = {});

}  // namespace relief::test

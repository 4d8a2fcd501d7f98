// SPDX-License-Identifier: Apache-2.0
/// \file
/// The contents of a glTF file independent of its buffer layout, for comparisons before and after
/// processing, and damaged copies of GLB files.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace relief::test {

/// Returns the JSON of a file with every reference to an accessor, buffer view or image replaced by
/// its contents: values, type, name, bytes. Two files with the same meaning compare equal.
nlohmann::json meaning_of(const std::filesystem::path& file);

/// Returns the same without the parts that processing may change: the accessor list, and
/// attributes, indices, modes and morph targets of primitives.
nlohmann::json meaning_beside_meshes(const std::filesystem::path& file);

/// Returns the number of bytes of a file's buffers that nothing refers to, including padding.
std::size_t unreferenced_bytes(const std::filesystem::path& file);

/// Returns all .gltf and .glb files below a folder, sorted.
std::vector<std::filesystem::path> gltf_files_below(const std::filesystem::path& folder);

/// Writes a GLB with one or two chunks or, by extension, a .gltf from JSON and bytes.
void write_gltf_file(const std::filesystem::path& file, const nlohmann::json& json,
                     const std::string& buffer = {});

/// Writes a copy of a GLB in which one to four random bytes behind its JSON have random values.
void write_damaged_copy(const std::filesystem::path& file, const std::filesystem::path& copy,
                        std::mt19937& random);

/// Returns whether a file is refused with a FileError. If not, all of its meshes are read (each may
/// be refused with InvalidInput) and the document is written, to expose other failures.
bool is_refused(const std::filesystem::path& file);

}  // namespace relief::test

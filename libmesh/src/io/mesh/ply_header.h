// SPDX-License-Identifier: Apache-2.0
/// \file
/// The header of a PLY file: what its elements are made of.
///
/// Source: [Turk 1994]. A malformed header throws FileError. Tests:
/// tests/mesh/io/mesh/ply_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace relief {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes that one value takes in a binary file.
std::size_t size_of(PlyType type);

/// One value of an element, or a list of them.
struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> count_type;  ///< Of a list; absent for a single value.
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
    std::size_t data_begin = 0;  ///< The first byte behind the header.
};

/// \throws FileError naming the line of what is malformed
PlyHeader parse_ply_header(std::string_view bytes, const std::filesystem::path& file);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// The header of PLY files: the elements that follow it, and the types of their values.
// Source: [Turk 1994].
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace relief::detail {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// One value of an element, or a list of values.
struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> count_type;  ///< The type of a list's length; absent for a single value.
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
    std::size_t data_begin = 0;  ///< Offset of the first byte after the header.
};

/// \throws FileError with the line of a malformed statement
PlyHeader parse_ply_header(std::string_view bytes, const std::filesystem::path& file);

/// Returns the bytes of one value in a binary file.
inline std::size_t size_of(PlyType type) {
    switch (type) {
        case PlyType::int8:
        case PlyType::uint8:
            return 1;
        case PlyType::int16:
        case PlyType::uint16:
            return 2;
        case PlyType::float64:
            return 8;
        default:
            return 4;
    }
}

/// Returns the divisor for integers that stand for fractions: the largest value of their type.
inline double largest_value(PlyType type) {
    switch (type) {
        case PlyType::int8:
            return 127.0;
        case PlyType::uint8:
            return 255.0;
        case PlyType::int16:
            return 32767.0;
        case PlyType::uint16:
            return 65535.0;
        case PlyType::int32:
            return 2147483647.0;
        case PlyType::uint32:
            return 4294967295.0;
        default:
            return 1.0;
    }
}

}  // namespace relief::detail

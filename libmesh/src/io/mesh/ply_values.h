// SPDX-License-Identifier: Apache-2.0
/// \file
/// One value after the other out of the data of a PLY file, ASCII or binary.
///
/// Data that ends too early throws FileError. Tests: tests/mesh/io/mesh/ply_test.cpp.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "io/mesh/mesh_file_text.h"
#include "io/mesh/ply_header.h"
#include "relief/mesh/error.h"

namespace relief {

/// Values stored as text.
class PlyTextValues {
  public:
    PlyTextValues(std::string_view data, const std::filesystem::path& file) : text_(data, file) {}

    double next(PlyType type) {
        const auto value = text_.number<double>();
        return type == PlyType::float32 ? static_cast<double>(static_cast<float>(value)) : value;
    }
    /// Goes to the next line, on which the next element stands; false if values were left over.
    bool end_element() {
        const bool is_whole = text_.word_on_line().empty();
        text_.skip_line();
        return is_whole;
    }
    /// A bound on how many more values there can be, so that no count is believed blindly.
    [[nodiscard]] std::uint64_t at_most(PlyType) const { return text_.rest().size() / 2 + 1; }

  private:
    TextScanner text_;
};

/// Values stored as bytes, in either order.
template <bool is_swapped>
class PlyBinaryValues {
  public:
    PlyBinaryValues(std::string_view data, const std::filesystem::path& file)
        : data_(data), file_(file) {}

    double next(PlyType type) {
        switch (type) {
            case PlyType::int8:
                return take<std::int8_t, std::uint8_t>();
            case PlyType::uint8:
                return take<std::uint8_t, std::uint8_t>();
            case PlyType::int16:
                return take<std::int16_t, std::uint16_t>();
            case PlyType::uint16:
                return take<std::uint16_t, std::uint16_t>();
            case PlyType::int32:
                return take<std::int32_t, std::uint32_t>();
            case PlyType::uint32:
                return take<std::uint32_t, std::uint32_t>();
            case PlyType::float32:
                return static_cast<double>(take<float, std::uint32_t>());
            case PlyType::float64:
                return take<double, std::uint64_t>();
        }
        return 0.0;
    }
    bool end_element() { return true; }
    [[nodiscard]] std::uint64_t at_most(PlyType type) const { return data_.size() / size_of(type); }

  private:
    template <typename Value, typename Bits>
    Value take() {
        if (data_.size() < sizeof(Bits)) throw FileError(file_, "ends in the middle of its data");
        Bits bits = 0;
        std::memcpy(&bits, data_.data(), sizeof(Bits));
        data_.remove_prefix(sizeof(Bits));
        if constexpr (is_swapped && sizeof(Bits) > 1) {
            Bits swapped = 0;
            for (std::size_t i = 0; i < sizeof(Bits); ++i) {
                swapped = static_cast<Bits>(swapped << 8U) | static_cast<Bits>(bits & 0xFFU);
                bits = static_cast<Bits>(bits >> 8U);
            }
            bits = swapped;
        }
        return std::bit_cast<Value>(bits);
    }

    std::string_view data_;
    const std::filesystem::path& file_;
};

}  // namespace relief

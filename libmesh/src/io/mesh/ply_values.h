// SPDX-License-Identifier: Apache-2.0
// The values of a PLY file one after another: as text, or as bytes of either order, which are read
// in pieces.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "files.h"
#include "io/mesh/mesh_formats.h"
#include "io/mesh/ply_header.h"
#include "relief/mesh/report.h"

namespace relief::detail {

/// Bytes that may follow the last element.
inline constexpr std::string_view ply_padding("\0 \t\r\n", 5);

/// Values as text.
class PlyTextValues {
  public:
    PlyTextValues(std::string_view data, const std::filesystem::path& file) : text_(data, file) {}

    double next(PlyType type) {
        const auto value = text_.number<double>();
        return type == PlyType::float32 ? static_cast<double>(static_cast<float>(value)) : value;
    }
    /// Moves to the next line, which has the next element; false if the line has surplus values.
    bool end_element() {
        const bool is_whole = text_.word_on_line().empty();
        text_.skip_line();
        return is_whole;
    }
    /// Number of bytes that have not been read.
    [[nodiscard]] std::uint64_t remaining() const { return text_.rest().size(); }
    /// Returns whether nothing but white space and zeros follows.
    bool is_at_end() {
        return text_.rest().find_first_not_of(ply_padding) == std::string_view::npos;
    }
    /// Upper bound of the number of remaining values, to validate counts.
    [[nodiscard]] std::uint64_t max_remaining(PlyType) const { return text_.rest().size() / 2 + 1; }
    /// Text has no triangles that can be copied.
    static bool next_triangle(PlyType, PlyType, glm::uvec3&) { return false; }

  private:
    TextScanner text_;
};

/// A file that is read from front to back, in pieces that stay in the cache.
class SequentialBytes {
  public:
    SequentialBytes(const RandomAccessFile& file, std::uint64_t begin)
        : file_(file), unread_(begin), piece_(piece_size) {}

    /// Returns whether `count` bytes follow; then they are at data(). At most a few values.
    bool has(std::size_t count) { return rest_.size() >= count || read_more(count); }
    [[nodiscard]] const char* data() const { return rest_.data(); }
    void skip(std::size_t count) { rest_.remove_prefix(count); }
    [[nodiscard]] std::uint64_t remaining() const { return rest_.size() + file_.size() - unread_; }

  private:
    static constexpr std::size_t piece_size = std::size_t{1} << 20;

    bool read_more(std::size_t count) {
        std::copy(rest_.begin(), rest_.end(), piece_.begin());
        const auto size = static_cast<std::size_t>(
            std::min<std::uint64_t>(piece_size - rest_.size(), file_.size() - unread_));
        file_.read(unread_, std::as_writable_bytes(std::span(piece_).subspan(rest_.size(), size)));
        unread_ += size;
        rest_ = {piece_.data(), rest_.size() + size};
        return rest_.size() >= count;
    }

    const RandomAccessFile& file_;
    std::uint64_t unread_;  ///< Offset of the first byte that is not in a piece yet.
    std::vector<char> piece_;
    std::string_view rest_;  ///< The part of the piece that has not been taken.
};

/// Values as bytes, in either order.
template <bool is_swapped>
class PlyBinaryValues {
  public:
    PlyBinaryValues(const RandomAccessFile& file, std::uint64_t begin)
        : bytes_(file, begin), file_(file.path()) {}

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
    [[nodiscard]] std::uint64_t remaining() const { return bytes_.remaining(); }
    bool is_at_end() {
        while (bytes_.has(1) && ply_padding.find(*bytes_.data()) != std::string_view::npos)
            bytes_.skip(1);
        return bytes_.remaining() == 0;
    }
    [[nodiscard]] std::uint64_t max_remaining(PlyType type) const {
        return bytes_.remaining() / size_of(type);
    }
    /// Takes a list of three indices, which is most of the data of large files. If the next list is
    /// none, or of rare types, it stays.
    bool next_triangle(PlyType count_type, PlyType index_type, glm::uvec3& triangle) {
        constexpr std::size_t size = 1 + sizeof(triangle);
        if (size_of(count_type) != 1 || size_of(index_type) != 4 ||
            index_type == PlyType::float32 || !bytes_.has(size) || *bytes_.data() != 3)
            return false;
        std::array<std::uint32_t, 3> corners{};
        std::memcpy(corners.data(), bytes_.data() + 1, sizeof(corners));
        for (std::uint32_t& corner : corners) {
            if constexpr (is_swapped) corner = swapped(corner);
            // Negative indices are reported as such.
            if (index_type == PlyType::int32 && corner > 0x7FFFFFFFU) return false;
        }
        bytes_.skip(size);
        triangle = glm::uvec3(corners[0], corners[1], corners[2]);
        return true;
    }

  private:
    template <typename Bits>
    static Bits swapped(Bits bits) {
        Bits result = 0;
        for (std::size_t i = 0; i < sizeof(Bits); ++i) {
            result = static_cast<Bits>(result << 8U) | static_cast<Bits>(bits & 0xFFU);
            bits = static_cast<Bits>(bits >> 8U);
        }
        return result;
    }

    template <typename Value, typename Bits>
    Value take() {
        if (!bytes_.has(sizeof(Bits))) throw FileError(file_, "ends in the middle of its data");
        Bits bits = 0;
        std::memcpy(&bits, bytes_.data(), sizeof(Bits));
        bytes_.skip(sizeof(Bits));
        if constexpr (is_swapped && sizeof(Bits) > 1) bits = swapped(bits);
        return std::bit_cast<Value>(bits);
    }

    SequentialBytes bytes_;
    const std::filesystem::path& file_;
};

}  // namespace relief::detail

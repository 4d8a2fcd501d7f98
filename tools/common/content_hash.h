// SPDX-License-Identifier: Apache-2.0
/// \file
/// Hashes that find damaged and changed files; they are no protection against forged ones.
/// Tests: tests/make/make_cache_test.cpp, tests/tools/relief_bake_shards_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace relief::tools {

/// 64-bit FNV-1a.
class ContentHash {
  public:
    void add(std::string_view bytes) {
        for (const char byte : bytes)
            hash_ = (hash_ ^ static_cast<unsigned char>(byte)) * 0x100000001B3ULL;
    }
    /// Adds a text and its length, so that "a", "bc" and "ab", "c" differ.
    void add_text(std::string_view text);

    [[nodiscard]] std::uint64_t value() const { return hash_; }
    /// 16 hexadecimal digits.
    [[nodiscard]] std::string text() const;

  private:
    std::uint64_t hash_ = 0xCBF29CE484222325ULL;
};

/// Returns the hash of a file's bytes; "missing" for a file that cannot be read.
std::string file_hash(const std::filesystem::path& file);

}  // namespace relief::tools

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Numbering keys in order of first appearance, by hashing: what welds corners into vertices.
///
/// The numbers depend on the keys and their order alone. Tests: tests/mesh/io/mesh/obj_test.cpp.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

namespace relief {

/// An open-addressing table of keys of N words that grows as needed.
template <std::size_t N>
class KeyNumbers {
  public:
    using Key = std::array<std::uint32_t, N>;

    explicit KeyNumbers(std::size_t expected) {
        slots_.assign(std::bit_ceil(2 * expected + 16), none);
        keys_.reserve(expected);
    }

    /// The number of a key; a new key gets the next one.
    std::uint32_t number_of(const Key& key) {
        if (2 * keys_.size() >= slots_.size()) grow();
        std::uint32_t& slot = slots_[place_of(key)];
        if (slot == none) {
            slot = static_cast<std::uint32_t>(keys_.size());
            keys_.push_back(key);
        }
        return slot;
    }

    /// All keys, each at its number.
    [[nodiscard]] const std::vector<Key>& keys() const { return keys_; }

  private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    std::size_t place_of(const Key& key) const {
        // Words are folded in with a multiplier and a shift of MurmurHash3's finalizer.
        std::uint64_t hash = 0;
        for (const std::uint32_t word : key) {
            hash = (hash ^ word) * 0xff51afd7ed558ccdULL;
            hash ^= hash >> 33;
        }
        std::size_t place = hash & (slots_.size() - 1);
        while (slots_[place] != none && keys_[slots_[place]] != key) {
            place = (place + 1) & (slots_.size() - 1);
        }
        return place;
    }

    void grow() {
        slots_.assign(2 * slots_.size(), none);
        for (std::size_t i = 0; i < keys_.size(); ++i) {
            slots_[place_of(keys_[i])] = static_cast<std::uint32_t>(i);
        }
    }

    std::vector<std::uint32_t> slots_;
    std::vector<Key> keys_;
};

}  // namespace relief

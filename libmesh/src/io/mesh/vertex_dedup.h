// SPDX-License-Identifier: Apache-2.0
/// \file
/// Merging equal corners into vertices.
///
/// Values are equal if all their bits are. Vertices are numbered in order of first use, so the
/// numbers depend only on the corners and their order.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "io/mesh/obj_parser.h"
#include "relief/mesh/mesh.h"

namespace relief {

/// An open-addressing hash table that numbers keys of N words in order of first use.
template <std::size_t N>
class KeyNumbers {
  public:
    using Key = std::array<std::uint32_t, N>;

    explicit KeyNumbers(std::size_t expected) {
        slots_.assign(std::bit_ceil(2 * expected + 16), none);
        keys_.reserve(expected);
    }

    /// The number of a key; a new key gets the next number.
    std::uint32_t number_of(const Key& key) {
        if (2 * keys_.size() >= slots_.size()) grow();
        std::uint32_t& slot = slots_[slot_of(key)];
        if (slot == none) {
            slot = static_cast<std::uint32_t>(keys_.size());
            keys_.push_back(key);
        }
        return slot;
    }

    /// All keys, indexed by their number.
    [[nodiscard]] const std::vector<Key>& keys() const { return keys_; }

  private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    std::size_t slot_of(const Key& key) const {
        // Words are combined with a multiplier and a shift of MurmurHash3's finalizer.
        std::uint64_t hash = 0;
        for (const std::uint32_t word : key) {
            hash = (hash ^ word) * 0xff51afd7ed558ccdULL;
            hash ^= hash >> 33;
        }
        std::size_t slot_index = hash & (slots_.size() - 1);
        while (slots_[slot_index] != none && keys_[slots_[slot_index]] != key) {
            slot_index = (slot_index + 1) & (slots_.size() - 1);
        }
        return slot_index;
    }

    void grow() {
        slots_.assign(2 * slots_.size(), none);
        for (std::size_t i = 0; i < keys_.size(); ++i) {
            slots_[slot_of(keys_[i])] = static_cast<std::uint32_t>(i);
        }
    }

    std::vector<std::uint32_t> slots_;
    std::vector<Key> keys_;
};

/// Fills `mesh` with one vertex for each combination of values among the corners; attributes that
/// no corner has stay empty.
///
/// Each corner must have a texture coordinate if any has one, and a normal if any has one.
/// \return the vertex of each corner
std::vector<std::uint32_t> unify_vertices(const ObjStatements& statements, Mesh& mesh);

}  // namespace relief

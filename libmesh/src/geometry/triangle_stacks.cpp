// SPDX-License-Identifier: Apache-2.0
// Most meshes have no stacks, so a bit for each hash of a triangle finds the few candidates first;
// only these are sorted.
#include "geometry/triangle_stacks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <numeric>

#include "progress_stage.h"

namespace relief::detail {
namespace {

/// The positions of a triangle, ascending.
using Key = std::array<std::uint32_t, 3>;

class KeyBits {
  public:
    explicit KeyBits(std::size_t triangles)
        : shift_(64U - static_cast<unsigned>(
                           std::bit_width(std::max<std::size_t>(16 * triangles, 64) - 1))),
          words_(((std::size_t(1) << (64U - shift_)) + 63) / 64, 0) {}

    /// \return whether the bit of the key was set before
    bool set(const Key& key) {
        const std::uint64_t at = index(key);
        const std::uint64_t bit = std::uint64_t(1) << (at % 64);
        const bool was_set = (words_[at / 64] & bit) != 0;
        words_[at / 64] |= bit;
        return was_set;
    }
    [[nodiscard]] bool has(const Key& key) const {
        const std::uint64_t at = index(key);
        return (words_[at / 64] >> (at % 64) & 1U) != 0;
    }

  private:
    [[nodiscard]] std::uint64_t index(const Key& key) const {
        std::uint64_t hash = key[0] * 0x9E3779B97F4A7C15ULL;
        hash = (hash ^ (hash >> 32) ^ key[1]) * 0xBF58476D1CE4E5B9ULL;
        hash = (hash ^ (hash >> 29) ^ key[2]) * 0x94D049BB133111EBULL;
        return hash >> shift_;
    }

    unsigned shift_;
    std::vector<std::uint64_t> words_;
};

}  // namespace

std::vector<std::uint32_t> triangle_stacks(TriangleSpan triangles,
                                           std::span<const std::uint32_t> classes) {
    const auto key_of = [&](std::size_t triangle) {
        const glm::uvec3& t = triangles[triangle];
        Key key = {t.x, t.y, t.z};
        if (!classes.empty()) key = {classes[t.x], classes[t.y], classes[t.z]};
        if (key[0] > key[1]) std::swap(key[0], key[1]);
        if (key[1] > key[2]) std::swap(key[1], key[2]);
        if (key[0] > key[1]) std::swap(key[0], key[1]);
        return key;
    };
    KeyBits seen(triangles.size());
    KeyBits seen_twice(triangles.size());
    bool has_candidates = false;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        check_cancelled(t);
        const Key key = key_of(t);
        if (!seen.set(key)) continue;
        seen_twice.set(key);
        has_candidates = true;
    }
    if (!has_candidates) return {};
    struct Candidate {
        Key key;
        std::uint32_t triangle;
        auto operator<=>(const Candidate&) const = default;
    };
    std::vector<Candidate> candidates;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        check_cancelled(t);
        const Key key = key_of(t);
        if (seen_twice.has(key)) candidates.push_back({key, static_cast<std::uint32_t>(t)});
    }
    std::sort(candidates.begin(), candidates.end());
    std::vector<std::uint32_t> stacks;
    for (std::size_t i = 1, first = 0; i < candidates.size(); ++i) {
        if (candidates[i].key != candidates[first].key) {
            first = i;
            continue;
        }
        if (stacks.empty()) {
            stacks.resize(triangles.size());
            std::iota(stacks.begin(), stacks.end(), 0U);
        }
        stacks[candidates[i].triangle] = candidates[first].triangle;
    }
    return stacks;
}

}  // namespace relief::detail

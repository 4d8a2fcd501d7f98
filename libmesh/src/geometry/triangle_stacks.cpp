// SPDX-License-Identifier: Apache-2.0
// Most meshes have no stacks, so a bit for each hash of a triangle at its lowest position finds the
// candidates first, about one in thirty triangles; only these are sorted.
#include "geometry/triangle_stacks.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

#include "progress_stage.h"

namespace relief::detail {
namespace {

/// The positions of a triangle, ascending.
using Key = std::array<std::uint32_t, 3>;

/// A set of keys that can report keys that it does not have: 64 bits for each lowest position. The
/// triangles of a mesh are mostly in an order in which these are close to each other in memory.
class KeyBits {
  public:
    explicit KeyBits(std::size_t positions) : words_(positions, 0) {}

    /// \return whether the bit of the key was set before
    bool set(const Key& key) {
        std::uint64_t& word = words_[key[0]];
        const bool was_set = (word & bit(key)) != 0;
        word |= bit(key);
        return was_set;
    }
    [[nodiscard]] bool has(const Key& key) const { return (words_[key[0]] & bit(key)) != 0; }

  private:
    static std::uint64_t bit(const Key& key) {
        std::uint64_t hash = key[1] * 0xBF58476D1CE4E5B9ULL;
        hash = (hash ^ (hash >> 29) ^ key[2]) * 0x94D049BB133111EBULL;
        return std::uint64_t{1} << (hash >> 58U);
    }

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
    std::size_t positions = classes.size();
    for (std::size_t t = 0; classes.empty() && t < triangles.size(); ++t)
        positions = std::max(positions, std::size_t{key_of(t)[2]} + 1);
    KeyBits seen(positions);
    KeyBits seen_twice(positions);
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

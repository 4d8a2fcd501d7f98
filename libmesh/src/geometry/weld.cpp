// SPDX-License-Identifier: Apache-2.0
// Exact welding uses open-addressed hash tables, one for each value of the hash's upper bits.
// Vertices enter them in ascending order, so the first vertex of a class, which stays in the table,
// has the smallest index.
//
// Welding with a tolerance uses a grid of cells so small that all vertices in one are near each
// other. A cell is joined as a whole, and two cells are joined at the first pair of near vertices.
// Cells are identified by integers in double, which are distinct as long as floats are.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "geometry/direction.h"
#include "geometry/weld.h"
#include "large_memory.h"
#include "parallel.h"
#include "portable_math.h"
#include "progress_stage.h"
#include "work_array.h"

namespace relief::detail {
namespace {

constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();

/// Returns a hash that is equal for equal keys: adding +0 turns -0 into +0. Regular grids of floats
/// do not collide.
template <std::size_t N>
std::uint64_t hash_of(const std::array<float, N>& key) {
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < N; i += 2) {
        const std::uint64_t low = std::bit_cast<std::uint32_t>(key[i] + 0.0F);
        const std::uint64_t high = i + 1 < N ? std::bit_cast<std::uint32_t>(key[i + 1] + 0.0F) : 0U;
        hash = mixed_bits(hash + (low | high << 32) + split_mix_step);
    }
    return hash;
}

/// The same for keys that are equal if their bits are.
template <std::size_t N>
std::uint64_t hash_of(const std::array<std::uint32_t, N>& key) {
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < N; i += 2) {
        const std::uint64_t low = key[i];
        const std::uint64_t high = i + 1 < N ? key[i + 1] : 0U;
        hash = mixed_bits(hash + (low | high << 32) + split_mix_step);
    }
    return hash;
}

/// A vertex in the bucket of its hash.
struct BucketEntry {
    std::uint32_t hash;
    std::uint32_t vertex;
};

/// Vertices by the upper bits of their hashes, ascending within each bucket. Equal vertices are in
/// the same bucket, and the table of a bucket fits the cache.
class Buckets {
  public:
    /// \param hash_at  hash_at(i) returns the hash of vertex i
    template <typename HashAt>
    Buckets(std::size_t count, const HashAt& hash_at)
        : shift_(32 - std::min(max_bits, static_cast<int>(std::bit_width(count / usual_size)))),
          first_((std::size_t(1) << (32 - shift_)) + 1, 0),
          entries_(count) {
        // Each part of the vertices first counts its vertices in each bucket, which gives the
        // position of its entries.
        constexpr std::size_t worth_a_thread = 32768;
        const std::size_t parts =
            std::clamp<std::size_t>(count / worth_a_thread, 1, thread_count());
        WorkArray<std::uint32_t> hashes(count);
        std::vector<std::vector<std::size_t>> places(parts);
        const auto for_vertices = [&](const auto& body) {
            parallel_for(parts, 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t part = begin; part < end; ++part) {
                    const std::size_t last = count * (part + 1) / parts;
                    for (std::size_t i = count * part / parts; i < last; ++i) {
                        check_cancelled(i);
                        body(i, places[part]);
                    }
                }
            });
        };
        for (std::vector<std::size_t>& place : places)
            place.resize(this->count());
        for_vertices([&](std::size_t i, std::vector<std::size_t>& place) {
            hashes[i] = hash_at(i);
            ++place[bucket_of(hashes[i])];
        });
        std::size_t next = 0;
        for (std::size_t bucket = 0; bucket < this->count(); ++bucket) {
            first_[bucket] = next;
            for (std::vector<std::size_t>& place : places)
                next += std::exchange(place[bucket], next);
        }
        first_.back() = next;
        for_vertices([&](std::size_t i, std::vector<std::size_t>& place) {
            entries_[place[bucket_of(hashes[i])]++] = {hashes[i], static_cast<std::uint32_t>(i)};
        });
    }

    [[nodiscard]] std::size_t count() const { return first_.size() - 1; }
    [[nodiscard]] std::span<const BucketEntry> at(std::size_t bucket) const {
        return {entries_.data() + first_[bucket], first_[bucket + 1] - first_[bucket]};
    }

  private:
    static constexpr std::size_t usual_size = 4096;
    static constexpr int max_bits = 10;

    [[nodiscard]] std::size_t bucket_of(std::uint32_t hash) const {
        return shift_ == 32 ? 0 : hash >> shift_;
    }

    int shift_;
    std::vector<std::size_t> first_;
    WorkArray<BucketEntry> entries_;
};

/// \param key_of  key_of(i) returns the numbers of vertex i as an array
template <typename KeyOf>
std::vector<std::uint32_t> weld(std::size_t count, const KeyOf& key_of) {
    const Buckets buckets(count, [&](std::size_t i) {
        const auto key = key_of(i);
        // A NaN equals no other value; a hash of the index avoids collisions.
        return static_cast<std::uint32_t>(key == key ? hash_of(key) : mixed_bits(i + 1));
    });
    std::vector<std::uint32_t> representatives(count);
    std::iota(representatives.begin(), representatives.end(), 0U);
    parallel_for(buckets.count(), 4, [&](std::size_t begin, std::size_t end) {
        std::vector<BucketEntry> table;
        for (std::size_t b = begin; b < end; ++b) {
            const std::span<const BucketEntry> bucket = buckets.at(b);
            const std::size_t slots = std::bit_ceil(2 * bucket.size() + 1);
            table.assign(slots, {0, no_vertex});
            for (const BucketEntry& entry : bucket) {
                // Positions are far apart in memory, so they are compared only if hashes are equal.
                std::size_t slot = entry.hash & (slots - 1);
                while (table[slot].vertex != no_vertex &&
                       (table[slot].hash != entry.hash ||
                        key_of(table[slot].vertex) != key_of(entry.vertex)))
                    slot = (slot + 1) & (slots - 1);
                if (table[slot].vertex == no_vertex)
                    table[slot] = entry;
                else
                    representatives[entry.vertex] = table[slot].vertex;
            }
        }
    });
    return representatives;
}

}  // namespace

std::vector<std::uint32_t> weld_positions(StridedSpan<const glm::vec3> positions) {
    return weld(positions.size(), [&](std::size_t i) {
        const glm::vec3& p = positions[i];
        return std::array{p.x, p.y, p.z};
    });
}

std::vector<std::uint32_t> weld_vertices(StridedSpan<const glm::vec3> positions,
                                         StridedSpan<const glm::vec3> normals,
                                         StridedSpan<const glm::vec2> texcoords) {
    return weld(positions.size(), [&](std::size_t i) {
        const glm::vec3& p = positions[i];
        const glm::vec3& n = normals[i];
        const glm::vec2& t = texcoords[i];
        return std::array{p.x, p.y, p.z, n.x, n.y, n.z, t.x, t.y};
    });
}

template <typename Value>
std::vector<std::uint32_t> weld_bits(std::span<const Value> values) {
    using Bits = std::array<std::uint32_t, sizeof(Value) / sizeof(std::uint32_t)>;
    return weld(values.size(), [&](std::size_t i) { return std::bit_cast<Bits>(values[i]); });
}
// Instances for types of hidden namespaces are hidden unless they say otherwise.
template __attribute__((visibility("default"))) std::vector<std::uint32_t> weld_bits(
    std::span<const glm::vec2>);
template __attribute__((visibility("default"))) std::vector<std::uint32_t> weld_bits(
    std::span<const glm::vec3>);
template __attribute__((visibility("default"))) std::vector<std::uint32_t> weld_bits(
    std::span<const std::array<float, 7>>);

Groups groups_of(std::span<const std::uint32_t> representatives) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> shared;  // Representative, member.
    for (std::size_t i = 0; i < representatives.size(); ++i) {
        if (representatives[i] != i)
            shared.emplace_back(representatives[i], static_cast<std::uint32_t>(i));
    }
    if (shared.empty()) return {};
    std::sort(shared.begin(), shared.end());
    Groups groups;
    for (std::size_t i = 0; i < shared.size(); ++i) {
        if (i == 0 || shared[i].first != shared[i - 1].first) {
            groups.first.push_back(static_cast<std::uint32_t>(groups.members.size()));
            groups.members.push_back(shared[i].first);
        }
        groups.members.push_back(shared[i].second);
    }
    groups.first.push_back(static_cast<std::uint32_t>(groups.members.size()));
    return groups;
}

std::vector<glm::uvec3> welded_triangles(TriangleSpan triangles,
                                         std::span<const std::uint32_t> representatives) {
    std::vector<glm::uvec3> welded;
    reserve_to_fill(welded, triangles.size());
    welded.resize(triangles.size());
    weld_triangles(triangles, representatives, welded);
    return welded;
}

void weld_triangles(TriangleSpan triangles, std::span<const std::uint32_t> representatives,
                    std::span<glm::uvec3> welded) {
    parallel_for(triangles.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::uvec3 triangle = triangles[i];
            welded[i] = {representatives[triangle.x], representatives[triangle.y],
                         representatives[triangle.z]};
        }
    });
}

namespace {

using CellKey = std::array<double, 3>;

struct HashOfCell {
    std::size_t operator()(const CellKey& key) const {
        std::size_t hash = 0;
        for (const double number : key)
            hash = (hash ^ std::hash<double>{}(number)) * 0x9e3779b97f4a7c15ULL + (hash >> 31);
        return hash;
    }
};

/// Cells in the order of their first vertex, with their vertices.
struct Cells {
    std::unordered_map<CellKey, std::uint32_t, HashOfCell> index;
    std::vector<CellKey> keys;
    std::vector<std::vector<std::uint32_t>> vertices;
};

Cells cells_of(StridedSpan<const glm::vec3> positions, double size) {
    Cells cells;
    cells.index.reserve(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        check_cancelled(i);
        if (!is_finite(positions[i])) continue;
        CellKey key;
        for (std::size_t k = 0; k < 3; ++k)
            key[k] = std::floor(positions[i][static_cast<int>(k)] / size) + 0.0;
        const auto [found, is_new] =
            cells.index.try_emplace(key, static_cast<std::uint32_t>(cells.keys.size()));
        if (is_new) {
            cells.keys.push_back(key);
            cells.vertices.emplace_back();
        }
        cells.vertices[found->second].push_back(static_cast<std::uint32_t>(i));
    }
    return cells;
}

bool any_near(StridedSpan<const glm::vec3> positions, std::span<const std::uint32_t> some,
              std::span<const std::uint32_t> others, double tolerance) {
    return std::any_of(some.begin(), some.end(), [&](std::uint32_t a) {
        check_cancelled();
        return std::any_of(others.begin(), others.end(), [&](std::uint32_t b) {
            return glm::distance(glm::dvec3(positions[a]), glm::dvec3(positions[b])) <= tolerance;
        });
    });
}

/// Returns half of the neighboring cells within the tolerance, so that each pair is tested once.
std::vector<CellKey> offsets_onwards() {
    constexpr int reach = 2;  // The tolerance equals sqrt(3) cells.
    std::vector<CellKey> offsets;
    for (int x = -reach; x <= reach; ++x) {
        for (int y = -reach; y <= reach; ++y) {
            for (int z = -reach; z <= reach; ++z) {
                if (std::array{x, y, z} > std::array{0, 0, 0})
                    offsets.push_back({double(x), double(y), double(z)});
            }
        }
    }
    return offsets;
}

}  // namespace

std::vector<std::uint32_t> weld_near_positions(StridedSpan<const glm::vec3> positions,
                                               double tolerance) {
    // The cell is slightly smaller than tolerance / sqrt(3), so that rounding joins no vertices
    // beyond the tolerance.
    const double size = tolerance / 1.7320509;
    const Cells cells = cells_of(positions, size);
    DisjointSets sets(positions.size());
    for (const std::vector<std::uint32_t>& together : cells.vertices) {
        for (const std::uint32_t vertex : together)
            sets.join(together.front(), vertex);
    }
    const std::vector<CellKey> onwards = offsets_onwards();
    for (std::size_t c = 0; c < cells.keys.size(); ++c) {
        check_cancelled();
        const std::vector<std::uint32_t>& here = cells.vertices[c];
        for (const CellKey& step : onwards) {
            const CellKey& key = cells.keys[c];
            const auto there = cells.index.find(
                {key[0] + step[0] + 0.0, key[1] + step[1] + 0.0, key[2] + step[2] + 0.0});
            if (there == cells.index.end() || there->second == c) continue;
            const std::vector<std::uint32_t>& others = cells.vertices[there->second];
            if (sets.find(here.front()) == sets.find(others.front())) continue;
            if (any_near(positions, here, others, tolerance))
                sets.join(here.front(), others.front());
        }
    }
    std::vector<std::uint32_t> representatives(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        representatives[i] = sets.find(static_cast<std::uint32_t>(i));
    return representatives;
}

}  // namespace relief::detail

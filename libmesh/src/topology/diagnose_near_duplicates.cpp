// SPDX-License-Identifier: Apache-2.0
// Finds positions that are almost equal: cracks that exact welding leaves open.
//
// The tolerance of a position is 4 units in the last place of its largest coordinate. Two positions
// are near if every coordinate differs by no more than the larger tolerance. Positions are stored
// in cubic cells of 64 tolerances, in one grid for each binary exponent. A search looks into its
// own cell and, near a side of it, into the next one; near a power of two it also searches the
// adjacent grid.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "geometry/direction.h"
#include "parallel.h"
#include "topology/diagnose_parts.h"

namespace relief::detail {
namespace {

constexpr std::size_t members_per_task = 4096;
constexpr double cell_in_reaches = 64.0;

// Maximum number of positions per cell that a search tests. Valid meshes have one or two. Only
// details as fine as rounding have more, and then nearly all of them are near one of these.
constexpr std::size_t looked_at_most = 64;

constexpr int smallest_exponent = -126;

/// Returns 2 to the power of an exponent, for the range of floats and slightly beyond. The
/// functions of the C library would take most of the time.
double power_of_two(int exponent) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

float largest_coordinate(const glm::vec3& position) {
    return std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z)});
}

/// Returns the binary exponent of the largest coordinate. Subnormal numbers have the smallest.
int exponent_of(const glm::vec3& position) {
    const std::uint32_t biased = std::bit_cast<std::uint32_t>(largest_coordinate(position)) >> 23;
    return std::max(static_cast<int>(biased) - 127, smallest_exponent);
}

double reach_at(int exponent) {
    return power_of_two(exponent - 21);
}

struct PositionCell {
    int exponent;
    std::array<std::int64_t, 3> place;
};

/// Cells per unit of length; a power of two, so that the division is exact.
double cells_by_length(int exponent) {
    return power_of_two(21 - exponent) / cell_in_reaches;
}

/// Floor; coordinates are below 2^18 cells.
std::int64_t place_of(double coordinate, double cells) {
    const double place = coordinate * cells;
    const auto towards_zero = static_cast<std::int64_t>(place);
    return towards_zero - (place < static_cast<double>(towards_zero) ? 1 : 0);
}

PositionCell cell_of(const glm::vec3& position, int exponent) {
    const double cells = cells_by_length(exponent);
    return {
        exponent,
        {place_of(position.x, cells), place_of(position.y, cells), place_of(position.z, cells)}};
}

/// Returns a multiplicative hash of a cell; its upper bits are well mixed.
std::uint64_t hash_of(const PositionCell& cell) {
    constexpr std::uint64_t odd = 0x9e3779b97f4a7c15ULL;
    auto hash = static_cast<std::uint64_t>(cell.exponent - smallest_exponent);
    for (const std::int64_t place : cell.place)
        hash = (std::rotl(hash, 23) ^ static_cast<std::uint64_t>(place)) * odd;
    return hash;
}

/// Positions of every cell: buckets of a hash table, each a range of one array.
class PositionGrid {
  public:
    PositionGrid(std::span<const glm::vec3> positions, std::span<const std::uint32_t> members)
        : positions_(positions),
          shift_(64 - static_cast<int>(std::bit_width(members.size() | 1U))) {
        std::vector<std::uint32_t> buckets(members.size());
        first_.assign((std::size_t{1} << (64 - shift_)) + 1, 0);
        parallel_for(members.size(), members_per_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const glm::vec3& position = positions[members[i]];
                buckets[i] = bucket_of(cell_of(position, exponent_of(position)));
            }
        });
        for (const std::uint32_t bucket : buckets)
            ++first_[bucket + 1];
        for (std::size_t i = 1; i < first_.size(); ++i)
            first_[i] += first_[i - 1];
        std::vector<std::uint32_t> end(first_.begin(), first_.end() - 1);
        members_.resize(members.size());
        for (std::size_t i = 0; i < members.size(); ++i)
            members_[end[buckets[i]]++] = members[i];
    }

    /// Tests whether another position in this cell is near `vertex`.
    [[nodiscard]] bool has_near(const PositionCell& cell, std::uint32_t vertex,
                                double reach) const {
        const std::uint32_t bucket = bucket_of(cell);
        std::size_t analyzed = 0;
        for (std::uint32_t i = first_[bucket]; i < first_[bucket + 1]; ++i) {
            if (members_[i] == vertex) continue;
            const glm::vec3& other = positions_[members_[i]];
            if (++analyzed > looked_at_most) return false;
            if (exponent_of(other) != cell.exponent) continue;
            const glm::dvec3 apart = glm::abs(glm::dvec3(other) - glm::dvec3(positions_[vertex]));
            if (std::max({apart.x, apart.y, apart.z}) <= reach) return true;
        }
        return false;
    }

  private:
    [[nodiscard]] std::uint32_t bucket_of(const PositionCell& cell) const {
        return static_cast<std::uint32_t>(hash_of(cell) >> shift_);
    }

    std::span<const glm::vec3> positions_;
    int shift_;
    std::vector<std::uint32_t> first_;
    std::vector<std::uint32_t> members_;
};

/// Searches all cells of one exponent within the tolerance.
bool near_among(const PositionGrid& grid, const glm::vec3& position, std::uint32_t vertex,
                int exponent, double reach) {
    const double cells = cells_by_length(exponent);
    std::array<std::int64_t, 3> low{};
    std::array<std::int64_t, 3> high{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double coordinate = position[static_cast<int>(i)];
        low[i] = place_of(coordinate - reach, cells);
        high[i] = place_of(coordinate + reach, cells);
    }
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
        for (std::int64_t y = low[1]; y <= high[1]; ++y) {
            for (std::int64_t z = low[2]; z <= high[2]; ++z) {
                if (grid.has_near({exponent, {x, y, z}}, vertex, reach)) return true;
            }
        }
    }
    return false;
}

bool is_near_another(const PositionGrid& grid, const glm::vec3& position, std::uint32_t vertex) {
    const int exponent = exponent_of(position);
    const double reach = reach_at(exponent);
    if (near_among(grid, position, vertex, exponent, reach)) return true;
    const double largest = largest_coordinate(position);
    const double power = power_of_two(exponent);
    if (exponent > smallest_exponent && largest - reach < power &&
        near_among(grid, position, vertex, exponent - 1, reach))
        return true;
    // Beyond the next power of two, the tolerance of the other position counts, which is twice as
    // large.
    return largest + 2.0 * reach >= 2.0 * power &&
           near_among(grid, position, vertex, exponent + 1, 2.0 * reach);
}

}  // namespace

void diagnose_near_duplicates(const DiagnosedMesh& diagnosed, Tally& tally) {
    const std::span<const glm::vec3> positions(diagnosed.mesh.positions);
    std::vector<std::uint32_t> members;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (diagnosed.classes[v] == v && is_finite(positions[v]))
            members.push_back(static_cast<std::uint32_t>(v));
    }
    const PositionGrid grid(positions, members);
    std::vector<std::uint8_t> is_near(members.size(), 0);
    parallel_for(members.size(), members_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            is_near[i] = is_near_another(grid, positions[members[i]], members[i]) ? 1 : 0;
    });
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (is_near[i] != 0) tally.add(MeshCondition::vertex_near_duplicate, members[i]);
    }
}

}  // namespace relief::detail

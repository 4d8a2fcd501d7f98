// SPDX-License-Identifier: Apache-2.0
// Triangles within a tolerance of each other, found by their centroids in a hashed grid. Where all
// corners are within the tolerance, so are the centroids: with cells that are wider, eight of them
// at most, and two on average, hold every candidate. Each triangle of b asks for its nearest of a;
// of several that ask for the same one the nearest gets it, and the others ask again. Object space,
// computed in double.
// Tests: tests/mesh/geometry/compare/compare_test.cpp.
#include "geometry/compare/corner_match_near.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "geometry/direction.h"
#include "parallel.h"

namespace relief {
namespace {

constexpr std::size_t near_match_grain = 1024;
constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t most_in_a_cell = 256;
constexpr double radii_in_a_cell = 8.0;
constexpr int most_match_rounds = 32;  // Few are left after three, but for crowds.
constexpr double narrowing = 8.0;
constexpr std::size_t most_tolerances = 10;

using CentroidCell = glm::dvec3;  // Whole numbers, which may be larger than integers hold.

glm::dvec3 centroid(const Mesh& mesh, std::uint32_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    return (glm::dvec3(mesh.positions[t.x]) + glm::dvec3(mesh.positions[t.y]) +
            glm::dvec3(mesh.positions[t.z])) /
           3.0;
}

std::size_t hash_of(const CentroidCell& cell) {
    std::uint64_t hash = 0;
    for (int i = 0; i < 3; ++i) {
        // Of whole numbers only the upper bits are set: they are brought down first.
        hash += std::bit_cast<std::uint64_t>(cell[i] + 0.0);
        hash = (hash ^ hash >> 32) * 0x9e3779b97f4a7c15ULL;
        hash = (hash ^ hash >> 29) * 0xbf58476d1ce4e5b9ULL;
        hash ^= hash >> 32;
    }
    return hash;
}

/// Triangles of one mesh by the cell of their centroid.
class CentroidGrid {
  public:
    CentroidGrid(const Mesh& mesh, std::span<const std::uint32_t> triangles, double cell_size)
        : cell_size_(cell_size),
          heads_(std::bit_ceil(2 * triangles.size() + 1), nobody),
          next_(triangles.size(), nobody),
          hashes_(triangles.size()) {
        std::vector<std::uint32_t> sizes(heads_.size(), 0);
        for (std::size_t i = triangles.size(); i-- > 0;) {
            const glm::dvec3 at = centroid(mesh, triangles[i]);
            if (!is_finite(at)) continue;
            hashes_[i] = hash_of(glm::floor(at / cell_size));
            std::uint32_t& head = heads_[slot(hashes_[i])];
            next_[i] = head;
            head = static_cast<std::uint32_t>(i);
            is_crowded_ = ++sizes[slot(hashes_[i])] > most_in_a_cell || is_crowded_;
        }
    }

    /// Not all triangles of some cell are looked at.
    [[nodiscard]] bool is_crowded() const { return is_crowded_; }

    /// Calls visit(i) for the triangles in the cells that a box touches, and for some others.
    template <typename Visit>
    void near(const glm::dvec3& at, double radius, const Visit& visit) const {
        const CentroidCell low = glm::floor((at - radius) / cell_size_);
        const CentroidCell high = glm::floor((at + radius) / cell_size_);
        for (int corner = 0; corner < 8; ++corner) {
            CentroidCell cell = low;
            bool is_new = true;
            for (int i = 0; i < 3; ++i) {
                if ((corner >> i & 1) == 0) continue;
                is_new = is_new && high[i] != low[i];
                cell[i] = high[i];
            }
            if (is_new) visit_cell(hash_of(cell), visit);
        }
    }

  private:
    [[nodiscard]] std::size_t slot(std::size_t hash) const { return hash & (heads_.size() - 1); }

    template <typename Visit>
    void visit_cell(std::size_t hash, const Visit& visit) const {
        std::size_t seen = 0;
        for (std::uint32_t i = heads_[slot(hash)]; i != nobody; i = next_[i]) {
            if (hashes_[i] != hash) continue;
            visit(i);
            if (++seen == most_in_a_cell) return;
        }
    }

    double cell_size_;
    std::vector<std::uint32_t> heads_;
    std::vector<std::uint32_t> next_;
    std::vector<std::size_t> hashes_;  ///< Of their cells.
    bool is_crowded_ = false;
};

/// How far two triangles are apart, in tolerances; infinite if they do not match.
double cost_of(const Mesh& a, const glm::uvec3& ta, const Mesh& b, const glm::uvec3& tb, int turn,
               const MatchOptions& options) {
    constexpr double never = std::numeric_limits<double>::infinity();
    double cost = 0.0;
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t va = ta[k];
        const std::uint32_t vb = tb[(k + turn) % 3];
        const double apart = glm::length(glm::dvec3(a.positions[va]) - glm::dvec3(b.positions[vb]));
        if (!(apart <= options.position_tolerance)) return never;
        if (apart > 0.0) cost += apart / options.position_tolerance;
        if (!options.by_texcoord) continue;
        const glm::dvec2 off = glm::abs(glm::dvec2(a.texcoords[va]) - glm::dvec2(b.texcoords[vb]));
        const double texcoord_apart = std::max(off.x, off.y);
        if (!(texcoord_apart <= options.texcoord_tolerance) || std::isnan(off.y)) return never;
        if (texcoord_apart > 0.0) cost += texcoord_apart / options.texcoord_tolerance;
    }
    return cost;
}

/// What a triangle of b asks for.
struct Wish {
    std::uint32_t a = nobody;  ///< Index into the triangles of a that are left.
    int turn = 0;
    double cost = std::numeric_limits<double>::infinity();
    std::uint32_t choices = 0;
};

/// A different order for everyone who asks, so that not all of a crowd ask for the same.
std::uint32_t preference(std::uint32_t a, std::uint32_t b) {
    std::uint32_t hash = (a * 0x9e3779b1U) ^ (b * 0x85ebca77U);
    hash = (hash ^ hash >> 15) * 0x2c1b3c6dU;
    return hash ^ hash >> 13;
}

class NearPairing {
  public:
    NearPairing(const Mesh& a, const Mesh& b, std::span<const std::uint32_t> left_a,
                std::span<const std::uint32_t> left_b, const MatchOptions& options)
        : a_(a),
          b_(b),
          left_a_(left_a),
          left_b_(left_b),
          options_(options),
          radius_(std::max(options.position_tolerance, rounding())),
          grid_(a, left_a, radii_in_a_cell * radius_),
          is_taken_(left_a.size(), 0) {}

    [[nodiscard]] bool is_crowded() const { return grid_.is_crowded(); }

    std::vector<NearPair> run() {
        std::vector<std::uint32_t> asking(left_b_.size());
        for (std::uint32_t i = 0; i < asking.size(); ++i)
            asking[i] = i;
        for (int i = 0; i < most_match_rounds && !asking.empty(); ++i)
            asking = round(asking);
        return std::move(pairs_);
    }

  private:
    /// Of a centroid, whose sum depends on which corner comes first.
    [[nodiscard]] double rounding() const {
        double largest = 0.0;
        for (const glm::vec3& p : a_.positions) {
            if (!is_finite(p)) continue;
            largest =
                std::max({largest, std::abs(static_cast<double>(p.x)),
                          std::abs(static_cast<double>(p.y)), std::abs(static_cast<double>(p.z))});
        }
        return std::max(largest * 1e-15, std::numeric_limits<double>::min());
    }

    [[nodiscard]] Wish wish_of(std::uint32_t triangle) const {
        Wish wish;
        const glm::dvec3 at = centroid(b_, triangle);
        if (!is_finite(at)) return wish;
        grid_.near(at, radius_, [&](std::uint32_t i) {
            if (is_taken_[i] != 0) return;
            Wish candidate{i};
            for (int turn = 0; turn < 3; ++turn) {
                const double cost = cost_of(a_, a_.triangles[left_a_[i]], b_,
                                            b_.triangles[triangle], turn, options_);
                if (cost < candidate.cost) candidate = {i, turn, cost};
            }
            if (!std::isfinite(candidate.cost)) return;
            const std::uint32_t choices = wish.choices + 1;
            if (candidate.cost < wish.cost ||
                (candidate.cost == wish.cost &&
                 preference(i, triangle) < preference(wish.a, triangle)))
                wish = candidate;
            wish.choices = choices;
        });
        return wish;
    }

    /// Grants what it can. \return those who have to ask again
    std::vector<std::uint32_t> round(const std::vector<std::uint32_t>& asking) {
        std::vector<Wish> wishes(asking.size());
        parallel_for(asking.size(), near_match_grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                wishes[i] = wish_of(left_b_[asking[i]]);
        });
        std::vector<std::uint32_t> nearest(left_a_.size(), nobody);
        for (std::uint32_t i = 0; i < wishes.size(); ++i) {
            if (wishes[i].a == nobody) continue;
            std::uint32_t& first = nearest[wishes[i].a];
            if (first == nobody || wishes[i].cost < wishes[first].cost) first = i;
        }
        std::vector<std::uint32_t> again;
        for (std::uint32_t i = 0; i < wishes.size(); ++i) {
            const Wish& wish = wishes[i];
            if (wish.a == nobody) continue;
            if (nearest[wish.a] != i) {
                again.push_back(asking[i]);
                continue;
            }
            is_taken_[wish.a] = 1;
            pairs_.push_back({left_a_[wish.a], left_b_[asking[i]], wish.turn, wish.choices > 1});
        }
        return again;
    }

    const Mesh& a_;
    const Mesh& b_;
    std::span<const std::uint32_t> left_a_;
    std::span<const std::uint32_t> left_b_;
    MatchOptions options_;
    double radius_;
    CentroidGrid grid_;
    std::vector<unsigned char> is_taken_;
    std::vector<NearPair> pairs_;
};

/// The tolerance of positions, and before it, where triangles crowd within it, narrower ones until
/// they do not: whoever has a partner near by then is paired before cells are too full to look at
/// all that is in them. Where they crowd however narrow it is, that would be of no use.
std::vector<double> rising_tolerances(const Mesh& a, const Mesh& b,
                                      std::span<const std::uint32_t> left_a,
                                      std::span<const std::uint32_t> left_b, MatchOptions options) {
    std::vector<double> tolerances = {options.position_tolerance};
    while (NearPairing(a, b, left_a, left_b, options).is_crowded()) {
        if (tolerances.size() == most_tolerances) return {tolerances.front()};
        options.position_tolerance /= narrowing;
        tolerances.push_back(options.position_tolerance);
    }
    std::reverse(tolerances.begin(), tolerances.end());
    return tolerances;
}

/// Takes out those that have been paired.
void drop_paired(std::vector<std::uint32_t>& left, const std::vector<NearPair>& pairs,
                 std::uint32_t NearPair::*triangle) {
    std::vector<std::uint32_t> paired;
    for (const NearPair& pair : pairs)
        paired.push_back(pair.*triangle);
    std::sort(paired.begin(), paired.end());
    std::erase_if(
        left, [&](std::uint32_t t) { return std::binary_search(paired.begin(), paired.end(), t); });
}

}  // namespace

std::vector<NearPair> pair_near(const Mesh& a, const Mesh& b, std::span<const std::uint32_t> left_a,
                                std::span<const std::uint32_t> left_b,
                                const MatchOptions& options) {
    if (left_a.empty() || left_b.empty()) return {};
    NearPairing whole(a, b, left_a, left_b, options);
    if (!whole.is_crowded()) return whole.run();
    std::vector<std::uint32_t> rest_a(left_a.begin(), left_a.end());
    std::vector<std::uint32_t> rest_b(left_b.begin(), left_b.end());
    std::vector<NearPair> all;
    MatchOptions within = options;
    for (const double tolerance : rising_tolerances(a, b, left_a, left_b, options)) {
        if (rest_a.empty() || rest_b.empty()) break;
        within.position_tolerance = tolerance;
        const std::vector<NearPair> pairs = NearPairing(a, b, rest_a, rest_b, within).run();
        all.insert(all.end(), pairs.begin(), pairs.end());
        drop_paired(rest_a, pairs, &NearPair::a);
        drop_paired(rest_b, pairs, &NearPair::b);
    }
    return all;
}

}  // namespace relief

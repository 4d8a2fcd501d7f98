// SPDX-License-Identifier: Apache-2.0
// Matches the triangles of two meshes, and compares the normals and tangents at matched corners, in
// degrees. Object space, computed in double precision, directions of any length. Undefined
// directions give NaN and count as undefined.
//
// Exact matching: vertices of both meshes are welded by position and texture coordinate. Each
// triangle is rotated so that its smallest vertex comes first, and triangles are grouped by that
// vertex. The time is linear except for sorting around a vertex. Ambiguities are resolved by
// material range and by value, never by the order of triangles.
//
// Matching within a tolerance, for the remaining triangles: a hashed grid holds centroids. If all
// corners are within the tolerance, the centroids are too, so at most eight cells (two on average)
// hold every candidate. Each triangle of b requests its nearest triangle of a. If several request
// the same one, the nearest wins, and the others request again.
#include "relief/mesh/compare.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "geometry/corners.h"
#include "geometry/direction.h"
#include "geometry/weld.h"
#include "parallel.h"
#include "relief/mesh/statistics.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Match of a triangle of a: the first corner of a's triangle is corner `turn` of b's.
struct NearPair {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    int turn = 0;
    bool is_ambiguous = false;  ///< b's triangle was within the tolerance of several.
};

constexpr std::size_t requests_per_piece = 1024;
constexpr std::uint32_t no_triangle = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t max_in_cell = 256;
constexpr double radii_in_a_cell = 8.0;
// Few triangles remain after three rounds, except in clusters.
constexpr int max_rounds = 32;
constexpr double narrowing = 8.0;
constexpr std::size_t max_tolerances = 10;

// Integers stored in double, because they may exceed the range of integer types.
using CentroidCell = glm::dvec3;

glm::dvec3 centroid(const Mesh& mesh, std::uint32_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    return (glm::dvec3(mesh.positions[t.x]) + glm::dvec3(mesh.positions[t.y]) +
            glm::dvec3(mesh.positions[t.z])) /
           3.0;
}

std::size_t hash_of(const CentroidCell& cell) {
    std::uint64_t hash = 0;
    for (int i = 0; i < 3; ++i) {
        // Only the upper bits of such numbers are set, so they are shifted down first.
        hash += std::bit_cast<std::uint64_t>(cell[i] + 0.0);
        hash = (hash ^ hash >> 32) * 0x9e3779b97f4a7c15ULL;
        hash = (hash ^ hash >> 29) * 0xbf58476d1ce4e5b9ULL;
        hash ^= hash >> 32;
    }
    return hash;
}

/// Triangles of one mesh, by the cell of their centroid.
class CentroidGrid {
  public:
    CentroidGrid(const Mesh& mesh, std::span<const std::uint32_t> triangles, double cell_size)
        : cell_size_(cell_size),
          heads_(std::bit_ceil(2 * triangles.size() + 1), no_triangle),
          next_(triangles.size(), no_triangle),
          hashes_(triangles.size()) {
        std::vector<std::uint32_t> sizes(heads_.size(), 0);
        for (std::size_t i = triangles.size(); i-- > 0;) {
            const glm::dvec3 at = centroid(mesh, triangles[i]);
            if (!is_finite(at)) continue;
            hashes_[i] = hash_of(glm::floor(at / cell_size));
            std::uint32_t& head = heads_[slot(hashes_[i])];
            next_[i] = head;
            head = static_cast<std::uint32_t>(i);
            is_crowded_ = ++sizes[slot(hashes_[i])] > max_in_cell || is_crowded_;
        }
    }

    /// Returns whether a search skips triangles of a crowded cell.
    [[nodiscard]] bool is_crowded() const { return is_crowded_; }

    /// Calls visit(i) for the triangles in the cells that a box touches, and possibly for others.
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
        for (std::uint32_t i = heads_[slot(hash)]; i != no_triangle; i = next_[i]) {
            if (hashes_[i] != hash) continue;
            visit(i);
            if (++seen == max_in_cell) return;
        }
    }

    double cell_size_;
    std::vector<std::uint32_t> heads_;
    std::vector<std::uint32_t> next_;
    std::vector<std::size_t> hashes_;  ///< Hashes of their cells.
    bool is_crowded_ = false;
};

/// Returns the distance of two triangles in tolerances; infinite if they do not match.
double nominal_cost(const Mesh& a, const glm::uvec3& ta, const Mesh& b, const glm::uvec3& tb,
                    int turn, const MatchOptions& options) {
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

/// Request of a triangle of b.
struct MethodRequest {
    std::uint32_t a = no_triangle;  ///< Index into the remaining triangles of a.
    int turn = 0;
    double cost = std::numeric_limits<double>::infinity();
    std::uint32_t choices = 0;
};

/// A different order for each request, so that triangles in a cluster do not all request the same
/// one.
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
        for (int i = 0; i < max_rounds && !asking.empty(); ++i)
            asking = round(asking);
        return std::move(pairs_);
    }

  private:
    /// Bound of the rounding error of a centroid, which depends on the first corner.
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

    [[nodiscard]] MethodRequest request_of(std::uint32_t triangle) const {
        MethodRequest request;
        const glm::dvec3 at = centroid(b_, triangle);
        if (!is_finite(at)) return request;
        grid_.near(at, radius_, [&](std::uint32_t i) {
            if (is_taken_[i] != 0) return;
            MethodRequest candidate{i};
            for (int turn = 0; turn < 3; ++turn) {
                const double cost = nominal_cost(a_, a_.triangles[left_a_[i]], b_,
                                                 b_.triangles[triangle], turn, options_);
                if (cost < candidate.cost) candidate = {i, turn, cost};
            }
            if (!std::isfinite(candidate.cost)) return;
            const std::uint32_t choices = request.choices + 1;
            if (candidate.cost < request.cost ||
                (candidate.cost == request.cost &&
                 preference(i, triangle) < preference(request.a, triangle)))
                request = candidate;
            request.choices = choices;
        });
        return request;
    }

    /// Grants requests. \return the triangles that must request again
    std::vector<std::uint32_t> round(const std::vector<std::uint32_t>& asking) {
        std::vector<MethodRequest> requests(asking.size());
        parallel_for(asking.size(), requests_per_piece, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                requests[i] = request_of(left_b_[asking[i]]);
        });
        std::vector<std::uint32_t> nearest(left_a_.size(), no_triangle);
        for (std::uint32_t i = 0; i < requests.size(); ++i) {
            if (requests[i].a == no_triangle) continue;
            std::uint32_t& first = nearest[requests[i].a];
            if (first == no_triangle || requests[i].cost < requests[first].cost) first = i;
        }
        std::vector<std::uint32_t> again;
        for (std::uint32_t i = 0; i < requests.size(); ++i) {
            const MethodRequest& request = requests[i];
            if (request.a == no_triangle) continue;
            if (nearest[request.a] != i) {
                again.push_back(asking[i]);
                continue;
            }
            is_taken_[request.a] = 1;
            pairs_.push_back(
                {left_a_[request.a], left_b_[asking[i]], request.turn, request.choices > 1});
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

/// The tolerances to use: the tolerance of positions, and before it narrower ones if triangles
/// cluster within it, so that most triangles are matched before cells become crowded. Narrower
/// tolerances are useless if triangles cluster at any scale.
std::vector<double> rising_tolerances(const Mesh& a, const Mesh& b,
                                      std::span<const std::uint32_t> left_a,
                                      std::span<const std::uint32_t> left_b, MatchOptions options) {
    std::vector<double> tolerances = {options.position_tolerance};
    while (NearPairing(a, b, left_a, left_b, options).is_crowded()) {
        if (tolerances.size() == max_tolerances) return {tolerances.front()};
        options.position_tolerance /= narrowing;
        tolerances.push_back(options.position_tolerance);
    }
    std::reverse(tolerances.begin(), tolerances.end());
    return tolerances;
}

/// Removes matched triangles.
void drop_paired(std::vector<std::uint32_t>& left, const std::vector<NearPair>& pairs,
                 std::uint32_t NearPair::*triangle) {
    std::vector<std::uint32_t> paired;
    for (const NearPair& pair : pairs)
        paired.push_back(pair.*triangle);
    std::sort(paired.begin(), paired.end());
    std::erase_if(
        left, [&](std::uint32_t t) { return std::binary_search(paired.begin(), paired.end(), t); });
}

/// Matches nearest triangles first, each triangle once. Triangles with a non-finite corner match
/// none.
///
/// \param left_a, left_b  the triangles to match
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

/// A triangle rotated so that the corner with the smallest index comes first.
struct Turned {
    glm::uvec3 key{0};
    int turn = 0;  ///< Index of that corner.
};

Turned turned(const glm::uvec3& t) {
    const auto rotated = [&](int turn) {
        return std::array{t[turn], t[(turn + 1) % 3], t[(turn + 2) % 3]};
    };
    int best = 0;
    for (int turn = 1; turn < 3; ++turn) {
        if (rotated(turn) < rotated(best)) best = turn;
    }
    const auto key = rotated(best);
    return {{key[0], key[1], key[2]}, best};
}

/// Returns the material range of each triangle.
std::vector<std::uint32_t> ranges_of(const Mesh& mesh) {
    std::vector<std::uint32_t> ranges(mesh.triangles.size(), 0);
    for (std::uint32_t i = 0; i < mesh.material_ranges.size(); ++i) {
        const MaterialRange& range = mesh.material_ranges[i];
        std::fill_n(ranges.begin() + range.first_triangle, range.triangle_count, i);
    }
    return ranges;
}

/// Triangles of both meshes with common indices for equal vertices.
struct Joined {
    std::vector<Turned> triangles;  ///< Triangles of a, followed by triangles of b.
    std::size_t vertex_count = 0;
    std::size_t count_a = 0;
};

Joined joined(const Mesh& a, const Mesh& b, bool by_texcoord) {
    std::vector<glm::vec3> positions = a.positions;
    positions.insert(positions.end(), b.positions.begin(), b.positions.end());
    std::vector<std::uint32_t> same;
    if (by_texcoord) {
        std::vector<glm::vec2> texcoords = a.texcoords;
        texcoords.insert(texcoords.end(), b.texcoords.begin(), b.texcoords.end());
        const std::vector<glm::vec3> no_normals(positions.size(), glm::vec3(0.0F));
        same = weld_vertices(positions, no_normals, texcoords);
    } else {
        same = weld_positions(positions);
    }
    Joined result;
    result.vertex_count = positions.size();
    result.count_a = a.triangles.size();
    result.triangles.resize(a.triangles.size() + b.triangles.size());
    const auto offset = static_cast<std::uint32_t>(a.positions.size());
    parallel_for(result.triangles.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::uvec3 t =
                i < result.count_a ? a.triangles[i] : b.triangles[i - result.count_a] + offset;
            result.triangles[i] = turned({same[t.x], same[t.y], same[t.z]});
        }
    });
    return result;
}

/// Triangles grouped by the first vertex of their key, in ascending order.
struct ByVertex {
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> triangles;

    explicit ByVertex(const Joined& all)
        : first(all.vertex_count + 1, 0), triangles(all.triangles.size()) {
        for (const Turned& t : all.triangles)
            ++first[t.key.x + 1];
        std::partial_sum(first.begin(), first.end(), first.begin());
        std::vector<std::uint32_t> end(first.begin(), first.end() - 1);
        for (std::uint32_t i = 0; i < all.triangles.size(); ++i)
            triangles[end[all.triangles[i].key.x]++] = i;
    }
};

class ExactPairing {
  public:
    ExactPairing(const Mesh& a, const Mesh& b, const Joined& all)
        : a_(a),
          b_(b),
          all_(all),
          ranges_a_(ranges_of(a)),
          ranges_b_(ranges_of(b)),
          partner_(all.count_a, no_corner_matched),
          is_ambiguous_(all.count_a, 0) {}

    void run() {
        ByVertex around(all_);
        parallel_for(all_.vertex_count, 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                pair_at({around.triangles.data() + around.first[v],
                         around.triangles.data() + around.first[v + 1]});
            }
        });
    }

    /// For each triangle of a, the triangle of b, or no_corner_matched.
    [[nodiscard]] const std::vector<std::uint32_t>& partners() const { return partner_; }
    [[nodiscard]] const std::vector<unsigned char>& ambiguous() const { return is_ambiguous_; }

  private:
    [[nodiscard]] bool is_of_a(std::uint32_t i) const { return i < all_.count_a; }
    [[nodiscard]] std::uint32_t range_of(std::uint32_t i) const {
        return is_of_a(i) ? ranges_a_[i] : ranges_b_[i - all_.count_a];
    }

    /// Normals and tangents at the corners, starting at the first corner of the key, with infinity
    /// instead of NaN, which has no order.
    [[nodiscard]] std::array<float, 21> values_of(std::uint32_t i) const {
        const Mesh& mesh = is_of_a(i) ? a_ : b_;
        const glm::uvec3& t = mesh.triangles[is_of_a(i) ? i : i - all_.count_a];
        std::array<float, 21> values{};
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = t[(all_.triangles[i].turn + k) % 3];
            for (int n = 0; n < 3 && !mesh.normals.empty(); ++n)
                values[static_cast<std::size_t>(7 * k + n)] = mesh.normals[v][n];
            for (int n = 0; n < 4 && !mesh.tangents.empty(); ++n)
                values[static_cast<std::size_t>(7 * k + 3 + n)] = mesh.tangents[v][n];
        }
        for (float& value : values) {
            if (std::isnan(value)) value = std::numeric_limits<float>::infinity();
        }
        return values;
    }

    void pair_at(std::span<std::uint32_t> triangles) {
        const auto key_of = [&](std::uint32_t i) {
            const glm::uvec3& key = all_.triangles[i].key;
            return std::tuple(key.y, key.z, i);
        };
        std::sort(triangles.begin(), triangles.end(),
                  [&](std::uint32_t p, std::uint32_t q) { return key_of(p) < key_of(q); });
        for (std::size_t begin = 0; begin < triangles.size();) {
            std::size_t end = begin + 1;
            const glm::uvec3& key = all_.triangles[triangles[begin]].key;
            while (end < triangles.size() && all_.triangles[triangles[end]].key == key)
                ++end;
            pair_equal(triangles.subspan(begin, end - begin));
            begin = end;
        }
    }

    /// Triangles with the same corners, those of a first.
    void pair_equal(std::span<std::uint32_t> same) {
        const auto middle =
            std::find_if(same.begin(), same.end(), [&](std::uint32_t i) { return !is_of_a(i); });
        const std::span of_a(same.begin(), middle);
        const std::span of_b(middle, same.end());
        if (of_a.empty() || of_b.empty()) return;
        if (of_a.size() == 1 && of_b.size() == 1) {
            partner_[of_a[0]] = static_cast<std::uint32_t>(of_b[0] - all_.count_a);
            return;
        }
        const bool repeats_a = repeats_in_a_range(of_a);  // This also sorts them.
        const bool repeats_b = repeats_in_a_range(of_b);
        pair_several(of_a, of_b, repeats_a || repeats_b || of_a.size() != of_b.size());
    }

    /// Sorts by range and value. Returns true if a range has several triangles.
    bool repeats_in_a_range(std::span<std::uint32_t> same) {
        std::sort(same.begin(), same.end(), [&](std::uint32_t p, std::uint32_t q) {
            if (range_of(p) != range_of(q)) return range_of(p) < range_of(q);
            return values_of(p) < values_of(q);
        });
        return std::adjacent_find(same.begin(), same.end(), [&](std::uint32_t p, std::uint32_t q) {
                   return range_of(p) == range_of(q);
               }) != same.end();
    }

    /// Matches triangles in the same range first, then the rest.
    void pair_several(std::span<const std::uint32_t> of_a, std::span<const std::uint32_t> of_b,
                      bool is_ambiguous) {
        std::vector<std::uint32_t> left_a;
        std::vector<std::uint32_t> left_b;
        const auto pair = [&](std::uint32_t i, std::uint32_t k) {
            partner_[i] = static_cast<std::uint32_t>(k - all_.count_a);
            is_ambiguous_[i] = is_ambiguous ? 1 : 0;
        };
        std::size_t i = 0;
        std::size_t k = 0;
        while (i < of_a.size() || k < of_b.size()) {
            if (k == of_b.size() || (i < of_a.size() && range_of(of_a[i]) < range_of(of_b[k])))
                left_a.push_back(of_a[i++]);
            else if (i == of_a.size() || range_of(of_b[k]) < range_of(of_a[i]))
                left_b.push_back(of_b[k++]);
            else
                pair(of_a[i++], of_b[k++]);
        }
        for (std::size_t n = 0; n < std::min(left_a.size(), left_b.size()); ++n)
            pair(left_a[n], left_b[n]);
    }

    const Mesh& a_;
    const Mesh& b_;
    const Joined& all_;
    std::vector<std::uint32_t> ranges_a_;
    std::vector<std::uint32_t> ranges_b_;
    std::vector<std::uint32_t> partner_;
    std::vector<unsigned char> is_ambiguous_;
};

/// Corner k of triangle a matches corner (k + turn) of triangle b.
void match_triangle(CornerMatch& match, std::size_t a, std::uint32_t b, int turn) {
    for (int k = 0; k < 3; ++k) {
        match.corners[3 * a + static_cast<std::size_t>(k)] =
            3 * b + static_cast<std::uint32_t>((k + turn) % 3);
    }
}

void match_exactly(const Mesh& a, const Mesh& b, CornerMatch& match) {
    const Joined all = joined(a, b, match.by_texcoord);
    ExactPairing pairing(a, b, all);
    pairing.run();
    std::vector<unsigned char> is_matched_b(b.triangles.size(), 0);
    for (std::uint32_t t = 0; t < all.count_a; ++t) {
        const std::uint32_t partner = pairing.partners()[t];
        if (partner == no_corner_matched) {
            match.only_a.push_back(t);
            continue;
        }
        is_matched_b[partner] = 1;
        const int turn = all.triangles[all.count_a + partner].turn - all.triangles[t].turn + 3;
        match_triangle(match, t, partner, turn);
        ++match.exact;
        match.ambiguous += pairing.ambiguous()[t];
    }
    for (std::uint32_t t = 0; t < b.triangles.size(); ++t) {
        if (is_matched_b[t] == 0) match.only_b.push_back(t);
    }
}

void match_nearly(const Mesh& a, const Mesh& b, const MatchOptions& options, CornerMatch& match) {
    MatchOptions how = options;
    how.by_texcoord = match.by_texcoord;
    std::vector<bool> is_matched_a(a.triangles.size(), false);
    std::vector<bool> is_matched_b(b.triangles.size(), false);
    for (const NearPair& pair : pair_near(a, b, match.only_a, match.only_b, how)) {
        match_triangle(match, pair.a, pair.b, pair.turn);
        is_matched_a[pair.a] = true;
        is_matched_b[pair.b] = true;
        ++match.near;
        match.ambiguous += pair.is_ambiguous ? 1 : 0;
    }
    std::erase_if(match.only_a, [&](std::uint32_t t) { return is_matched_a[t]; });
    std::erase_if(match.only_b, [&](std::uint32_t t) { return is_matched_b[t]; });
}

}  // namespace

CornerMatch match_corners(const Mesh& a, const Mesh& b, const MatchOptions& options) {
    validate(a);
    validate(b);
    CornerMatch match;
    match.by_texcoord = options.by_texcoord && !a.texcoords.empty() && !b.texcoords.empty();
    match.corners.assign(3 * a.triangles.size(), no_corner_matched);
    match_exactly(a, b, match);
    if (options.position_tolerance > 0.0 || options.texcoord_tolerance > 0.0)
        match_nearly(a, b, options, match);
    return match;
}

namespace {

constexpr float unmatched = -1.0F;
constexpr std::size_t corners_per_piece = 4096;

/// Equal directions are the common case and need no arc tangent.
float degrees_apart(const glm::vec3& a, const glm::vec3& b) {
    const float length = glm::dot(a, a);
    if (a == b && length > 0.0F && std::isfinite(length)) return 0.0F;
    return static_cast<float>(degrees_between(glm::dvec3(a), glm::dvec3(b)));
}

/// Order: undefined first, then the largest angles; ties: the lower corner.
bool is_worse(const WorstCorner& a, const WorstCorner& b) {
    const auto rank = [](float degrees) { return std::isnan(degrees) ? 1e9F : degrees; };
    if (rank(a.degrees) != rank(b.degrees)) return rank(a.degrees) > rank(b.degrees);
    return a.corner_a < b.corner_a;
}

/// Angles at matched corners, and the largest of them.
std::vector<float> gather(std::span<const float> degrees, const CornerMatch& match,
                          std::size_t first, std::size_t count, std::size_t limit,
                          std::vector<WorstCorner>& worst) {
    std::vector<float> angles;
    for (std::size_t corner = first; corner < first + count; ++corner) {
        const float angle = degrees[corner];
        if (angle < 0.0F) continue;
        angles.push_back(angle);
        if (angle == 0.0F || limit == 0) continue;
        const WorstCorner candidate{static_cast<std::uint32_t>(corner), match.corners[corner],
                                    angle};
        if (worst.size() == limit && !is_worse(candidate, worst.back())) continue;
        worst.insert(std::upper_bound(worst.begin(), worst.end(), candidate, is_worse), candidate);
        if (worst.size() > limit) worst.pop_back();
    }
    return angles;
}

}  // namespace

CornerDifferences corner_differences(const Mesh& a, const Mesh& b, const CornerMatch& match) {
    CornerDifferences result;
    const std::size_t count = match.corners.size();
    const bool has_normals = !a.normals.empty() && !b.normals.empty();
    const bool has_tangents = !a.tangents.empty() && !b.tangents.empty();
    if (has_normals) result.normals.assign(count, unmatched);
    if (has_tangents) {
        result.tangents.assign(count, unmatched);
        result.sign_differs.assign(count, 0);
    }
    parallel_for(count, corners_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t corner = begin; corner < end; ++corner) {
            if (match.corners[corner] == no_corner_matched) continue;
            const std::uint32_t va = vertex_of(static_cast<Corner>(corner), a.triangles);
            const std::uint32_t vb = vertex_of(match.corners[corner], b.triangles);
            if (has_normals) result.normals[corner] = degrees_apart(a.normals[va], b.normals[vb]);
            if (!has_tangents) continue;
            const glm::vec4& ta = a.tangents[va];
            const glm::vec4& tb = b.tangents[vb];
            result.tangents[corner] = degrees_apart(glm::vec3(ta), glm::vec3(tb));
            result.sign_differs[corner] = (ta.w < 0.0F) != (tb.w < 0.0F) ? 1 : 0;
        }
    });
    return result;
}

FrameComparison compared(const CornerDifferences& differences, const CornerMatch& match,
                         std::size_t first_triangle, std::size_t triangle_count,
                         std::size_t worst) {
    FrameComparison result;
    const std::size_t first = 3 * first_triangle;
    const std::size_t count = 3 * triangle_count;
    for (std::size_t corner = first; corner < first + count; ++corner)
        result.corners += match.corners[corner] != no_corner_matched ? 1 : 0;
    if (!differences.normals.empty()) {
        result.normals = error_stats(
            gather(differences.normals, match, first, count, worst, result.worst_normals));
    }
    if (!differences.tangents.empty()) {
        result.tangents = error_stats(
            gather(differences.tangents, match, first, count, worst, result.worst_tangents));
        for (std::size_t corner = first; corner < first + count; ++corner)
            result.sign_differences += differences.sign_differs[corner];
    }
    return result;
}

}  // namespace relief

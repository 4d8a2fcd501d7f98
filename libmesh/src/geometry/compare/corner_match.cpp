// SPDX-License-Identifier: Apache-2.0
// Pairing the triangles of two meshes whose corners are the same numbers. Vertices of both are
// welded by position and texture coordinate, triangles turned so that their smallest vertex comes
// first, and gathered by that vertex: linear but for sorting around it. Whatever is ambiguous is
// settled by material range and by value, never by the order of triangles.
// Tests: tests/mesh/geometry/compare/compare_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "geometry/compare/corner_match_near.h"
#include "geometry/corners.h"
#include "geometry/weld.h"
#include "parallel.h"
#include "relief/mesh/compare.h"

namespace relief {
namespace {

/// A triangle turned so that the corner with the smallest name comes first.
struct Turned {
    glm::uvec3 key{0};
    int turn = 0;  ///< Which corner that is.
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

/// Which material range each triangle is in.
std::vector<std::uint32_t> ranges_of(const Mesh& mesh) {
    std::vector<std::uint32_t> ranges(mesh.triangles.size(), 0);
    for (std::uint32_t i = 0; i < mesh.material_ranges.size(); ++i) {
        const MaterialRange& range = mesh.material_ranges[i];
        std::fill_n(ranges.begin() + range.first_triangle, range.triangle_count, i);
    }
    return ranges;
}

/// The triangles of both meshes over vertices that are named alike where they are the same.
struct Joined {
    std::vector<Turned> triangles;  ///< Those of a, then those of b.
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

/// Triangles by the first vertex of their key, each vertex's in ascending order.
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

    /// For each triangle of a that of b, or no_corner_matched.
    [[nodiscard]] const std::vector<std::uint32_t>& partners() const { return partner_; }
    [[nodiscard]] const std::vector<unsigned char>& ambiguous() const { return is_ambiguous_; }

  private:
    [[nodiscard]] bool is_of_a(std::uint32_t i) const { return i < all_.count_a; }
    [[nodiscard]] std::uint32_t range_of(std::uint32_t i) const {
        return is_of_a(i) ? ranges_a_[i] : ranges_b_[i - all_.count_a];
    }

    /// The normals and tangents at its corners, the corner that is first in the key first; with
    /// infinity for NaN, which has no place in an order.
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

    /// All with the same corners, those of a first.
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
        const bool repeats_a = repeats_in_a_range(of_a);  // Sorts them, too.
        const bool repeats_b = repeats_in_a_range(of_b);
        pair_several(of_a, of_b, repeats_a || repeats_b || of_a.size() != of_b.size());
    }

    /// Sorts by range and value, and says whether a range has several.
    bool repeats_in_a_range(std::span<std::uint32_t> same) {
        std::sort(same.begin(), same.end(), [&](std::uint32_t p, std::uint32_t q) {
            if (range_of(p) != range_of(q)) return range_of(p) < range_of(q);
            return values_of(p) < values_of(q);
        });
        return std::adjacent_find(same.begin(), same.end(), [&](std::uint32_t p, std::uint32_t q) {
                   return range_of(p) == range_of(q);
               }) != same.end();
    }

    /// Those in the same range first, then whoever is left.
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

/// Corner k of triangle a is corner (k + turn) of triangle b.
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
    CornerMatch match;
    match.by_texcoord = options.by_texcoord && !a.texcoords.empty() && !b.texcoords.empty();
    match.corners.assign(3 * a.triangles.size(), no_corner_matched);
    match_exactly(a, b, match);
    if (options.position_tolerance > 0.0 || options.texcoord_tolerance > 0.0)
        match_nearly(a, b, options, match);
    return match;
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Terms in long double, sorted by value and then added; so neither the order of triangles nor the
// corner that one begins with can show. Where arithmetic is to be in float, the terms are the same
// as normal_sums.cpp has, bit for bit, and only their sum is better.
// Tests: tests/mesh/geometry/normals/normals_test.cpp.
#include "geometry/normals/exact_normals.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/corners.h"
#include "geometry/direction.h"
#include "geometry/normals/normal_rounding.h"
#include "geometry/normals/normal_votes.h"
#include "parallel.h"

namespace relief {
namespace {

// Votes that cancel to less than this leave only rounding: float positions cannot hold an angle
// that would leave so little, while a million votes in double err by 1e-10 together.
constexpr long double cancelled_votes = 1e-9L;

using Term = std::array<long double, 3>;

struct CornerAtPlace {
    std::uint32_t place;
    Corner corner;

    friend bool operator<(const CornerAtPlace& a, const CornerAtPlace& b) {
        return a.place != b.place ? a.place < b.place : a.corner < b.corner;
    }
};

/// Which place a vertex belongs to, for few vertices of many.
class PlacesOfVertices {
  public:
    PlacesOfVertices(std::size_t vertex_count, std::span<const Place> places)
        : listed_(vertex_count, false) {
        for (std::size_t i = 0; i < places.size(); ++i) {
            for (const std::uint32_t vertex : places[i].vertices) {
                listed_[vertex] = true;
                places_.push_back({vertex, static_cast<std::uint32_t>(i)});
            }
        }
        std::sort(places_.begin(), places_.end());
    }

    [[nodiscard]] bool any_in(const VertexRange& range) const {
        const auto found = std::lower_bound(places_.begin(), places_.end(),
                                            std::pair{range.lowest, std::uint32_t(0)});
        return found != places_.end() && found->first <= range.highest;
    }
    [[nodiscard]] bool has(std::uint32_t vertex) const { return listed_[vertex]; }
    [[nodiscard]] std::uint32_t at(std::uint32_t vertex) const {
        return std::lower_bound(places_.begin(), places_.end(), std::pair{vertex, std::uint32_t(0)})
            ->second;
    }

  private:
    std::vector<bool> listed_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> places_;
};

std::vector<CornerAtPlace> corners_at(std::span<const glm::uvec3> triangles,
                                      std::span<const VertexRange> ranges,
                                      const PlacesOfVertices& places) {
    std::vector<CornerAtPlace> found;
    for (std::size_t block = 0; block < ranges.size(); ++block) {
        if (!places.any_in(ranges[block])) continue;
        const std::size_t first = block * triangles_at_once;
        const std::size_t end = std::min(first + triangles_at_once, triangles.size());
        for (std::size_t t = first; t < end; ++t) {
            for (int i = 0; i < 3; ++i) {
                const std::uint32_t vertex = triangles[t][i];
                if (places.has(vertex)) {
                    found.push_back(
                        {places.at(vertex), static_cast<Corner>(3 * t) + static_cast<Corner>(i)});
                }
            }
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

template <typename Real>
Term term_of(const TriangleVotes<Real>& votes, std::size_t corner) {
    const auto factor = static_cast<long double>(votes.factor[corner]);
    return {factor * static_cast<long double>(votes.area_vector[0]),
            factor * static_cast<long double>(votes.area_vector[1]),
            factor * static_cast<long double>(votes.area_vector[2])};
}

/// The vote at the first of three corners, in long double.
template <NormalWeight weight>
Term exact_term(const std::array<glm::vec3, 3>& at) {
    // Beginning with the first by value, as kind_of() does.
    const auto before = [](const glm::vec3& a, const glm::vec3& b) {
        return comes_before(glm::dvec3(a), glm::dvec3(b));
    };
    const auto shift =
        static_cast<std::size_t>(std::min_element(at.begin(), at.end(), before) - at.begin());
    const auto votes = triangle_votes<weight, long double>(at[shift], at[(shift + 1) % 3],
                                                           at[(shift + 2) % 3], 1.0L);
    return term_of(votes, (3 - shift) % 3);
}

/// The vote at one corner of a triangle, as normal_sums.cpp has it in arithmetic of float.
template <NormalWeight weight>
Term float_term(const std::array<glm::vec3, 3>& at, std::size_t corner, float scale) {
    const auto votes = triangle_votes<weight, float>(at[0], at[1], at[2], scale);
    if (votes.sound) return term_of(votes, corner);
    return term_of(triangle_votes<weight, double>(at[0], at[1], at[2], double(scale)), corner);
}

bool term_comes_before(const Term& a, const Term& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// Kind and normal of one place by the votes there.
void decide(std::vector<Term>& terms, bool any_triangle, Place& place) {
    if (terms.empty()) {
        place.kind = any_triangle ? PlaceKind::voiceless : PlaceKind::isolated;
        return;
    }
    std::sort(terms.begin(), terms.end(),
              [](const Term& a, const Term& b) { return term_comes_before(a, b); });
    Term sum{};
    long double longest = 0.0L;
    for (const Term& term : terms) {
        for (std::size_t i = 0; i < 3; ++i)
            sum[i] += term[i];
        longest += std::hypot(term[0], term[1], term[2]);
    }
    const long double length = std::hypot(sum[0], sum[1], sum[2]);
    if (!(length > cancelled_votes * longest)) {
        place.kind = PlaceKind::cancelling;
        return;
    }
    place.kind = PlaceKind::sound;
    place.normal =
        on_grid(double(sum[0] / length), double(sum[1] / length), double(sum[2] / length));
}

/// One place after the other, from its stretch of the sorted corners.
template <NormalWeight weight>
class ExactNormals {
  public:
    ExactNormals(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                 Arithmetic arithmetic)
        : positions_(positions),
          triangles_(triangles),
          in_float_(arithmetic == Arithmetic::float32),
          scale_(in_float_ ? scale_for(positions) : 1.0F) {}

    void find(std::span<const CornerAtPlace> corners, Place& place) {
        if (!is_finite(positions_[place.vertices.front()])) {
            place.kind = PlaceKind::non_finite;
            return;
        }
        terms_.clear();
        for (const CornerAtPlace& entry : corners)
            add_term(entry.corner);
        decide(terms_, !corners.empty(), place);
    }

  private:
    void add_term(Corner corner) {
        const glm::uvec3& triangle = triangles_[triangle_of(corner)];
        const std::array<glm::vec3, 3> at = {positions_[triangle.x], positions_[triangle.y],
                                             positions_[triangle.z]};
        if (kind_of(at[0], at[1], at[2]) != TriangleKind::sound) return;
        const std::size_t i = corner % 3;
        terms_.push_back(in_float_ ? float_term<weight>(at, i, scale_)
                                   : exact_term<weight>({at[i], at[(i + 1) % 3], at[(i + 2) % 3]}));
    }

    std::span<const glm::vec3> positions_;
    std::span<const glm::uvec3> triangles_;
    bool in_float_;
    float scale_;
    std::vector<Term> terms_;
};

}  // namespace

void find_exact_normals(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                        std::span<const VertexRange> ranges, NormalWeight weight,
                        Arithmetic arithmetic, std::span<Place> places) {
    if (places.empty()) return;
    const PlacesOfVertices at(positions.size(), places);
    const std::vector<CornerAtPlace> corners = corners_at(triangles, ranges, at);
    constexpr std::size_t grain = 256;
    with_weight(weight, [&]<NormalWeight constant>() {
        parallel_for(places.size(), grain, [&](std::size_t begin, std::size_t end) {
            ExactNormals<constant> normals(positions, triangles, arithmetic);
            for (std::size_t i = begin; i < end; ++i) {
                const auto place = static_cast<std::uint32_t>(i);
                const auto first =
                    std::lower_bound(corners.begin(), corners.end(), CornerAtPlace{place, 0});
                const auto last =
                    std::upper_bound(first, corners.end(), CornerAtPlace{place, no_corner});
                normals.find({first, last}, places[i]);
            }
        });
    });
}

}  // namespace relief

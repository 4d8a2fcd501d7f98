// SPDX-License-Identifier: Apache-2.0
// Vertex, corner and triangle normals. Object space, any unit of length.
//
// normal_sums.h sums contributions quickly and rounds them where the result is certain. The other
// vertices are summed again here: in higher precision, with the terms sorted by value, so that
// neither the order of triangles nor the first corner of a triangle matters. With float arithmetic,
// the terms have the same bits as in normal_sums.cpp, and only their sum is more precise. For
// corner normals, vertices are split where fans of smooth triangles meet (smooth_fans.h); then the
// normals are averaged as for any mesh.
#include "relief/mesh/normals.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "geometry/check_triangles.h"
#include "geometry/corners.h"
#include "geometry/direction.h"
#include "geometry/normal_contributions.h"
#include "geometry/normal_sums.h"
#include "geometry/smooth_fans.h"
#include "geometry/triangle_stacks.h"
#include "geometry/weld.h"
#include "parallel.h"
#include "portable_math.h"
#include "progress_stage.h"
#include "relaxed_store.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

enum class PlaceKind : std::uint8_t {
    sound,
    isolated,           ///< It has no triangle.
    no_valid_triangle,  ///< All its triangles are degenerate or not finite.
    cancelling,         ///< Its contributions cancel.
    non_finite,         ///< Its position is not finite.
};

/// Vertices that share a normal.
struct Place {
    std::span<const std::uint32_t> vertices;
    PlaceKind kind = PlaceKind::sound;
    glm::vec3 normal{0.0F};  ///< Unit length if the kind is `sound`.
};

// Relative length of a sum below which only rounding remains: float positions cannot represent an
// angle that would leave so little, and the error of a million contributions in double is 1e-10.
constexpr double cancelled_contributions = 1e-9;

using Term = std::array<DoubleDouble, 3>;

struct CornerAtPlace {
    std::uint32_t place;
    Corner corner;

    friend bool operator<(const CornerAtPlace& a, const CornerAtPlace& b) {
        return a.place != b.place ? a.place < b.place : a.corner < b.corner;
    }
};

/// Maps vertices to places, for a small part of all vertices.
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

std::vector<CornerAtPlace> corners_at(TriangleSpan triangles, std::span<const VertexRange> ranges,
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
Term term_of(const TriangleContributions<Real>& contributions, std::size_t corner) {
    const DoubleDouble factor = contributions.factor[corner];
    return {factor * contributions.area_vector[0], factor * contributions.area_vector[1],
            factor * contributions.area_vector[2]};
}

/// Contribution at the first of three corners, in extended precision.
template <NormalWeight weight>
Term exact_term(const std::array<glm::vec3, 3>& at) {
    // Starts with the smallest corner by value, like kind_of().
    const auto before = [](const glm::vec3& a, const glm::vec3& b) {
        return comes_before(glm::dvec3(a), glm::dvec3(b));
    };
    const auto shift =
        static_cast<std::size_t>(std::min_element(at.begin(), at.end(), before) - at.begin());
    const auto contributions = triangle_contributions<weight, DoubleDouble>(
        at[shift], at[(shift + 1) % 3], at[(shift + 2) % 3], 1.0);
    return term_of(contributions, (3 - shift) % 3);
}

/// Returns the contribution at one corner of a triangle, computed like in normal_sums.cpp with
/// float arithmetic.
template <NormalWeight weight>
Term float_term(const std::array<glm::vec3, 3>& at, std::size_t corner, float scale) {
    const auto contributions = triangle_contributions<weight, float>(at[0], at[1], at[2], scale);
    if (contributions.sound) return term_of(contributions, corner);
    return term_of(triangle_contributions<weight, double>(at[0], at[1], at[2], double(scale)),
                   corner);
}

DoubleDouble length_of(const Term& term) {
    return sqrt(term[0] * term[0] + term[1] * term[1] + term[2] * term[2]);
}

bool term_comes_before(const Term& a, const Term& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// Computes kind and normal of one place from its contributions.
void decide(std::vector<Term>& terms, bool any_triangle, Place& place) {
    if (terms.empty()) {
        place.kind = any_triangle ? PlaceKind::no_valid_triangle : PlaceKind::isolated;
        return;
    }
    std::sort(terms.begin(), terms.end(),
              [](const Term& a, const Term& b) { return term_comes_before(a, b); });
    Term sum{};
    DoubleDouble longest;
    for (const Term& term : terms) {
        for (std::size_t i = 0; i < 3; ++i)
            sum[i] += term[i];
        longest += length_of(term);
    }
    const DoubleDouble length = length_of(sum);
    if (!(length > cancelled_contributions * longest)) {
        place.kind = PlaceKind::cancelling;
        return;
    }
    place.kind = PlaceKind::sound;
    place.normal = on_grid((sum[0] / length).high, (sum[1] / length).high, (sum[2] / length).high);
}

/// Computes places one after the other, each from its range of the sorted corners.
template <NormalWeight weight>
class ExactNormals {
  public:
    ExactNormals(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
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

    StridedSpan<const glm::vec3> positions_;
    TriangleSpan triangles_;
    bool in_float_;
    float scale_;
    std::vector<Term> terms_;
};

/// Computes kind and normal of every place. Places do not share vertices.
///
/// The time is one test per block of triangles, plus 1 microsecond per triangle at the places.
/// \param ranges  vertex ranges of the blocks, from sum_contributions()
void find_exact_normals(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
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

/// Normal of vertices and triangles whose direction is undefined.
constexpr glm::vec3 fallback_normal{0.0F, 0.0F, 1.0F};

/// The findings of averaging.
struct AveragingResult {
    /// Vertices without a direction, ascending, with the reason.
    std::vector<std::pair<std::uint32_t, PlaceKind>> problems;
    /// Triangles that are not valid, and some that are, ascending.
    std::vector<std::uint32_t> odd_triangles;
    std::size_t by_area = 0;  ///< See ChosenNormals.
};

constexpr std::size_t few_triangles = 8192;

/// Places whose rounding is uncertain: vertices that share with no other, and groups.
std::vector<Place> doubtful_places(std::size_t vertex_count,
                                   const std::vector<std::uint32_t>& vertices, const Groups& shared,
                                   const std::vector<std::uint32_t>& groups) {
    std::vector<bool> shares(shared.members.empty() ? 0 : vertex_count, false);
    for (const std::uint32_t member : shared.members)
        shares[member] = true;
    std::vector<Place> places;
    for (const std::uint32_t& vertex : vertices) {
        if (shares.empty() || !shares[vertex]) places.push_back({std::span(&vertex, 1)});
    }
    for (const std::uint32_t group : groups)
        places.push_back({shared.at(group)});
    return places;
}

void take_over(std::span<const Place> places, StridedSpan<glm::vec3> normals,
               AveragingResult& result) {
    for (const Place& place : places) {
        const bool sound = place.kind == PlaceKind::sound;
        for (const std::uint32_t vertex : place.vertices) {
            normals[vertex] = sound ? place.normal : fallback_normal;
            if (!sound) result.problems.emplace_back(vertex, place.kind);
        }
    }
    std::sort(result.problems.begin(), result.problems.end());
}

/// Marks vertices (1) with an adjacent triangle that faces away from the normal or is edge-on.
/// Vertices that share a normal share the mark.
std::vector<std::uint8_t> folded_vertices(StridedSpan<const glm::vec3> positions,
                                          TriangleSpan triangles,
                                          StridedSpan<const glm::vec3> normals,
                                          const Groups& shared) {
    std::vector<std::uint8_t> folded(positions.size(), 0);
    parallel_for(triangles.size(), few_triangles, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const glm::uvec3& triangle = triangles[t];
            const glm::dvec3 a(positions[triangle.x]);
            const glm::dvec3 area_vector = glm::cross(glm::dvec3(positions[triangle.y]) - a,
                                                      glm::dvec3(positions[triangle.z]) - a);
            for (int i = 0; i < 3; ++i) {
                const glm::dvec3 normal(normals[triangle[i]]);
                if (!(glm::dot(area_vector, normal) <= 0.0)) continue;
                // Triangles without a normal do not count.
                if (kind_of(positions[triangle.x], positions[triangle.y], positions[triangle.z]) !=
                    TriangleKind::sound)
                    continue;
                // Several threads may write the same 1 here.
                relaxed_store(folded[triangle[i]], 1);
            }
        }
    });
    for (std::size_t g = 0; g < shared.count(); ++g) {
        std::uint8_t any = 0;
        for (const std::uint32_t member : shared.at(g))
            any |= folded[member];
        for (const std::uint32_t member : shared.at(g))
            folded[member] = any;
    }
    return folded;
}

/// Groups of vertices that share their normal. \throws InvalidInput if the tolerance is invalid
Groups sharing_vertices(StridedSpan<const glm::vec3> positions,
                        const std::optional<double>& weld_tolerance) {
    if (!weld_tolerance) return {};
    if (!(*weld_tolerance >= 0.0) || std::isinf(*weld_tolerance)) {
        throw InvalidInput(fmt::format(
            "the weld tolerance is {}, but must be finite and at least 0", *weld_tolerance));
    }
    return groups_of(*weld_tolerance > 0.0 ? weld_near_positions(positions, *weld_tolerance)
                                           : weld_positions(positions));
}

/// Computes the normals of all vertices from the sums at them; the fallback for vertices with
/// problems.
///
/// \param shared  the groups of vertices that share a normal
AveragingResult normals_of_sums(NormalSums sums, StridedSpan<const glm::vec3> positions,
                                TriangleSpan triangles, NormalWeight weight, Arithmetic arithmetic,
                                const Groups& shared, StridedSpan<glm::vec3> normals) {
    AveragingResult result;
    result.odd_triangles = std::move(sums.odd);
    const auto vertices = round_normals(sums, normals);
    const auto doubtful = round_shared_normals(sums, shared.first, shared.members, normals);
    std::vector<Place> places = doubtful_places(positions.size(), vertices, shared, doubtful);
    find_exact_normals(positions, triangles, sums.ranges, weight, arithmetic, places);
    take_over(places, normals, result);
    return result;
}

/// \throws InvalidInput if a triangle names a vertex that does not exist
AveragingResult averaged_normals(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
                                 NormalWeight weight, Arithmetic arithmetic, const Groups& shared,
                                 StridedSpan<glm::vec3> normals) {
    return normals_of_sums(sum_contributions(positions, triangles, weight, arithmetic, normals),
                           positions, triangles, weight, arithmetic, shared, normals);
}

/// Averages with the weighting that suits each vertex.
AveragingResult averaged_normals_by_choice(StridedSpan<const glm::vec3> positions,
                                           TriangleSpan triangles, Arithmetic arithmetic,
                                           const Groups& shared, StridedSpan<glm::vec3> normals) {
    AveragingResult result =
        averaged_normals(positions, triangles, NormalWeight::max, arithmetic, shared, normals);
    std::vector<std::uint8_t> by_area = folded_vertices(positions, triangles, normals, shared);
    for (const auto& [vertex, kind] : result.problems)
        by_area[vertex] = kind == PlaceKind::cancelling ? 1 : 0;
    result.by_area = static_cast<std::size_t>(std::count(by_area.begin(), by_area.end(), 1));
    if (result.by_area == 0) return result;

    std::vector<glm::vec3> area_normals(positions.size());
    AveragingResult area = averaged_normals(positions, triangles, NormalWeight::area, arithmetic,
                                            shared, area_normals);
    for (std::size_t v = 0; v < by_area.size(); ++v) {
        if (by_area[v] != 0) normals[v] = area_normals[v];
    }
    // Vertices that cancel by area but not by Max's weights keep the latter.
    std::erase_if(area.problems, [&](const auto& problem) {
        return problem.second == PlaceKind::cancelling && by_area[problem.first] == 0;
    });
    result.problems = std::move(area.problems);
    return result;
}

/// Counts triangles without a normal in the report.
void report_triangles(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
                      std::span<const std::uint32_t> odd, std::string_view outcome,
                      Report& report) {
    for (const std::uint32_t t : odd) {
        const glm::uvec3& triangle = triangles[t];
        switch (kind_of(positions[triangle.x], positions[triangle.y], positions[triangle.z])) {
            case TriangleKind::sound:
                break;
            case TriangleKind::degenerate:
                report.add("degenerate triangle", "triangle", t, outcome);
                break;
            case TriangleKind::non_finite:
                report.add("triangle with a non-finite corner", "triangle", t, outcome);
                break;
        }
    }
}

/// Counts one vertex without a direction in the report.
void report_vertex(PlaceKind kind, std::size_t vertex, Report& report) {
    static constexpr std::string_view outcome = "gets the normal (0,0,1)";
    switch (kind) {
        case PlaceKind::sound:
            break;
        case PlaceKind::isolated:
            report.add("isolated vertex", "vertex", vertex, outcome);
            break;
        case PlaceKind::no_valid_triangle:
            report.add("vertex with only degenerate triangles", "vertex", vertex, outcome);
            break;
        case PlaceKind::cancelling:
            report.add("cancelling normals", "vertex", vertex, outcome);
            break;
        case PlaceKind::non_finite:
            report.add("non-finite position", "vertex", vertex, outcome);
            break;
    }
}

void report_all(const AveragingResult& averaged, StridedSpan<const glm::vec3> positions,
                TriangleSpan triangles, Report& report) {
    report_triangles(positions, triangles, averaged.odd_triangles,
                     "does not contribute to vertex normals", report);
    for (const auto& [vertex, kind] : averaged.problems)
        report_vertex(kind, vertex, report);
}

}  // namespace

void vertex_normals(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
                    const NormalOptions& options, StridedSpan<glm::vec3> normals, Report& report,
                    const ExecutionOptions& execution) {
    const ExecutionScope scope(execution);
    if (normals.size() != positions.size()) {
        throw InvalidInput(fmt::format("there is memory for {} normals, but there are {} positions",
                                       normals.size(), positions.size()));
    }
    NormalSums sums;
    Groups shared;
    const auto sum = [&] {
        sums = sum_contributions(positions, triangles, options.weight, options.arithmetic, normals);
    };
    const auto weld = [&] { shared = sharing_vertices(positions, options.weld_tolerance); };
    // Without welding, the sums get all threads.
    if (options.weld_tolerance)
        parallel_tasks({sum, weld}, triangles.size() < few_triangles);
    else
        sum();
    const AveragingResult averaged = normals_of_sums(
        std::move(sums), positions, triangles, options.weight, options.arithmetic, shared, normals);
    report_all(averaged, positions, triangles, report);
}

std::vector<glm::vec3> vertex_normals(StridedSpan<const glm::vec3> positions,
                                      TriangleSpan triangles, const NormalOptions& options,
                                      Report& report) {
    std::vector<glm::vec3> normals(positions.size());
    vertex_normals(positions, triangles, options, normals, report);
    return normals;
}

std::vector<glm::vec3> vertex_normals(StridedSpan<const glm::vec3> positions,
                                      TriangleSpan triangles, NormalWeight weight, Report& report) {
    NormalOptions options;
    options.weight = weight;
    return vertex_normals(positions, triangles, options, report);
}

ChosenNormals chosen_normals(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
                             const NormalOptions& options, Report& report) {
    ChosenNormals result;
    result.normals.resize(positions.size());
    const AveragingResult averaged = averaged_normals_by_choice(
        positions, triangles, options.arithmetic,
        sharing_vertices(positions, options.weld_tolerance), result.normals);
    report_all(averaged, positions, triangles, report);
    result.by_area = averaged.by_area;
    return result;
}

std::vector<glm::vec3> triangle_normals(StridedSpan<const glm::vec3> positions,
                                        TriangleSpan triangles, Report& report) {
    check_triangles(triangles, positions.size());
    std::vector<glm::vec3> normals = normals_or_zero(positions, triangles);
    std::vector<std::uint32_t> odd;
    for (std::size_t t = 0; t < normals.size(); ++t) {
        if (normals[t] != glm::vec3(0.0F)) continue;
        odd.push_back(static_cast<std::uint32_t>(t));
        normals[t] = fallback_normal;
    }
    report_triangles(positions, triangles, odd, "gets the normal (0,0,1)", report);
    return normals;
}

namespace {

void check(const HardEdges& hard_edges, std::size_t triangle_count) {
    const auto& angle = hard_edges.crease_angle;
    if (angle && !(*angle >= 0.0 && *angle <= std::numbers::pi)) {
        throw InvalidInput(
            fmt::format("the crease angle is {} radians, but must be 0 to pi", *angle));
    }
    const std::size_t groups = hard_edges.smoothing_groups.size();
    if (groups != 0 && groups != triangle_count) {
        throw InvalidInput(
            fmt::format("there are {} smoothing groups, but {} triangles", groups, triangle_count));
    }
}

/// Replaces each vertex index by the first vertex at its place.
std::vector<glm::uvec3> over_places(TriangleSpan triangles, std::size_t vertex_count,
                                    const Groups& shared) {
    std::vector<std::uint32_t> place(vertex_count);
    std::iota(place.begin(), place.end(), 0U);
    for (std::size_t g = 0; g < shared.count(); ++g) {
        for (const std::uint32_t member : shared.at(g))
            place[member] = shared.at(g).front();
    }
    return welded_triangles(triangles, place);
}

/// A mesh in which no two fans share a vertex.
struct SeparatedFans {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t> vertex;  ///< Vertex of the original mesh.
    Groups fans;                        ///< Groups of vertices that belong to one fan.
};

SeparatedFans mesh_of(const SmoothFans& fans, StridedSpan<const glm::vec3> positions,
                      TriangleSpan triangles) {
    const auto vertex_at = [&](std::size_t corner) {
        return vertex_of(static_cast<Corner>(corner), triangles);
    };
    // The corners by fan.
    std::vector<std::uint32_t> begin(fans.count + 1, 0);
    for (const std::uint32_t fan : fans.fan_of_corner)
        ++begin[fan + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    std::vector<std::uint32_t> vertices(fans.fan_of_corner.size());
    for (std::size_t c = 0; c < fans.fan_of_corner.size(); ++c) {
        check_cancelled(c);
        vertices[next[fans.fan_of_corner[c]]++] = vertex_at(c);
    }
    // Vertices of a fan can have different positions, because welding has a tolerance.
    SeparatedFans mesh;
    std::vector<std::uint32_t> first_of_fan;
    for (std::size_t fan = 0; fan < fans.count; ++fan) {
        check_cancelled(fan);
        const auto from = vertices.begin() + begin[fan];
        const auto to = vertices.begin() + begin[fan + 1];
        std::sort(from, to);
        const auto first = static_cast<std::uint32_t>(mesh.vertex.size());
        begin[fan] = first;
        mesh.vertex.insert(mesh.vertex.end(), from, std::unique(from, to));
        first_of_fan.resize(mesh.vertex.size(), first);
    }
    begin[fans.count] = static_cast<std::uint32_t>(mesh.vertex.size());
    mesh.positions.reserve(mesh.vertex.size());
    for (const std::uint32_t vertex : mesh.vertex)
        mesh.positions.push_back(positions[vertex]);
    mesh.fans = groups_of(first_of_fan);
    mesh.triangles.resize(triangles.size());
    for (std::size_t c = 0; c < fans.fan_of_corner.size(); ++c) {
        check_cancelled(c);
        const std::uint32_t fan = fans.fan_of_corner[c];
        const auto found = std::lower_bound(mesh.vertex.begin() + begin[fan],
                                            mesh.vertex.begin() + begin[fan + 1], vertex_at(c));
        mesh.triangles[c / 3][static_cast<int>(c % 3)] =
            static_cast<std::uint32_t>(found - mesh.vertex.begin());
    }
    return mesh;
}

/// Gives the corners of triangles without a normal the normal of another corner at their vertex, so
/// that they split no vertex, or else at their position: the first one by value.
///
/// \param open  the corners of these triangles, ascending. Those without another keep their normal
/// \param welded  the triangles with the indices of welded vertices
/// \return for each vertex, whether its open corners got a normal; empty if there are none
std::vector<bool> borrow_normals(std::span<const Corner> open, std::size_t vertex_count,
                                 TriangleSpan triangles, std::span<const glm::uvec3> welded,
                                 std::span<glm::vec3> normals) {
    if (open.empty()) return {};
    constexpr glm::vec3 none(0.0F);
    std::vector<glm::vec3> at_vertex(vertex_count, none);
    std::vector<glm::vec3> at_position(vertex_count, none);
    auto next_open = open.begin();
    for (Corner corner = 0; corner < normals.size(); ++corner) {
        if (next_open != open.end() && *next_open == corner) {
            ++next_open;
            continue;
        }
        for (glm::vec3* const first :
             {&at_vertex[vertex_of(corner, triangles)], &at_position[vertex_of(corner, welded)]}) {
            if (*first == none || comes_before(glm::dvec3(normals[corner]), glm::dvec3(*first)))
                *first = normals[corner];
        }
    }
    std::vector<bool> has_normal(vertex_count, false);
    for (const Corner corner : open) {
        const std::uint32_t vertex = vertex_of(corner, triangles);
        const glm::vec3& here = at_vertex[vertex];
        const glm::vec3& normal = here != none ? here : at_position[vertex_of(corner, welded)];
        if (normal == none) continue;
        normals[corner] = normal;
        has_normal[vertex] = true;
    }
    return has_normal;
}

/// Stacks of triangles, as in FanInput; empty if none is doubled.
struct Stacks {
    std::vector<std::uint32_t> first;
    std::vector<std::uint8_t> doubled;
};

/// \param normals  of the triangles; those without one are not doubled
Stacks stacks_of(std::span<const glm::uvec3> welded, std::span<const glm::vec3> normals,
                 Report& report) {
    Stacks stacks{triangle_stacks(welded), {}};
    // By stack: the windings of its triangles with a normal, relative to the first triangle.
    constexpr std::uint8_t both = 3;
    std::vector<std::uint8_t> windings(stacks.first.size(), 0);
    bool has_doubled = false;
    for (std::uint32_t t = 0; t < stacks.first.size(); ++t) {
        if (normals[t] == glm::vec3(0.0F)) continue;
        std::uint8_t& found = windings[stacks.first[t]];
        const std::uint8_t before = found;
        const bool is_opposite = are_opposite(welded[t], welded[stacks.first[t]]);
        found = static_cast<std::uint8_t>(found | (is_opposite ? 2U : 1U));
        if (found != both || before == both) continue;
        report.add("double-sided triangle", "triangle", stacks.first[t],
                   "keeps a normal for each side");
        has_doubled = true;
    }
    if (!has_doubled) return {};
    for (const std::uint32_t first : stacks.first)
        stacks.doubled.push_back(windings[first] == both ? 1 : 0);
    return stacks;
}

/// \param joins_positions  see FanInput
CornerNormals fan_normals(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
                          std::optional<NormalWeight> weight, const NormalOptions& options,
                          const HardEdges& hard_edges, bool joins_positions, Report& report) {
    check_triangles(triangles, positions.size());
    check(hard_edges, triangles.size());
    const Groups shared = sharing_vertices(positions, options.weld_tolerance);
    const std::vector<glm::uvec3> welded = over_places(triangles, positions.size(), shared);
    const std::vector<glm::vec3> of_triangles = normals_or_zero(positions, triangles);
    // Triangles that welding moves to the same positions are not the sides of one.
    const bool is_exact = options.weld_tolerance.value_or(0.0) == 0.0;
    const Stacks stacks = is_exact ? stacks_of(welded, of_triangles, report) : Stacks{};
    const SeparatedFans fans = mesh_of(smooth_fans({positions, triangles, welded, of_triangles,
                                                    stacks.first, stacks.doubled, joins_positions},
                                                   hard_edges),
                                       positions, triangles);
    std::vector<glm::vec3> normals(fans.positions.size());
    const AveragingResult averaged =
        weight ? averaged_normals(fans.positions, fans.triangles, *weight, options.arithmetic,
                                  fans.fans, normals)
               : averaged_normals_by_choice(fans.positions, fans.triangles, options.arithmetic,
                                            fans.fans, normals);

    CornerNormals result;
    result.by_area = averaged.by_area;
    result.normals.reserve(3 * triangles.size());
    std::vector<Corner> open;
    for (Corner corner = 0; corner < 3 * triangles.size(); ++corner) {
        if (of_triangles[triangle_of(corner)] == glm::vec3(0.0F)) open.push_back(corner);
        result.normals.push_back(normals[vertex_of(corner, fans.triangles)]);
    }
    const std::vector<bool> has_normal =
        borrow_normals(open, positions.size(), triangles, welded, result.normals);
    report_triangles(positions, triangles, averaged.odd_triangles,
                     "does not contribute to vertex normals", report);
    for (const auto& [vertex, kind] : averaged.problems) {
        // A vertex with only such triangles can get a normal of another one at its position.
        if (kind == PlaceKind::no_valid_triangle && has_normal[fans.vertex[vertex]]) continue;
        report_vertex(kind, fans.vertex[vertex], report);
    }
    return result;
}

}  // namespace

CornerNormals corner_normals(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
                             std::optional<NormalWeight> weight, const NormalOptions& options,
                             const HardEdges& hard_edges, Report& report) {
    return fan_normals(positions, triangles, weight, options, hard_edges, false, report);
}

CornerNormals detail::side_normals(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
                                   std::optional<NormalWeight> weight, const NormalOptions& options,
                                   Report& report) {
    return fan_normals(positions, triangles, weight, options, {}, true, report);
}

}  // namespace relief

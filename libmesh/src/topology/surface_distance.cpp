// SPDX-License-Identifier: Apache-2.0
// The distance between surfaces, by searches of closest points (surface_search.h). The time is
// limited: the work of a search is measured first, and if all searches together would exceed the
// limit, fewer points are examined, and the others are counted.
// Tests: tests/mesh/topology/surface_distance_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "geometry/direction.h"
#include "parallel.h"
#include "portable_math.h"
#include "progress_stage.h"
#include "relief/mesh/topology.h"
#include "topology/surface_search.h"
#include "topology/triangle_distance.h"

namespace relief {
using namespace relief::detail;

namespace {

/// The mean work of a search that needs no limit: that on a surface without thin triangles is about
/// 150.
constexpr SearchWork little_work = 500;

/// Beyond that, the work for all vertices, which takes one to six seconds of processor time.
constexpr SearchWork max_work = 200'000'000;

/// Returns the mean work of searching for points of another surface, which is at least 1.
///
/// \param most  the maximum number of searches
SearchWork mean_work(const SurfaceSearch& from, const SurfaceSearch& to, std::size_t most) {
    const std::size_t count = std::min(most, from.size());
    SearchWork work = 0;
    std::uint32_t guess = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Corners at = from.corners(i * from.size() / count);
        guess = to.nearest((at[0] + at[1] + at[2]) / 3.0, guess, work).triangle;
    }
    return 1 + work / count;
}

glm::dvec3 normal_of(const Corners& corners) {
    return glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
}

/// Visits the pieces of a parallel loop with fixed borders, so that sums do not depend on the
/// number of threads.
template <typename Value, typename Measure>
std::vector<Value> measured_in_pieces(std::size_t count, const Measure& measure,
                                      std::size_t piece = 4096) {
    std::vector<Value> values((count + piece - 1) / piece);
    parallel_for(values.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            values[i] = measure(i * piece, std::min(count, (i + 1) * piece));
    });
    return values;
}

/// A place on a surface.
struct Sample {
    double area;             ///< The area of the triangles before it, and of a part of its own.
    glm::dvec2 in_triangle;  ///< In the unit square, which is folded onto the triangle.
};

/// Places samples at equal steps of area, and within their triangles by a sequence with low
/// discrepancy.
struct EvenSamples {
    static constexpr std::size_t piece = 4096;
    std::size_t count;

    [[nodiscard]] EvenSamples starting_at(std::size_t /*begin*/) const { return *this; }
    [[nodiscard]] Sample at(std::size_t i, double area) const {
        constexpr double step_u = 0.7548776662466927;
        constexpr double step_v = 0.5698402909980532;
        const double u = static_cast<double>(i) * step_u;
        const double v = static_cast<double>(i) * step_v;
        return {(static_cast<double>(i) + 0.5) / static_cast<double>(count) * area,
                {u - std::floor(u), v - std::floor(v)}};
    }
};

/// Divides the area into equal parts, and places an independent random sample in each.
struct RandomSamples {
    static constexpr std::size_t piece = 512;
    std::size_t count;
    std::uint32_t seed;
    Random random{0};

    /// Returns the samples of a piece, whose numbers do not depend on those of other pieces.
    [[nodiscard]] RandomSamples starting_at(std::size_t begin) const {
        const auto mixed = seed * 0x9e3779b9U + static_cast<std::uint32_t>(begin);
        return {count, seed, Random(mixed)};
    }
    Sample at(std::size_t i, double area) {
        const double part = static_cast<double>(i) + random.between(0.0, 1.0);
        const double u = random.between(0.0, 1.0);
        return {part / static_cast<double>(count) * area, {u, random.between(0.0, 1.0)}};
    }
};

/// The sum of the areas up to each triangle.
std::vector<double> area_sums(const SurfaceSearch& surface) {
    std::vector<double> sums;
    sums.reserve(surface.size());
    double area = 0.0;
    for (std::size_t t = 0; t < surface.size(); ++t) {
        area += glm::length(normal_of(surface.corners(t))) / 2.0;
        sums.push_back(area);
    }
    return sums;
}

/// Computes means over samples, the 95 % of them, and the maximum.
///
/// \param areas  area_sums() of `from`
template <typename Samples>
void measure_samples(const SurfaceSearch& from, const SurfaceSearch& to,
                     std::span<const double> areas, const Samples& all_samples,
                     DistanceStats& stats) {
    const std::size_t count = all_samples.count;
    stats.area = areas.back();
    if (!(stats.area > 0.0) || count == 0) return;
    stats.samples = count;
    using Sums = DistanceStats;
    std::vector<double> squared(count);
    const std::vector<Sums> pieces = measured_in_pieces<Sums>(
        count,
        [&](std::size_t begin, std::size_t end) {
            Sums sums;
            SearchWork work = 0;
            std::uint32_t guess = 0;
            Samples samples = all_samples.starting_at(begin);
            for (std::size_t i = begin; i < end; ++i) {
                check_cancelled();
                const Sample sample = samples.at(i, stats.area);
                const auto found = std::lower_bound(areas.begin(), areas.end(), sample.area);
                const auto t =
                    std::min(static_cast<std::size_t>(found - areas.begin()), from.size() - 1);
                double u = sample.in_triangle.x;
                double v = sample.in_triangle.y;
                if (u + v > 1.0) {
                    u = 1.0 - u;
                    v = 1.0 - v;
                }
                const Corners c = from.corners(t);
                const NearestTriangle nearest =
                    to.nearest(c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]), guess, work);
                guess = nearest.triangle;
                squared[i] = nearest.squared;
                sums.mean += std::sqrt(nearest.squared);
                sums.rms += nearest.squared;
                sums.max = std::max(sums.max, nearest.squared);
                const glm::dvec3 a = normal_of(c);
                const glm::dvec3 b = normal_of(to.corners(nearest.triangle));
                const double degrees = angle_between(a, b) * 180.0 / std::numbers::pi;
                sums.mean_degrees += degrees;
                sums.max_degrees = std::max(sums.max_degrees, degrees);
            }
            return sums;
        },
        Samples::piece);
    for (const Sums& piece : pieces) {
        stats.mean += piece.mean;
        stats.rms += piece.rms;
        stats.max = std::max(stats.max, piece.max);
        stats.mean_degrees += piece.mean_degrees;
        stats.max_degrees = std::max(stats.max_degrees, piece.max_degrees);
    }
    stats.mean /= static_cast<double>(count);
    stats.rms = std::sqrt(stats.rms / static_cast<double>(count));
    const auto rank = squared.begin() + static_cast<std::ptrdiff_t>((95 * count + 99) / 100 - 1);
    std::nth_element(squared.begin(), rank, squared.end());
    stats.p95 = std::sqrt(*rank);
    stats.max = std::sqrt(stats.max);
    stats.mean_degrees /= static_cast<double>(count);
}

/// A point of a surface with the nearest triangle of the other one.
struct Probe {
    glm::dvec3 point;
    NearestTriangle nearest;
};

/// Searches the interior of triangles for the largest distance.
struct InteriorSearch {
    const SurfaceSearch& to;
    SearchWork work = 0;
    SearchWork most;
    bool was_stopped = false;  ///< The work has exceeded `most`.

    double largest(const std::array<Probe, 3>& piece, double known, int depth);
};

/// Returns the largest squared distance at the corners of a piece of a triangle and of its parts.
/// The distance from one triangle is convex, so the largest one at the corners bounds it. The piece
/// is divided while that bound is above `known`.
double InteriorSearch::largest(const std::array<Probe, 3>& piece, double known, int depth) {
    double corner = 0.0;
    for (const Probe& probe : piece)
        corner = std::max(corner, probe.nearest.squared);
    const auto is_bounded_by = [&](std::uint32_t candidate) {
        const Corners triangle = to.corners(candidate);
        constexpr double slack = 1.004;  // Of squares: what is not told apart, 0.2 %.
        const double allowed = std::max(known, corner) * slack;
        return std::all_of(piece.begin(), piece.end(), [&](const Probe& probe) {
            return squared_distance(probe.point, triangle) <= allowed;
        });
    };
    for (const Probe& probe : piece) {
        if (is_bounded_by(probe.nearest.triangle)) return corner;
    }
    if (work > most) {
        was_stopped = true;
        return corner;
    }
    const glm::dvec3 center = (piece[0].point + piece[1].point + piece[2].point) / 3.0;
    const NearestTriangle of_center = to.nearest(center, piece[0].nearest.triangle, work);
    corner = std::max(corner, of_center.squared);
    if (depth == 0 || is_bounded_by(of_center.triangle)) return corner;
    std::array<Probe, 3> middle;
    for (std::size_t i = 0; i < 3; ++i) {
        middle[i].point = (piece[(i + 1) % 3].point + piece[(i + 2) % 3].point) / 2.0;
        middle[i].nearest = to.nearest(middle[i].point, of_center.triangle, work);
        corner = std::max(corner, middle[i].nearest.squared);
    }
    known = std::max(known, corner);
    double most_found = std::max(corner, largest(middle, known, depth - 1));
    for (std::size_t i = 0; i < 3; ++i) {
        const std::array<Probe, 3> part = {piece[i], middle[(i + 2) % 3], middle[(i + 1) % 3]};
        most_found = std::max(most_found, largest(part, std::max(known, most_found), depth - 1));
    }
    return most_found;
}

/// The largest squared distance of some points, and the number of those that were left out.
struct Largest {
    double squared = 0.0;
    std::size_t omitted = 0;
};

/// Computes the distances of the used vertices.
///
/// \param step  only each vertex at a multiple of this index is examined
/// \param least  squared distances below it are not told apart
Largest largest_of_vertices(const SurfaceSearch& from, const SurfaceSearch& to, std::size_t step,
                            double least, std::vector<NearestTriangle>& nearest) {
    const std::vector<glm::vec3>& positions = from.mesh().positions;
    std::vector<bool> is_used(positions.size(), false);
    for (std::size_t t = 0; t < from.size(); ++t) {
        for (int i = 0; i < 3; ++i)
            is_used[from.vertices(t)[i]] = true;
    }
    nearest.resize(positions.size());
    const auto pieces =
        measured_in_pieces<Largest>(positions.size(), [&](std::size_t begin, std::size_t end) {
            Largest largest;
            SearchWork work = 0;
            std::uint32_t guess = 0;
            for (std::size_t v = begin; v < end; ++v) {
                check_cancelled();
                if (!is_used[v]) continue;
                if (v % step != 0) {
                    ++largest.omitted;
                    continue;
                }
                nearest[v] = to.nearest(glm::dvec3(positions[v]), guess, work, least);
                guess = nearest[v].triangle;
                largest.squared = std::max(largest.squared, nearest[v].squared);
            }
            return largest;
        });
    Largest all;
    for (const Largest& piece : pieces) {
        all.squared = std::max(all.squared, piece.squared);
        all.omitted += piece.omitted;
    }
    return all;
}

/// Returns the step between the vertices that can be examined.
///
/// \param work  the mean work of a search
std::size_t vertex_step(const SurfaceSearch& from, SearchWork work) {
    const std::size_t vertices = from.mesh().positions.size();
    return 1 + static_cast<std::size_t>(work > little_work ? vertices * work / max_work : 0);
}

/// Computes the maximum distance of vertices and of points inside the triangles.
///
/// \param work  the mean work of a search
void measure_maximum(const SurfaceSearch& from, const SurfaceSearch& to, SearchWork work,
                     DistanceStats& stats) {
    const std::size_t step = vertex_step(from, work);
    std::vector<NearestTriangle> nearest;
    const Largest at_vertices = largest_of_vertices(from, to, step, 0.0, nearest);
    const double of_all = std::max(at_vertices.squared, stats.max * stats.max);
    stats.max = std::sqrt(of_all);
    stats.omitted = at_vertices.omitted;
    if (step > 1) {
        stats.omitted += from.size();
        return;
    }
    // Distances below the rounding of positions are not told apart.
    const double known = std::max(of_all, to.rounding() * to.rounding());
    constexpr std::size_t max_pieces = 500'000;
    int depth = 1;
    while (depth < 6 && (from.size() << (2 * depth + 2)) <= max_pieces)
        ++depth;
    // The work for one triangle, on average over a piece of the loop.
    const SearchWork allowed = std::max<SearchWork>(4 * max_work / from.size(), 2 * little_work);
    const auto of_triangles =
        measured_in_pieces<Largest>(from.size(), [&](std::size_t begin, std::size_t end) {
            Largest largest{of_all, 0};
            InteriorSearch search{to, 0, allowed * (end - begin)};
            for (std::size_t t = begin; t < end; ++t) {
                check_cancelled();
                std::array<Probe, 3> piece;
                const Corners corners = from.corners(t);
                for (std::size_t i = 0; i < 3; ++i)
                    piece[i] = {corners[i], nearest[from.vertices(t)[static_cast<int>(i)]]};
                search.was_stopped = false;
                largest.squared = std::max(largest.squared, search.largest(piece, known, depth));
                if (search.was_stopped) ++largest.omitted;
            }
            return largest;
        });
    double squared = of_all;
    for (const Largest& piece : of_triangles) {
        squared = std::max(squared, piece.squared);
        stats.omitted += piece.omitted;
    }
    stats.max = std::sqrt(squared);
}

DistanceStats distances_on(const SurfaceSearch& from, const SurfaceSearch& to, SearchWork work) {
    constexpr std::size_t min_samples = 1000;
    DistanceStats stats;
    const std::size_t most = std::max<std::size_t>(min_samples, max_work / work);
    const std::size_t count =
        std::min(most, std::clamp<std::size_t>(std::max(from.size(), to.size()), 20'000, 50'000));
    measure_samples(from, to, area_sums(from), EvenSamples{count}, stats);
    measure_maximum(from, to, work, stats);
    return stats;
}

/// Calls measure(to, work) with the surface, or with its triangles divided if searches take less
/// work then.
template <typename Measure>
DistanceStats measured_with_little_work(const SurfaceSearch& from, const SurfaceSearch& to,
                                        const Measure& measure) {
    constexpr std::size_t searches = 256;
    const SearchWork work = mean_work(from, to, searches);
    if (work <= little_work) return measure(to, work);
    SurfaceSearch divided = to;
    SearchWork of_divided = work;
    for (const std::size_t more : {500'000, 2'000'000}) {
        divided.divide(more);
        of_divided = mean_work(from, divided, searches);
        if (of_divided <= little_work) break;
    }
    return of_divided < work ? measure(divided, of_divided) : measure(to, work);
}

DistanceStats distances(const SurfaceSearch& from, const SurfaceSearch& to) {
    return measured_with_little_work(from, to, [&](const SurfaceSearch& surface, SearchWork work) {
        return distances_on(from, surface, work);
    });
}

double largest_vertex_distance(const SurfaceSearch& from, const SurfaceSearch& to, double least) {
    const DistanceStats stats =
        measured_with_little_work(from, to, [&](const SurfaceSearch& surface, SearchWork work) {
            std::vector<NearestTriangle> nearest;
            const Largest largest =
                largest_of_vertices(from, surface, vertex_step(from, work), least * least, nearest);
            DistanceStats of_vertices;
            of_vertices.max = std::sqrt(largest.squared);
            return of_vertices;
        });
    return std::max(stats.max, least);
}

/// Measures at random samples, fewer if searches take long.
DistanceStats random_distances(const SurfaceSearch& from, SurfaceSearch& to, std::size_t samples,
                               std::uint32_t seed) {
    DistanceStats stats;
    if (samples > 0) {
        constexpr std::size_t searches = 16;
        SearchWork work = mean_work(from, to, searches);
        if (work > little_work) {
            to.add_prisms();
            work = mean_work(from, to, searches);
        }
        // A few searches far from each other have worse guesses than those of many samples.
        constexpr SearchWork enough = 2 * little_work;
        if (work > enough) samples = std::max<std::size_t>(samples * enough / work, 1);
    }
    measure_samples(from, to, area_sums(from), RandomSamples{samples, seed}, stats);
    return stats;
}

}  // namespace

SurfaceDistance surface_distance(const Mesh& a, const Mesh& b) {
    validate(a);
    validate(b);
    SurfaceSearch surface_a(a);
    SurfaceSearch surface_b(b);
    if (surface_a.size() == 0 || surface_b.size() == 0) return {};
    surface_a.add_prisms();
    surface_b.add_prisms();
    return {distances(surface_a, surface_b), distances(surface_b, surface_a)};
}

SurfaceDistance sampled_distance(const Mesh& a, const Mesh& b, std::size_t samples_a,
                                 std::size_t samples_b, std::uint32_t seed) {
    validate(a);
    validate(b);
    SurfaceSearch surface_a(a);
    SurfaceSearch surface_b(b);
    if (surface_a.size() == 0 || surface_b.size() == 0) return {};
    return {random_distances(surface_a, surface_b, samples_a, seed),
            random_distances(surface_b, surface_a, samples_b, seed)};
}

double largest_vertex_distance(const Mesh& a, const Mesh& b, double least) {
    validate(a);
    validate(b);
    if (!(least >= 0.0))
        throw InvalidInput(fmt::format("the least distance is {}, but must be at least 0", least));
    SurfaceSearch surface_a(a);
    SurfaceSearch surface_b(b);
    if (surface_a.size() == 0 || surface_b.size() == 0) return least;
    surface_a.add_prisms();
    surface_b.add_prisms();
    // The second direction searches only beyond the result of the first.
    return largest_vertex_distance(surface_b, surface_a,
                                   largest_vertex_distance(surface_a, surface_b, least));
}

double max_farther_part(std::size_t samples, double confidence) {
    if (!(confidence > 0.0 && confidence < 1.0))
        throw InvalidInput(
            fmt::format("the confidence is {}, but must be between 0 and 1", confidence));
    // The probability that no sample is in a part p of the area is at most (1 - p)^samples.
    return samples == 0 ? 1.0
                        : 1.0 - portable::pow(1.0 - confidence, 1.0 / static_cast<double>(samples));
}

}  // namespace relief

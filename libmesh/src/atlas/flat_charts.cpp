// SPDX-License-Identifier: Apache-2.0
#include "atlas/flat_charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <queue>

#include "parallel.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// A projection with at most this stretch is as good as a flattened chart.
constexpr double isometric_stretch = 1.001;
std::array<glm::dvec2, 3> corners_of(const ChartMesh& chart, std::size_t index,
                                     std::span<const glm::dvec2> coordinates) {
    const glm::uvec3& v = chart.vertices[index];
    return {coordinates[v.x], coordinates[v.y], coordinates[v.z]};
}

double stretch_ratio(const Stretch& stretch) {
    if (!(stretch.smallest > 0.0)) return std::numeric_limits<double>::infinity();
    const double area = stretch.largest * stretch.smallest;
    return std::max({stretch.largest / stretch.smallest, area, 1.0 / area});
}

/// Works on the parts of one chart of the segmentation.
class ChartFlattener {
  public:
    ChartFlattener(const AtlasSurface& surface, ChartMembers& members, const FlatnessLimits& limits,
                   double total_area)
        : surface_(surface),
          members_(members),
          limits_(limits),
          min_area_(min_area_share(surface.faces.size()) * total_area) {}

    void flatten(std::vector<std::uint32_t> faces, std::vector<FlatChart>& result) {
        std::vector<std::vector<std::uint32_t>> waiting;
        waiting.push_back(std::move(faces));
        flatten(std::move(waiting), result);
    }

    /// Divides a chart at a face before its parts are flattened.
    void divide(const ChartMesh& chart, std::uint32_t face, std::vector<FlatChart>& result) {
        std::vector<std::vector<std::uint32_t>> parts = bisected(chart, face);
        std::reverse(parts.begin(), parts.end());
        flatten(std::move(parts), result);
    }

    /// Flattens connected faces, without dividing them. \return none if that fails
    std::optional<FlatChart> attempt(std::vector<std::uint32_t> faces) {
        members_.assign(faces);
        FlatChart chart;
        chart.mesh = chart_mesh(surface_, members_, std::move(faces));
        if (problem_of(chart)) return std::nullopt;
        return chart;
    }

    /// Flattens a connected union of charts, without dividing it.
    std::optional<FlatChart> flattened(std::vector<std::uint32_t> faces, double max_energy) {
        members_.assign(faces);
        FlatChart chart;
        chart.mesh = chart_mesh(surface_, members_, std::move(faces));
        if (try_flatten(chart)) return std::nullopt;
        for (const std::uint32_t face : chart.mesh.faces)
            chart.area += surface_.areas[face];
        if (!(energy_of(surface_, chart) <= max_energy)) return std::nullopt;
        align_to_box(chart);
        if (end_of_long(chart)) return std::nullopt;
        return chart;
    }

  private:
    /// \param waiting the parts, the first one last
    void flatten(std::vector<std::vector<std::uint32_t>> waiting, std::vector<FlatChart>& result) {
        while (!waiting.empty()) {
            check_cancelled();
            std::vector<std::uint32_t> part = std::move(waiting.back());
            waiting.pop_back();
            members_.assign(part);
            FlatChart chart;
            chart.mesh = chart_mesh(surface_, members_, std::move(part));
            const std::optional<std::uint32_t> problem = problem_of(chart);
            if (!problem) {
                result.push_back(std::move(chart));
                continue;
            }
            // In reverse, so that the first part is next.
            std::vector<std::vector<std::uint32_t>> parts = bisected(chart.mesh, *problem);
            for (auto each = parts.rbegin(); each != parts.rend(); ++each)
                waiting.push_back(std::move(*each));
        }
    }

    /// Fills a chart. \return a face with a problem, as an index of the chart
    std::optional<std::uint32_t> problem_of(FlatChart& chart) const {
        std::optional<std::uint32_t> problem = try_flatten(chart);
        if (problem) return problem;
        align_to_box(chart);
        if (chart.mesh.faces.size() > 1) problem = end_of_long(chart);
        for (const std::uint32_t face : chart.mesh.faces)
            chart.area += surface_.areas[face];
        return problem;
    }

    /// \return a face with a problem, as an index of the chart
    std::optional<std::uint32_t> try_flatten(FlatChart& chart) const {
        if (is_pair(chart.mesh)) {
            chart.coordinates = unfolded(surface_, chart.mesh);
            return problem_of(chart.mesh, chart.coordinates, limits_.max_stretch);
        }
        std::vector<glm::dvec2> projection = projected(surface_, chart.mesh);
        if (chart.mesh.faces.size() == 1 ||
            problem_of(chart.mesh, projection, isometric_stretch) == std::nullopt) {
            chart.coordinates = std::move(projection);
            return std::nullopt;
        }
        std::vector<glm::dvec2> flat = detail::flattened(
            surface_, chart.mesh, projection, {limits_.method, limits_.max_stretch, min_area_});
        const std::optional<std::uint32_t> problem =
            problem_of(chart.mesh, flat, limits_.max_stretch);
        if (!problem) {
            chart.coordinates = std::move(flat);
            return std::nullopt;
        }
        // A projection keeps no angles.
        if (limits_.method != Flattening::conformal &&
            !problem_of(chart.mesh, projection, limits_.max_stretch)) {
            chart.coordinates = std::move(projection);
            return std::nullopt;
        }
        return problem;
    }

    [[nodiscard]] std::optional<std::uint32_t> problem_of(const ChartMesh& chart,
                                                          std::span<const glm::dvec2> coordinates,
                                                          double max_stretch) const {
        double worst = max_stretch;
        std::optional<std::uint32_t> result;
        for (std::uint32_t i = 0; i < chart.faces.size(); ++i) {
            const std::uint32_t face = chart.faces[i];
            const double ratio =
                stretch_ratio(stretch_of(surface_, face, corners_of(chart, i, coordinates)));
            const bool counts = surface_.areas[face] >= min_area_ || std::isinf(ratio);
            if (!counts || ratio <= worst) continue;
            worst = ratio;
            result = i;
            if (std::isinf(ratio)) return result;
        }
        if (result) return result;
        return overlap_in(chart, on_lattice(coordinates, limits_.lattice_scale));
    }

    /// The distances over centers of faces from one of them.
    [[nodiscard]] std::vector<double> distances_from(const ChartMesh& chart,
                                                     std::uint32_t start) const {
        const auto center = [&](std::uint32_t index) {
            const Corner corner = 3 * chart.faces[index];
            return (surface_.position(corner) + surface_.position(corner + 1) +
                    surface_.position(corner + 2)) /
                   3.0;
        };
        using Entry = std::pair<double, std::uint32_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        std::vector<double> distance(chart.faces.size(), std::numeric_limits<double>::infinity());
        distance[start] = 0.0;
        queue.emplace(0.0, start);
        while (!queue.empty()) {
            const auto [length, index] = queue.top();
            queue.pop();
            if (length > distance[index]) continue;
            const glm::dvec3 here = center(index);
            for (std::uint32_t k = 0; k < 3; ++k) {
                const Corner other = chart.opposite[3 * index + k];
                if (other == no_corner) continue;
                const std::uint32_t neighbor = other / 3;
                const double next = length + glm::length(center(neighbor) - here);
                if (next >= distance[neighbor]) continue;
                distance[neighbor] = next;
                queue.emplace(next, neighbor);
            }
        }
        return distance;
    }

    /// Divides a chart between a face and the one that is farthest from it.
    [[nodiscard]] std::vector<std::vector<std::uint32_t>> bisected(const ChartMesh& chart,
                                                                   std::uint32_t face) const {
        const std::vector<double> from_face = distances_from(chart, face);
        // Another face, even if it is at the same place.
        std::uint32_t far = face == 0 ? 1 : 0;
        for (std::uint32_t i = 0; i < from_face.size(); ++i)
            if (i != face && from_face[i] > from_face[far]) far = i;
        const std::vector<double> from_far = distances_from(chart, far);
        std::vector<std::uint8_t> side(chart.faces.size());
        for (std::size_t i = 0; i < side.size(); ++i)
            side[i] = from_face[i] < from_far[i] ? 1 : 0;
        side[face] = 1;
        side[far] = 0;
        return components(chart, side);
    }

    static std::vector<std::vector<std::uint32_t>> components(
        const ChartMesh& chart, const std::vector<std::uint8_t>& side) {
        std::vector<std::vector<std::uint32_t>> parts;
        std::vector<bool> is_visited(side.size(), false);
        std::vector<std::uint32_t> stack;
        for (std::uint32_t first = 0; first < side.size(); ++first) {
            if (is_visited[first]) continue;
            std::vector<std::uint32_t>& part = parts.emplace_back();
            is_visited[first] = true;
            stack.push_back(first);
            while (!stack.empty()) {
                const std::uint32_t index = stack.back();
                stack.pop_back();
                part.push_back(chart.faces[index]);
                for (std::uint32_t k = 0; k < 3; ++k) {
                    const Corner other = chart.opposite[3 * index + k];
                    if (other == no_corner || is_visited[other / 3] ||
                        side[other / 3] != side[index])
                        continue;
                    is_visited[other / 3] = true;
                    stack.push_back(other / 3);
                }
            }
            std::sort(part.begin(), part.end());
        }
        return parts;
    }

    /// Returns a face at the end of a chart that is too long.
    [[nodiscard]] std::optional<std::uint32_t> end_of_long(const FlatChart& chart) const {
        if (std::max(chart.size.x, chart.size.y) <= limits_.max_side) return std::nullopt;
        const glm::length_t axis = chart.size.x >= chart.size.y ? 0 : 1;
        std::uint32_t first = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::uint32_t i = 0; i < chart.mesh.faces.size(); ++i) {
            const double x = chart.coordinates[chart.mesh.vertices[i].x][axis];
            if (x >= least) continue;
            least = x;
            first = i;
        }
        return first;
    }

    const AtlasSurface& surface_;
    ChartMembers& members_;
    const FlatnessLimits& limits_;
    double min_area_;
};

/// Narrower limits for the parts of charts that cannot be flattened.
constexpr std::array<ChartLimits, 2> narrow_limits{ChartLimits{0.873, 0.16, 1.6},
                                                   ChartLimits{0.524, 0.07, 0.6}};

/// Flattens all charts of a segmentation; those that fail are divided within narrower limits, and
/// at last in halves.
class LimitLadder {
  public:
    LimitLadder(const AtlasSurface& surface, Segmentation& segmentation, ChartMembers& members,
                const FlatnessLimits& limits)
        : surface_(surface),
          segmentation_(segmentation),
          members_(members),
          limits_(limits),
          total_(std::accumulate(surface.areas.begin(), surface.areas.end(), 0.0)) {}

    std::vector<FlatChart> flattened() {
        std::vector<std::vector<std::uint32_t>> charts(segmentation_.count);
        for (std::uint32_t face = 0; face < segmentation_.chart.size(); ++face)
            charts[segmentation_.chart[face]].push_back(face);
        for (const ChartLimits& narrower : narrow_limits) {
            charts = attempt(std::move(charts));
            if (charts.empty()) break;
            charts = divided_within(narrower, charts);
        }
        finish(std::move(charts));
        std::sort(result_.begin(), result_.end(), [](const FlatChart& a, const FlatChart& b) {
            return a.mesh.faces.front() < b.mesh.faces.front();
        });
        return std::move(result_);
    }

  private:
    using Charts = std::vector<std::vector<std::uint32_t>>;  ///< Faces, ascending.

    /// Calls body(i) for all charts, the largest first, so that threads end at about the same time.
    template <typename Body>
    void for_each(const Charts& charts, const Body& body) const {
        std::vector<std::uint32_t> order(charts.size());
        std::iota(order.begin(), order.end(), 0U);
        std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return charts[a].size() > charts[b].size();
        });
        parallel_for(order.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                check_cancelled();
                body(order[i]);
            }
        });
    }

    /// Flattens charts. \return those for which it fails
    Charts attempt(Charts charts) {
        std::vector<std::optional<FlatChart>> flat(charts.size());
        for_each(charts, [&](std::size_t i) {
            flat[i] = ChartFlattener(surface_, members_, limits_, total_).attempt(charts[i]);
        });
        Charts failed;
        for (std::size_t i = 0; i < charts.size(); ++i) {
            if (flat[i])
                result_.push_back(std::move(*flat[i]));
            else
                failed.push_back(std::move(charts[i]));
        }
        return failed;
    }

    /// Divides charts, and straightens the borders of their parts.
    Charts divided_within(const ChartLimits& limits, const Charts& charts) {
        Charts parts(charts.size());
        for_each(charts, [&](std::size_t i) {
            parts[i] = divided_part(surface_, segmentation_, charts[i], limits);
        });
        // Old charts have no number: they do not change.
        std::fill(segmentation_.chart.begin(), segmentation_.chart.end(), 0U);
        std::vector<std::uint32_t> group{no_face};
        for (std::uint32_t i = 0; i < charts.size(); ++i) {
            const auto first = static_cast<std::uint32_t>(group.size());
            for (std::size_t k = 0; k < charts[i].size(); ++k) {
                const std::uint32_t part = first + parts[i][k];
                segmentation_.chart[charts[i][k]] = part;
                if (part >= group.size()) group.resize(part + 1, i);
            }
        }
        segmentation_.count = group.size();
        replace_borders(surface_, segmentation_, group);
        separate_components(surface_, segmentation_);
        Charts result(segmentation_.count);
        for (const std::vector<std::uint32_t>& chart : charts)
            for (const std::uint32_t face : chart)
                result[segmentation_.chart[face]].push_back(face);
        std::erase_if(result, [](const auto& faces) { return faces.empty(); });
        for (const std::vector<std::uint32_t>& faces : result)
            members_.join(faces);
        return result;
    }

    /// Flattens charts, and divides them until that does not fail.
    void finish(Charts charts) {
        std::vector<std::vector<FlatChart>> parts(charts.size());
        for_each(charts, [&](std::size_t i) {
            ChartFlattener(surface_, members_, limits_, total_)
                .flatten(std::move(charts[i]), parts[i]);
        });
        for (std::vector<FlatChart>& each : parts)
            std::move(each.begin(), each.end(), std::back_inserter(result_));
    }

    const AtlasSurface& surface_;
    Segmentation& segmentation_;
    ChartMembers& members_;
    const FlatnessLimits& limits_;
    double total_;  ///< Area of the surface.
    std::vector<FlatChart> result_;
};

}  // namespace

std::vector<LatticePoint> on_lattice(std::span<const glm::dvec2> coordinates, double scale) {
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    for (const glm::dvec2& each : coordinates)
        low = glm::min(low, each);
    std::vector<LatticePoint> result(coordinates.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        const glm::dvec2 scaled = (coordinates[i] - low) * scale + 0.5;
        result[i] = {static_cast<int>(std::min(scaled.x, 67108863.0)),
                     static_cast<int>(std::min(scaled.y, 67108863.0))};
    }
    return result;
}

std::vector<FlatChart> flat_charts(const AtlasSurface& surface, Segmentation& segmentation,
                                   ChartMembers& members, const FlatnessLimits& limits) {
    std::vector<FlatChart> charts = LimitLadder(surface, segmentation, members, limits).flattened();
    return cut_charts(surface, members, limits,
                      merged_charts(surface, members, limits, std::move(charts)));
}

double energy_of(const AtlasSurface& surface, const FlatChart& chart) {
    double energy = 0.0;
    double area = 0.0;
    for (std::uint32_t i = 0; i < chart.mesh.faces.size(); ++i) {
        const std::uint32_t face = chart.mesh.faces[i];
        const Stretch stretch =
            stretch_of(surface, face, corners_of(chart.mesh, i, chart.coordinates));
        const double largest = stretch.largest * stretch.largest;
        const double smallest = stretch.smallest * stretch.smallest;
        energy += surface.areas[face] * (largest + smallest + 1.0 / largest + 1.0 / smallest);
        area += surface.areas[face];
    }
    return energy / (4.0 * area);
}

double largest_stretch(const AtlasSurface& surface, const FlatChart& chart, double total_area) {
    const double min_area = min_area_share(surface.faces.size()) * total_area;
    double largest = 1.0;
    for (std::uint32_t i = 0; i < chart.mesh.faces.size(); ++i) {
        const std::uint32_t face = chart.mesh.faces[i];
        if (surface.areas[face] < min_area) continue;
        const auto corners = corners_of(chart.mesh, i, chart.coordinates);
        largest = std::max(largest, stretch_ratio(stretch_of(surface, face, corners)));
    }
    return largest;
}

std::optional<FlatChart> flattened_union(const AtlasSurface& surface, ChartMembers& members,
                                         std::vector<std::uint32_t> faces,
                                         const FlatnessLimits& limits, double total_area,
                                         double max_energy) {
    return ChartFlattener(surface, members, limits, total_area)
        .flattened(std::move(faces), max_energy);
}

std::vector<FlatChart> divided_further(const AtlasSurface& surface, ChartMembers& members,
                                       const FlatChart& chart, std::uint32_t face,
                                       const FlatnessLimits& limits) {
    const double total = std::accumulate(surface.areas.begin(), surface.areas.end(), 0.0);
    std::vector<FlatChart> parts;
    ChartFlattener(surface, members, limits, total).divide(chart.mesh, face, parts);
    return parts;
}

}  // namespace relief::detail

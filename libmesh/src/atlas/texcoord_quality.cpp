// SPDX-License-Identifier: Apache-2.0
#include "relief/mesh/texcoord_quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "atlas/atlas_stats.h"
#include "atlas/box_tree.h"
#include "atlas/flatten.h"
#include "atlas/surface.h"
#include "geometry/direction.h"
#include "geometry/exact_orientation.h"
#include "progress_stage.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr double max_distance = 64.0;

/// Counter-clockwise.
using MapTriangle = std::array<glm::vec2, 3>;

PlaneBox box_of(std::span<const glm::vec2> points) {
    PlaneBox box;
    for (const glm::vec2& point : points)
        box.add(point);
    return box;
}

/// Numbers the connected parts of the faces that are finite in the map.
FaceCharts connected_parts(const AtlasSurface& surface, std::span<const std::uint8_t> is_finite) {
    FaceCharts charts{std::vector<std::uint32_t>(surface.faces.size(), no_face), 0};
    std::vector<std::uint32_t> open;
    std::size_t steps = 0;
    for (std::uint32_t first = 0; first < surface.faces.size(); ++first) {
        check_cancelled(first);
        if (charts.chart[first] != no_face || is_finite[first] == 0) continue;
        const auto number = static_cast<std::uint32_t>(charts.count++);
        charts.chart[first] = number;
        open.push_back(first);
        while (!open.empty()) {
            const std::uint32_t face = open.back();
            open.pop_back();
            check_cancelled(++steps);
            for (Corner edge = 3 * face; edge < 3 * face + 3; ++edge) {
                const Corner other = surface.opposite[edge];
                if (other == no_corner || charts.chart[other / 3] != no_face ||
                    is_finite[other / 3] == 0)
                    continue;
                charts.chart[other / 3] = number;
                open.push_back(other / 3);
            }
        }
    }
    return charts;
}

/// True if an edge of `a` has all of `b` on its outer side or on its line.
bool separates(const MapTriangle& a, const MapTriangle& b) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (std::all_of(b.begin(), b.end(), [&](const glm::vec2& point) {
                return orientation_sign(a[i], a[(i + 1) % 3], point) <= 0;
            }))
            return true;
    }
    return false;
}

/// Returns the UDIM number of the tile that has all corners; none if there is none. A corner at a
/// common border is in both tiles.
std::optional<int> tile_of(const MapTriangle& triangle) {
    constexpr double columns = 10.0;
    constexpr double rows = 900.0;
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high(-low);
    for (const glm::vec2& texcoord : triangle) {
        const glm::dvec2 upwards(texcoord.x, 1.0 - static_cast<double>(texcoord.y));
        low = glm::min(low, upwards);
        high = glm::max(high, upwards);
    }
    // A line along a border counts to the tile before it.
    const glm::dvec2 tile = glm::min(glm::floor(low), glm::max(glm::ceil(high) - 1.0, 0.0));
    if (!(tile.x >= 0.0 && tile.x < columns && tile.y >= 0.0 && tile.y < rows)) return std::nullopt;
    if (!(high.x <= tile.x + 1.0 && high.y <= tile.y + 1.0)) return std::nullopt;
    return 1001 + static_cast<int>(tile.x) + 10 * static_cast<int>(tile.y);
}

/// For each chart, the number of the first one with the same triangles in the map. Charts without
/// an area in the map are like no other one. \param drawn  the triangles of each chart
std::vector<std::uint32_t> equal_charts(std::vector<std::vector<MapTriangle>> drawn) {
    const auto is_less = [](const glm::vec2& a, const glm::vec2& b) {
        return a.x != b.x ? a.x < b.x : a.y < b.y;
    };
    std::size_t steps = 0;
    const auto is_triangle_less = [&](const MapTriangle& a, const MapTriangle& b) {
        check_cancelled(++steps);
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), is_less);
    };
    const auto is_chart_less = [&](const auto& a, const auto& b) {
        if (a.size() != b.size()) return a.size() < b.size();
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                            is_triangle_less);
    };
    std::map<std::vector<MapTriangle>, std::uint32_t, decltype(is_chart_less)> firsts(
        is_chart_less);
    std::vector<std::uint32_t> first(drawn.size());
    for (std::uint32_t chart = 0; chart < drawn.size(); ++chart) {
        first[chart] = chart;
        std::vector<MapTriangle>& triangles = drawn[chart];
        if (triangles.empty()) continue;
        for (MapTriangle& each : triangles)
            std::rotate(each.begin(), std::min_element(each.begin(), each.end(), is_less),
                        each.end());
        std::sort(triangles.begin(), triangles.end(), is_triangle_less);
        first[chart] = firsts.emplace(std::move(triangles), chart).first->second;
    }
    return first;
}

/// For each triangle, 1 if it shares an area with another one.
std::vector<std::uint8_t> overlapping_among(std::span<const MapTriangle> triangles) {
    std::vector<std::uint8_t> overlaps(triangles.size(), 0);
    if (triangles.empty()) return overlaps;
    std::vector<PlaneBox> boxes;
    boxes.reserve(triangles.size());
    for (const MapTriangle& each : triangles)
        boxes.push_back(box_of(each));
    const BoxTree tree(boxes);
    std::size_t steps = 0;
    for (const std::uint32_t i : tree.order()) {
        if (overlaps[i] != 0) continue;
        tree.find(boxes[i], [&](std::uint32_t j) {
            check_cancelled(++steps);
            if (i == j || separates(triangles[i], triangles[j]) ||
                separates(triangles[j], triangles[i]))
                return false;
            overlaps[i] = overlaps[j] = 1;
            return true;
        });
    }
    return overlaps;
}

struct Segment {
    std::array<glm::vec2, 2> ends;  ///< Texels.
    std::uint32_t chart;
    std::optional<int> tile;
};

double distance(const glm::dvec2& point, const Segment& segment) {
    const glm::dvec2 from(segment.ends[0]);
    const glm::dvec2 along = glm::dvec2(segment.ends[1]) - from;
    const double squared = glm::dot(along, along);
    const double t =
        squared > 0.0 ? std::clamp(glm::dot(point - from, along) / squared, 0.0, 1.0) : 0.0;
    const glm::dvec2 difference = point - from - t * along;
    return std::sqrt(glm::dot(difference, difference));
}

/// The distance of segments that do not cross.
double distance(const Segment& a, const Segment& b) {
    return std::min({distance(glm::dvec2(a.ends[0]), b), distance(glm::dvec2(a.ends[1]), b),
                     distance(glm::dvec2(b.ends[0]), a), distance(glm::dvec2(b.ends[1]), a)});
}

bool cross(const Segment& a, const Segment& b) {
    const auto side = [](const Segment& s, const glm::vec2& point) {
        return orientation_sign(s.ends[0], s.ends[1], point);
    };
    return side(a, b.ends[0]) * side(a, b.ends[1]) < 0 &&
           side(b, a.ends[0]) * side(b, a.ends[1]) < 0;
}

/// The least distance between borders of different charts, unless they are in two tiles.
std::optional<double> least_distance(std::span<const Segment> segments) {
    if (segments.empty()) return std::nullopt;
    std::vector<PlaneBox> boxes;
    boxes.reserve(segments.size());
    for (const Segment& each : segments)
        boxes.push_back(box_of(each.ends));
    const BoxTree tree(boxes);
    double least = max_distance;
    std::size_t steps = 0;
    for (const std::uint32_t i : tree.order()) {
        PlaneBox box = boxes[i];
        const auto shrink = [&] {
            box.min = boxes[i].min - static_cast<float>(least);
            box.max = boxes[i].max + static_cast<float>(least);
        };
        shrink();
        const bool is_zero = tree.find(box, [&](std::uint32_t j) {
            check_cancelled(++steps);
            if (segments[i].chart == segments[j].chart) return false;
            if (segments[i].tile && segments[j].tile && segments[i].tile != segments[j].tile)
                return false;
            const double between =
                cross(segments[i], segments[j]) ? 0.0 : distance(segments[i], segments[j]);
            if (!(between < least)) return false;
            least = between;
            shrink();
            return least == 0.0;
        });
        if (is_zero) return 0.0;
    }
    return least < max_distance ? std::optional(least) : std::nullopt;
}

/// The coordinates of a surface, measured face by face.
class Measurement {
  public:
    Measurement(const Mesh& mesh, const glm::ivec2& size,
                std::span<const std::uint32_t> first_vertices, Report& report)
        : size_(size),
          surface_(
              atlas_surface(mesh, {.at_seams = true, .first_vertices = first_vertices}, report)) {
        corner_texcoords_.reserve(3 * mesh.triangles.size());
        for (const glm::uvec3& triangle : mesh.triangles)
            for (int i = 0; i < 3; ++i)
                corner_texcoords_.push_back(mesh.texcoords[triangle[i]]);
        triangles_ = triangles_of_faces(surface_);
        classify(report);
        charts_ = connected_parts(surface_, is_finite_);
        find_shared_charts();
    }

    TexcoordQuality result() {
        quality_.chart.assign(surface_.face_of_triangle.size(), std::nullopt);
        for (std::size_t t = 0; t < quality_.chart.size(); ++t) {
            const std::uint32_t face = surface_.face_of_triangle[t];
            if (face != no_face && charts_.chart[face] != no_face)
                quality_.chart[t] = numbered_.chart[face];
        }
        count_inverted();
        count_overlapping();
        quality_.min_distance = least_distance(borders());
        FaceCharts measured = numbered_;
        for (std::uint32_t face = 0; face < surface_.faces.size(); ++face)
            if (signs_[face] == 0 || is_copy(face)) measured.chart[face] = no_face;
        quality_.stats = stats_of(surface_, corner_texcoords_, measured, size_);
        quality_.stats.used /= static_cast<double>(std::max<std::size_t>(quality_.tiles.size(), 1));
        quality_.stats.safe_mip_level =
            safe_mip_level(quality_.min_distance.value_or(max_distance));
        return std::move(quality_);
    }

  private:
    [[nodiscard]] glm::vec2 texcoord(Corner corner) const {
        const std::uint32_t triangle = triangles_[corner / 3];
        return corner_texcoords_[3 * std::size_t{triangle} +
                                 (corner % 3 + surface_.first_corner[triangle]) % 3];
    }

    void classify(Report& report) {
        is_finite_.assign(surface_.faces.size(), 1);
        signs_.assign(surface_.faces.size(), 0);
        tiles_.assign(surface_.faces.size(), std::nullopt);
        std::set<int> tiles;
        for (std::uint32_t face = 0; face < surface_.faces.size(); ++face) {
            check_cancelled(face);
            const MapTriangle stored{texcoord(3 * face), texcoord(3 * face + 1),
                                     texcoord(3 * face + 2)};
            if (!std::all_of(stored.begin(), stored.end(),
                             [](const glm::vec2& each) { return is_finite(each); })) {
                is_finite_[face] = 0;
                report.add("triangle with non-finite texture coordinates", "triangle",
                           triangles_[face], "is not measured");
                continue;
            }
            tiles_[face] = tile_of(stored);
            if (!tiles_[face]) ++quality_.outside;
            // v points down, so that a clockwise triangle is not mirrored.
            const int sign = orientation_sign(stored[0], stored[1], stored[2]);
            if (sign != 0) {
                drawn_.push_back(sign > 0 ? stored : MapTriangle{stored[0], stored[2], stored[1]});
                drawn_faces_.push_back(face);
                if (tiles_[face]) tiles.insert(*tiles_[face]);
            }
            const Stretch stretch = stretch_of(
                surface_, face, texels_of(corner_texcoords_, surface_, triangles_[face], size_));
            if (sign != 0 && std::abs(stretch.smallest) > 0.0)
                signs_[face] = -sign;
            else
                ++quality_.flat;
        }
        quality_.tiles.assign(tiles.begin(), tiles.end());
    }

    /// Numbers the charts anew, so that those that share texels have one number.
    void find_shared_charts() {
        std::vector<std::vector<MapTriangle>> drawn(charts_.count);
        for (std::size_t i = 0; i < drawn_.size(); ++i)
            drawn[charts_.chart[drawn_faces_[i]]].push_back(drawn_[i]);
        first_chart_ = equal_charts(std::move(drawn));
        std::vector<std::uint32_t> number(charts_.count);
        for (std::uint32_t chart = 0; chart < charts_.count; ++chart)
            number[chart] = first_chart_[chart] == chart
                                ? static_cast<std::uint32_t>(numbered_.count++)
                                : number[first_chart_[chart]];
        quality_.shared_charts = charts_.count - numbered_.count;
        for (const std::uint32_t chart : charts_.chart)
            numbered_.chart.push_back(chart == no_face ? no_face : number[chart]);
    }
    /// Returns whether the chart of a face shares the texels of an earlier one.
    [[nodiscard]] bool is_copy(std::uint32_t face) const {
        const std::uint32_t chart = charts_.chart[face];
        return chart != no_face && first_chart_[chart] != chart;
    }

    /// Charts that share texels are tested once, and count together.
    void count_overlapping() {
        std::vector<std::size_t> sharing(charts_.count, 0);
        for (const std::uint32_t first : first_chart_)
            ++sharing[first];
        std::vector<MapTriangle> tested;
        std::vector<std::uint32_t> chart;
        for (std::size_t i = 0; i < drawn_.size(); ++i) {
            if (is_copy(drawn_faces_[i])) continue;
            tested.push_back(drawn_[i]);
            chart.push_back(charts_.chart[drawn_faces_[i]]);
        }
        const std::vector<std::uint8_t> overlaps = overlapping_among(tested);
        for (std::size_t i = 0; i < tested.size(); ++i)
            if (overlaps[i] != 0) quality_.overlapping += sharing[chart[i]];
    }

    /// Counts mirrored charts and the triangles that differ from their chart.
    void count_inverted() {
        std::vector<double> areas(charts_.count, 0.0);
        for (std::uint32_t face = 0; face < signs_.size(); ++face)
            if (signs_[face] != 0)
                areas[charts_.chart[face]] += signs_[face] * surface_.areas[face];
        quality_.mirrored_charts = static_cast<std::size_t>(
            std::count_if(areas.begin(), areas.end(), [](double area) { return area < 0.0; }));
        for (std::uint32_t face = 0; face < signs_.size(); ++face) {
            if (signs_[face] == 0) continue;
            const int usual = areas[charts_.chart[face]] < 0.0 ? -1 : 1;
            if (signs_[face] == -usual) ++quality_.inverted;
        }
    }

    [[nodiscard]] std::vector<Segment> borders() const {
        std::vector<Segment> result;
        for (Corner edge = 0; edge < surface_.opposite.size(); ++edge) {
            if (surface_.opposite[edge] != no_corner || is_finite_[edge / 3] == 0 ||
                is_copy(edge / 3))
                continue;
            const glm::vec2 scale(size_);
            const Segment segment{
                {texcoord(edge) * scale, texcoord(next_in_triangle(edge)) * scale},
                numbered_.chart[edge / 3],
                tiles_[edge / 3]};
            // Coordinates near the largest float are not finite in texels.
            if (is_finite(segment.ends[0]) && is_finite(segment.ends[1])) result.push_back(segment);
        }
        return result;
    }

    glm::ivec2 size_;
    AtlasSurface surface_;
    std::vector<glm::vec2> corner_texcoords_;
    std::vector<std::uint32_t> triangles_;
    FaceCharts charts_;                       ///< All connected parts.
    std::vector<std::uint32_t> first_chart_;  ///< For each of them, the first with its texels.
    FaceCharts numbered_;                     ///< Only first charts have numbers of their own.
    /// For each face: 1 as the surface shows it, -1 mirrored, 0 flat or not finite.
    std::vector<int> signs_;
    std::vector<std::uint8_t> is_finite_;
    std::vector<std::optional<int>> tiles_;  ///< Of each face.
    std::vector<MapTriangle> drawn_;         ///< The triangles that have an area in the map.
    std::vector<std::uint32_t> drawn_faces_;
    TexcoordQuality quality_;
};

}  // namespace

TexcoordQuality measure_texcoords(const Mesh& mesh, const glm::ivec2& size, Report& report,
                                  std::span<const std::uint32_t> first_vertices) {
    for (const int side : {size.x, size.y})
        if (side < 1 || side > 65536)
            throw InvalidInput(
                fmt::format("the size of the map is {}, but must be 1 to 65536 texels", side));
    validate(mesh);
    if (mesh.texcoords.empty()) throw InvalidInput("there are no texture coordinates");
    check_parts(mesh, first_vertices);
    const ProgressStage stage("measuring texture coordinates");
    return Measurement(mesh, size, first_vertices, report).result();
}

}  // namespace relief

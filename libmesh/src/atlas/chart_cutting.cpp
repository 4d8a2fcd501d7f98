// SPDX-License-Identifier: Apache-2.0
// Branches, bends and rings leave room in the map that other charts cannot fill. A straight cut
// makes two or more charts of such a chart, whose shapes need less room. The best line is found on
// a small grid of cells; the cut itself follows the edges of faces.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "atlas/cell_mask.h"
#include "atlas/chart_outline.h"
#include "atlas/convex_hull.h"
#include "atlas/flat_charts.h"
#include "geometry/weld.h"
#include "parallel.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// The area that a cut must save for each unit of its length, in addition to the padding along the
/// cut: this multiple of the root of the area of the surface, but at most the other one divided by
/// the square of the relative length of all seams, to which a cut then adds little. It balances
/// unused texels and seams.
constexpr double min_saving = 0.045;
constexpr double min_saving_of_seams = 3.2;
/// Charts stay as they are if their room exceeds their area by less than this share, or by less
/// than this share of the surface: no cut pays.
constexpr double min_waste = 0.15;
constexpr double min_waste_of_surface = 1e-3;
/// The smallest part of a chart: a share of the surface, and texels.
constexpr double min_part_share = 5e-4;
constexpr double min_part_texels = 400.0;
/// The cells along the longer side of a chart, and the number of parallel lines that are tried.
constexpr int grid_cells = 40;
constexpr int line_count = 15;
/// The number of lines that are tried on faces.
constexpr std::size_t max_tried = 3;
/// Passes that remove the teeth of a cut.
constexpr int smoothing_passes = 2;
/// Passes that join parts that are too small with the other side.
constexpr int joining_passes = 2;

/// The area that a chart takes in the map, estimated: it lies between the area of the hull and that
/// of the box, because other charts fill a part of the corners.
double room_of(std::vector<glm::dvec2> points) {
    const std::vector<glm::dvec2> hull = convex_hull(std::move(points));
    return 0.5 * (area_of_hull(hull) + smallest_box(hull).area);
}

/// Normals of lines that are at least as steep as a diagonal. Together with their quarter turns,
/// they are all multiples of 22.5 degrees.
std::array<glm::dvec2, 4> steep_normals() {
    const double half = std::sqrt(0.5);
    const double cosine = std::sqrt(0.5 + 0.5 * half);
    const double sine = std::sqrt(0.5 - 0.5 * half);
    return {{{1.0, 0.0}, {cosine, sine}, {half, half}, {cosine, -sine}}};
}

struct Line {
    glm::dvec2 normal{1.0, 0.0};  ///< In the chart, unit.
    double offset = 0.0;          ///< dot(normal, point) of its points.
    double saved = 0.0;           ///< Room, less the cost of the cut.
};

/// Estimates what cuts along straight lines save, on the cells of a chart.
class LineSearch {
  public:
    /// \param cost  of a unit of length. \param direction  the image of the x axis in the grid
    LineSearch(const FlatChart& chart, const glm::dvec2& direction, double cost)
        : direction_(direction), cost_(cost) {
        const Outline outline = outline_of(chart, direction);
        low_ = outline.low;
        cell_ = std::max(outline.size.x, outline.size.y) / grid_cells;
        mask_ = mask_of(outline, 1.0 / cell_, {}, 1);
    }

    /// Adds the best line in each direction, if it saves room.
    void find(std::vector<Line>& lines) {
        // That of the cells too, so that both have the same error.
        const double room = room_of_all();
        for (const glm::dvec2& normal : steep_normals()) {
            const double low = std::min(normal.y, 0.0) * mask_.height;
            const double high = normal.x * mask_.width + std::max(normal.y, 0.0) * mask_.height;
            Line best;
            for (int i = 1; i <= line_count; ++i) {
                const double offset = low + (high - low) * i / (line_count + 1);
                const double saved = saved_by(normal, offset, room);
                if (saved <= best.saved) continue;
                // Back to the chart, whose origin is at -low_ in the grid.
                const glm::dvec2 back(direction_.x, -direction_.y);
                best = {rotated(normal, back), offset * cell_ + glm::dot(normal, low_), saved};
            }
            if (best.saved > 0.0) lines.push_back(best);
        }
    }

  private:
    /// A part of a run on one side of a line.
    struct Piece {
        int y;
        double begin, end;
        bool is_beyond;
    };

    [[nodiscard]] double room_of_all() const {
        std::vector<glm::dvec2> points;
        for (int y = 0; y < mask_.height; ++y)
            for (const Run& run : mask_.row(y))
                add_corners(y, run.begin, run.end, points);
        return room_of(std::move(points)) * cell_ * cell_;
    }
    static void add_corners(int y, double begin, double end, std::vector<glm::dvec2>& points) {
        points.emplace_back(begin, y);
        points.emplace_back(begin, y + 1);
        points.emplace_back(end, y);
        points.emplace_back(end, y + 1);
    }

    double saved_by(const glm::dvec2& normal, double offset, double room) {
        pieces_.clear();
        double length = 0.0;  // Cells.
        first_.clear();
        for (int y = 0; y < mask_.height; ++y) {
            first_.push_back(pieces_.size());
            const double x = (offset - normal.y * (y + 0.5)) / normal.x;
            for (const Run& run : mask_.row(y)) {
                if (x <= run.begin || x >= run.end) {
                    pieces_.push_back({y, 1.0 * run.begin, 1.0 * run.end, x <= run.begin});
                    continue;
                }
                pieces_.push_back({y, 1.0 * run.begin, x, false});
                pieces_.push_back({y, x, 1.0 * run.end, true});
                length += 1.0 / normal.x;
            }
        }
        first_.push_back(pieces_.size());
        if (length == 0.0) return 0.0;
        double saved = room - cost_ * length * cell_;
        sets_.reset(pieces_.size());
        for (int y = 1; y < mask_.height; ++y)
            join_rows(static_cast<std::size_t>(y));
        // The pieces of each part, and their room.
        by_part_.clear();
        for (std::uint32_t i = 0; i < pieces_.size(); ++i)
            by_part_.emplace_back(sets_.find(i), i);
        std::sort(by_part_.begin(), by_part_.end());
        for (std::size_t i = 0; i < by_part_.size() && saved > 0.0;) {
            const std::uint32_t part = by_part_[i].first;
            std::vector<glm::dvec2> points;
            for (; i < by_part_.size() && by_part_[i].first == part; ++i) {
                const Piece& piece = pieces_[by_part_[i].second];
                add_corners(piece.y, piece.begin, piece.end, points);
            }
            saved -= room_of(std::move(points)) * cell_ * cell_;
        }
        return saved;
    }

    /// Joins the pieces of a row with those of the row below.
    void join_rows(std::size_t y) {
        for (std::size_t i = first_[y]; i < first_[y + 1]; ++i) {
            for (std::size_t k = first_[y - 1]; k < first_[y]; ++k) {
                const Piece& a = pieces_[i];
                const Piece& b = pieces_[k];
                if (a.is_beyond == b.is_beyond && a.begin < b.end && b.begin < a.end)
                    sets_.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k));
            }
        }
    }

    glm::dvec2 direction_;
    double cost_;
    glm::dvec2 low_{0.0};
    double cell_ = 1.0;  ///< In the unit of the chart.
    CellMask mask_;
    std::vector<Piece> pieces_;
    std::vector<std::size_t> first_;  ///< The first piece of each row.
    DisjointSets sets_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> by_part_;
};

/// Cuts one chart, and its parts, as long as that saves room.
class ChartCutter {
  public:
    /// \param seam_cost  of a unit of length, an area
    ChartCutter(const AtlasSurface& surface, ChartMembers& members, const FlatnessLimits& limits,
                double total_area, double seam_cost)
        : surface_(surface),
          members_(members),
          cost_(seam_cost + limits.padding * limits.texel),
          min_waste_(min_waste_of_surface * total_area),
          min_part_(std::max(min_part_share * total_area,
                             min_part_texels * limits.texel * limits.texel)) {}

    void cut(FlatChart chart, std::vector<FlatChart>& result) {
        std::vector<FlatChart> waiting;
        waiting.push_back(std::move(chart));
        while (!waiting.empty()) {
            check_cancelled();
            FlatChart next = std::move(waiting.back());
            waiting.pop_back();
            std::vector<FlatChart> parts = parts_of(next);
            if (parts.empty()) {
                result.push_back(std::move(next));
                continue;
            }
            // In reverse, so that the first part is next.
            std::move(parts.rbegin(), parts.rend(), std::back_inserter(waiting));
        }
    }

  private:
    /// \return none if no cut saves room
    std::vector<FlatChart> parts_of(const FlatChart& chart) {
        if (chart.area < 2.0 * min_part_) return {};
        const double room = room_of(chart.coordinates);
        const double waste = room - chart.area;
        if (waste < std::max(min_waste * chart.area, min_waste_)) return {};
        std::vector<Line> lines;
        LineSearch(chart, {1.0, 0.0}, cost_).find(lines);
        LineSearch(chart, {0.0, 1.0}, cost_).find(lines);
        std::stable_sort(lines.begin(), lines.end(),
                         [](const Line& a, const Line& b) { return a.saved > b.saved; });
        if (lines.size() > max_tried) lines.resize(max_tried);
        std::optional<Parts> best;
        double most = 0.0;
        for (const Line& line : lines) {
            std::optional<Parts> parts = parts_along(chart, line);
            if (!parts) continue;
            const double saved = saved_by(chart, *parts, room);
            if (saved <= most) continue;
            most = saved;
            best = std::move(parts);
        }
        std::vector<FlatChart> result;
        if (!best) return result;
        for (std::uint32_t i = 0; i < best->count; ++i)
            result.push_back(extracted(chart, *best, i));
        return result;
    }

    /// The parts of a chart.
    struct Parts {
        std::vector<std::uint32_t> of_face;  ///< For each face of the chart.
        std::uint32_t count = 0;
    };

    /// Divides the faces of a chart by the side of a line on which their centers are.
    /// \return none if a part would be too small
    [[nodiscard]] std::optional<Parts> parts_along(const FlatChart& chart, const Line& line) const {
        const std::size_t count = chart.mesh.faces.size();
        std::vector<std::uint8_t> side(count);
        for (std::size_t i = 0; i < count; ++i) {
            const glm::uvec3& v = chart.mesh.vertices[i];
            const glm::dvec2 center =
                (chart.coordinates[v.x] + chart.coordinates[v.y] + chart.coordinates[v.z]) / 3.0;
            side[i] = glm::dot(center, line.normal) > line.offset ? 1 : 0;
        }
        for (int pass = 0; pass < smoothing_passes; ++pass)
            remove_teeth(chart.mesh, side);
        for (int pass = 0; pass <= joining_passes; ++pass) {
            Parts parts = components(chart.mesh, side);
            std::vector<double> areas(parts.count, 0.0);
            for (std::size_t i = 0; i < count; ++i)
                areas[parts.of_face[i]] += surface_.areas[chart.mesh.faces[i]];
            bool are_large = true;
            for (std::size_t i = 0; i < count; ++i) {
                if (areas[parts.of_face[i]] >= min_part_) continue;
                are_large = false;
                side[i] = side[i] == 0 ? 1 : 0;
            }
            if (are_large && parts.count > 1) return parts;
            if (are_large) return std::nullopt;
        }
        return std::nullopt;
    }

    /// Moves faces to the side of two of their neighbors.
    static void remove_teeth(const ChartMesh& mesh, std::vector<std::uint8_t>& side) {
        for (std::size_t i = 0; i < side.size(); ++i) {
            int others = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const Corner other = mesh.opposite[3 * i + k];
                if (other != no_corner && side[other / 3] != side[i]) ++others;
            }
            if (others >= 2) side[i] = side[i] == 0 ? 1 : 0;
        }
    }

    static Parts components(const ChartMesh& mesh, const std::vector<std::uint8_t>& side) {
        Parts parts{std::vector<std::uint32_t>(side.size(), no_face), 0};
        std::vector<std::uint32_t> stack;
        for (std::uint32_t first = 0; first < side.size(); ++first) {
            if (parts.of_face[first] != no_face) continue;
            parts.of_face[first] = parts.count;
            stack.push_back(first);
            while (!stack.empty()) {
                const std::uint32_t face = stack.back();
                stack.pop_back();
                for (std::uint32_t k = 0; k < 3; ++k) {
                    const Corner other = mesh.opposite[3 * face + k];
                    if (other == no_corner || parts.of_face[other / 3] != no_face ||
                        side[other / 3] != side[face])
                        continue;
                    parts.of_face[other / 3] = parts.count;
                    stack.push_back(other / 3);
                }
            }
            ++parts.count;
        }
        return parts;
    }

    [[nodiscard]] double saved_by(const FlatChart& chart, const Parts& parts, double room) const {
        double length = 0.0;
        std::vector<std::vector<glm::dvec2>> points(parts.count);
        for (Corner corner = 0; corner < chart.mesh.opposite.size(); ++corner) {
            const Corner other = chart.mesh.opposite[corner];
            const std::uint32_t part = parts.of_face[corner / 3];
            const bool is_border = other == no_corner;
            if (!is_border && parts.of_face[other / 3] == part) continue;
            const glm::dvec2& start = point_of(chart, corner);
            points[part].push_back(start);
            if (is_border || other < corner) continue;
            const glm::dvec2 edge = point_of(chart, next_in_triangle(corner)) - start;
            length += std::sqrt(glm::dot(edge, edge));
        }
        double saved = room - cost_ * length;
        for (std::vector<glm::dvec2>& each : points)
            saved -= room_of(std::move(each));
        return saved;
    }
    static const glm::dvec2& point_of(const FlatChart& chart, Corner corner) {
        const glm::uvec3& v = chart.mesh.vertices[corner / 3];
        return chart.coordinates[v[static_cast<glm::length_t>(corner % 3)]];
    }

    FlatChart extracted(const FlatChart& chart, const Parts& parts, std::uint32_t part) {
        std::vector<std::uint32_t> faces;
        std::vector<std::uint32_t> old;
        for (std::uint32_t i = 0; i < parts.of_face.size(); ++i) {
            if (parts.of_face[i] != part) continue;
            faces.push_back(chart.mesh.faces[i]);
            old.push_back(i);
        }
        members_.assign(faces);
        FlatChart result;
        result.mesh = chart_mesh(surface_, members_, std::move(faces));
        result.coordinates.resize(result.mesh.positions.size());
        for (std::size_t i = 0; i < old.size(); ++i) {
            for (glm::length_t k = 0; k < 3; ++k)
                result.coordinates[result.mesh.vertices[i][k]] =
                    chart.coordinates[chart.mesh.vertices[old[i]][k]];
            result.area += surface_.areas[result.mesh.faces[i]];
        }
        align_to_box(result);
        return result;
    }

    const AtlasSurface& surface_;
    ChartMembers& members_;
    double cost_;  ///< Of a unit of the length of cuts, an area.
    double min_waste_;
    double min_part_;
};

}  // namespace

std::vector<FlatChart> cut_charts(const AtlasSurface& surface, ChartMembers& members,
                                  const FlatnessLimits& limits, std::vector<FlatChart> charts) {
    double area = 0.0;
    double length = 0.0;  // Of the seams.
    for (const FlatChart& chart : charts) {
        area += chart.area;
        for (Corner corner = 0; corner < chart.mesh.opposite.size(); ++corner)
            if (chart.mesh.opposite[corner] == no_corner)
                length += 0.5 * surface.edge_length(3 * chart.mesh.faces[corner / 3] + corner % 3);
    }
    const double seam_cost =
        std::min(min_saving, min_saving_of_seams * area / (length * length)) * std::sqrt(area);
    std::vector<std::vector<FlatChart>> parts(charts.size());
    parallel_for(charts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            ChartCutter(surface, members, limits, area, seam_cost)
                .cut(std::move(charts[i]), parts[i]);
    });
    std::vector<FlatChart> result;
    for (std::vector<FlatChart>& each : parts)
        std::move(each.begin(), each.end(), std::back_inserter(result));
    return result;
}

}  // namespace relief::detail

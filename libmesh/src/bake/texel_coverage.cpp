// SPDX-License-Identifier: Apache-2.0
// Texel coverage: the triangle that owns each texel of a map, and the texture tiles that triangles
// overlap.
//
// The map is drawn in bands of 64 rows, one band per thread. Each texel goes to the triangle that
// ranks first in a strict order, so the order of drawing has no influence. Triangles are drawn with
// edge functions in 128-bit integers over fixed-point coordinates of at most 2^60, so no product or
// sum rounds. Positions are in texels, x right and y down, from the upper left corner of the map.
// Tests: tests/mesh/bake/texel_coverage_test.cpp.
#include "relief/mesh/texel_coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "compiler.h"
#include "geometry/check_triangles.h"
#include "parallel.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Integers that hold sums of products of two fixed-point coordinates.
using Wide = Integer128;

/// The fixed-point unit: 2^bits per texel.
struct TexelScale {
    explicit TexelScale(int largest_side);
    [[nodiscard]] std::int64_t fixed(double texels) const;
    [[nodiscard]] std::int64_t one() const { return std::int64_t{1} << bits; }
    int bits;
};

/// The texels [begin, end) of a row or a column; the range is empty if end <= begin.
struct TexelRange {
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

/// A fixed-point position.
using FixedPoint = std::array<std::int64_t, 2>;

/// A triangle on the texel grid: exact tests for texel centers and texel squares.
class TexelTriangle {
  public:
    /// The reason why a triangle covers no texel.
    enum class Problem { none, not_finite, too_far, no_area };
    /// Sets `triangle` unless there is a problem. \param texels  the corners
    static Problem make(const std::array<glm::dvec2, 3>& texels, const TexelScale& scale,
                        TexelTriangle& triangle);

    /// Returns the rows whose texels the triangle may overlap.
    [[nodiscard]] TexelRange rows() const;
    /// Returns the texels of a row whose center is inside.
    [[nodiscard]] TexelRange inside(std::int64_t row) const;
    /// Returns the texels of a row whose square overlaps the triangle with a positive area.
    [[nodiscard]] TexelRange touched(std::int64_t row) const;

    /// Returns the barycentric weights of a texel's center, which is inside, in the order of
    /// make().
    [[nodiscard]] glm::dvec3 weights(std::int64_t column, std::int64_t row) const;
    /// Returns the weights of the point of the triangle nearest to a texel's center, and its
    /// squared distance.
    [[nodiscard]] glm::dvec3 nearest(std::int64_t column, std::int64_t row,
                                     double& squared_distance) const;

    [[nodiscard]] bool is_mirrored() const { return is_mirrored_; }
    /// Returns the corners sorted by position: the same for any first corner.
    [[nodiscard]] const std::array<FixedPoint, 3>& sorted() const { return sorted_; }

  private:
    struct Edge {
        std::int64_t a, b;  ///< The inward normal.
        Wide c;             ///< a x + b y + c >= 0 inside, in fixed point.
        bool owns_its_points;
    };
    [[nodiscard]] TexelRange columns_where(std::int64_t row, bool whole_square) const;
    [[nodiscard]] glm::dvec3 in_given_order(const glm::dvec3& weights) const;

    TexelScale scale_{1};
    std::array<FixedPoint, 3> corners_{}, sorted_{};  ///< The corners are clockwise.
    std::array<Edge, 3> edges_{};                     ///< Edge i is opposite corner i.
    double doubled_area_ = 0.0;
    bool is_mirrored_ = false;
};

constexpr int unit_square_bits = 28;
constexpr double max_coordinate = 0x1p33;  // In texels.

Wide floor_divide(Wide numerator, Wide positive) {
    const Wide quotient = numerator / positive;
    return numerator % positive < 0 ? quotient - 1 : quotient;
}
Wide ceiling_divide(Wide numerator, Wide positive) {
    return -floor_divide(-numerator, positive);
}

glm::dvec2 as_double(const FixedPoint& point, double unit) {
    return {static_cast<double>(point[0]) / unit, static_cast<double>(point[1]) / unit};
}

/// Returns the parameter, 0 to 1, of the point of a segment nearest to `p`.
double along_segment(const glm::dvec2& p, const glm::dvec2& from, const glm::dvec2& to) {
    const glm::dvec2 edge = to - from;
    return std::clamp(glm::dot(p - from, edge) / glm::dot(edge, edge), 0.0, 1.0);
}

TexelScale::TexelScale(int largest_side) : bits(unit_square_bits) {
    while (bits > 0 && (std::int64_t{largest_side} << bits) > (std::int64_t{1} << unit_square_bits))
        --bits;
}

std::int64_t TexelScale::fixed(double texels) const {
    // std::round would break ties by the sign, and so depend on the tile.
    return static_cast<std::int64_t>(std::floor(std::ldexp(texels, bits) + 0.5));
}

TexelTriangle::Problem TexelTriangle::make(const std::array<glm::dvec2, 3>& texels,
                                           const TexelScale& scale, TexelTriangle& triangle) {
    std::array<FixedPoint, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
        if (!std::isfinite(texels[i].x) || !std::isfinite(texels[i].y)) return Problem::not_finite;
        if (std::max(std::abs(texels[i].x), std::abs(texels[i].y)) > max_coordinate)
            return Problem::too_far;
        corners[i] = {scale.fixed(texels[i].x), scale.fixed(texels[i].y)};
    }
    const auto doubled_area = [](const std::array<FixedPoint, 3>& c) {
        return Wide{c[1][0] - c[0][0]} * (c[2][1] - c[0][1]) -
               Wide{c[1][1] - c[0][1]} * (c[2][0] - c[0][0]);
    };
    Wide area = doubled_area(corners);
    if (area == 0) return Problem::no_area;
    triangle.scale_ = scale;
    // A counter-clockwise triangle is also counter-clockwise in an unmirrored image. With y down,
    // its area is negative there.
    triangle.is_mirrored_ = area > 0;
    if (area < 0) {
        std::swap(corners[1], corners[2]);
        area = -area;
    }
    triangle.corners_ = corners;
    triangle.sorted_ = corners;
    std::sort(triangle.sorted_.begin(), triangle.sorted_.end());
    triangle.doubled_area_ = static_cast<double>(area);
    for (std::size_t i = 0; i < 3; ++i) {
        const FixedPoint& from = corners[(i + 1) % 3];
        const FixedPoint& to = corners[(i + 2) % 3];
        Edge& edge = triangle.edges_[i];
        edge.a = from[1] - to[1];
        edge.b = to[0] - from[0];
        edge.c = -(Wide{edge.a} * from[0] + Wide{edge.b} * from[1]);
        // The top-left rule of GPU rasterizers.
        edge.owns_its_points = edge.a > 0 || (edge.a == 0 && edge.b > 0);
    }
    return Problem::none;
}

TexelRange TexelTriangle::rows() const {
    const auto [low, high] = std::minmax({corners_[0][1], corners_[1][1], corners_[2][1]});
    return {low >> scale_.bits, (high >> scale_.bits) + 1};
}

TexelRange TexelTriangle::columns_where(std::int64_t row, bool whole_square) const {
    const std::int64_t one = scale_.one();
    const std::int64_t half = one / 2;
    const std::int64_t y = row * one + half;
    Wide begin = std::numeric_limits<std::int64_t>::min();
    Wide end = std::numeric_limits<std::int64_t>::max();
    if (whole_square) {
        const auto [low, high] = std::minmax({corners_[0][0], corners_[1][0], corners_[2][0]});
        const auto [top, bottom] = std::minmax({corners_[0][1], corners_[1][1], corners_[2][1]});
        if (bottom <= row * one || top >= (row + 1) * one) return {};
        begin = floor_divide(low, one);
        end = ceiling_divide(high, one);
    }
    for (const Edge& edge : edges_) {
        // The center of column i is at x = i * one + half. Positive values are inside.
        Wide at_first = Wide{edge.a} * half + Wide{edge.b} * y + edge.c;
        bool or_zero = edge.owns_its_points;
        if (whole_square) {
            // The corner of the square that is furthest inside decides; touching in a point does
            // not count.
            at_first += (Wide{std::abs(edge.a)} + std::abs(edge.b)) * half;
            or_zero = false;
        }
        const Wide least = or_zero ? 0 : 1;
        const Wide step = Wide{edge.a} * one;
        if (step > 0)
            begin = std::max(begin, ceiling_divide(least - at_first, step));
        else if (step < 0)
            end = std::min(end, floor_divide(at_first - least, -step) + 1);
        else if (at_first < least)
            return {};
    }
    if (begin >= end) return {};
    return {static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end)};
}

TexelRange TexelTriangle::inside(std::int64_t row) const {
    return columns_where(row, false);
}

TexelRange TexelTriangle::touched(std::int64_t row) const {
    return columns_where(row, true);
}

glm::dvec3 TexelTriangle::in_given_order(const glm::dvec3& weights) const {
    return is_mirrored_ ? weights : glm::dvec3(weights.x, weights.z, weights.y);
}

glm::dvec3 TexelTriangle::weights(std::int64_t column, std::int64_t row) const {
    const std::int64_t half = scale_.one() / 2;
    const std::int64_t x = column * scale_.one() + half;
    const std::int64_t y = row * scale_.one() + half;
    glm::dvec3 weights;
    for (std::size_t i = 0; i < 3; ++i) {
        const Edge& edge = edges_[i];
        weights[static_cast<int>(i)] =
            static_cast<double>(Wide{edge.a} * x + Wide{edge.b} * y + edge.c) / doubled_area_;
    }
    return in_given_order(weights);
}

glm::dvec3 TexelTriangle::nearest(std::int64_t column, std::int64_t row,
                                  double& squared_distance) const {
    const auto unit = static_cast<double>(scale_.one());
    // The sorted order makes the distance independent of the first corner.
    const glm::dvec2 p(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    squared_distance = std::numeric_limits<double>::infinity();
    std::array<double, 3> best{};
    for (const auto& [from, to] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
        const glm::dvec2 a = as_double(sorted_[from], unit);
        const glm::dvec2 b = as_double(sorted_[to], unit);
        const double along = along_segment(p, a, b);
        const glm::dvec2 rest = a + along * (b - a) - p;
        if (glm::dot(rest, rest) >= squared_distance) continue;
        squared_distance = glm::dot(rest, rest);
        best = {};
        best[from] = 1.0 - along;
        best[to] = along;
    }
    glm::dvec3 weights(0.0);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto place = std::find(corners_.begin(), corners_.end(), sorted_[i]);
        weights[static_cast<int>(place - corners_.begin())] = best[i];
    }
    return in_given_order(weights);
}

constexpr int band_rows = TexelRasterizer::band_rows;
constexpr double max_repeats = 64.0;  // Of a repeating texture, across one triangle.

/// The triangles of a map on the texel grid, made on demand from an index.
class Triangles {
  public:
    Triangles(std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
              const CoverageOptions& options)
        : texcoords_(texcoords),
          triangles_(triangles),
          options_(options),
          scale_(std::max(options.width, options.height)) {}

    [[nodiscard]] std::size_t count() const {
        return options_.only ? options_.only->size() : triangles_.size();
    }
    [[nodiscard]] std::size_t index(std::size_t place) const {
        return options_.only ? (*options_.only)[place] : place;
    }

    TexelTriangle::Problem make(std::size_t index, TexelTriangle& triangle) const {
        std::array<glm::dvec2, 3> corners;
        glm::dvec2 least(std::numeric_limits<double>::infinity());
        for (std::size_t i = 0; i < 3; ++i) {
            corners[i] = glm::dvec2(texcoords_[triangles_[index][static_cast<int>(i)]]);
            least = glm::min(least, glm::floor(corners[i]));
        }
        const glm::dvec2 tile = options_.repeat ? least : glm::dvec2(options_.tile);
        for (glm::dvec2& corner : corners) {
            corner -= tile;
            if (options_.repeat && std::max(corner.x, corner.y) > max_repeats)
                return TexelTriangle::Problem::too_far;
            corner *= glm::dvec2(options_.width, options_.height);
        }
        return TexelTriangle::make(corners, scale_, triangle);
    }

  private:
    std::span<const glm::vec2> texcoords_;
    std::span<const glm::uvec3> triangles_;
    const CoverageOptions& options_;
    TexelScale scale_;
};

/// Calls visit(begin, end, offset) for the parts of [first, last) on the map. The range is clipped,
/// or with `repeat` wrapped. `offset` is what the wrapping subtracted.
template <typename Visit>
void for_parts(std::int64_t first, std::int64_t last, std::int64_t count, bool repeat,
               const Visit& visit) {
    if (!repeat) {
        first = std::max<std::int64_t>(first, 0);
        last = std::min(last, count);
        if (first < last) visit(first, last, std::int64_t{0});
        return;
    }
    while (first < last) {
        const std::int64_t moved = (first % count + count) % count;
        const std::int64_t length = std::min(last - first, count - moved);
        visit(moved, moved + length, first - moved);
        first += length;
    }
}

/// The triangles that overlap each band, in ascending order.
class Bands {
  public:
    Bands(const Triangles& triangles, const CoverageOptions& options, Report& report)
        : count_(static_cast<std::size_t>((options.height + band_rows - 1) / band_rows)),
          starts_(count_ + 1, 0) {
        // The first pass counts, the second one fills.
        for_each_overlap(triangles, options, &report,
                         [&](std::size_t, std::size_t band) { ++starts_[band + 1]; });
        for (std::size_t band = 0; band < count_; ++band)
            starts_[band + 1] += starts_[band];
        members_.resize(starts_.back());
        std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
        for_each_overlap(triangles, options, nullptr, [&](std::size_t index, std::size_t band) {
            members_[next[band]++] = static_cast<std::uint32_t>(index);
        });
    }

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] std::span<const std::uint32_t> members(std::size_t band) const {
        return std::span(members_).subspan(starts_[band], starts_[band + 1] - starts_[band]);
    }

  private:
    template <typename Visit>
    void for_each_overlap(const Triangles& triangles, const CoverageOptions& options,
                          Report* report, const Visit& visit) const {
        std::vector<std::size_t> overlapped;
        for (std::size_t place = 0; place < triangles.count(); ++place) {
            const std::size_t index = triangles.index(place);
            TexelTriangle triangle;
            const TexelTriangle::Problem problem = triangles.make(index, triangle);
            if (problem != TexelTriangle::Problem::none) {
                if (report != nullptr) note(problem, index, *report);
                continue;
            }
            TexelRange rows = triangle.rows();
            if (rows.end - rows.begin > options.height && options.repeat)
                rows = {0, options.height};
            overlapped.clear();
            for_parts(rows.begin, rows.end, options.height, options.repeat,
                      [&](std::int64_t first, std::int64_t last, std::int64_t) {
                          for (auto band = first / band_rows; band * band_rows < last; ++band)
                              overlapped.push_back(static_cast<std::size_t>(band));
                      });
            std::sort(overlapped.begin(), overlapped.end());
            overlapped.erase(std::unique(overlapped.begin(), overlapped.end()), overlapped.end());
            for (const std::size_t band : overlapped)
                visit(index, band);
        }
    }

    static void note(TexelTriangle::Problem problem, std::size_t index, Report& report) {
        switch (problem) {
            case TexelTriangle::Problem::not_finite:
                report.add("texture not finite", "triangle", index, "covers no texel");
                break;
            case TexelTriangle::Problem::too_far:
                report.add("texture too far away", "triangle", index, "covers no texel");
                break;
            default:
                report.add("triangle without area in the image", "triangle", index,
                           "covers no texel");
        }
    }

    std::size_t count_;
    std::vector<std::size_t> starts_;
    std::vector<std::uint32_t> members_;
};

/// Draws one band.
class Band {
  public:
    Band(const Triangles& triangles, const CoverageOptions& options, int first_row)
        : triangles_(triangles),
          options_(options),
          first_row_(first_row),
          last_row_(std::min(options.height, first_row + band_rows)),
          texels_(static_cast<std::size_t>(options.width) *
                  static_cast<std::size_t>(last_row_ - first_row)),
          distances_(options.touched ? texels_.size() : 0),
          holders_(texels_.size(), 0) {}

    void draw(std::uint32_t index) {
        TexelTriangle triangle;
        triangles_.make(index, triangle);
        compared_with_ = CoveredTexel::no_triangle;
        const TexelRange rows = triangle.rows();
        for_parts(rows.begin, rows.end, options_.height, options_.repeat,
                  [&](std::int64_t first, std::int64_t last, std::int64_t moved) {
                      first = std::max<std::int64_t>(first, first_row_);
                      last = std::min<std::int64_t>(last, last_row_);
                      for (std::int64_t row = first; row < last; ++row)
                          draw_row(index, triangle, row, row + moved);
                  });
    }

    Coverage finish(Report& report) const {
        Coverage coverage;
        for (std::size_t i = 0; i < texels_.size(); ++i) {
            ++(texels_[i].is_inside      ? coverage.inside
               : texels_[i].is_covered() ? coverage.touched
                                         : coverage.empty);
            if (is_shared(i)) ++coverage.shared;
            if (holders_[i] == plain_and_mirrored) ++coverage.mirrored;
        }
        if (coverage.shared > 0) report_shared(report);
        return coverage;
    }
    [[nodiscard]] std::span<const CoveredTexel> texels() const { return texels_; }

  private:
    // The kinds of triangles that contain a texel's center.
    static constexpr std::uint8_t plain = 1;
    static constexpr std::uint8_t mirrored = 2;
    static constexpr std::uint8_t plain_and_mirrored = plain | mirrored;
    static constexpr std::uint8_t several_of_a_kind = 4;

    [[nodiscard]] bool is_shared(std::size_t i) const { return holders_[i] >= plain_and_mirrored; }

    /// Reports each texel once for all its samples, as mirrored only if all shared samples are.
    void report_shared(Report& report) const {
        const auto side = static_cast<std::size_t>(options_.samples_across);
        const std::size_t columns = static_cast<std::size_t>(options_.width);
        const std::size_t width = columns / side;
        std::vector<std::uint8_t> flags(texels_.size() / (side * side), 0);
        const std::size_t first_texel = static_cast<std::size_t>(first_row_) / side * width;
        for (std::size_t i = 0; i < texels_.size(); ++i) {
            if (is_shared(i)) flags[i / columns / side * width + i % columns / side] |= holders_[i];
        }
        for (std::size_t texel = 0; texel < flags.size(); ++texel) {
            if (flags[texel] == plain_and_mirrored) {
                report.add("texel of mirrored triangles", "texel", first_texel + texel,
                           "belongs to the one that is not mirrored");
            } else if (flags[texel] != 0) {
                report.add("texel of several triangles", "texel", first_texel + texel,
                           "belongs to one of them, by a fixed rule");
            }
        }
    }

    void draw_row(std::uint32_t index, const TexelTriangle& triangle, std::int64_t row,
                  std::int64_t row_there) {
        const std::size_t first =
            static_cast<std::size_t>(row - first_row_) * static_cast<std::size_t>(options_.width);
        const TexelRange inside = triangle.inside(row_there);
        for_parts(inside.begin, inside.end, options_.width, options_.repeat,
                  [&](std::int64_t begin, std::int64_t end, std::int64_t moved) {
                      for (std::int64_t column = begin; column < end; ++column)
                          claim_inside(first + static_cast<std::size_t>(column), index, triangle,
                                       column + moved, row_there);
                  });
        if (!options_.touched) return;
        const TexelRange touched = triangle.touched(row_there);
        const auto claim = [&](std::int64_t begin, std::int64_t end, std::int64_t moved) {
            for (std::int64_t column = begin; column < end; ++column)
                claim_touched(first + static_cast<std::size_t>(column), index, triangle,
                              column + moved, row_there);
        };
        if (inside.begin >= inside.end) {
            for_parts(touched.begin, touched.end, options_.width, options_.repeat, claim);
            return;
        }
        for_parts(touched.begin, inside.begin, options_.width, options_.repeat, claim);
        for_parts(inside.end, touched.end, options_.width, options_.repeat, claim);
    }

    /// Returns whether the triangle being drawn ranks before the owner of a texel. The result is
    /// cached, because neighboring texels mostly have the same owner.
    [[nodiscard]] bool is_before(std::uint32_t index, const TexelTriangle& triangle,
                                 std::uint32_t owner_index) {
        if (owner_index == compared_with_) return is_before_;
        TexelTriangle owner;
        triangles_.make(owner_index, owner);
        compared_with_ = owner_index;
        is_before_ = std::make_tuple(triangle.is_mirrored(), triangle.sorted(), index) <
                     std::make_tuple(owner.is_mirrored(), owner.sorted(), owner_index);
        return is_before_;
    }

    void set(std::size_t at, std::uint32_t index, const glm::dvec3& weights, bool is_inside) {
        texels_[at] = {index, static_cast<float>(weights.y), static_cast<float>(weights.z),
                       is_inside};
    }

    void claim_inside(std::size_t at, std::uint32_t index, const TexelTriangle& triangle,
                      std::int64_t column, std::int64_t row) {
        const std::uint8_t side = triangle.is_mirrored() ? mirrored : plain;
        if ((holders_[at] & side) != 0) holders_[at] |= several_of_a_kind;
        holders_[at] |= side;
        if (texels_[at].is_inside) {
            if (!is_before(index, triangle, texels_[at].triangle)) return;
        }
        set(at, index, triangle.weights(column, row), true);
    }

    void claim_touched(std::size_t at, std::uint32_t index, const TexelTriangle& triangle,
                       std::int64_t column, std::int64_t row) {
        if (texels_[at].is_inside) return;
        double distance = 0.0;
        const glm::dvec3 weights = triangle.nearest(column, row, distance);
        if (texels_[at].is_covered()) {
            if (distance > distances_[at]) return;
            if (distance == distances_[at] && !is_before(index, triangle, texels_[at].triangle))
                return;
        }
        distances_[at] = distance;
        set(at, index, weights, false);
    }

    const Triangles& triangles_;
    const CoverageOptions& options_;
    int first_row_, last_row_;
    std::vector<CoveredTexel> texels_;
    std::vector<double> distances_;  ///< Squared, of texels that are only touched.
    std::vector<std::uint8_t> holders_;
    std::uint32_t compared_with_ =
        CoveredTexel::no_triangle;  ///< The owner that `is_before_` is for.
    bool is_before_ = false;
};

void check(std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
           const CoverageOptions& options) {
    for (const int side : {options.width, options.height}) {
        if (side < 1 || side > TexelRasterizer::largest_side)
            throw InvalidInput(
                fmt::format("the map has {} x {} texels, but must have 1 to {} along each side",
                            options.width, options.height, TexelRasterizer::largest_side));
    }
    const int across = options.samples_across;
    constexpr std::array known = {1, 2, 4, 8, 16, 32};
    const bool is_known = std::find(known.begin(), known.end(), across) != known.end();
    if (!is_known || options.width % across != 0 || options.height % across != 0)
        throw InvalidInput(fmt::format(
            "the number of samples across a texel is {}, but must be 1, 2, 4, 8, 16 or 32",
            across));
    check_triangles(triangles, texcoords.size());
    if (options.only && !options.only->empty() && options.only->back() >= triangles.size())
        throw InvalidInput(fmt::format("there is no triangle {}", options.only->back()));
}

}  // namespace

struct TexelRasterizer::Implementation {
    Implementation(std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
                   const CoverageOptions& given, Report& report)
        : options(given), all(texcoords, triangles, options), bands(all, options, report) {}

    CoverageOptions options;
    Triangles all;
    Bands bands;
};

TexelRasterizer::TexelRasterizer(std::span<const glm::vec2> texcoords,
                                 std::span<const glm::uvec3> triangles,
                                 const CoverageOptions& options, Report& report) {
    check(texcoords, triangles, options);
    implementation_ = std::make_unique<Implementation>(texcoords, triangles, options, report);
}

TexelRasterizer::~TexelRasterizer() = default;

Coverage TexelRasterizer::cover(
    int first_row, int last_row,
    const std::function<void(int first_row, std::span<const CoveredTexel> texels)>& take,
    Report& report) const {
    // Clang 14 cannot capture structured bindings in a lambda.
    const CoverageOptions& options = implementation_->options;
    const Triangles& all = implementation_->all;
    const Bands& bands = implementation_->bands;
    const auto first_band = static_cast<std::size_t>(first_row / band_rows);
    const auto last_band = static_cast<std::size_t>((last_row + band_rows - 1) / band_rows);
    std::vector<Coverage> coverages(last_band - first_band);
    parallel_for_reporting(
        coverages.size(), 1, report, [&](std::size_t begin, std::size_t end, Report& findings) {
            for (std::size_t i = begin; i < end; ++i) {
                const int band_row = static_cast<int>(first_band + i) * band_rows;
                Band band(all, options, band_row);
                for (const std::uint32_t index : bands.members(first_band + i))
                    band.draw(index);
                coverages[i] = band.finish(findings);
                take(band_row, band.texels());
            }
        });
    Coverage coverage;
    for (const Coverage& one : coverages)
        coverage += one;
    return coverage;
}

Coverage cover_texels(
    std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
    const CoverageOptions& options,
    const std::function<void(int first_row, std::span<const CoveredTexel> texels)>& take,
    Report& report) {
    return TexelRasterizer(texcoords, triangles, options, report)
        .cover(0, options.height, take, report);
}

namespace {

constexpr double tile_margin = 1e-5;  // Relative to the side of a tile.
constexpr std::size_t max_tiles = 1000;

using Corners = std::array<glm::dvec2, 3>;

/// The first and the last tile that an interval overlaps.
struct Interval {
    double first, last;

    Interval(double least, double greatest)
        : first(std::floor(least + tile_margin)), last(std::ceil(greatest - tile_margin) - 1.0) {
        if (first > last) first = last = std::floor((least + greatest) / 2.0);
    }
};

/// Returns whether an edge of the triangle separates it from the square.
bool is_apart(const Corners& corners, const glm::dvec2& low, const glm::dvec2& high) {
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec2 edge = corners[(i + 1) % 3] - corners[i];
        const glm::dvec2 across(-edge.y, edge.x);
        const double third = glm::dot(across, corners[(i + 2) % 3] - corners[i]);
        // The normal towards the triangle; for a triangle without area, either one.
        const glm::dvec2 inwards = third < 0.0 ? -across : across;
        const glm::dvec2 farthest(inwards.x > 0.0 ? high.x : low.x,
                                  inwards.y > 0.0 ? high.y : low.y);
        if (glm::dot(inwards, farthest - corners[i]) < 0.0) return true;
    }
    return false;
}

/// Orders tiles by UDIM number.
struct ByNumber {
    bool operator()(const glm::ivec2& a, const glm::ivec2& b) const {
        return a.y != b.y ? a.y > b.y : a.x < b.x;
    }
};

/// Collects the triangles of each tile.
class Sorting {
  public:
    explicit Sorting(const TileRange& range) : range_(range) {}

    void add(std::uint32_t index, const Corners& corners) {
        const glm::dvec2 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
        const glm::dvec2 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
        if (!std::isfinite(low.x + low.y + high.x + high.y)) {
            result_.not_finite.push_back(index);
            return;
        }
        const Interval across(low.x, high.x), down(low.y, high.y);
        const glm::dvec2 least(range_.min), greatest(range_.max);
        const glm::dvec2 begin = glm::max(glm::dvec2(across.first, down.first), least);
        const glm::dvec2 end = glm::min(glm::dvec2(across.last, down.last), greatest);
        bool is_inside = across.first >= least.x && across.last <= greatest.x &&
                         down.first >= least.y && down.last <= greatest.y;
        const bool is_one = across.first == across.last && down.first == down.last;
        bool is_anywhere = false;
        for (double y = begin.y; y <= end.y; ++y) {
            for (double x = begin.x; x <= end.x; ++x) {
                const glm::dvec2 corner(x, y);
                if (!is_one &&
                    is_apart(corners, corner + tile_margin, corner + (1.0 - tile_margin)))
                    continue;
                is_anywhere = true;
                place(glm::ivec2(corner), index);
            }
        }
        if (!is_anywhere) {
            result_.outside.push_back(index);
        } else if (!is_inside) {
            result_.partly_outside.push_back(index);
        }
    }

    MapTiles finish() {
        for (auto& [tile, triangles] : tiles_)
            result_.tiles.push_back({tile, std::move(triangles)});
        return std::move(result_);
    }

  private:
    void place(const glm::ivec2& tile, std::uint32_t index) {
        tiles_[tile].push_back(index);
        if (tiles_.size() > max_tiles) {
            throw InvalidInput(
                fmt::format("the texture coordinates enter more than {} tiles", max_tiles));
        }
    }

    TileRange range_;
    std::map<glm::ivec2, std::vector<std::uint32_t>, ByNumber> tiles_;
    MapTiles result_;
};

}  // namespace

MapTiles tiles_of(std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
                  const std::optional<std::span<const std::uint32_t>>& only,
                  const TileRange& range) {
    check_triangles(triangles, texcoords.size());
    Sorting sorting(range);
    const std::size_t count = only ? only->size() : triangles.size();
    for (std::size_t i = 0; i < count; ++i) {
        const auto index = only ? (*only)[i] : static_cast<std::uint32_t>(i);
        if (index >= triangles.size())
            throw InvalidInput(fmt::format("there is no triangle {}", index));
        Corners corners;
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = glm::dvec2(texcoords[triangles[index][static_cast<int>(k)]]);
        sorting.add(index, corners);
    }
    return sorting.finish();
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Rasterizes all triangles into one image of owners. If a triangle covers a texel that another one
// owns, both overlap, and all texels of the new triangle are closed: every later triangle that
// covers a closed texel overlaps too. A texel changes at most twice, from empty to owned to closed.
// Runs of closed texels are skipped in one step (each points to the next texel that may be open,
// with path compression). The work is therefore that of the raster plus the rows of every triangle,
// however often the image is covered.
//
// The result does not depend on the order of triangles: overlapping triangles are those that share
// a texel.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/direction.h"
#include "progress_stage.h"
#include "topology/diagnose_parts.h"

namespace relief::detail {
namespace {

constexpr int min_side = 1024;
constexpr int largest_side = 4096;
constexpr double texels_by_triangle = 4.0;

// Limits of rows: per triangle, and in total for small meshes.
constexpr std::uint64_t rows_by_triangle = 32;
constexpr std::uint64_t rows_at_least = 4'000'000;

// Minimal distance of a texel's center from all edges, in texels.
constexpr double texel_margin = 1e-3;

constexpr std::uint32_t no_owner = std::numeric_limits<std::uint32_t>::max();

struct Box {
    glm::dvec2 min{std::numeric_limits<double>::infinity()};
    glm::dvec2 max{-std::numeric_limits<double>::infinity()};
};

using Corners = std::array<glm::dvec2, 3>;

double area_of(const Corners& c) {
    const glm::dvec2 a = c[1] - c[0];
    const glm::dvec2 b = c[2] - c[0];
    return a.x * b.y - a.y * b.x;
}

/// Corners of a triangle, counter-clockwise in u and v; none if its area is zero.
std::optional<Corners> corners_of(std::span<const glm::vec2> texcoords,
                                  const glm::uvec3& triangle) {
    Corners corners;
    for (int i = 0; i < 3; ++i) {
        if (!is_finite(texcoords[triangle[i]])) return std::nullopt;
        corners[static_cast<std::size_t>(i)] = glm::dvec2(texcoords[triangle[i]]);
    }
    const double area = area_of(corners);
    if (area == 0.0) return std::nullopt;
    if (area < 0.0) std::swap(corners[1], corners[2]);
    return corners;
}

Box box_of(std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles) {
    Box box;
    for (const glm::uvec3& triangle : triangles) {
        const std::optional<Corners> corners = corners_of(texcoords, triangle);
        if (!corners) continue;
        for (const glm::dvec2& corner : *corners) {
            box.min = glm::min(box.min, corner);
            box.max = glm::max(box.max, corner);
        }
    }
    return box;
}

/// Returns the side of the raster: two by two texels per triangle, fewer if the rows would be too
/// many. Rows are counted in whole rows of the largest raster, so the order of triangles does not
/// matter.
int side_for(std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
             const Box& box) {
    const double per_row = largest_side / (box.max.y - box.min.y);
    std::uint64_t rows = 0;
    for (const glm::uvec3& triangle : triangles) {
        const std::optional<Corners> corners = corners_of(texcoords, triangle);
        if (!corners) continue;
        const auto [low, high] = std::minmax({(*corners)[0].y, (*corners)[1].y, (*corners)[2].y});
        rows += static_cast<std::uint64_t>((high - low) * per_row);
    }
    const double wanted =
        std::clamp(std::sqrt(texels_by_triangle * static_cast<double>(triangles.size())),
                   static_cast<double>(min_side), static_cast<double>(largest_side));
    const auto allowed =
        static_cast<double>(std::max(rows_by_triangle * triangles.size(), rows_at_least));
    const double affordable =
        rows == 0 ? wanted : largest_side * (allowed / static_cast<double>(rows));
    return std::max(1, static_cast<int>(std::min(wanted, affordable)));
}

/// Owner of each texel.
class Raster {
  public:
    Raster(int side, std::size_t triangle_count)
        : side_(side),
          owners_(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), no_owner),
          skips_(owners_.size(), 0),
          overlapping_(triangle_count, 0) {}

    /// Rasterizes a triangle. Corners are in texels, counter-clockwise.
    void draw(std::uint32_t triangle, const Corners& corners) {
        if (meets_another(corners)) {
            overlapping_[triangle] = 1;
            for_spans(corners, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = open_from(begin, end); i < end; i = open_from(i, end))
                    skips_[i] = 1;
            });
        } else {
            for_spans(corners, [&](std::size_t begin, std::size_t end) {
                std::fill(owners_.begin() + static_cast<std::ptrdiff_t>(begin),
                          owners_.begin() + static_cast<std::ptrdiff_t>(end), triangle);
            });
        }
    }

    [[nodiscard]] std::vector<std::uint8_t> take_overlapping() { return std::move(overlapping_); }

  private:
    /// Tests whether any texel of the triangle has an owner. The owners of all such texels overlap.
    bool meets_another(const Corners& corners) {
        bool meets = false;
        for_spans(corners, [&](std::size_t begin, std::size_t end) {
            for (std::size_t texel = begin; texel < end; ++texel) {
                const std::size_t open = open_from(texel, end);
                if (open != texel) meets = true;  // The texels between are closed.
                texel = open;
                if (open == end || owners_[open] == no_owner) continue;
                meets = true;
                overlapping_[owners_[open]] = 1;
            }
        });
        return meets;
    }

    /// First texel of [texel, end) that is not closed, or `end`. Paths along closed texels are
    /// shortened.
    std::size_t open_from(std::size_t texel, std::size_t end) {
        std::size_t open = texel;
        while (open < end && skips_[open] != 0)
            open += skips_[open];
        for (std::size_t walked = texel; walked < end && walked < open;) {
            const std::size_t next = walked + skips_[walked];
            skips_[walked] = static_cast<std::uint16_t>(open - walked);
            walked = next;
        }
        return std::min(open, end);
    }

    /// Calls visit(begin, end) for the texels of every row whose centers are inside.
    template <typename Visit>
    void for_spans(const Corners& corners, const Visit& visit);

    int side_;
    std::vector<std::uint32_t> owners_;
    /// 0 if a texel is open, otherwise a lower bound of the distance to the next one that may be
    /// open, never beyond the end of the row.
    std::vector<std::uint16_t> skips_;
    std::vector<std::uint8_t> overlapping_;
};

/// Edge as the half plane on its left, moved inwards by the margin: normal . p >= offset.
struct HalfPlane {
    glm::dvec2 normal;
    double offset;

    HalfPlane(const glm::dvec2& from, const glm::dvec2& to)
        : normal(from.y - to.y, to.x - from.x),
          offset(glm::dot(normal, from) + texel_margin * glm::length(normal)) {}
};

template <typename Visit>
void Raster::for_spans(const Corners& corners, const Visit& visit) {
    const std::array planes = {HalfPlane(corners[0], corners[1]), HalfPlane(corners[1], corners[2]),
                               HalfPlane(corners[2], corners[0])};
    const auto [low, high] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
    const int first_row = std::max(0, static_cast<int>(std::ceil(low - 0.5)));
    const int last_row = std::min(side_ - 1, static_cast<int>(std::floor(high - 0.5)));
    for (int row = first_row; row <= last_row; ++row) {
        check_cancelled();
        const double y = row + 0.5;
        double begin = 0.5;
        double end = side_ - 0.5;
        for (const HalfPlane& plane : planes) {
            const double rest = plane.offset - plane.normal.y * y;
            if (plane.normal.x > 0.0)
                begin = std::max(begin, rest / plane.normal.x);
            else if (plane.normal.x < 0.0)
                end = std::min(end, rest / plane.normal.x);
            else if (rest > 0.0)
                end = -1.0;
        }
        if (begin > end) continue;
        const auto first = static_cast<std::size_t>(std::ceil(begin - 0.5));
        const auto count = static_cast<std::size_t>(std::floor(end - 0.5)) + 1;
        if (first >= count) continue;
        const std::size_t start = static_cast<std::size_t>(row) * static_cast<std::size_t>(side_);
        visit(start + first, start + count);
    }
}

}  // namespace

TextureOverlap texture_overlap(std::span<const glm::vec2> texcoords,
                               std::span<const glm::uvec3> triangles) {
    TextureOverlap overlap{std::vector<std::uint8_t>(triangles.size(), 0), 0};
    const Box box = box_of(texcoords, triangles);
    if (!(box.min.x < box.max.x && box.min.y < box.max.y)) return overlap;
    overlap.raster = side_for(texcoords, triangles, box);
    Raster raster(overlap.raster, triangles.size());
    const glm::dvec2 scale = static_cast<double>(overlap.raster) / (box.max - box.min);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        check_cancelled(t);
        std::optional<Corners> corners = corners_of(texcoords, triangles[t]);
        if (!corners) continue;
        for (glm::dvec2& corner : *corners)
            corner = (corner - box.min) * scale;
        raster.draw(static_cast<std::uint32_t>(t), *corners);
    }
    overlap.overlapping = raster.take_overlapping();
    return overlap;
}

}  // namespace relief::detail

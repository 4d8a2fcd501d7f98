// SPDX-License-Identifier: Apache-2.0
// Assigns triangles to the texture tiles that they overlap. Texture space with v down, in double.
// Tests: tests/mesh/bake/texel_coverage_test.cpp.
#include "relief/mesh/texel_coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geometry/check_triangles.h"
#include "relief/mesh/report.h"

namespace relief {
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
        const glm::dvec2 least(range_.least), greatest(range_.greatest);
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

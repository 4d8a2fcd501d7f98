// SPDX-License-Identifier: Apache-2.0
// The map in bands of 64 rows, each done by one thread: triangles that reach into a band are drawn
// there in order of index, and whoever has the better claim to a texel has it; claims are compared
// by a strict order, so that the order of drawing does not matter. Texels, x right and y down from
// the map's upper left corner. Tests: tests/mesh/bake/texel_coverage_test.cpp.
#include "relief/mesh/texel_coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include "bake/texel_triangle.h"
#include "geometry/check_triangles.h"
#include "parallel.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr int rows_per_band = TexelCover::band_rows;
constexpr double most_turns = 64.0;  // Of a texture that repeats, across one triangle.

/// The triangles of a map, found by index.
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

    TexelTriangle::Trouble make(std::size_t index, TexelTriangle& triangle) const {
        std::array<glm::dvec2, 3> corners;
        glm::dvec2 least(std::numeric_limits<double>::infinity());
        for (std::size_t i = 0; i < 3; ++i) {
            corners[i] = glm::dvec2(texcoords_[triangles_[index][static_cast<int>(i)]]);
            least = glm::min(least, glm::floor(corners[i]));
        }
        const glm::dvec2 tile = options_.repeat ? least : glm::dvec2(options_.tile);
        for (glm::dvec2& corner : corners) {
            corner -= tile;
            if (options_.repeat && std::max(corner.x, corner.y) > most_turns)
                return TexelTriangle::Trouble::too_far;
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

/// Calls visit(begin, end) for the parts of [first, last) that are on the map: cut off, or each
/// whole turn of it moved there.
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

/// For every band, the triangles that reach into it, ascending.
class Bands {
  public:
    Bands(const Triangles& triangles, const CoverageOptions& options, Report& report)
        : count_(static_cast<std::size_t>((options.height + rows_per_band - 1) / rows_per_band)),
          starts_(count_ + 1, 0) {
        // Twice through all triangles: to count, then to fill.
        for_each_reach(triangles, options, &report,
                       [&](std::size_t, std::size_t band) { ++starts_[band + 1]; });
        for (std::size_t band = 0; band < count_; ++band)
            starts_[band + 1] += starts_[band];
        members_.resize(starts_.back());
        std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
        for_each_reach(triangles, options, nullptr, [&](std::size_t index, std::size_t band) {
            members_[next[band]++] = static_cast<std::uint32_t>(index);
        });
    }

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] std::span<const std::uint32_t> members(std::size_t band) const {
        return std::span(members_).subspan(starts_[band], starts_[band + 1] - starts_[band]);
    }

  private:
    template <typename Reach>
    void for_each_reach(const Triangles& triangles, const CoverageOptions& options, Report* report,
                        const Reach& reach) const {
        std::vector<std::size_t> reached;
        for (std::size_t place = 0; place < triangles.count(); ++place) {
            const std::size_t index = triangles.index(place);
            TexelTriangle triangle;
            const TexelTriangle::Trouble trouble = triangles.make(index, triangle);
            if (trouble != TexelTriangle::Trouble::none) {
                if (report != nullptr) note(trouble, index, *report);
                continue;
            }
            Columns rows = triangle.rows();
            if (rows.end - rows.begin > options.height && options.repeat)
                rows = {0, options.height};
            reached.clear();
            for_parts(rows.begin, rows.end, options.height, options.repeat,
                      [&](std::int64_t first, std::int64_t last, std::int64_t) {
                          for (auto band = first / rows_per_band; band * rows_per_band < last;
                               ++band)
                              reached.push_back(static_cast<std::size_t>(band));
                      });
            std::sort(reached.begin(), reached.end());
            reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
            for (const std::size_t band : reached)
                reach(index, band);
        }
    }

    static void note(TexelTriangle::Trouble trouble, std::size_t index, Report& report) {
        switch (trouble) {
            case TexelTriangle::Trouble::not_finite:
                report.add("texture not finite", "triangle", index, "covers no texel");
                break;
            case TexelTriangle::Trouble::too_far:
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

/// A band being drawn.
class DrawnBand {
  public:
    DrawnBand(const Triangles& triangles, const CoverageOptions& options, int first_row)
        : triangles_(triangles),
          options_(options),
          first_row_(first_row),
          last_row_(std::min(options.height, first_row + rows_per_band)),
          texels_(static_cast<std::size_t>(options.width) *
                  static_cast<std::size_t>(last_row_ - first_row)),
          distances_(options.touched ? texels_.size() : 0),
          holders_(texels_.size(), 0) {}

    void draw(std::uint32_t index) {
        TexelTriangle triangle;
        triangles_.make(index, triangle);
        compared_with_ = CoveredTexel::nobody;
        const Columns rows = triangle.rows();
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
            if (holders_[i] == one_of_each) ++coverage.mirrored;
        }
        if (coverage.shared > 0) report_shared(report);
        return coverage;
    }
    [[nodiscard]] std::span<const CoveredTexel> texels() const { return texels_; }

  private:
    // The triangles that hold a texel's centre, by whether their texture is mirrored.
    static constexpr std::uint8_t plain = 1;
    static constexpr std::uint8_t mirrored = 2;
    static constexpr std::uint8_t one_of_each = plain | mirrored;
    static constexpr std::uint8_t several_alike = 4;

    [[nodiscard]] bool is_shared(std::size_t i) const { return holders_[i] >= one_of_each; }

    /// Texels once each, of however many samples: as mirrored only if all shared samples are.
    void report_shared(Report& report) const {
        const auto side = static_cast<std::size_t>(options_.samples_across);
        const std::size_t columns = static_cast<std::size_t>(options_.width);
        const std::size_t width = columns / side;
        std::vector<std::uint8_t> found(texels_.size() / (side * side), 0);
        const std::size_t first_texel = static_cast<std::size_t>(first_row_) / side * width;
        for (std::size_t i = 0; i < texels_.size(); ++i) {
            if (is_shared(i)) found[i / columns / side * width + i % columns / side] |= holders_[i];
        }
        for (std::size_t texel = 0; texel < found.size(); ++texel) {
            if (found[texel] == one_of_each) {
                report.add("texel of mirrored triangles", "texel", first_texel + texel,
                           "belongs to the one that is not mirrored");
            } else if (found[texel] != 0) {
                report.add("texel of several triangles", "texel", first_texel + texel,
                           "belongs to one of them, by a fixed rule");
            }
        }
    }

    void draw_row(std::uint32_t index, const TexelTriangle& triangle, std::int64_t row,
                  std::int64_t row_there) {
        const std::size_t first =
            static_cast<std::size_t>(row - first_row_) * static_cast<std::size_t>(options_.width);
        const Columns inside = triangle.inside(row_there);
        for_parts(inside.begin, inside.end, options_.width, options_.repeat,
                  [&](std::int64_t begin, std::int64_t end, std::int64_t moved) {
                      for (std::int64_t column = begin; column < end; ++column)
                          claim_inside(first + static_cast<std::size_t>(column), index, triangle,
                                       column + moved, row_there);
                  });
        if (!options_.touched) return;
        const Columns touched = triangle.touched(row_there);
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

    /// Whether the triangle being drawn comes before the owner of a texel; neighbours mostly have
    /// the same owner, for whom the answer is kept.
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
        if ((holders_[at] & side) != 0) holders_[at] |= several_alike;
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
    std::vector<double> distances_;  ///< Of those that are only touched, squared.
    std::vector<std::uint8_t> holders_;
    std::uint32_t compared_with_ = CoveredTexel::nobody;  ///< By is_before(), which found this:
    bool is_before_ = false;
};

void check(std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
           const CoverageOptions& options) {
    for (const int side : {options.width, options.height}) {
        if (side < 1 || side > TexelCover::largest_side)
            throw InvalidInput(fmt::format("a map of {} x {} texels is not within 1 to {}",
                                           options.width, options.height,
                                           TexelCover::largest_side));
    }
    const int across = options.samples_across;
    constexpr std::array known = {1, 2, 4, 8, 16, 32};
    const bool is_known = std::find(known.begin(), known.end(), across) != known.end();
    if (!is_known || options.width % across != 0 || options.height % across != 0)
        throw InvalidInput(
            fmt::format("{} samples across a texel are not 1, 2, 4, 8, 16 or 32", across));
    check_triangles(triangles, texcoords.size());
    if (options.only && !options.only->empty() && options.only->back() >= triangles.size())
        throw InvalidInput(fmt::format("there is no triangle {}", options.only->back()));
}

}  // namespace

struct TexelCover::Implementation {
    Implementation(std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
                   const CoverageOptions& given, Report& report)
        : options(given), all(texcoords, triangles, options), bands(all, options, report) {}

    CoverageOptions options;
    Triangles all;
    Bands bands;
};

TexelCover::TexelCover(std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
                       const CoverageOptions& options, Report& report) {
    check(texcoords, triangles, options);
    implementation_ = std::make_unique<Implementation>(texcoords, triangles, options, report);
}

TexelCover::~TexelCover() = default;

Coverage TexelCover::cover(
    int first_row, int last_row,
    const std::function<void(int first_row, std::span<const CoveredTexel> texels)>& take,
    Report& report) const {
    // No structured binding: Clang 14 lets no lambda capture one.
    const CoverageOptions& options = implementation_->options;
    const Triangles& all = implementation_->all;
    const Bands& bands = implementation_->bands;
    const auto first_band = static_cast<std::size_t>(first_row / rows_per_band);
    const auto last_band = static_cast<std::size_t>((last_row + rows_per_band - 1) / rows_per_band);
    std::vector<Coverage> found(last_band - first_band);
    parallel_for_reporting(
        found.size(), 1, report, [&](std::size_t begin, std::size_t end, Report& findings) {
            for (std::size_t i = begin; i < end; ++i) {
                const int band_row = static_cast<int>(first_band + i) * rows_per_band;
                DrawnBand band(all, options, band_row);
                for (const std::uint32_t index : bands.members(first_band + i))
                    band.draw(index);
                found[i] = band.finish(findings);
                take(band_row, band.texels());
            }
        });
    Coverage coverage;
    for (const Coverage& one : found)
        coverage += one;
    return coverage;
}

Coverage cover_texels(
    std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
    const CoverageOptions& options,
    const std::function<void(int first_row, std::span<const CoveredTexel> texels)>& take,
    Report& report) {
    return TexelCover(texcoords, triangles, options, report).cover(0, options.height, take, report);
}

}  // namespace relief

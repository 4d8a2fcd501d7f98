// SPDX-License-Identifier: Apache-2.0
/// \file
/// A triangle on the lattice of texels, in whole numbers: exact answers to which texel centres it
/// holds and which texel squares it reaches into. Tests: tests/mesh/bake/texel_coverage_test.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

namespace relief {

/// Whole numbers for products of two fixed-point coordinates and their sums.
__extension__ using Wide = __int128;

/// Fixed-point numbers: 2^bits to a texel.
struct TexelScale {
    explicit TexelScale(int largest_side);
    [[nodiscard]] std::int64_t fixed(double texels) const;
    [[nodiscard]] std::int64_t one() const { return std::int64_t{1} << bits; }
    int bits;
};

/// Columns [begin, end) of a row; empty if they are the wrong way round.
struct Columns {
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

class TexelTriangle {
  public:
    /// \param texels  corners, in texels from the map's upper left corner, x right and y down
    /// \return nothing where a corner is not finite or too far away, or the area is none
    enum class Trouble { none, not_finite, too_far, no_area };
    static Trouble make(const std::array<glm::dvec2, 3>& texels, const TexelScale& scale,
                        TexelTriangle& triangle);

    /// Rows whose centres, or squares, it may have a part in.
    [[nodiscard]] Columns rows() const;
    /// Texels of a row whose centre is inside.
    [[nodiscard]] Columns inside(std::int64_t row) const;
    /// Texels of a row whose square has a part of the triangle's area in it.
    [[nodiscard]] Columns touched(std::int64_t row) const;

    /// Weights of the corners, in the order given, for a texel's centre inside.
    [[nodiscard]] glm::dvec3 weights(std::int64_t column, std::int64_t row) const;
    /// Of the point on the triangle nearest to a texel's centre; and its squared distance, texels.
    [[nodiscard]] glm::dvec3 nearest(std::int64_t column, std::int64_t row,
                                     double& squared_distance) const;

    [[nodiscard]] bool is_mirrored() const { return is_mirrored_; }
    /// Corners in order of place: the same for the same triangle, whatever corner comes first.
    [[nodiscard]] const std::array<std::array<std::int64_t, 2>, 3>& sorted() const {
        return sorted_;
    }

  private:
    struct Edge {
        std::int64_t a, b;  ///< Inward normal.
        Wide c;             ///< a x + b y + c >= 0 inside, in fixed-point numbers.
        bool owns_its_points;
    };
    [[nodiscard]] Columns columns_where(std::int64_t row, bool whole_square) const;
    [[nodiscard]] glm::dvec3 in_given_order(const glm::dvec3& weights) const;

    TexelScale scale_{1};
    std::array<std::array<std::int64_t, 2>, 3> corners_{}, sorted_{};  ///< Corners: clockwise seen.
    std::array<Edge, 3> edges_{};  ///< Edge i is opposite corner i.
    double doubled_area_ = 0.0;
    bool is_mirrored_ = false;
};

}  // namespace relief

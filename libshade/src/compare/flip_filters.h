// SPDX-License-Identifier: Apache-2.0
/// \file
/// What FLIP looks at: the colours that an eye still tells apart at its distance, and how strong
/// edges and points are. Row by row, so that a picture is worked on in bands on all threads.
///
/// Opponent colours are (Y/Yn, X/Xn - Y/Yn, Y/Yn - Z/Zn) of linear sRGB: YCxCz without its scales
/// and offset, which the filters keep as they are. Beyond the border the outermost pixel goes on.
/// Source: [Andersson et al. 2020], the colour and the feature pipeline.
/// Tests: tests/shade/compare/flip_test.cpp.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace relief {

/// XYZ, each relative to the white's, of linear sRGB; the rows add up to 1. Made from the
/// standard's primaries and white point [IEC 61966-2-1].
const glm::dmat3& relative_xyz_from_rgb();

/// Weights of a symmetric or antisymmetric filter along a row or a column: 2 radius + 1 of them.
using Kernel1d = std::vector<float>;

/// The filters for one number of pixels per degree. All have the same length; what is beyond a
/// filter's own reach has weight 0.
struct FlipFilters {
    explicit FlipFilters(double pixels_per_degree);

    int radius = 0;
    /// Contrast sensitivity: a Gaussian each for Y and Cx, the sum of two for Cz.
    Kernel1d y, cx, cz_narrow, cz_wide;
    /// The Gaussian that is as wide as what edge detectors of the eye see, and its derivatives;
    /// positive weights add up to 1, negative ones to -1.
    Kernel1d smooth, edge, point;
};

/// Rows of one float a pixel, which stand for the rows first, first + 1, ... of a picture.
class Rows {
  public:
    Rows(int first, int count, int width)
        : first_(first),
          width_(static_cast<std::size_t>(width)),
          values_(static_cast<std::size_t>(count) * width_) {}

    [[nodiscard]] float* row(int y) {
        return values_.data() + static_cast<std::size_t>(y - first_) * width_;
    }
    [[nodiscard]] const float* row(int y) const {
        return values_.data() + static_cast<std::size_t>(y - first_) * width_;
    }

  private:
    int first_;
    std::size_t width_;
    std::vector<float> values_;
};

/// A band of rows [begin, end) of a picture; `halo` more on both sides may lie outside of it.
struct Band {
    int begin = 0;
    int end = 0;
    int width = 0;
    int halo = 0;

    [[nodiscard]] Rows rows() const { return {begin, end - begin, width}; }
    [[nodiscard]] Rows rows_with_halo() const {
        return {begin - halo, end - begin + 2 * halo, width};
    }
};

/// What an eye sees of a band.
struct SeenBand {
    std::array<Rows, 3> opponent;  ///< Filtered.
    Rows edge;                     ///< Strength of edges, 0 to sqrt(2).
    Rows point;                    ///< Strength of points and lines.
};

/// \param opponent  of the band with its halo; the halo is the filters' radius
SeenBand see(const FlipFilters& filters, const Band& band, const std::array<Rows, 3>& opponent);

}  // namespace relief

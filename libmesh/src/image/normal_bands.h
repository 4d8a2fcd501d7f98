// SPDX-License-Identifier: Apache-2.0
/// \file
/// The functions of relief/mesh/normal_map.h for bands of rows of a map. Their results are those of
/// the whole map. Findings count texels from the first texel of the band, except where stated.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "image/texel_loops.h"
#include "relief/export.h"
#include "relief/mesh/image.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {
namespace detail {

/// The codes of flat texels, see flat_texel_codes().
using FlatCodes = std::optional<std::array<std::uint16_t, 2>>;

/// \throws InvalidInput if a map of so many channels lacks one of these
void check_xy_channels(int count, const XyChannels& channels);

/// Computes flat_texel_codes() of a map by bands.
class FlatCodeCount {
  public:
    /// \param x,y  channels that the map has
    void add(const ImageView& map, int x, int y);
    [[nodiscard]] FlatCodes codes() const;

  private:
    int bits_ = 32;
    std::array<std::size_t, 4> counts_{};
};

/// \param first_row  the row of the map at which the band begins; it determines the dithering
/// \param report  counts texels from the first one of the map
Image encode_normal_rows(const ImageView& normals, const NormalMapFormat& format, int first_row,
                         Report& report);

/// Decodes with y up. \param codes  of the whole map, or none
Image decode_normal_rows(const ImageView& map, FlatCode flat, const FlatCodes& codes,
                         Report& report);
Image decode_xy_rows(const ImageView& map, const XyChannels& channels, FlatCode flat,
                     const FlatCodes& codes, Report& report);

/// The lengths of the vectors of a row.
struct RowLengths {
    double min = std::numeric_limits<double>::infinity();
    double sum = 0.0;
    double max = 0.0;
    std::size_t count = 0;
};

/// Measures as measure_lengths() does, and appends the lengths of each row.
void append_row_lengths(const Image& map, FlatCode flat, std::vector<RowLengths>& lengths,
                        Report& report);

/// Combines all rows in order.
LengthRange range_of(const std::vector<RowLengths>& rows);

void blend_normal_rows(Image& base, int first_row, const Image& detail, NormalBlend method,
                       Report& report);

// Resizing. Rows of the source are requested by their index, from all threads.

using FloatRows = std::function<const float*(std::size_t row)>;

/// The texels of the source along one axis for each texel of the result.
struct ResampledAxis {
    struct Tap {
        std::size_t place;
        float weight;
    };
    struct Reach {
        int begin, end;
    };
    std::vector<Tap> taps;
    std::vector<std::size_t> first = {0};  ///< Result i has the taps in [first[i], first[i + 1]).
    std::vector<Reach> reach;  ///< The texels of each result before wrapping, or a few more.
};

/// \throws InvalidInput if a size or a number of repetitions is not positive
void check_resize(int width, int height, const ResizeOptions& options);

/// Computes rows of float samples at another size.
class Resampling {
  public:
    Resampling(int width, int height, int to_width, int to_height, const ResizeOptions& options);

    void make_row(std::size_t row, std::size_t channels, const FloatRows& source,
                  float* result) const;

    /// Returns the mean of vectors at one texel of the result, with the weights of the samples.
    [[nodiscard]] Direction mean_vector(const FloatRows& vectors, std::size_t row,
                                        std::size_t column) const;

    /// Returns the rows of the source that a row of the result needs; rows outside the source are
    /// those that the wrap rule selects.
    [[nodiscard]] ResampledAxis::Reach reach(int row) const {
        return down_.reach[static_cast<std::size_t>(row)];
    }

  private:
    /// Returns the weighted sum of the source rows of one result row, by column.
    [[nodiscard]] std::vector<float> sum_of_rows(std::size_t row, std::size_t channels,
                                                 const FloatRows& source) const;

    std::size_t width_;
    ResampledAxis across_;
    ResampledAxis down_;
};

/// Returns the slopes of normals, two floats per texel; NaN if the normal is too steep.
Image slopes_to_average(const Image& normals, Report& report);

/// Computes rows of resize_normals() and resize_samples() from `first_row` on.
/// \param slopes  from slopes_to_average(), for ResizeDomain::slopes
void resize_normal_rows(const Resampling& resampling, ResizeDomain domain, const FloatRows& normals,
                        const FloatRows& slopes, int first_row, Image& result, Report& report);
void resize_sample_rows(const Resampling& resampling, const FloatRows& samples, int first_row,
                        Image& result);

}  // namespace detail
}  // namespace relief

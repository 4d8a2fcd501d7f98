// SPDX-License-Identifier: Apache-2.0
/// \file
/// Conversion of height maps to bump maps by bands of rows: the rows of a file that a band needs,
/// and the samples of the result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bump/bump_rows.h"
#include "relief/mesh/bump_file.h"

namespace relief::detail {

/// Reads a height map by bands of rows, from the top.
class HeightBandReader {
  public:
    /// \param file  must outlive the reader
    explicit HeightBandReader(const HeightMapFile& file);

    /// Reads the next rows; fewer at the end.
    /// \throws FileError if they are damaged, or if a texel is transparent
    HeightMap read(int rows);
    void skip(int rows) { reader_.skip(rows); }

  private:
    const HeightMapFile& file_;
    ImageRowReader reader_;
};

/// Consecutive rows of samples; the first ones can be dropped.
class KeptRows {
  public:
    void append(const Image& rows);
    void append_row(const KeptRows& other, int index);
    void drop(int count);
    [[nodiscard]] bool empty() const { return bytes_.empty(); }
    [[nodiscard]] int count() const;
    [[nodiscard]] const void* at(int index) const;
    /// Bits of a sample: 8, 16 or 32.
    [[nodiscard]] int bits() const { return bits_; }

  private:
    std::vector<std::byte> bytes_;
    std::size_t row_bytes_ = 1;
    int bits_ = 32;
};

/// The rows of a height map file that a band needs, which move over the file.
class HeightWindow {
  public:
    /// \param radius  the distance of rows that a row needs
    HeightWindow(const HeightMapFile& file, int radius, const Wraps& wrap);

    /// Brings rows up to `last` and those within the radius into memory. Rows more than the radius
    /// before `first` are dropped. \throws FileError
    void move_to(int first, int last);

    /// Reads in advance what move_to(..., last) will need. Rows that row() returns stay valid.
    void read_ahead(int last);

    /// Returns a row within the radius of the band; the wrap rule applies at borders.
    [[nodiscard]] const void* row(int place) const;
    /// Returns the alpha of a row of the band.
    [[nodiscard]] const void* alpha_row(int place) const { return alpha_.at(place - begin_); }
    [[nodiscard]] bool has_alpha() const { return !alpha_.empty(); }
    [[nodiscard]] int bits() const { return heights_.bits(); }
    [[nodiscard]] int alpha_bits() const { return alpha_.bits(); }

  private:
    void append(const HeightMap& rows);
    [[nodiscard]] int needed_end(int last) const;

    HeightBandReader reader_;
    int height_;
    int radius_;
    int begin_ = 0;  ///< The first row in memory.
    KeptRows heights_, alpha_;
    KeptRows head_, tail_;  ///< The first and last rows of a map that repeats.
    HeightMap ahead_;       ///< Rows from read_ahead().
};

/// The input of a band.
struct BumpBandSource {
    HeightRows heights;
    /// The alpha of a row, if the map has alpha, and its bits.
    std::function<const void*(int row)> alpha;
    int alpha_bits = 8;
    /// 1 for each transparent texel of a row, if the map has transparent ones.
    std::function<const std::uint8_t*(int row)> transparent;
};

/// Returns the shape of the image for a format.
ImageShape shape_of(const BumpFileFormat& format, int width, int height);

/// Computes rows [first, last) of the file on all threads.
///
/// \param rows    memory for these rows, tightly packed
/// \param report  counts heights and alphas that were clamped
/// \return false if a height that matters is not finite; the rows are then unspecified, and
///         nothing is reported
bool make_bump_band(const BumpBandSource& source, const BumpOptions& options,
                    const BumpFileFormat& format, int first, int last, std::span<std::byte> rows,
                    Report& report);

}  // namespace relief::detail

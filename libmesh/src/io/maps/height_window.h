// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rows of a height map that move over a file: those of a band and around it are in memory.
/// Tests: tests/mesh/io/maps/bump_file_test.cpp.
#pragma once

#include <cstddef>
#include <vector>

#include "relief/mesh/bump_file.h"

namespace relief {

/// A height map by bands of rows, in order from the top.
class HeightBandReader {
  public:
    /// \param file  must outlive the reader
    explicit HeightBandReader(const HeightMapFile& file);

    /// The next rows, fewer at the end.
    /// \throws FileError if they are damaged, or a texel is transparent
    HeightMap read(int rows);
    void skip(int rows) { reader_.skip(rows); }

  private:
    const HeightMapFile& file_;
    ImageRowReader reader_;
};

/// Rows of samples that follow each other, kept from some row on.
class KeptRows {
  public:
    void append(const Image& rows);
    void drop(int count);
    [[nodiscard]] bool empty() const { return bytes_.empty(); }
    [[nodiscard]] int count() const;
    [[nodiscard]] const void* at(int index) const;
    /// Of the samples: 8, 16 or 32.
    [[nodiscard]] int bits() const { return bits_; }

  private:
    std::vector<std::byte> bytes_;
    std::size_t row_bytes_ = 1;
    int bits_ = 32;
};

class HeightWindow {
  public:
    /// \param radius  how far from a row others are asked for
    HeightWindow(const HeightMapFile& file, int radius, const Wraps& wrap);

    /// Brings rows up to `last`, with those around them, into memory; what lies farther than the
    /// radius before `first` is gone. \throws FileError
    void move_to(int first, int last);

    /// Reads ahead what move_to(..., last) will need, touching nothing that row() gives.
    void read_ahead(int last);

    /// A row within the radius of the band, or by the wrap rule at the other border.
    [[nodiscard]] const void* row(int place) const;
    /// The alpha of a row of the band.
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
    int begin_ = 0;  ///< The first row that is in memory.
    KeptRows heights_, alpha_;
    KeptRows head_, tail_;  ///< The first and last rows of a map that repeats.
    HeightMap ahead_;       ///< What was read ahead.
};

}  // namespace relief

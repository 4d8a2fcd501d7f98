// SPDX-License-Identifier: Apache-2.0
/// \file
/// Errors of a level of a texture: of all its blocks of 4 x 4 texels, or of some at random.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/image.h"
#include "relief/mesh/map_texture.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/texture_file.h"

namespace RELIEF_API relief {
namespace detail {

/// The errors of some blocks of a row, those of the texels inside of the level.
struct BlockErrors {
    std::vector<float> errors;
    std::vector<std::size_t> counts;  ///< The number of errors of each block.
};

struct MeasuredError {
    ErrorStats error;
    std::optional<SampleConfidence> confidence;
};

/// Chooses blocks and collects their errors. A level is divided into equal runs of blocks, and one
/// block of each run is chosen by a hash of its index, so the choice is always the same.
class BlockSample {
  public:
    /// \param max_texels  at most so many are measured, but at least one block
    BlockSample(int width, int height, std::size_t max_texels);

    /// Returns the chosen blocks of a row of blocks, in order.
    [[nodiscard]] std::vector<std::size_t> columns(std::size_t row) const;

    /// Measures rows of blocks in parallel. Calls must be in the order of the rows.
    /// \param errors_of  errors_of(row, columns of blocks), called if there are columns
    void measure(std::size_t first_row, std::size_t end_row,
                 const std::function<BlockErrors(std::size_t row,
                                                 std::span<const std::size_t> columns)>& errors_of);

    /// Returns the statistics of all errors.
    [[nodiscard]] MeasuredError result();

  private:
    void add(const BlockErrors& found);

    std::size_t blocks_across_;
    std::size_t blocks_;
    std::size_t run_;  ///< Blocks of which one is measured.
    std::vector<float> errors_;
    std::vector<double> means_;         ///< Of the errors of each block,
    std::vector<double> mean_squares_;  ///< and of their squares.
};

/// The encoded texels of a row of blocks.
struct EncodedRow {
    TextureFormat format;
    std::span<const std::byte> bytes;
    int width = 0;  ///< Of the level.
    int rows = 0;   ///< Of texels, 1 to 4.
};

/// Decodes some blocks, side by side. Texels outside of the level are repeated.
Image decoded_columns(const EncodedRow& row, std::span<const std::size_t> columns);

/// Returns the angles between normals and decoded ones. \param exact  the same rows of the level
BlockErrors normal_block_errors(const EncodedRow& row, std::span<const std::size_t> columns,
                                const float* exact, Green green);

/// Calls each(texel of `decoded_columns`, texel of the rows of the level) for the texels of the
/// blocks that are inside of the level, and collects the errors that it returns.
template <typename Each>
BlockErrors block_errors(const EncodedRow& row, std::span<const std::size_t> columns,
                         const Each& each) {
    BlockErrors result;
    const auto width = static_cast<std::size_t>(row.width);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const std::size_t before = result.errors.size();
        for (std::size_t y = 0; y < static_cast<std::size_t>(row.rows); ++y) {
            for (std::size_t x = 0; x < 4; ++x) {
                const std::size_t column = 4 * columns[i] + x;
                if (column >= width) continue;
                result.errors.push_back(
                    each(y * 4 * columns.size() + 4 * i + x, y * width + column));
            }
        }
        result.counts.push_back(result.errors.size() - before);
    }
    return result;
}

/// Returns the code of flat texels of a format.
FlatCode flat_code_of(TextureFormat format);

}  // namespace detail
}  // namespace relief

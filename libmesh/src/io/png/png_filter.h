// SPDX-License-Identifier: Apache-2.0
/// \file
/// PNG's filters: what predicts a byte from its neighbours, so that the rest deflates well.
/// Source: [ISO/IEC 15948], clause 9. Tests: tests/mesh/io/png/png_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace relief {

/// Filter type 4, the prediction of Paeth; 0 to 3 are none, left, above, and their mean.
inline constexpr std::uint8_t paeth_filter = 4;
inline constexpr std::uint8_t filter_count = 5;

/// Turns a row of filtered bytes into the row itself.
///
/// \param filter  its type, as the byte before it says
/// \param step    bytes from a sample to the same sample of the texel on the left: 1 to 8
/// \param above   the row above, done; of the same size (zeros above the first)
/// \return false where there is no such filter
bool undo_filter(std::uint8_t filter, std::size_t step, std::span<std::uint8_t> row,
                 std::span<const std::uint8_t> above);

/// The row's bytes less their prediction by a filter, 0 to 4, into `filtered`; parameters as above.
void apply_filter(std::uint8_t filter, std::size_t step, std::span<const std::uint8_t> row,
                  std::span<const std::uint8_t> above, std::span<std::uint8_t> filtered);

}  // namespace relief

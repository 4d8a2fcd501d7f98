// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which of PNG's filters makes some rows smallest, found by trying them on a part of these rows.
/// Tests: tests/mesh/io/png/png_filter_choice_test.cpp.
///
/// The usual rule, least sum of magnitudes, guesses wrong where rows repeat: there the bytes as
/// they are deflate to half of what any filter makes of them (normals of stepped heights).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "io/png/deflate_encoder.h"

namespace relief {

struct FilterChoice {
    std::uint8_t filter = 0;
    Repetitions repetitions = Repetitions::sought;
};

/// \param rows    rows in PNG's byte order, one behind the other, the row above the first before
/// them \param size    bytes in a row \param step    from a sample to the same of the texel on the
/// left
FilterChoice choose_filter(std::span<const std::uint8_t> rows, std::size_t size, std::size_t step,
                           WriteEffort effort);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Whether a map shows that the lower of the two codes around zero is what it holds for flat.
/// Tests: tests/mesh/image/check/flat_evidence_test.cpp.
#pragma once

#include <cstddef>

#include "relief/mesh/image.h"

namespace relief {

/// Texels whose x and y both have one of the two codes below and the two above 127.5 (32767.5).
struct FlatEvidence {
    std::size_t near = 0;   ///< All of them.
    std::size_t lower = 0;  ///< Those that have the lower code of zero, 127, for both.

    /// A smooth surface passes all sixteen pairs of codes alike, on its way; where texels are flat
    /// by intention, one pair stands out. So: at least 64 texels, and more than half of those near.
    [[nodiscard]] bool is_half() const { return lower >= 64 && 2 * lower > near; }
};

/// \param map  three channels at least; none of 32 bits has evidence
FlatEvidence flat_evidence(const Image& map);

}  // namespace relief

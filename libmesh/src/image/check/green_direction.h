// SPDX-License-Identifier: Apache-2.0
/// \file
/// What only a surface can show: which way the green channel grows, and whether alpha holds its
/// heights. The change of the slope along x, in y, is the change of the slope along y, in x; with
/// green the wrong way round the two have opposite signs.
/// Tests: tests/mesh/image/check/normal_map_check_test.cpp.
#pragma once

#include "image/check/map_vectors.h"

namespace relief {

struct SurfaceEvidence {
    GreenEvidence green;
    std::optional<double> alpha_correlation;  ///< With the slopes; where there is an alpha.
};

/// \param map  two channels at least; y as it is stored
///
/// Texels that are not finite, face back or are steeper than 10 have no say, nor have their
/// neighbours. The map is looked at as it is and averaged over 2, 4 and 8 texels, where the noise
/// of few bits is less; of these the one counts that is surest.
SurfaceEvidence surface_evidence(const Image& map, const SampleMeaning& meaning);

}  // namespace relief

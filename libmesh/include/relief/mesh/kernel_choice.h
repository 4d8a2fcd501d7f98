// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which kernel takes the truest slopes of a height map, told from the map alone.
/// Tests: tests/mesh/accuracy/kernel_choice_test.cpp.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "relief/mesh/bump.h"
#include "relief/mesh/height_statistics.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_part.h"

namespace relief {

/// A kernel and what it is expected to do on a map.
struct KernelPrediction {
    Kernel kernel = Kernel::sobel3;
    int gaussian_radius = 2;   ///< Of Kernel::gaussian.
    double rms_degrees = 0.0;  ///< Expected error of the normals.
};

/// What the map looks like, and what follows.
struct KernelChoice {
    Kernel kernel = Kernel::sobel3;
    int gaussian_radius = 2;   ///< Of Kernel::gaussian.
    double rms_degrees = 0.0;  ///< Expected error of the normals.
    std::string reason;        ///< A sentence for people, with figures.

    HeightDepth depth;   ///< Of what was looked at.
    double noise = 0.0;  ///< Deviation of the noise beyond rounding, in the unit of heights.
    double walls = 0.0;  ///< Share of texels beside a cliff.
    std::vector<KernelPrediction> predictions;  ///< All that were tried, best first.
};

/// The radius that its Gaussian should have, whether that is the choice or not.
int best_gaussian_radius(const KernelChoice& choice);

/// The parts of a map that choose_kernel() looks at: at most 9 squares of 128 texels, in even
/// distances; smaller ones of a small map. From top to bottom, so that a file can be read in turn.
std::vector<ImagePart> parts_to_look_at(int width, int height);

/// The kernel with the least root mean square error of the normals to be expected.
///
/// \param parts    of one map, as parts_to_look_at() says or any others; one channel, all of the
///                 same depth
/// \param options  strength and texel as in the conversion; nothing else is looked at
/// \param destaircased  choose for the map after destaircase() (destaircase.h)
/// \return the same for the same parts, on any machine and number of threads. A constant map gets
///         central3, where all are exact
/// \throws InvalidInput as normals_from_height() does, and if there are no parts
///
/// What the map may have been before it was rounded and before noise came to it is restored (white
/// noise by spectral subtraction [Boll 1979], steps wider than texels by destaircase()); rounding
/// and noise are then done to it anew, and each kernel is measured on the result. So truncation,
/// noise and quantisation count as much as they do on this map.
KernelChoice choose_kernel(std::span<const Image> parts, const BumpOptions& options,
                           bool destaircased = false);

/// The same for a map in memory.
KernelChoice choose_kernel(const Image& height, const BumpOptions& options,
                           bool destaircased = false);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which kernel takes the truest slopes of a height map, told from the map alone.
/// Tests: tests/mesh/accuracy/kernel_choice_test.cpp.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/mesh/bump.h"
#include "relief/mesh/height_statistics.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_part.h"

namespace relief {

/// The error of normals made from a height map, in degrees, by where it comes from.
struct ExpectedError {
    /// What the map itself leaves uncertain (noise, rounding, detail finer than its texels): the
    /// error expected of the best conversion known.
    double map = 0.0;
    /// The error that a conversion adds (kernel, arithmetic, bits): its distance from that best
    /// one.
    double added = 0.0;
    /// Root of the sum of squares: the parts are taken to be independent.
    [[nodiscard]] double total() const { return std::hypot(map, added); }
};

/// A kernel and what it is expected to do on a map.
struct KernelPrediction {
    Kernel kernel = Kernel::sobel3;
    int gaussian_radius = 2;   ///< Of Kernel::gaussian.
    double rms_degrees = 0.0;  ///< Expected error of the normals.
    double max_degrees = 0.0;  ///< Greatest error of a texel looked at.
};

/// How fine, even grain in a height map is interpreted. The map alone cannot tell noise from sand.
enum class Grain {
    automatic,  ///< Noise, unless the map holds nothing but grain.
    noise,
    detail,
};

/// The consequences if the grain of a map was interpreted wrongly.
struct OtherReading {
    double rms_degrees = 0.0;  ///< Expected error of the kernel that was chosen.
    KernelPrediction best;     ///< The kernel to choose then.
};

/// What the map looks like, and what follows.
struct KernelChoice {
    Kernel kernel = Kernel::sobel3;
    int gaussian_radius = 2;  ///< Of Kernel::gaussian.
    /// Expected error of the normals. NaN for maps of fewer than 64 texels, which say too little.
    double rms_degrees = 0.0;
    double max_degrees = 0.0;  ///< The same of the texel that is off most.
    /// The same two if the map does not show all: noise hides detail or looks like it, detail is
    /// finer than texels, or a map of nothing but grain is noise. Not less than those.
    double upper_rms_degrees = 0.0;
    double upper_max_degrees = 0.0;
    std::string reason;  ///< A sentence for people, with figures.

    HeightDepth depth;   ///< Of what was looked at.
    double noise = 0.0;  ///< Deviation of the noise beyond rounding, in the unit of heights.
    double grain = 0.0;  ///< The same of all grain: that of the noise, or of what is detail.
    /// For maps with grain: the consequences if it is detail instead of noise, or the reverse.
    std::optional<OtherReading> otherwise;
    double spikes = 0.0;  ///< Share of texels that stick out on their own, taken for noise.
    double walls = 0.0;   ///< Share of texels beside a cliff.

    /// Whether the error may be greater by so much that one number would not tell it.
    [[nodiscard]] bool is_range() const { return upper_rms_degrees > 1.5 * rms_degrees; }
    /// Whether another kernel has a far smaller error under the other interpretation of the grain.
    [[nodiscard]] bool is_ambiguous() const {
        return otherwise && otherwise->rms_degrees > 1.0 &&
               otherwise->rms_degrees > 1.5 * otherwise->best.rms_degrees;
    }
    std::vector<KernelPrediction> predictions;  ///< All that were tried, best first.
};

/// The expected error in degrees: "1.3", or "1.3 to 9.9" where it is a range.
std::string expected_words(const KernelChoice& choice);

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
/// \param grain    what even grain is taken for. Grain is what no continuous surface has: power
/// that
///                 falls more slowly than the inverse square of the frequency
/// \return the same for the same parts, on any machine and number of threads. A constant map gets
///         central3, where all are exact
/// \throws InvalidInput as normals_from_height() does, and if there are no parts
///
/// What the map may have been before it was rounded and before noise came to it is restored (white
/// or colored noise by spectral subtraction [Boll 1979], steps wider than texels by destaircase(),
/// texels that stick out on their own by a median); rounding, noise and spikes are then done to it
/// anew, and each kernel is measured on the result. So truncation, noise and quantization count as
/// much as they do on this map. Maps of at most four levels that are farther apart than the codes
/// of the file are masks: their levels are taken for the true heights.
KernelChoice choose_kernel(std::span<const Image> parts, const BumpOptions& options,
                           bool destaircased = false, Grain grain = Grain::automatic);

/// The same for a map in memory.
KernelChoice choose_kernel(const Image& height, const BumpOptions& options,
                           bool destaircased = false, Grain grain = Grain::automatic);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Selects the derivative kernel with the least expected error for a height map, from the map
/// alone.
/// Tests: tests/mesh/bump/kernel_choice_test.cpp.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image.h"

namespace RELIEF_API relief {

/// The error of normals from a height map in degrees, by cause.
struct ExpectedError {
    /// The expected error of the best known conversion, which the map causes by noise, rounding, or
    /// detail smaller than a texel.
    double map = 0.0;
    /// The additional error of a conversion (kernel, arithmetic, bits): its difference from the
    /// best one.
    double added = 0.0;
    /// The root of the sum of squares; both parts are assumed to be independent.
    [[nodiscard]] double total() const { return std::hypot(map, added); }
};

/// A kernel and its expected error on a map.
struct KernelPrediction {
    Kernel kernel = Kernel::sobel3;
    int gaussian_radius = 2;   ///< The radius of Kernel::gaussian.
    double rms_degrees = 0.0;  ///< Expected RMS error of the normals.
    double max_degrees = 0.0;  ///< Expected maximum error over the examined texels.
};

/// The interpretation of fine, uniform grain in a height map. The map alone does not distinguish
/// noise from detail such as sand.
enum class Grain {
    automatic,  ///< Noise, unless the map contains nothing but grain.
    noise,
    detail,
};

/// The result for the other interpretation of the grain.
struct AlternativeChoice {
    double rms_degrees = 0.0;  ///< Expected RMS error of the selected kernel.
    KernelPrediction best;     ///< The best kernel in that case.
};

/// The selected kernel and the properties of the map.
struct KernelChoice {
    Kernel kernel = Kernel::sobel3;
    int gaussian_radius = 2;  ///< The radius of Kernel::gaussian.
    /// Expected RMS error of the normals. NaN for maps of fewer than 64 texels, which are too small
    /// for an estimate.
    double rms_degrees = 0.0;
    double max_degrees = 0.0;  ///< Expected maximum error.
    /// Upper estimates of the RMS and maximum error for properties that the map does not reveal:
    /// noise that hides or resembles detail, detail smaller than texels, or a map of nothing but
    /// noise. They are at least the values above.
    double upper_rms_degrees = 0.0;
    double upper_max_degrees = 0.0;
    std::string reason;  ///< An explanation for people, with figures.

    HeightDepth depth;  ///< The quantization of the examined parts.
    /// Standard deviation of the noise without rounding, in the unit of heights.
    double noise = 0.0;
    /// Standard deviation of all grain, noise or detail, in the unit of heights.
    double grain = 0.0;
    /// For maps with grain: the result for the other interpretation.
    std::optional<AlternativeChoice> otherwise;
    double spikes = 0.0;  ///< Share of isolated outliers, which are treated as noise.
    double walls = 0.0;   ///< Share of texels beside a step edge.

    /// Returns true if the upper estimate is so much larger that a single number would be
    /// misleading.
    [[nodiscard]] bool is_range() const { return upper_rms_degrees > 1.5 * rms_degrees; }
    /// Returns true if another kernel has a far smaller error under the other interpretation of the
    /// grain.
    [[nodiscard]] bool is_ambiguous() const {
        return otherwise && otherwise->rms_degrees > 1.0 &&
               otherwise->rms_degrees > 1.5 * otherwise->best.rms_degrees;
    }
    std::vector<KernelPrediction> predictions;  ///< All examined kernels, smallest error first.
};

/// Formats the expected error in degrees: "1.3", or "1.3 to 9.9" if it is a range.
std::string expected_error_text(const KernelChoice& choice);

/// Returns the best radius for Kernel::gaussian, even if another kernel was selected.
int best_gaussian_radius(const KernelChoice& choice);

/// Returns the parts of a map that choose_kernel() examines: at most 9 regularly spaced squares of
/// 128 texels, or smaller ones for a small map. They are ordered from top to bottom, so that a file
/// can be read in one pass.
std::vector<ImagePart> parts_to_analyze(int width, int height);

/// Selects the kernel with the smallest expected RMS error of the normals.
///
/// \param parts  of one map, as from parts_to_analyze() or others; one channel, all with the same
///         number of bits
/// \param options  strength and texel as in the conversion; the other options are ignored
/// \param destaircased  selects for the map after destaircase() (height_map.h)
/// \param grain  interpretation of uniform grain: variation that no continuous surface has, because
///         its power decreases more slowly than the inverse square of the frequency
/// \return the same result for the same parts on any machine and with any number of threads. A
///         constant map gets central3, because all kernels are exact
/// \throws InvalidInput as normals_from_height() does, and if there are no parts
///
/// The kernel error model first restores the map as it may have been before noise and rounding:
/// white or colored noise is removed by spectral subtraction [Boll 1979], steps wider than texels
/// by destaircase(), and isolated outliers by a median. It then adds rounding, noise and outliers
/// again, and measures each kernel on the result. So truncation, noise and quantization have the
/// same weight as in this map. Maps of at most four levels that are farther apart than the codes of
/// the file are treated as masks with exact levels.
KernelChoice choose_kernel(std::span<const Image> parts, const BumpOptions& options,
                           bool destaircased = false, Grain grain = Grain::automatic);

/// The same for a map in memory.
KernelChoice choose_kernel(const Image& height, const BumpOptions& options,
                           bool destaircased = false, Grain grain = Grain::automatic);

}  // namespace relief

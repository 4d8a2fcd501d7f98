// SPDX-License-Identifier: Apache-2.0
/// \file
/// Height maps: extracts heights from images, analyzes them, removes their quantization steps,
/// integrates normal maps, and selects the derivative kernel of a map.
/// Tests: tests/mesh/image/height_map_test.cpp, tests/mesh/image/heights_from_normals_test.cpp,
/// tests/mesh/bump/kernel_choice_test.cpp.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace RELIEF_API relief {

/// The channel that holds the heights. For mean, luminance and red of a gray image it is the only
/// one, without decoding. For colors, only `luminance` decodes sRGB.
enum class HeightChannel {
    mean,  ///< The mean of red, green and blue.
    /// The luminance of Rec. 709 in linear light; integer samples are decoded from sRGB.
    luminance,
    red,
    green,
    blue,
    alpha,
};

template <>
inline constexpr auto enum_names<HeightChannel> =
    std::to_array<EnumName<HeightChannel>>({{"mean", HeightChannel::mean},
                                            {"luminance", HeightChannel::luminance},
                                            {"red", HeightChannel::red},
                                            {"green", HeightChannel::green},
                                            {"blue", HeightChannel::blue},
                                            {"alpha", HeightChannel::alpha}});

/// Extracts the heights of an image as one float channel.
///
/// Integer samples are divided by their maximum. Alpha is ignored, unless it is the channel.
/// \throws InvalidInput if the image is empty or has no such channel
Image height_field(const Image& image, HeightChannel channel = HeightChannel::mean);

/// Heights, and the texels that do not belong to the surface.
struct HeightMap {
    /// One channel: gray images keep their samples and bits, others are as from height_field().
    Image heights;
    /// The alpha of the image with its bits; empty if it has none or alpha holds the heights.
    Image alpha;
    /// 1 for texels with alpha 0, whose colors are not heights. Empty if there are none.
    std::vector<std::uint8_t> transparent;
    /// Share of texels whose red, green and blue clearly differ; near 0 for height maps. It is
    /// estimated from about 10000 regularly spaced texels.
    double colored_fraction = 0.0;
    /// Share of texels whose alpha is neither 0 nor the maximum, estimated in the same way: alpha
    /// may be the heights.
    double partial_alpha_fraction = 0.0;

    [[nodiscard]] std::size_t transparent_count() const;
};

/// Extracts the heights of an image.
///
/// \param image  is consumed; the samples of gray images are moved, not copied
/// \throws InvalidInput as height_field()
HeightMap height_map(Image&& image, HeightChannel channel = HeightChannel::mean);

/// The continuity of a map across the seams between its last and first column, and last and first
/// row.
struct Tiling {
    /// RMS change across the seam, divided by the maximum RMS change between adjacent columns or
    /// rows inside (of at most 256 pairs). 0 if the seam has no change; infinite if only the seam
    /// has one.
    double seam_x = 0.0;
    double seam_y = 0.0;

    /// Maximum value for a map that tiles.
    static constexpr double max_seam = 1.25;
    [[nodiscard]] bool tiles_x() const { return seam_x <= max_seam; }
    [[nodiscard]] bool tiles_y() const { return seam_y <= max_seam; }
    /// Wrap::repeat for axes along which the map tiles, else Wrap::clamp.
    [[nodiscard]] Wraps wraps() const {
        return {tiles_x() ? Wrap::repeat : Wrap::clamp, tiles_y() ? Wrap::repeat : Wrap::clamp};
    }
};

/// Measures the seams of a height map.
///
/// \param height  one channel of 8, 16 or 32 bits; texels that are not finite are ignored
/// \throws InvalidInput if the image is empty or has more than one channel
///
/// Maps of pure noise, and maps with a constant border, also count as tiling.
Tiling detect_tiling(const ImageView& height);

/// The quantization of a height map.
struct HeightDepth {
    /// The smallest n for which every height is a multiple of 1 / (2^n - 1), or of 1 / 2^n, up to
    /// float rounding: 1 to 16. 10 for multiples of 1 / 765, the means of three 8-bit colors. 0 if
    /// there is none (float maps). Eight or more levels that were rounded to the codes of a file of
    /// more bits count as their own bits: 5 for 32 levels in 8 bits.
    int bits = 0;
    /// The mean step between the values that occur, in the unit of heights (1.0 is white): 257 /
    /// 65535 for 8 bits stored in 16. 0 if `bits` is 0.
    double step = 0.0;
};

/// Detects the quantization of a height map.
///
/// \param height  one channel of 8, 16 or 32 bits; texels that are not finite are ignored
/// \throws InvalidInput if the image is empty or has more than one channel
///
/// For a constant map, `bits` is 1 and `step` is the height, or 1 for height 0.
HeightDepth height_depth(const Image& height);

/// Estimates the standard deviation of the noise in a height map, in the unit of heights. The
/// estimate includes fine detail: it is an upper bound for smooth maps, and meaningless for maps
/// with detail of 2 or 3 texels.
///
/// \return 0 for maps of fewer than 3 texels a side
///
/// Source: [Immerkaer 1996].
double height_noise(const Image& height);

/// Options of destaircase().
struct DestaircaseOptions {
    Wraps wrap;
    /// The step between adjacent codes, where 1.0 is white. 0: height_depth() determines it.
    double step = 0.0;
};

struct Destaircased {
    Image heights;      ///< One float channel.
    double step = 0.0;  ///< 0 if the map has no steps; its heights are unchanged then.
};

/// Estimates the heights before they were quantized.
///
/// \param height  one channel of 8, 16 or 32 bits
/// \return for every texel a height within half a step of the stored one, so that rounding
///         reproduces the map. Planes and smooth curves become smooth; edges of several steps and
///         constant maps do not change. Non-finite heights do not change either, and their
///         neighbors are smoothed as if the hole were filled, as in normals_from_height(); beyond
///         the border `wrap` applies. The same bits for any number of threads
/// \throws InvalidInput if the image is empty or has more than one channel, or the step is negative
///         or not finite
///
/// Each texel takes the value of a smoothed surface. The scale of smoothing grows, up to a standard
/// deviation of 37 texels, as long as the mean squared deviation from the surrounding codes does
/// not exceed that of rounding, which is 1/12 of the squared step (the choice of scale is that of
/// [Lepski 1991]). The value is then clamped to half a step around the code. Texels farther away
/// than 400 have no effect.
Destaircased destaircase(const Image& height, const DestaircaseOptions& options = {});

/// Options of heights_from_normals().
struct IntegrationOptions {
    /// The kernel whose slopes are matched: the one with which normals_from_height() will be
    /// called.
    Kernel kernel = Kernel::central7;
    int gaussian_radius = 2;  ///< The radius of Kernel::gaussian in texels.
    Wraps wrap;
    glm::dvec2 texel{1.0, 1.0};  ///< As in BumpOptions; heights have its unit.
    /// Maximum length of a slope. Steeper normals, and normals that face sideways or back, are
    /// clamped to it. The default is 86 degrees; there, one 8-bit code of z already changes the
    /// slope by one sixteenth.
    double max_slope = 16.0;
    /// Subtracts the mean slope first. If flat texels have an error of one 8-bit code, the mean
    /// slope is 0.8%, which adds up to large heights in maps with clamped borders.
    bool level = false;
};

struct IntegratedHeights {
    Image heights;         ///< One float channel in the unit of the texel; the minimum is 0.
    double highest = 0.0;  ///< The maximum height.
    /// The RMS of the remaining difference of slopes over both axes, which no height field can
    /// have. 0 if the map was made from heights by the same kernel.
    double residual_slope = 0.0;
    ErrorStats residual;     ///< The remaining angles between the normals, in degrees.
    double rms_slope = 0.0;  ///< The RMS slope of the map, for comparison.
    /// The mean slope of the map to the right and upwards, before `level` is applied.
    glm::dvec2 mean_slope{};
    int rounds = 1;  ///< Number of iterations; 1 unless a wrap is clamp.
};

/// Computes heights by least squares: no other height field has slopes, by the kernel, that are
/// closer to those of the normals.
///
/// \param normals  three float channels, y up, as from decode_normal_map(); any length
/// \param report  counts texels whose normal is not finite or zero (read as flat), faces sideways
///         or back, or is steeper than `steepest` (clamped)
/// \return heights from which normals_from_height() with the same kernel, wrap and texel reproduces
///         the normals as closely as possible. Waves shorter than 3 texels, to which kernels hardly
///         respond, keep small amplitudes, with relative slope errors of up to 1e-3. A map without
///         slopes gives 0 everywhere. The same bits for any number of threads
/// \throws InvalidInput if the image is empty or not three float channels, or if the texel, the
///         radius or `steepest` (1e-3 to 1e6) is out of range
///
/// If both wraps are repeat or mirror and the kernel is symmetric, the solution is computed
/// directly by fast transforms; otherwise by conjugate gradients with these transforms as the
/// preconditioner. Memory beside normals and result: 8 bytes per texel, or 40 if a wrap is clamp.
/// Source: [Frankot and Chellappa 1988], with the response of the kernel instead of the derivative.
IntegratedHeights heights_from_normals(const Image& normals, const IntegrationOptions& options,
                                       Report& report = IgnoredReport());

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
    double mean_degrees = 0.0;
    double p99_degrees = 0.0;  ///< 99 % of the texels have at most this error; exact to 1/64.
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

/// The expected error if fine detail is noise that was blurred over about 2.5 texels or more.
/// Nothing distinguishes such noise from detail.
struct BlurredNoiseReading {
    double deviation = 0.0;  ///< Standard deviation of that detail, in the unit of heights.
    /// The upper end of the expected RMS error if it is detail; the lower end is
    /// KernelChoice::rms_degrees.
    double detail_upper_rms_degrees = 0.0;
    double rms_degrees = 0.0;        ///< The lower end of the expected RMS error if it is noise.
    double upper_rms_degrees = 0.0;  ///< The upper end in that case.

    /// Returns true if the error is far larger than that of detail.
    [[nodiscard]] bool is_significant(double detail_rms_degrees) const {
        return rms_degrees > 1.0 && rms_degrees > 1.5 * detail_rms_degrees;
    }
};

/// The selected kernel and the properties of the map.
struct KernelChoice {
    Kernel kernel = Kernel::sobel3;
    int gaussian_radius = 2;  ///< The radius of Kernel::gaussian.
    /// Expected RMS error of the normals. NaN for maps of fewer than 64 texels, which are too small
    /// for an estimate.
    double rms_degrees = 0.0;
    double mean_degrees = 0.0;  ///< Expected mean error.
    double p99_degrees = 0.0;   ///< Expected error that 99 % of the texels do not exceed.
    double max_degrees = 0.0;   ///< Expected maximum error.
    /// Upper estimates of these errors for properties that the map does not reveal: noise that
    /// hides or resembles detail, detail smaller than texels, or a map of nothing but noise. They
    /// are at least the values above.
    double upper_rms_degrees = 0.0;
    double upper_mean_degrees = 0.0;
    double upper_p99_degrees = 0.0;
    double upper_max_degrees = 0.0;
    std::string reason;  ///< An explanation for people, with figures.

    HeightDepth depth;  ///< The quantization of the examined parts.
    /// Standard deviation of the noise without rounding, in the unit of heights.
    double noise = 0.0;
    /// Standard deviation of all grain, noise or detail, in the unit of heights.
    double grain = 0.0;
    /// Present if fine detail can be blurred noise, and this matters. The upper estimates above
    /// include it.
    std::optional<BlurredNoiseReading> blurred_noise;
    /// For maps with grain: the result for the other interpretation.
    std::optional<AlternativeChoice> otherwise;
    double spikes = 0.0;  ///< Share of isolated outliers, which are treated as noise.
    double walls = 0.0;   ///< Share of texels beside a step edge.

    /// Returns true if the upper estimate is so much larger that a single number would be
    /// misleading.
    [[nodiscard]] bool is_range() const { return upper_rms_degrees > min_range * rms_degrees; }
    static constexpr double min_range = 1.05;
    /// Returns true if another kernel has a far smaller error under the other interpretation of the
    /// grain.
    [[nodiscard]] bool is_ambiguous() const {
        return otherwise && otherwise->rms_degrees > 1.0 &&
               otherwise->rms_degrees > 1.5 * otherwise->best.rms_degrees;
    }
    /// All examined kernels, smallest error first. The errors of kernels that are not close to the
    /// best one are those of a sample of the parts.
    std::vector<KernelPrediction> predictions;
};

/// Formats the expected error in degrees: "1.3", or "1.3 to 9.9" if it is a range.
std::string expected_error_text(const KernelChoice& choice);

/// Reports that fine detail may be blurred noise, with the expected errors of both cases.
void report_blurred_noise(const KernelChoice& choice, Report& report);

/// Returns the best radius for Kernel::gaussian, even if another kernel was selected.
int best_gaussian_radius(const KernelChoice& choice);

/// Returns the parts of a map that choose_kernel() examines: at most 9 regularly spaced squares of
/// 128 texels, or smaller ones for a small map. They begin at multiples of 8 texels, as the blocks
/// of JPEG do, and are ordered from top to bottom, so that a file can be read in one pass.
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
/// The kernel error model first restores the map as it may have been before noise and rounding. It
/// detects white, colored and blurred noise, offsets of rows or columns, noise that grows with the
/// height, isolated outliers, and the blocks of JPEG (if the parts begin at multiples of 8 texels).
/// Noise is removed by spectral subtraction [Boll 1979], steps wider than texels by destaircase(),
/// blocks by projection [Zakhor 1992]. The model then adds the same degradation again, and measures
/// each kernel on the result. So truncation, noise and quantization have the same weight as in this
/// map. Noise that is blurred over more than about two texels is taken for detail. Maps of at most
/// four levels that are farther apart than the codes of the file are treated as masks with exact
/// levels.
KernelChoice choose_kernel(std::span<const Image> parts, const BumpOptions& options,
                           bool destaircased = false, Grain grain = Grain::automatic);

/// The same for a map in memory.
KernelChoice choose_kernel(const ImageView& height, const BumpOptions& options,
                           bool destaircased = false, Grain grain = Grain::automatic);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Converts bump maps (height fields) to unit normals, normal maps or slopes by finite differences.
/// Tests: tests/mesh/bump/bump_kernels_test.cpp, tests/mesh/bump/bump_test.cpp.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// Derivative kernels. All have unit gain on a plane, so the choice of a kernel does not change the
/// depth of a map. On waves of L texels, the error is proportional to L^-order. The noise column is
/// the standard deviation of the slope for independent height errors of standard deviation 1. The
/// anisotropy column is the maximum error of direction at L = 8, in degrees.
enum class Kernel {
    //                                                       order noise anisotropy
    forward,   ///< The next height minus this one: the slope     1  1.414    0.37
               ///< half a texel farther on.
    central3,  ///< Half the difference of the two neighbors.     2  0.707    1.54
    prewitt3,  ///< Central differences of three lines, 1 1 1.    2  0.408    1.56
    sobel3,    ///< The same, 1 2 1.                              2  0.433    0.75
    scharr3,   ///< The same, 3 10 3: lower anisotropy.           2  0.480    0.16
    sobel5,    ///< Differences 2 1, lines 1 4 6 4 1.             2  0.207    0.75
    scharr5,   ///< Weights with minimal anisotropy.              2  0.283    0.003
    central5,  ///< Differences 8 -1, over 12: for smooth maps.   4  0.950    0.17
    central7,  ///< Differences 45 -9 1, over 60.                 6  1.082    0.02
    /// The slope of the plane with the best least-squares fit, weighted by a Gaussian whose
    /// standard deviation is half the radius: the derivative of a Gaussian, with unit gain. Order
    /// 2.
    gaussian,
};

template <>
inline constexpr auto enum_names<Kernel> =
    std::to_array<EnumName<Kernel>>({{"forward", Kernel::forward},
                                     {"central3", Kernel::central3},
                                     {"prewitt3", Kernel::prewitt3},
                                     {"sobel3", Kernel::sobel3},
                                     {"scharr3", Kernel::scharr3},
                                     {"sobel5", Kernel::sobel5},
                                     {"scharr5", Kernel::scharr5},
                                     {"central5", Kernel::central5},
                                     {"central7", Kernel::central7},
                                     {"gaussian", Kernel::gaussian}});

/// The difference of two heights along the axis of the slope.
struct HeightDifference {
    int before;  ///< Offset in texels.
    int after;
    double weight;  ///< The weight of height[after] - height[before].
};

/// A kernel as data. The slope along one axis is the sum of `differences` along this axis, each
/// smoothed across it, divided by `divisor`.
struct GradientKernel {
    std::vector<HeightDifference> differences;
    /// The weight of the line itself, then of both lines at a distance of 1, 2, ... texels.
    std::vector<double> smoothing;
    double divisor = 1.0;
    int order = 1;
    int radius = 1;  ///< Maximum distance of a height that contributes.
};

inline constexpr int max_kernel_radius = 64;

/// Returns the weights of a kernel.
///
/// \param gaussian_radius  of Kernel::gaussian, 1 to 64; other kernels ignore it
/// \throws InvalidInput if the radius is out of range
///
/// The weights of the 3x3 kernels, of Sobel's 5x5 kernel and of the central differences are
/// integers, so that slopes of integer heights are exact. Source: [Sobel and Feldman 1968],
/// [Scharr 2000] (whose 5 taps have 4 digits), [Fornberg 1988] for the central differences of
/// higher order.
GradientKernel gradient_kernel(Kernel kernel, int gaussian_radius = 2);

/// Returns the standard deviation of a slope if heights have independent errors of standard
/// deviation 1: sqrt(sum of squares of all weights), in slope per height.
double noise_gain(const GradientKernel& kernel);

/// Returns the slope along x that the kernel computes for a plane wave, divided by the exact slope:
/// 1 is exact. The exact slope is taken at the center of the kernel: at the texel, or half a texel
/// farther along x for Kernel::forward.
///
/// \param frequency  in radians per texel along x and y; x within (-pi, pi), 0 gives the limit
double slope_response(const GradientKernel& kernel, glm::dvec2 frequency);

/// Returns the maximum angle in radians, over all directions of a plane wave, between the gradient
/// of the kernel and the exact one. Each of the two slopes is compared at the center of its own
/// kernel, see slope_response(). At the texel itself, the gradient of Kernel::forward can have any
/// error of direction, because its two slopes belong to different positions.
///
/// \param wavelength  in texels, above 2
double anisotropy(const GradientKernel& kernel, double wavelength);

/// Options for the conversion of heights to slopes. Absent options are derived from the map: see
/// resolve_options().
struct BumpOptions {
    std::optional<Kernel> kernel{};
    std::optional<Wraps> wrap{};
    /// The height of the value 1.0 in the unit of `texel` (by default in texels), within +-1e30.
    /// Negative values turn bumps into dents.
    double strength = 16.0;
    /// Width and height of a texel, from 1e-30 to 1e30; they may differ. With (1, 1), `strength` is
    /// in texels.
    glm::dvec2 texel{1.0, 1.0};
    int gaussian_radius = 2;  ///< The radius of Kernel::gaussian in texels, if `kernel` is given.
    /// The precision of slopes and normals. If absent: float32 for results of 8 or 16 bits, else
    /// float64.
    std::optional<Arithmetic> arithmetic{};
};

/// Fills in all absent options from the map, in the same way for every conversion and tool.
///
/// \param height  as for normals_from_height()
/// \return absent kernels (with radius) by choose_kernel() (height_map.h), absent wraps by
///         detect_tiling() (height_map.h); the other options unchanged
/// \throws InvalidInput as normals_from_height() does
BumpOptions resolve_options(const ImageView& height, BumpOptions options);

/// Computes the unit normals of a height field in tangent space: x points right, y up in the image,
/// z out of it.
///
/// \param height  one channel of float, as from height_field() (height_map.h), or of 8 or 16 bits,
///         which stand for value / 255 and value / 65535
/// \param report  counts texels whose height is not finite. Each is replaced by the mean of the
///         finite heights in the smallest square around it that contains any (beyond the border by
///         `wrap`), or by 0 if the image has none
/// \return three float channels: normalize(-dh/dx, -dh/dy, 1), with y upwards. A constant field and
///         a single texel give exactly (0,0,1). Arithmetic::float64 computes in double precision
///         and rounds once. The result is the same bits for any number of threads. For a given
///         kernel, a mirrored map, or one shifted across a border that repeats, has corresponding
///         bits; a transposed one differs by at most 1e-5 degrees, and 1e-3 with float32. Powers of
///         two that cancel between heights, strength and texel change nothing
/// \throws InvalidInput if the image is empty or has more than one channel, or if the strength, the
///         texel or the radius is out of range
///
/// Source: [Blinn 1978]; for the kernels see Kernel.
Image normals_from_height(const Image& height, const BumpOptions& options,
                          Report& report = IgnoredReport());

/// Computes a normal map in its stored format directly, at the speed of memory.
///
/// \param result  its memory is reused if it has the required size and format
///
/// The codes are those of encode_normal_map(). For float64 they come from the normal before it is
/// rounded to float; for float32 they differ by at most one code of 16 bits, and mostly not at all.
/// Blocks with slopes above 1e15, whose squares overflow float32, use float64.
void normal_map_from_height(const Image& height, const BumpOptions& options,
                            const NormalMapFormat& format, Image& result,
                            Report& report = IgnoredReport());
Image normal_map_from_height(const Image& height, const BumpOptions& options,
                             const NormalMapFormat& format, Report& report = IgnoredReport());

/// Writes the normal map into the caller's memory, from heights in the caller's memory.
///
/// \param height  one channel. It is copied only if a height is not finite; if `options` have no
///         kernel, at most nine squares of 128 texels are copied to choose one
/// \param result  two channels (x and y), three, or four (with an alpha of 1), with the size of
///         `height` and the bits of `format`. Two and four channels take about twice
///         the time of three
/// \param execution  threads, progress and cancellation; the map does not depend on it
/// \throws InvalidInput also if `result` has another format; Cancelled
void normal_map_from_height(const ImageView& height, const BumpOptions& options,
                            const NormalMapFormat& format, const MutableImageView& result,
                            Report& report = IgnoredReport(),
                            const ExecutionOptions& execution = {});

/// Computes slopes instead of normals: two float channels, dh/dx to the right and dh/dy upwards.
///
/// Otherwise like normals_from_height(). Slopes beyond the range of float become +-infinity.
Image slopes_from_height(const Image& height, const BumpOptions& options,
                         Report& report = IgnoredReport());

}  // namespace relief

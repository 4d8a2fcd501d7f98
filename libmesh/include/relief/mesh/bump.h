// SPDX-License-Identifier: Apache-2.0
/// \file
/// Converts bump maps (height fields) to unit normals, normal maps or slopes by finite differences.
/// Tests: tests/mesh/bump/bump_test.cpp.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "relief/mesh/arithmetic.h"
#include "relief/mesh/gradient_kernel.h"
#include "relief/mesh/image.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"

namespace relief {

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
/// \return absent kernels (with radius) by choose_kernel() (kernel_choice.h), absent wraps by
///         detect_tiling() (height_statistics.h); the other options unchanged
/// \throws InvalidInput as normals_from_height() does
BumpOptions resolve_options(const Image& height, BumpOptions options);

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
///         and rounds once. The result is the same bits for any number of threads
/// \throws InvalidInput if the image is empty or has more than one channel, or if the strength, the
///         texel or the radius is out of range
///
/// Source: [Blinn 1978]; for the kernels see gradient_kernel.h.
Image normals_from_height(const Image& height, const BumpOptions& options, Report& report);

/// Computes a normal map in its stored format directly, at the speed of memory.
///
/// \param result  its memory is reused if it has the required size and format
///
/// The codes are those of encode_normal_map(). For float64 they come from the normal before it is
/// rounded to float; for float32 they differ by at most one code of 16 bits, and mostly not at all.
/// Blocks with slopes above 1e15, whose squares overflow float32, use float64.
void normal_map_from_height(const Image& height, const BumpOptions& options,
                            const NormalMapFormat& format, Image& result, Report& report);
Image normal_map_from_height(const Image& height, const BumpOptions& options,
                             const NormalMapFormat& format, Report& report);

/// Computes slopes instead of normals: two float channels, dh/dx to the right and dh/dy upwards.
///
/// Otherwise like normals_from_height(). Slopes beyond the range of float become +-infinity.
Image slopes_from_height(const Image& height, const BumpOptions& options, Report& report);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// From a bump map (a field of heights) to unit normals, by finite differences.
/// Tests: tests/mesh/image/bump/bump_test.cpp.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "relief/mesh/arithmetic.h"
#include "relief/mesh/gradient_kernel.h"
#include "relief/mesh/image.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"

namespace relief {

/// What lies beyond the border of the image.
enum class Wrap {
    repeat,  ///< The opposite edge: the map tiles.
    clamp,   ///< Nothing. The surface goes on as its own point reflection at the border texel: a
             ///< plane stays a plane, and a slope across the border is one-sided.
    mirror,  ///< The map mirrored at the border, its outermost texels twice, as OpenGL does it.
};

/// The same in both directions, unless told otherwise.
struct Wraps {
    Wrap x = Wrap::repeat;
    Wrap y = Wrap::repeat;

    constexpr Wraps() = default;
    constexpr Wraps(Wrap both) : x(both), y(both) {}
    constexpr Wraps(Wrap along_x, Wrap along_y) : x(along_x), y(along_y) {}
    bool operator==(const Wraps&) const = default;
};

/// Options for the conversion of heights to slopes. The map decides absent ones: see
/// settled_options().
struct BumpOptions {
    std::optional<Kernel> kernel{};
    std::optional<Wraps> wrap{};
    /// The height that the value 1.0 stands for, in the unit of `texel`: in texels, unless that is
    /// changed. Within +-1e30; negative turns bumps into dents.
    double strength = 16.0;
    /// Width and height of a texel, from 1e-30 to 1e30. Both 1: `strength` is in texels. Unequal:
    /// texels are not square.
    glm::dvec2 texel{1.0, 1.0};
    int gaussian_radius = 2;  ///< Of Kernel::gaussian, in texels, where the kernel is given.
    /// What slopes and normals are computed in. Unless given: float32 where the result has 8 or 16
    /// bits, else float64.
    std::optional<Arithmetic> arithmetic{};
};

/// The options with all that was left to the map, as every conversion and every tool settles it.
///
/// \param height  as for normals_from_height()
/// \return kernel (and its radius) by choose_kernel() (kernel_choice.h), wrap by detect_tiling()
///         (height_statistics.h), where they are absent; the others as they are
/// \throws InvalidInput as normals_from_height() does
BumpOptions settled_options(const Image& height, BumpOptions options);

/// Unit normals of a height field, in tangent space: x to the right, y up in the image, z out.
///
/// \param height  one channel, as from height_field() (height_map.h) or of 8 or 16 bits as in a
/// file (samples stand
///                for value / 255 and value / 65535)
/// \param report  counts texels whose height is not finite: each is read as the mean of the finite
///                heights in the smallest square around it that holds any (beyond the border by
///                `wrap`), or 0 where the image has none
/// \return three float channels: normalize(-dh/dx, -dh/dy, 1), with y upwards; a constant field
///         gives exactly (0,0,1), and so does a single texel. In float64, computed in double and
///         rounded once. The same bits for any number of threads.
/// \throws InvalidInput if the image is empty or has more than one channel, or if the strength, the
///         texel or the radius is out of range
///
/// Source: [Blinn 1978]; for the kernels see gradient_kernel.h.
Image normals_from_height(const Image& height, const BumpOptions& options, Report& report);

/// The same as stored codes at once, without the normals in between: at the speed of memory.
///
/// \param result  its memory is used again if it has the shape and depth asked for already
///
/// The codes are those of encode_normal_map: in float64, of the normal before it is rounded to
/// float; in float32, within one code of 16 bits of that (mostly equal). Blocks with slopes above
/// 1e15, which float32 cannot square, are done in float64 all the same.
void normal_map_from_height(const Image& height, const BumpOptions& options,
                            const NormalMapFormat& format, Image& result, Report& report);
Image normal_map_from_height(const Image& height, const BumpOptions& options,
                             const NormalMapFormat& format, Report& report);

/// Slopes instead of normals: two float channels, dh/dx to the right and dh/dy upwards.
///
/// Otherwise as normals_from_height; slopes beyond float's range become +-infinity.
Image slopes_from_height(const Image& height, const BumpOptions& options, Report& report);

}  // namespace relief

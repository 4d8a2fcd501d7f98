// SPDX-License-Identifier: Apache-2.0
/// \file
/// Encodes and decodes normal maps, and blends, filters and resizes them.
///
/// docs/normal-maps.md has the errors of the methods.
/// Tests: tests/mesh/image/normal_map_test.cpp, tests/mesh/image/normal_map_operations_test.cpp,
/// tests/mesh/image/normal_resize_test.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// The space of the vectors of a map.
enum class VectorSpace {
    tangent,  ///< The normals and tangents of the mesh, as the shader interpolates them.
    object,   ///< The object space of the mesh.
    world,    ///< The space in which meshes are placed.
};

template <>
inline constexpr auto enum_names<VectorSpace> =
    std::to_array<EnumName<VectorSpace>>({{"tangent", VectorSpace::tangent},
                                          {"object", VectorSpace::object},
                                          {"world", VectorSpace::world}});

/// The direction of the green channel.
enum class Green {
    up,    ///< OpenGL and glTF: surfaces that face up in the image are bright in green.
    down,  ///< DirectX.
};

template <>
inline constexpr auto enum_names<Green> = std::to_array<EnumName<Green>>(
    {{"up", Green::up, "up (OpenGL)"}, {"down", Green::down, "down (DirectX)"}});

/// The code of zero in maps of 8 or 16 bits. Decoding with the wrong one causes an error of up to
/// 0.7 degrees in 8 bits, 0.003 in 16: half a code in addition to rounding.
enum class FlatCode {
    /// 128 of 255 (32768 of 65535) is exactly 0: n = (code - 128) / 127, at least -1.
    middle,
    /// 127.5 of 255 is 0: n = 2 * code / 255 - 1, as in glTF 2.0 and engines. No code is exactly 0:
    /// a flat texel is stored as (128, 128, 255), which decodes to a direction 0.32 degrees from
    /// flat (0.0012 in 16 bits). FlatTexels::exact corrects this.
    half,
};

/// The names are codes of 8 bits. In 16 bits the codes are 32767.5 and 32768.
template <>
inline constexpr auto enum_names<FlatCode> =
    std::to_array<EnumName<FlatCode>>({{"127.5", FlatCode::half}, {"128", FlatCode::middle}});

/// The decoding of flat texels with FlatCode::half.
enum class FlatTexels {
    as_coded,  ///< By the formula, as glTF and engines do.
    /// As exactly (0,0,1), if flat_texel_codes() finds the codes of flat texels.
    exact,
};

struct NormalMapFormat {
    /// 8, 16 or 32. Float samples hold (n + 1) / 2, like the EXR and TIFF maps of other bakers.
    /// Zero is exactly 0.5 then, and `flat` is ignored.
    int bits = 16;
    Green green = Green::up;
    FlatCode flat = FlatCode::half;
    /// For 8 and 16 bits. With dithering, the error of a texel is less than one code instead of at
    /// most half a code, but the mean over a few texels is accurate.
    Dither dither = Dither::none;
};

/// Encodes normals as a data image of three channels.
///
/// \param normals  three float channels, y up, of any length
/// \param report  counts normals that are zero or not finite, which are stored as flat
/// \return codes that are rounded to the nearest, or as `dither` says. With FlatCode::middle,
///         (0,0,1) decodes to exactly (0,0,1), and n and -n have symmetric codes, so that seams of
///         mirrored textures are invisible. With FlatCode::half, 0 becomes the upper one of its two
///         codes, or both alternately with dithering
/// \throws InvalidInput if the image is empty or not three float channels, or bits is not 8, 16 or
///         32
Image encode_normal_map(const ImageView& normals, const NormalMapFormat& format,
                        Report& report = IgnoredReport());

/// Writes the codes into the caller's memory.
///
/// \param map  two channels (x and y), three, or four (with an alpha of 1), with the size of
///         `normals` and the bits of `format`; must not overlap `normals`
/// \param execution  threads, progress and cancellation; the codes do not depend on it
/// \throws InvalidInput also if `map` has another format; Cancelled
void encode_normal_map(const ImageView& normals, const NormalMapFormat& format,
                       const MutableImageView& map, Report& report = IgnoredReport(),
                       const ExecutionOptions& execution = {});

/// Decodes a normal map to three float channels, unit, y up.
///
/// \param map  three or four channels (the fourth is ignored) of any number of bits.
///         FlatTexels::exact needs the whole map, because it counts codes
/// \param flat  for 8 and 16 bits
/// \param report  counts texels that decode to zero or to values that are not finite; they become
///         flat
/// \throws InvalidInput if the image is empty or has fewer than three channels
Image decode_normal_map(const ImageView& map, Green green, FlatCode flat,
                        Report& report = IgnoredReport(), FlatTexels texels = FlatTexels::as_coded);

/// Writes the normals into the caller's memory.
///
/// \param normals  three float channels with the size of `map`; must not overlap it
/// \param execution  threads, progress and cancellation; the normals do not depend on it
/// \throws InvalidInput also if `normals` has another format; Cancelled
void decode_normal_map(const ImageView& map, Green green, FlatCode flat,
                       const MutableImageView& normals, Report& report = IgnoredReport(),
                       FlatTexels texels = FlatTexels::as_coded,
                       const ExecutionOptions& execution = {});

/// Finds the codes of x and y that stand for exactly flat in a map with FlatCode::half: the pair of
/// codes around zero, 127 or 128 each, that at least three quarters of the nearly flat texels have.
/// Absent if there is no such pair, as in dithered or curved maps, where each of the four pairs is
/// a different direction; and in float maps.
///
/// \param x,y  channels
/// \throws InvalidInput if the image is empty or has no such channels
std::optional<std::array<std::uint16_t, 2>> flat_texel_codes(const ImageView& map, int x = 0,
                                                             int y = 1);

/// Returns the code of zero that the metadata names, else FlatCode::half, as in glTF and engines.
/// It cannot be found from the texels: flat ones contain 128 in both kinds of maps.
///
/// \throws InvalidInput if the image is empty or has fewer than three channels
FlatCode detect_flat_code(const ImageView& map,
                          const std::map<std::string, std::string>& metadata = {});

/// Returns the text entries of a normal map in tangent space, as from write_description()
/// (map_description.h): its content, green, code of zero and color space.
std::map<std::string, std::string> normal_map_metadata(const NormalMapFormat& format);

/// One of the axes x, y, z, or its opposite.
struct SignedAxis {
    int axis = 0;  ///< 0 to 2.
    bool is_negative = false;
    bool operator==(const SignedAxis&) const = default;
};

/// A signed permutation of axes: the sources of x, y and z.
using AxisMapping = std::array<SignedAxis, 3>;
inline constexpr AxisMapping same_axes = {{{0, false}, {1, false}, {2, false}}};

/// Permutes and negates the stored components of a map, without decoding them.
///
/// \param map  three or four channels; the fourth does not change
/// \param flat  for 8 and 16 bits
/// \param report  counts samples of code 0 under FlatCode::middle that are negated. They stand for
///         -1, as code 1 does, and become the maximum code; the inverse mapping returns 1
/// \throws InvalidInput if the image has fewer than three channels, or if an axis occurs twice
///
/// Except for these, a mapping followed by its inverse restores every code; float samples are
/// restored within 2^-24.
void map_axes(Image& map, const AxisMapping& mapping, FlatCode flat,
              Report& report = IgnoredReport());

/// The same for decoded normals, without rounding: three float channels.
void map_normal_axes(Image& normals, const AxisMapping& mapping);

/// The channels of an image that hold x and y.
struct XyChannels {
    int x = 0;
    int y = 1;
};

/// Reconstructs unit normals from x and y; z is the positive value that makes them unit.
///
/// \param map  two to four channels; FlatTexels::exact needs the whole map
/// \param report  counts texels whose x and y are longer than 1, as lossy compression causes (z
///         becomes 0, and they are normalized), and texels that are not finite (read as flat)
/// \return three float channels, unit, y up
/// \throws InvalidInput if the image is empty or lacks one of the channels
Image decode_xy_map(const ImageView& map, const XyChannels& channels, Green green, FlatCode flat,
                    Report& report = IgnoredReport(), FlatTexels texels = FlatTexels::as_coded);

/// The lengths of the vectors of a map.
struct LengthRange {
    double min = 0.0;
    double mean = 0.0;
    double max = 0.0;
};

/// Measures the lengths of a map's vectors without changing it; decode_normal_map() normalizes
/// them.
///
/// \param report  counts vectors whose length deviates from 1 by more than rounding or dithering to
///         the map's codes causes (sqrt(3) codes; 0.001 for float, because of half floats)
/// \return statistics of finite lengths
/// \throws InvalidInput if the image is empty or has fewer than three channels
LengthRange measure_lengths(const Image& map, FlatCode flat, Report& report = IgnoredReport());

/// Multiplies the slopes of unit normals, in place, as if the heights had been multiplied.
///
/// \param normals  three float channels, unit
/// \param strength  within +-1e6; negative values turn bumps into dents, 0 makes all flat
/// \param report  counts normals whose z is not positive, which have no slope: their x and y are
///         multiplied anyway; and results without direction, which become flat
/// \throws InvalidInput if the image is not three float channels, or the strength is out of range
void scale_slopes(Image& normals, double strength, Report& report = IgnoredReport());

/// The maximum slope, 89.94 degrees; useful height maps have no steeper ones.
inline constexpr double largest_slope = 1024.0;

/// Converts unit normals to slopes: two float channels, dh/dx to the right and dh/dy upwards, as
/// from slopes_from_height().
///
/// \param report  counts normals that are steeper than largest_slope or do not face outwards: their
///         slope keeps its direction and gets the maximum length (or 0 for (0,0,-1))
/// \throws InvalidInput if the image is not three float channels
Image slopes_from_normals(const Image& normals, Report& report = IgnoredReport());

/// Converts slopes to unit normals. \throws InvalidInput if the image is not two float channels
Image normals_from_slopes(const Image& slopes, Report& report = IgnoredReport());

/// Blending methods for unit normals: base b and detail d, with z out of the surface. Every result
/// is normalized. docs/normal-maps.md has the error of each method.
enum class NormalBlend {
    /// d, rotated by the shortest rotation from (0,0,1) to b: the detail is carved into the base.
    /// [Barré-Brisebois and Hill 2012]
    reoriented,
    /// The sum of slopes, (b.xy d.z + d.xy b.z, b.z d.z): exactly that of two added height fields.
    partial_derivative,
    whiteout,  ///< (b.xy + d.xy, b.z d.z): slightly less steep than the sum of slopes.
    udn,       ///< (b.xy + d.xy, b.z): fast; the detail fades on slopes.
    unity,     ///< d in a frame whose axes are b rotated by 90 degrees about x and y.
    linear,    ///< b + d: both have half their slope.
    /// The Overlay mode of image editors on (n + 1) / 2: distorts all normals that are not nearly
    /// flat.
    overlay,
};

inline constexpr NormalBlend all_normal_blends[] = {
    NormalBlend::reoriented, NormalBlend::partial_derivative,
    NormalBlend::whiteout,   NormalBlend::udn,
    NormalBlend::unity,      NormalBlend::linear,
    NormalBlend::overlay};

/// Blends a detail map into a base map, in place.
///
/// \param base  three float channels, unit, y up; it becomes the result, unit
/// \param detail  three float channels, unit, y up, of any size; repeated from the upper left
///         corner. To scale it, see fitted_detail()
/// \param report  counts texels whose result has no direction or, for reoriented, whose base normal
///         is (0,0,-1): they keep the base's normal; and texels whose result by reoriented or unity
///         faces back while the base does not, because both slopes are steep
/// \throws InvalidInput if an image is empty or not three float channels
///
/// A flat detail does not change the base, up to rounding, except for `linear` and `overlay`. A
/// flat base gives the detail, except for these two and `udn`, whose result is steeper than the
/// detail.
void blend_normals(Image& base, const Image& detail, NormalBlend method,
                   Report& report = IgnoredReport());

/// Computes the levels of a normal map down to one texel, with the sizes and weights of
/// mip_levels().
///
/// \param normals  three float channels, unit
/// \return mean vectors with a length of at most 1: each texel is the mean of the area that it
///         covers in the map itself, without normalization in between
/// \throws InvalidInput if the image is empty or not three float channels
std::vector<Image> normal_mip_levels(const Image& normals);

/// Normalizes mean vectors, in place.
///
/// \param report  counts vectors of length 0 (below 1e-6, because of rounding), such as those of a
///         peak whose sides cancel: they become flat
/// \return their previous lengths, from 0 to 1: one float channel
Image split_lengths(Image& means, Report& report = IgnoredReport());

/// Returns the slope variance per axis (the mean of both axes) of unit normals whose mean has this
/// length: (1 / length^2 - 1) / 2. It is exact if all normals have the same angle to the mean, and
/// otherwise too small: 95% of the variance of normally distributed slopes with standard deviation
/// 0.2, 82% with 0.5.
///
/// \param length  clamped to [1e-3, 1]
double slope_variance_of_length(double length);

/// Returns the factor for a Phong or Blinn-Phong exponent for normals whose mean has this length:
/// length / (length + exponent (1 - length)). Source: [Toksvig 2005].
double toksvig_factor(double length, double exponent);

/// Adds a slope variance to a roughness (of glTF: alpha = roughness^2): alpha'^2 = alpha^2 + 2
/// variance, at most 1.
///
/// The slopes of Beckmann's distribution have the variance alpha^2 / 2 along each axis, and
/// variances add [Olano and Baker 2010]. Those of GGX have no finite variance; it uses the same
/// alpha by convention.
double roughness_with_variance(double roughness, double variance);

/// Computes the roughness of each texel of a level: one float channel.
///
/// \param lengths  as from split_lengths()
/// \param roughness  of the map itself, 0 to 1
/// \throws InvalidInput if the image is not one float channel, or the roughness is out of range
Image roughness_from_lengths(const Image& lengths, double roughness);

/// The filter kernel. When an image is reduced, the kernel is widened by the same factor.
/// docs/normal-maps.md has the error of each filter.
enum class ResizeFilter {
    /// The texels that the new one covers, weighted by area; for enlargement the nearest texel.
    box,
    triangle,  ///< Linear interpolation.
    cubic,     ///< The Catmull-Rom spline, which interpolates the texels.
    lanczos,   ///< Three lobes: the sharpest.
    /// The filter with the smallest error along each axis: lanczos to reduce, cubic to enlarge.
    best,
};

/// The quantity that is averaged.
enum class ResizeDomain {
    slopes,   ///< Slopes: the result has the normals of the filtered surface.
    vectors,  ///< The normals themselves, with normalization; steep texels have less weight.
};

/// The maximum slope for averaging slopes, 86.4 degrees. Steeper normals would dominate their
/// neighborhood; where they contribute, vectors are averaged instead.
inline constexpr float max_averaged_slope = 16.0F;

struct ResizeOptions {
    ResizeFilter filter = ResizeFilter::best;
    ResizeDomain domain = ResizeDomain::slopes;
    Wraps wrap;
    /// Number of repetitions of the map in the result along each axis, above 0.
    glm::dvec2 repeat{1.0, 1.0};
};

/// Resizes normals. Slopes do not change: the size of texels changes, not the surface.
///
/// \param normals  three float channels, unit
/// \param width, height  positive
/// \param report  counts texels whose mean vector has no direction, which become flat; with
///         ResizeDomain::slopes also normals that are too steep for averaging slopes
/// \throws InvalidInput if the image is not three float channels, or a size or repeat is not
///         positive
///
/// At the same size and with one repetition, the result is bitwise equal to the input.
Image resize_normals(const Image& normals, int width, int height, const ResizeOptions& options,
                     Report& report = IgnoredReport());

/// Resizes any float samples, channel by channel, such as the alpha that belongs to normals.
/// \throws InvalidInput as resize_normals() does. options.domain is ignored
Image resize_samples(const Image& image, int width, int height, const ResizeOptions& options);

/// Resizes a detail map as blend_normals() needs it for a base of this size, so that it repeats
/// `options.repeat` times across the base. The result is one period if the base's size is a
/// multiple of it, else the whole area. It always wraps around; options.wrap is ignored.
Image fitted_detail(const Image& detail, int base_width, int base_height,
                    const ResizeOptions& options, Report& report = IgnoredReport());

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Relief mapping: the methods that intersect a ray with a height map.
/// Tests: tests/mesh/bump/height_field_test.cpp, tests/mesh/bump/height_march_test.cpp,
/// tests/mesh/bump/curved_ray_test.cpp, tests/mesh/bump/cone_map_test.cpp.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// How the point of a height map is found that a ray of view hits, from least to most accurate.
///
/// Texel space: x and y are texture coordinates times the size of the map; depth s is in texels
/// below the surface of white, from 0 to the depth D of black. The ray is at p(s) = p(0) + k s.
enum class HeightMethod {
    parallax,            ///< One step, by the depth at p(0) [Kaneko 2001].
    parallax_occlusion,  ///< Layers of equal depth, then one secant step [Tatarchuk 2006].
    relief_mapping,      ///< Layers of equal depth, then bisection [Policarpo et al. 2005].
    relaxed_cones,  ///< Steps within a cone for each texel, then bisection [Policarpo and Oliveira
                    ///< 2007]; needs a cone map.
    maximum_mipmaps,  ///< Descent through a pyramid of maximum heights, then the exact bilinear
                      ///< patch [Tevs et al. 2008].
};

/// A method with its settings. Those that the method does not use are ignored.
struct HeightMarch {
    HeightMethod method = HeightMethod::maximum_mipmaps;
    int layers = 16;      ///< Of parallax occlusion and relief mapping; steps of relaxed cones.
                          ///< From 1 to 512.
    int bisections = 6;   ///< Of relief mapping and relaxed cones. From 0 to 16.
    int max_steps = 128;  ///< Of maximum mipmaps. From 1 to 1024.
};

template <>
inline constexpr auto enum_names<HeightMethod> =
    std::to_array<EnumName<HeightMethod>>({{"parallax", HeightMethod::parallax},
                                           {"parallax_occlusion", HeightMethod::parallax_occlusion},
                                           {"relief_mapping", HeightMethod::relief_mapping},
                                           {"relaxed_cones", HeightMethod::relaxed_cones},
                                           {"maximum_mipmaps", HeightMethod::maximum_mipmaps}});

namespace detail {
struct HeightFieldData;
}  // namespace detail

/// A ray in texel space (see HeightMethod). Texels may be anisotropic in object space: the caller
/// divides directions by the width and height of a texel.
struct HeightRay {
    glm::dvec2 texcoord{0.0};   ///< Of the beginning; outside of [0,1] by the wrap modes.
    glm::dvec3 direction{0.0};  ///< x to the right, y down in the image, z into the depth; texels.
    double black_depth = 0.0;   ///< The depth D of black; from 0.
    double start_depth = 0.0;   ///< The depth of the beginning; from 0 to D.
    /// How much the surface curves below a ray that goes down: where the direction has led down by
    /// s, the ray is at the depth start_depth + s - bend s^2. Rays that go up ignore it.
    double bend = 0.0;
};

/// How a surface curves around a point, to the second order, in texels whose length is the root of
/// the area of a texel.
struct HeightCurvature {
    /// The turn of the unit normal over a texel to the right (first column) and down: texels to the
    /// right and down for each unit of length. Positive on convex surfaces.
    glm::dmat2 turn{0.0};
    /// The inner products of the edges of a texel on the tangent plane.
    glm::dmat2 metric{1.0};
};

/// Returns the curvature of a triangle whose normals are interpolated.
///
/// \param normal  interpolated, of any length
/// \param along_x,along_y  the edges of a texel to the right and down, in the space of the normal
/// \param normal_x,normal_y  what the interpolated normal gains along them
/// \return zero if something is not finite, or if the edges do not span a plane across the normal
HeightCurvature height_curvature(const glm::dvec3& normal, const glm::dvec3& along_x,
                                 const glm::dvec3& along_y, const glm::dvec3& normal_x,
                                 const glm::dvec3& normal_y);

/// A ray over a curved surface, as the coordinates and the depth of the surface have it.
struct CurvedHeightRay {
    HeightRay ray;  ///< Bent.
    /// After the way s of the bent ray, the straight one is at the depth plane.x s + plane.y s^2 on
    /// the tangent plane.
    glm::dvec2 plane{1.0, 0.0};
};

/// Bends a ray of view by the curvature of the surface below it.
///
/// \param ray  on the tangent plane, from the surface of white down; its start_depth and bend are
///         ignored
/// \return a parabola above the line through the beginning and the middle of the ray, with the
///         depths of the ray where it begins, where it reaches black or is deepest, and at half of
///         the depth on the plane between them. These points are exact on spheres and cylinders,
///         but for rounding; on other surfaces to the second order. The ray is straight if the
///         curvature is zero or not finite, and straight down
///
/// A radius of curvature of less than twice the depth of black counts as twice the depth. On a
/// convex surface, a ray that does not reach black leaves through the surface of white. The
/// coordinates stay linear along the ray, so that its intersection with a bilinear patch stays a
/// quadratic equation.
CurvedHeightRay curved_ray(const HeightRay& ray, const HeightCurvature& curvature);

/// How a ray ends.
enum class HeightRayEnd {
    hit,
    left,      ///< It leaves through the surface of white, or has no direction; from the surface of
               ///< white, only directions with z > 0 enter, which leave if the surface is convex.
    exceeded,  ///< It is longer than the bound on patches or steps.
};

/// Where a ray ends. Without a hit, this is the last point that it reached.
struct HeightHit {
    glm::dvec2 texcoord{0.0};  ///< Continues that of the ray: it is not reduced to [0,1].
    double depth = 0.0;        ///< In texels below white.
    double way = 0.0;          ///< How far the direction has led down to there, or up, in texels.
    /// The slope of the bilinear heights at the point: the height in texels that is gained per
    /// texel to the right and per texel down in the image. The normal in texel space, with z up,
    /// is (-slope.x, -slope.y, 1).
    glm::dvec2 slope{0.0};
    HeightRayEnd end = HeightRayEnd::left;
    /// first_hit() counts the patches that it visits; march() the texels or filtered values that it
    /// reads, where a value that is needed twice counts once, and a patch of four texels as four.
    int lookups = 0;
};

/// A height map as a surface: bilinear between the centers of texels, as textures are sampled.
/// White (1.0) is at depth 0, black at depth D. Copies share their heights.
class HeightField {
  public:
    /// The bound of first_hit() on patches.
    static constexpr int max_patches = 1 << 16;

    /// How far above its own point on the surface is_shadowed() begins, as a share of the depth of
    /// black: 500 times the rounding of heights, and of coordinates in texels below 8192, in float.
    static constexpr double shadow_lift = 1.0 / 512.0;

    /// \param heights  one channel of 8, 16 or 32 bits
    /// \param wraps  beyond the border; Wrap::clamp continues the border texel
    /// \param report  counts heights that are not finite, which are filled as in
    ///         normals_from_height(), and heights outside of 0 to 1, which are clamped
    /// \throws InvalidInput if the image is empty or has more than one channel
    HeightField(const Image& heights, const Wraps& wraps, Report& report = IgnoredReport());

    /// The width and height of the map in texels.
    [[nodiscard]] glm::ivec2 size() const;
    [[nodiscard]] const Wraps& wraps() const;

    /// Returns the height at finite texture coordinates, from 0 to 1.
    [[nodiscard]] double height(const glm::dvec2& texcoord) const;

    /// Returns the derivatives of height() per texel to the right and down in the image. At the
    /// center lines of texels they are those to the right and below.
    [[nodiscard]] glm::dvec2 slope(const glm::dvec2& texcoord) const;

    /// Intersects a ray with the bilinear patches in their order along the ray.
    ///
    /// \param ray  with finite coordinates and finite, nonnegative depths
    /// \return the first point at which the ray is not above the surface: the first root of the
    ///         quadratic of a patch, in double precision. A ray that begins at or below the surface
    ///         hits there; one that goes down hits at depth D at the latest, or exceeds
    ///         `max_patches`. Only + - * / and square roots decide, so results are the same
    ///         everywhere. Rays that are not finite end as HeightRayEnd::left
    ///
    /// A ray within rounding of a ridge may miss it. The cost is about 1.3 patches per texel
    /// of distance along the map.
    ///
    /// Source: [Amanatides and Woo 1987] for the order of patches.
    [[nodiscard]] HeightHit first_hit(const HeightRay& ray) const;

    /// Tells whether the surface hides one of its own points from a light: self-shadowing.
    ///
    /// \param ray  from the point of the surface at its texture coordinates towards the light, so
    ///         that its direction has z < 0; its start_depth is ignored
    /// \return true if first_hit() finds a hit before the ray leaves through the surface of white.
    ///         The ray begins `shadow_lift` times the depth of black above the point, but not above
    ///         white. Light that does not come from above, is flatter than 1 in 10^6, or is not
    ///         finite does not reach the point; a ray over more than `max_patches` does
    [[nodiscard]] bool is_shadowed(const HeightRay& ray) const;

    /// Finds a hit by a method of shaders, with the same steps as `shaders/height_march.glsl`, but
    /// in double precision.
    ///
    /// \param ray  its start_depth is ignored: it begins at the surface of white
    /// \param cones  for HeightMethod::relaxed_cones: the second channel of a cone map of the same
    ///         size as a field, HeightField(channel_of(cone_map, 1), wraps)
    /// \return the point that the method takes for the hit. HeightRayEnd::exceeded is possible only
    ///         for HeightMethod::maximum_mipmaps; the others take what they have. A bent ray ends
    ///         as HeightRayEnd::left where it leaves through the surface of white without a hit
    /// \throws InvalidInput if the settings are out of range, or cones are missing or have another
    ///         size
    [[nodiscard]] HeightHit march(const HeightRay& ray, const HeightMarch& method,
                                  const HeightField* cones = nullptr) const;

  private:
    friend Image relaxed_cones(const HeightField& field, int bits);

    std::shared_ptr<const detail::HeightFieldData> data_;
};

/// Computes a cone map for HeightMethod::relaxed_cones. It depends on the wrap modes, but not on
/// the depth.
///
/// \param bits  8, 16 or 32 (floats)
/// \return two channels: the height, and the root of the ratio of a cone's radius to its height,
///         both as fractions of the larger side of the map and of the depth. Roots of integer
///         samples are rounded down, but are at least 1
/// \throws InvalidInput if bits is something else
///
/// A texel's cone stands upside down, with its apex on the surface. Its definition is stricter than
/// that of the paper, where rays begin at the surface of white: no ray that passes the axis of the
/// cone above its apex, at any height and slant, leaves the surface within the cone. It therefore
/// enters it at most once, and no step of HeightMethod::relaxed_cones passes by the first hit. This
/// holds for all apexes less than a texel from the center, because cones are filtered. Radii are at
/// most 128 texels.
///
/// 1024 x 1024 texels cost 2 to 10 seconds on one thread. The result is the same bits for any
/// number of threads. Source: [Policarpo and Oliveira 2007].
Image relaxed_cones(const HeightField& field, int bits = 16);

}  // namespace relief

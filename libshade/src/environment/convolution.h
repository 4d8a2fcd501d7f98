// SPDX-License-Identifier: Apache-2.0
/// \file
/// The environment as rough and as matte surfaces reflect it: GGX, its directional albedo, and the
/// convolutions of the environment with GGX's lobe and with the cosine. World space, linear light.
///
/// GGX is the distribution of a rough surface's facets, in double, with alpha = roughness^2 as
/// glTF 2.0 (appendix B) defines it. Its directions are unit, and the surface's normal is +z.
/// Source: [Walter et al. 2007], [Heitz 2014] (masking and shadowing). Sheen is
/// that of KHR_materials_sheen: [Estevez and Kulla 2017].
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/image.h"

namespace RELIEF_API relief {
namespace shade::detail {

// The distribution

/// Returns the distribution D of facet normals h; its integral times n.h over the hemisphere is 1.
double ggx_distribution(double n_h, double alpha);

/// Returns V = G / (4 n.l n.v), height-correlated: G is the share of facets without masking and
/// shadowing.
double ggx_visibility(double n_l, double n_v, double alpha);

/// Returns point i of n evenly spread points in the unit square: (i + 1/2) / n, and the reversed
/// binary digits of i as a fraction, plus half of the last digit [Hammersley 1960].
glm::dvec2 hammersley(unsigned i, unsigned n);

/// A point of the unit square, for facets of any alpha.
struct FacetSample {
    double share;        ///< The share of facets that are nearer to the normal.
    glm::dvec2 azimuth;  ///< The cosine and the sine of the azimuth.
};

FacetSample facet_sample(const glm::dvec2& point);

/// Returns the facet normal of a sample; evenly spread points sample the density D n.h.
glm::dvec3 ggx_facet(const FacetSample& sample, double alpha);

/// Returns the facet normal of a point.
inline glm::dvec3 ggx_facet(const glm::dvec2& point, double alpha) {
    return ggx_facet(facet_sample(point), alpha);
}

// Directional albedo

/// Returns the share of even light from all directions that a GGX surface reflects to the eye: its
/// directional albedo f0 A + B, for Schlick's Fresnel factor f0 + (1 - f0) (1 - v.h)^5 and
/// height-correlated masking and shadowing. Together with the blurred environment (convolution.h)
/// it is the split sum of [Karis, SIGGRAPH 2013]. A + B is at most 1 and falls with roughness:
/// light that would bounce between facets is lost.
///
/// \param n_v  cosine of the angle between normal and eye, above 0, at most 1
/// \param roughness  from 0 to 1; 0 is a mirror
/// \return (A, B), within 1e-3 of the integral for n.v and roughness of at least 1/64
glm::dvec2 environment_brdf(double n_v, double roughness);

/// Returns A and B as a table: column x for sqrt(n.v) = x / (size - 1), since they change fastest
/// at grazing angles, and row y for roughness y / (size - 1); both ends are included.
///
/// \return two float channels, data; the same bits for any number of threads. Bilinear lookups in a
///         table of 64 have an error within 3e-3 for roughness of at least 0.045.
/// \throws InvalidInput if size is less than 2
Image environment_brdf_table(int size);

// Sheen

/// Returns alpha of Charlie's distribution: roughness^2, with a roughness of at least 0.045.
double sheen_alpha(double roughness);

/// Returns Charlie's distribution D' of the directions of fibers: (2 + 1 / alpha) sin^(1 / alpha) /
/// (2 pi). \param n_h  from 0 to 1
double sheen_distribution(double n_h, double alpha);

/// Returns n.l V' of the sheen: 1 / (4 n.v (1 + Lambda(n.v) + Lambda(n.l))), with the fit of
/// Lambda by [Estevez and Kulla 2017]. \param n_v, n_l  within [0,1]; n.v counts as at least 1e-4
double sheen_visibility(double n_l, double n_v, double alpha);

/// The directional albedo of a sheen of the color 1: entry i for sqrt(n.v) = i / 31.
using SheenAlbedo = std::array<double, 32>;

/// Returns the share of even light from all directions that the sheen reflects to the eye. Smooth
/// fibers would reflect more than they receive at grazing angles; that counts as 1.
///
/// \return within 1e-3 of the integral for a roughness of at least 0.1, and linear lookups
///         (sheen_albedo()) within 5e-3
SheenAlbedo sheen_albedo_table(double roughness);

/// Returns the linear interpolation of a table at n.v, which is clamped to [0,1].
double sheen_albedo(const SheenAlbedo& table, double n_v);

/// The albedos of a sheen whose roughness a texture multiplies: row j for the texel (j / 19)^2.
using SheenAlbedos = std::array<SheenAlbedo, 20>;

/// Returns the albedos for the roughness of a material and of smoother fibers.
///
/// \return the last row is sheen_albedo_table(roughness). The other rows are not limited to 1,
///         since rows with a bend would be interpolated worse: for a roughness of at least 0.1 and
///         n.v of at least 0.026, the table of the roughness at a pixel and lookups
///         (sheen_albedo()) differ by at most 1e-2
SheenAlbedos sheen_albedo_tables(double roughness);

/// Returns the interpolation of the tables at n.v and at the root of the texel, which are clamped
/// to [0,1]; at most 1.
double sheen_albedo(const SheenAlbedos& tables, double n_v, double texel);

// Blurred radiance

/// Six faces, and their means over 2 x 2, 4 x 4, ... texels, weighted by solid angle.
///
/// Blurred radiance in a direction d is the average over the hemisphere around d with the weight
/// D(h) n.l, where normal and eye are d itself and D is GGX's distribution of the half vector h:
/// the first half of the split sum [Karis, SIGGRAPH 2013]. Far from d the weight changes slowly, so
/// that many texels count as one there [Barnes and Hut 1986]: a texel of the result needs some
/// hundred terms instead of a hundred thousand.
class RadianceTree {
  public:
    /// A texel, or the mean of several texels.
    struct Node {
        glm::vec3 direction{0.0F};  ///< The unit direction of its center.
        float solid_angle = 0.0F;
        glm::vec3 radiance{0.0F};         ///< Mean over the solid angle.
        glm::vec3 light_direction{0.0F};  ///< The average direction of its light, unit.
    };

    /// \param faces  +x -x +y -y +z -z, three float channels of finite radiance, their size a power
    ///               of two
    /// \throws InvalidInput if they do not fit together or have another size or kind
    explicit RadianceTree(std::span<const Image> faces);

    /// Level 0 holds the whole faces, the last level the texels.
    [[nodiscard]] std::size_t level_count() const { return levels_.size(); }

    /// Returns one of the 2^level by 2^level nodes of a face.
    [[nodiscard]] const Node& node(std::size_t level, std::size_t face, std::size_t x,
                                   std::size_t y) const {
        return levels_[level][(((face << level) + y) << level) + x];
    }

  private:
    std::vector<std::vector<Node>> levels_;
};

/// Returns six faces of blurred radiance.
///
/// \param roughness  0.1 to 1, alpha = roughness^2; smoother lobes are narrower than a texel
/// \return three float channels; the relative root mean square error against blurred_radiance() is
///         within 2%, and within 1% for pictures of real places; the same bits for any number of
///         threads
std::vector<Image> blurred_faces(const RadianceTree& tree, int size, double roughness);

/// Returns the same for one direction of any length but zero, by a sum over all texels in double.
///
/// \param faces  as above, of any size
glm::dvec3 blurred_radiance(std::span<const Image> faces, const glm::dvec3& direction,
                            double roughness);

// Irradiance

/// Irradiance for every normal in nine numbers a color channel: spherical harmonics up to order 2
/// [Ramamoorthi and Hanrahan 2001]. Values are over pi, so a white surface shows them unchanged. In
/// pictures of real places the error is within 2% of the brightest value of the true integral; for
/// one small light it is within 9.4% of the irradiance at normal incidence, and far from it the
/// result is slightly negative. The irradiance over pi of a surface with the unit normal n is
///
///     c[0] + c[1] n.y + c[2] n.z + c[3] n.x + c[4] n.x n.y + c[5] n.y n.z
///          + c[6] (3 n.z^2 - 1) + c[7] n.x n.z + c[8] (n.x^2 - n.y^2)
using IrradianceSh = std::array<glm::vec3, 9>;

/// \param faces  six images in linear light, +x -x +y -y +z -z, of three float channels or more
/// \return sums in double, each texel weighted by its solid angle
/// \throws InvalidInput if the faces do not fit together or are not float, or a texel is not finite
IrradianceSh irradiance_sh(std::span<const Image> faces);

/// Returns the polynomial at a unit normal. It is not clamped to 0.
glm::dvec3 irradiance_over_pi(const IrradianceSh& coefficients, const glm::dvec3& normal);

/// Returns the coefficients of the environment rotated about the y axis, from +z to +x.
IrradianceSh rotated(const IrradianceSh& coefficients, double radians);

}  // namespace shade::detail
}  // namespace relief

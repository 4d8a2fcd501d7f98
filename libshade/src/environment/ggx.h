// SPDX-License-Identifier: Apache-2.0
/// \file
/// GGX, the distribution of a rough surface's facets, in double, with alpha = roughness^2 as glTF
/// 2.0 (appendix B) defines it, and its directional albedo. Directions are unit, the surface's
/// normal is +z. Source: [Walter et al. 2007], [Heitz 2014] (masking and shadowing).
#pragma once

#include <glm/glm.hpp>

#include "relief/export.h"
#include "relief/mesh/image.h"

namespace RELIEF_API relief {

// The distribution

/// The distribution D of facet normals h; its integral times n.h over the hemisphere is 1.
double ggx_distribution(double n_h, double alpha);

/// V = G / (4 n.l n.v), height-correlated: G is the share of facets without masking and shadowing.
double ggx_visibility(double n_l, double n_v, double alpha);

/// Point i of n evenly spread points in the unit square: (i + 1/2) / n, and the reversed binary
/// digits of i as a fraction, plus half of the last digit [Hammersley 1960].
glm::dvec2 hammersley(unsigned i, unsigned n);

/// The facet normal for a point of the unit square; evenly spread points sample the density D n.h.
glm::dvec3 ggx_facet(const glm::dvec2& point, double alpha);

// Directional albedo

/// The share of even light from all directions that a GGX surface reflects to the eye: its
/// directional albedo f0 A + B, for Schlick's Fresnel factor f0 + (1 - f0) (1 - v.h)^5 and
/// height-correlated masking and shadowing. Together with the blurred environment (convolution.h)
/// it is the split sum of [Karis, SIGGRAPH 2013]. A + B is at most 1 and falls with roughness:
/// light that would bounce between facets is lost.
///
/// \param n_v  cosine of the angle between normal and eye, above 0, at most 1
/// \param roughness  from 0 to 1; 0 is a mirror
/// \return (A, B), within 1e-3 of the integral for n.v and roughness of at least 1/64
glm::dvec2 environment_brdf(double n_v, double roughness);

/// A and B as a table: column x for sqrt(n.v) = x / (size - 1), since they change fastest at
/// grazing angles, and row y for roughness y / (size - 1); both ends are included.
///
/// \return two float channels, data; the same bits for any number of threads. Bilinear lookups in a
///         table of 64 have an error within 3e-3 for roughness of at least 0.045.
/// \throws InvalidInput if size is less than 2
Image environment_brdf_table(int size);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// How much of an even light from everywhere a GGX surface reflects to the eye: its directional
/// albedo f0 A + B, for Schlick's Fresnel factor f0 + (1 - f0) (1 - v.h)^5 and height-correlated
/// masking and shadowing, as glTF 2.0 (appendix B) defines them.
///
/// Together with the blurred surroundings (gl/prefilter.h) this is the split sum of [Karis,
/// SIGGRAPH 2013]. A + B is at most 1 and falls with roughness: light that would bounce from facet
/// to facet is lost. Tests: tests/shade/environment/environment_brdf_test.cpp.
#pragma once

#include <glm/glm.hpp>

#include "relief/mesh/image.h"

namespace relief {

/// \param n_v  cosine of the angle between normal and eye, above 0, at most 1
/// \param roughness  from 0 to 1; 0 is a mirror
/// \return (A, B), within 1e-3 of the integral for n.v and roughness of at least 1/64
glm::dvec2 environment_brdf(double n_v, double roughness);

/// A and B as a table: column x for sqrt(n.v) = x / (size - 1), since they change fastest at
/// grazing angles, and row y for roughness y / (size - 1); both ends are there.
///
/// \return two float channels, data; the same bits for any number of threads. Of a table of 64,
///         bilinear lookups are within 3e-3 for roughness of at least 0.045.
/// \throws InvalidInput if size is less than 2
Image environment_brdf_table(int size);

}  // namespace relief

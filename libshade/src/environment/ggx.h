// SPDX-License-Identifier: Apache-2.0
/// \file
/// GGX, the distribution of a rough surface's facets, in double, with alpha = roughness^2 as glTF
/// 2.0 (appendix B) defines it. Directions are unit, the surface's normal is +z.
/// Source: [Walter et al. 2007], [Heitz 2014] (masking and shadowing).
/// Tests: tests/shade/environment/ggx_test.cpp.
#pragma once

#include <glm/glm.hpp>

namespace relief {

/// The distribution D of facet normals h; its integral times n.h over the hemisphere is 1.
double ggx_distribution(double n_h, double alpha);

/// V = G / (4 n.l n.v), height-correlated: what of the facets neither masks nor shadows another.
double ggx_visibility(double n_l, double n_v, double alpha);

/// Point i of n in the unit square, spread evenly: (i + 1/2) / n, and the binary digits of i behind
/// the point, mirrored, plus half of the last one [Hammersley 1960].
glm::dvec2 hammersley(unsigned i, unsigned n);

/// The facet normal at a point of the unit square, such that even points give D n.h.
glm::dvec3 ggx_facet(const glm::dvec2& point, double alpha);

}  // namespace relief

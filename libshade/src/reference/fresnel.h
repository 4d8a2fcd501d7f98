// SPDX-License-Identifier: Apache-2.0
/// \file
/// How much a smooth boundary mirrors, by Fresnel's formulas for unpolarised light: the mean of
/// both polarisations. Indices are of the inside to the outside; n + ik for metals.
/// Tests: tests/shade/reference/fresnel_test.cpp.
#pragma once

#include <complex>
#include <glm/glm.hpp>

#include "relief/shade/material.h"

namespace relief::reference {

/// \param cosine  of the angle of incidence, within [0,1]
/// \return within [0,1]; 0 for an index of 1, which is no boundary, and 1 for one of 0
double fresnel(std::complex<double> index, double cosine);

/// Material's factor F at n.v, kept within [0,1] by channel. 0 where reflectivity is zero.
glm::dvec3 fresnel_factor(const Material& material, double n_dot_v);

}  // namespace relief::reference

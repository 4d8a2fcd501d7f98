// SPDX-License-Identifier: Apache-2.0
/// \file
/// Ways to compute how much a smooth boundary mirrors, by the cosine of the angle of incidence.
/// Tests: tests/accuracy/fresnel_experiment_test.cpp.
#pragma once

#include <complex>
#include <vector>

#include "shading/formula_methods.h"

namespace relief {

/// \param index    of the inside to the outside; n + ik for metals
/// \param cosines  within [0,1]; must outlive the methods
/// \return the reflectance at normal incidence everywhere; Schlick's fit to it [Schlick 1994] by
///         products and by a power of two [Karis, SIGGRAPH 2013]; that with a third number, by
///         which it is right at 82 degrees, too [Kutz et al. 2021]; a table; Fresnel's formulas in
///         float
std::vector<FormulaMethod> fresnel_methods(std::complex<double> index,
                                           std::span<const float> cosines);

/// Fresnel's formulas in double (libshade's reference shader).
std::vector<double> true_reflectances(std::complex<double> index, std::span<const float> cosines);

/// Cosines of angles from 0 to 90 degrees, evenly spread, ends included.
std::vector<float> cosines_of_angles(std::size_t count);

}  // namespace relief

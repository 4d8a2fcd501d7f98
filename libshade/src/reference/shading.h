// SPDX-License-Identifier: Apache-2.0
/// \file
/// Material's formula (material.h), term by term, in double precision. World space, linear light.
#pragma once

#include <complex>
#include <glm/glm.hpp>

#include "reference/surface.h"
#include "relief/export.h"
#include "relief/shade/material.h"

namespace relief {
namespace RELIEF_API reference {

/// Returns the reflectance of a smooth boundary by Fresnel's formulas for unpolarized light: the
/// mean of both polarizations.
///
/// \param index   of the inside relative to the outside; n + ik for metals
/// \param cosine  of the angle of incidence, within [0,1]
/// \return within [0,1]; 0 for an index of 1, which is no boundary, and 1 for an index of 0
double fresnel(std::complex<double> index, double cosine);

/// Returns Material's factor F at n.v, clamped to [0,1] by channel; 0 if the reflectivity is zero.
glm::dvec3 fresnel_factor(const Material& material, double n_dot_v);

/// The light from a surface to the eye.
struct Shaded {
    glm::dvec3 radiance{0.0};  ///< Unrestricted, like the data of the scene.
    double alpha = 1.0;        ///< As Material says, whatever the alpha mode.
};

Shaded shade(const PreparedScene& prepared, const Hit& hit, const Material& material, Trace& trace);

}  // namespace reference
}  // namespace relief

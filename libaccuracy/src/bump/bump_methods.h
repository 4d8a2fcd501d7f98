// SPDX-License-Identifier: Apache-2.0
/// \file
/// The kernels that are compared, by name, and how far their normals are from the truth; what the
/// experiments and the tables of docs/bump.md measure. Tests: tests/accuracy/bump_methods_test.cpp.
#pragma once

#include <span>
#include <string>

#include "relief/mesh/analytic_heights.h"
#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/bump_fields.h"

namespace relief {

struct NamedKernel {
    std::string name;  ///< "sobel3", "gaussian 4"
    Kernel kernel = Kernel::sobel3;
    int radius = 2;  ///< Of Kernel::gaussian.
};

/// All kernels, Gaussians of radius 2, 4, 8 and 16 last.
std::span<const NamedKernel> named_kernels();

/// The name that a kernel has there.
std::string name_of(Kernel kernel, int gaussian_radius);

/// RMS degrees of the unrounded normals, computed in double; texels without a true one left out.
double rms_error(const BumpField& field, Kernel kernel, int gaussian_radius);

/// A field of one of the sets. \throws InvalidInput if none has that name
const FieldRecipe& recipe_named(const std::string& name);

/// A height map of one oblique wave of slope 1, and its true normals.
struct WaveMap {
    Image heights;  ///< One channel.
    BumpOptions options;
    std::vector<glm::dvec3> normals;
};

/// Texels along each border whose heights a kernel would need from beyond it: not compared.
inline constexpr int wave_margin = 16;

/// The wave runs two texels to the right for one down: no kernel is at its best or at its worst.
///
/// \param bits  of the heights: 8, 16, or 32 for floats
WaveMap oblique_wave(int side, double wavelength, int bits);

/// How far the unrounded normals of such a map are from the truth.
AngleDistribution wave_errors(const WaveMap& wave, const NamedKernel& kernel,
                              Arithmetic arithmetic);

/// The same surface at several resolutions: waves that tile a square of `side` texels.
WaveMap surface_at(int side);

}  // namespace relief

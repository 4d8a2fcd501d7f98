// SPDX-License-Identifier: Apache-2.0
/// \file
/// Experiments on normals from height maps: every kernel in both arithmetics, on waves and fields
/// whose normals are known in closed form.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiment_driver.h"
#include "relief/accuracy/asset.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/statistics.h"

namespace relief {

struct NamedKernel {
    std::string name;  ///< "sobel3", "gaussian 4"
    Kernel kernel = Kernel::sobel3;
    int radius = 2;  ///< Only for Kernel::gaussian.
};

/// All kernels; Gaussians of radius 2, 4, 8 and 16 come last.
std::span<const NamedKernel> named_kernels();

/// The name of a kernel in named_kernels().
std::string name_of(Kernel kernel, int gaussian_radius);

/// The RMS error in degrees of the unrounded normals in double precision. Texels without a defined
/// ground truth do not count.
double rms_error(const BumpField& field, Kernel kernel, int gaussian_radius);

/// A field from one of the sets of ground_truth.h. \throws InvalidInput if none has that name
const FieldRecipe& field_recipe(const std::string& name);

/// A height map of one oblique wave of slope 1, with its exact normals.
struct WaveMap {
    Image heights;  ///< One channel.
    BumpOptions options;
    std::vector<glm::dvec3> normals;
};

/// Texels along each border that are not compared, because kernels need heights beyond the border.
inline constexpr int wave_margin = 16;

/// Makes a wave that runs two texels to the right for one down, a direction that favors no kernel.
///
/// \param bits  of the heights: 8, 16, or 32 for floats
WaveMap oblique_wave(int side, double wavelength, int bits);

/// The errors of the unrounded normals of a wave map.
ErrorStats wave_errors(const WaveMap& wave, const NamedKernel& kernel, Arithmetic arithmetic);

/// The same surface at several resolutions: waves that tile a square of `side` texels.
WaveMap surface_at(int side);

/// A method named "scharr3, float32, 16 bit", with its choices and the bytes of a texel, but
/// without functions.
ExperimentMethod described(const BumpMethod& method);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Experiments on shading: where light is computed, specular models, Fresnel factors, interpolated
/// normals, cube maps as environments, and antialiasing of edges and highlights.
#pragma once

#include <complex>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "experiment_driver.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/image.h"
#include "relief/shade/scene.h"
#include "rendered_methods.h"

namespace relief::accuracy::detail {

// The experiments of shading_plan() in other files: formulas without OpenGL, and environments.
PreparedExperiment glass_experiment(const PlanOptions& options);
PreparedExperiment metal_experiment(const PlanOptions& options);
PreparedExperiment unit_normal_experiment(const PlanOptions& options);
PreparedExperiment reflection_experiment(const PlanOptions& options);
PreparedExperiment glossy_experiment(const PlanOptions& options);
PreparedExperiment energy_experiment(const PlanOptions& options);

/// A method for a formula. It knows its inputs, and writes one result per input.
using FormulaMethod = MethodOn<std::span<float>, void>;

/// Statistics of the absolute differences. NaN counts as undefined.
ErrorStats formula_error(const FormulaMethod& method, std::span<const double> ground_truth);

/// Returns ways to compute the reflectance of a smooth boundary:
/// - the value at normal incidence for all angles;
/// - Schlick's approximation with products [Schlick 1994];
/// - the same with a power of two [Karis, SIGGRAPH 2013];
/// - the same with a third parameter, exact at 82 degrees [Kutz et al. 2021];
/// - a table of 65 values;
/// - Fresnel's formulas in float.
///
/// \param index    refractive index of the inside relative to the outside; n + ik for metals
/// \param cosines  of the angles of incidence, within [0,1]; must outlive the methods
std::vector<FormulaMethod> fresnel_methods(std::complex<double> index,
                                           std::span<const float> cosines);

/// Fresnel's formulas in double, from the reference shader of libshade.
std::vector<double> exact_reflectances(std::complex<double> index, std::span<const float> cosines);

/// Cosines of evenly spaced angles from 0 to 90 degrees, both included.
std::vector<float> cosines_of_angles(std::size_t count);

/// Interpolated normals on a triangle whose corner normals surround +z at equal angles to each
/// other.
class NormalSamples {
  public:
    /// \param degrees  angle between two corner normals, above 0 and below 120
    /// \param side     of a square grid; only the half inside the triangle counts
    NormalSamples(double degrees, int side);

    [[nodiscard]] std::size_t count() const { return interpolated_.size(); }
    /// Not normalized: shorter than 1.
    [[nodiscard]] const std::vector<glm::vec3>& interpolated() const { return interpolated_; }

    [[nodiscard]] std::vector<double> exact_radiances() const;

    static const glm::vec3& light();  ///< Unit direction to the light.
    static const glm::vec3& half();   ///< Unit half vector between light and viewer.

  private:
    std::vector<glm::vec3> interpolated_;
};

/// Shading with the interpolated normal as it is; normalized with one Newton step for the inverse
/// square root from 1; with a square root in float; and in double.
/// \param samples  must outlive the methods
std::vector<FormulaMethod> unit_normal_methods(const NormalSamples& samples);

/// An environment in closed form: radiance by unit direction, linear color.
using EnvironmentFormula = std::function<glm::dvec3(const glm::dvec3& direction_world)>;

/// An environment of waves and a few lights, within [0,1]. The smallest details are 3 degrees wide.
glm::dvec3 waves_and_lights(const glm::dvec3& direction_world);

/// Converts an environment to a cube map; a texel is the mean of 2 x 2 directions.
shade::Environment cube_map_of(const EnvironmentFormula& formula, int size);

/// A ball of radius 1 at the origin that reflects all light. The camera is so near that the ball
/// fills the square image; its visible normals are within 45 degrees of the view direction.
/// \param roughness  0: a perfect mirror
shade::Scene mirror_ball(shade::Environment environment, double roughness);

/// The exact image of mirror_ball() without roughness, from the equation of the ball.
/// \param rays_per_side  rays along each side of a pixel
/// \return three float channels
Image exact_mirror(const EnvironmentFormula& formula, int size, int rays_per_side);

}  // namespace relief::accuracy::detail

// SPDX-License-Identifier: Apache-2.0
/// \file
/// Maps, rays of view and methods for the experiments of relief mapping on planes
/// (relief_experiments.cpp) and on curved surfaces (relief_curved.cpp).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiment_parts.h"
#include "relief/mesh/height_march.h"

namespace relief::accuracy::detail {

/// A height map of the experiments.
struct ReliefSample {
    const char* id;
    const char* description;
    double depth;  ///< Of black, in texels.
    Image (*heights)(int side);
};

/// Angles between the view and the normal of the plane, in degrees.
struct ViewBand {
    double from;
    double to;
};
inline constexpr std::array view_bands = {ViewBand{0.0, 30.0}, ViewBand{30.0, 45.0},
                                          ViewBand{45.0, 70.0}, ViewBand{70.0, 85.0}};

/// Returns "45-70".
std::string name_of(const ViewBand& band);

struct ReliefFields {
    HeightField heights;
    HeightField cones;
};

/// A map with rays of view.
struct ReliefInput {
    std::shared_ptr<const ReliefFields> fields;
    std::vector<HeightRay> rays;
    std::vector<HeightHit> exact;
    std::vector<HeightRay> curved;  ///< The rays as curved_ray() bends them; empty on a plane.
};

/// A method; without one, only the normal map is looked up, where the ray meets the plane.
struct ReliefMethod {
    std::string name;
    std::optional<HeightMarch> march;
    double bytes;            ///< Per texel, with heights of 16 bits.
    bool is_curved = false;  ///< The relief curves with the surface.
};

/// \param on_curves  adds the methods that know the curvature of a surface
std::vector<ReliefMethod> relief_methods(bool on_curves);

/// Describes an experiment on rays, and adds its methods.
PreparedExperiment relief_of(const std::string& ground_truth, const std::string& description,
                             const std::shared_ptr<const ReliefInput>& input);

/// The experiments on curved surfaces, with one of the maps.
std::vector<PlannedExperiment> curved_relief_plan(const ReliefSample& map,
                                                  const SharedInput<ReliefFields>& fields);

}  // namespace relief::accuracy::detail

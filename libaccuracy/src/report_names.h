// SPDX-License-Identifier: Apache-2.0
/// \file
/// The values that experiments iterate over, and their names in reports.
#pragma once

#include <array>
#include <string>

#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/execution.h"

namespace relief {

inline constexpr std::array all_surfaces = {AnalyticSurface::sphere, AnalyticSurface::torus,
                                            AnalyticSurface::ellipsoid, AnalyticSurface::saddle,
                                            AnalyticSurface::cubic};
inline constexpr std::array all_triangulations = {Triangulation::regular, Triangulation::jittered,
                                                  Triangulation::anisotropic,
                                                  Triangulation::folded};
inline constexpr std::array both_arithmetics = {Arithmetic::float64, Arithmetic::float32};

/// The sample format of a map: "16 bit", "float".
inline std::string depth_name(int bits) {
    return bits == 32 ? "float" : std::to_string(bits) + " bit";
}

inline std::string name_of(AnalyticSurface surface) {
    constexpr std::array names = {"sphere", "torus", "ellipsoid", "saddle", "cubic"};
    return names.at(static_cast<std::size_t>(surface));
}

inline std::string name_of(Triangulation triangulation) {
    constexpr std::array names = {"regular", "jittered", "anisotropic", "folded"};
    return names.at(static_cast<std::size_t>(triangulation));
}

}  // namespace relief

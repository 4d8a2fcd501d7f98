// SPDX-License-Identifier: Apache-2.0
/// \file
/// What ground truths are called in reports.
#pragma once

#include <array>
#include <string>

#include "relief/mesh/analytic_surfaces.h"
#include "relief/mesh/arithmetic.h"

namespace relief {

inline constexpr std::array all_surfaces = {AnalyticSurface::sphere, AnalyticSurface::torus,
                                            AnalyticSurface::ellipsoid, AnalyticSurface::saddle,
                                            AnalyticSurface::cubic};
inline constexpr std::array all_triangulations = {Triangulation::regular, Triangulation::jittered,
                                                  Triangulation::anisotropic,
                                                  Triangulation::folded};
inline constexpr std::array both_arithmetics = {Arithmetic::float64, Arithmetic::float32};

/// Of what maps are stored in: "16 bit", "float".
inline std::string depth_words(int bits) {
    return bits == 32 ? "float" : std::to_string(bits) + " bit";
}

inline std::string word_of(AnalyticSurface surface) {
    constexpr std::array words = {"sphere", "torus", "ellipsoid", "saddle", "cubic"};
    return words.at(static_cast<std::size_t>(surface));
}

inline std::string word_of(Triangulation triangulation) {
    constexpr std::array words = {"regular", "jittered", "anisotropic", "folded"};
    return words.at(static_cast<std::size_t>(triangulation));
}

inline std::string word_of(Arithmetic arithmetic) {
    return arithmetic == Arithmetic::float64 ? "float64" : "float32";
}

}  // namespace relief

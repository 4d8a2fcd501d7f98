// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lengths and directions of many vectors at once, with the bits of make_unit() and store().
#pragma once

#include <array>
#include <cstddef>

#include "relief/export.h"

namespace RELIEF_API relief {
namespace detail {

inline constexpr std::size_t vectors_per_group = 64;

/// One number for each vector of a group.
struct alignas(64) VectorNumbers : std::array<double, vectors_per_group> {};

/// Vectors by component. Lanes without a vector have numbers, too.
struct VectorGroup {
    VectorNumbers x{}, y{}, z{};
};

/// The functions of a processor.
struct UnitVectorFunctions {
    void (*lengths)(const VectorGroup& vectors, VectorNumbers& lengths);
    /// Stores three floats per vector. \return false if a vector has no direction, is not finite,
    /// or is so small that its square is zero: its floats are not defined then
    bool (*make_units)(const VectorGroup& vectors, std::size_t count, float* normals);
};

/// Returns the functions for this processor; they all have the same results. Callers keep them for
/// a loop, because the choice takes as long as a group.
UnitVectorFunctions unit_vector_functions();

}  // namespace detail
}  // namespace relief

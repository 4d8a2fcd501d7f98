// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines the floating-point precision of computations that offer a choice.
#pragma once

namespace relief {

/// The floating-point type of a computation. Each option of this type documents its accuracy and
/// time.
enum class Arithmetic { float64, float32 };

}  // namespace relief

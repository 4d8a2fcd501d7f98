// SPDX-License-Identifier: Apache-2.0
/// \file
/// The numbers to compute in, where there is a choice.
#pragma once

namespace relief {

/// What each means for accuracy and time, the option that takes it says.
enum class Arithmetic { float64, float32 };

}  // namespace relief

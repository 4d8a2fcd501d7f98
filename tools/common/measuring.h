// SPDX-License-Identifier: Apache-2.0
/// \file
/// The effort of measuring a result: `--measure`.
#pragma once

#include "common/options.h"

namespace relief::tools {

/// A result is not measured, or at random samples, or everywhere.
enum class Measuring { none, quick, full };

inline const Choices<Measuring> measuring_words = {
    {"quick", Measuring::quick}, {"full", Measuring::full}, {"none", Measuring::none}};

}  // namespace relief::tools

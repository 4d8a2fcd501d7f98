// SPDX-License-Identifier: Apache-2.0
/// \file
/// Why an effect that is asked for cannot show, in words. Pure.
/// Tests: tests/shade/effects/plan_test.cpp, effect_forcing_test.cpp.
#pragma once

#include <string>

#include "relief/shade/effects.h"

namespace relief {

/// \param wished  what was asked for  \param shown  what canonical() left of it, without `effect`
std::string why_hidden(const Effect& effect, const Features& wished, const Features& shown);

}  // namespace relief

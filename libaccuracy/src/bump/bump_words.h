// SPDX-License-Identifier: Apache-2.0
/// \file
/// What ways to convert a height map are called in reports and on command lines.
/// Tests: tests/accuracy/own_maps_test.cpp.
#pragma once

#include <string>

#include "measured_methods.h"
#include "relief/mesh/bump_experiment.h"

namespace relief {

/// "scharr3", ...: the words of relief-bake.
std::string word_of(Kernel kernel);

/// "repeat", or for axes that differ "repeat,clamp".
std::string words_of(const Wraps& wraps);

/// "scharr3, float32, 16 bit", with its choices and the bytes of a texel.
MeasuredMethod measured_method(const BumpMethod& method, const ErrorFigures& error);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// How the error of every kernel falls, with the orders of theory beside those fitted.
/// Tests: tests/accuracy/bump_experiments_test.cpp.
#pragma once

#include "relief/accuracy/experiment.h"

namespace relief {

/// With longer waves, on maps of `side` texels and heights of so many bits (32: floats). Orders
/// are told of floats alone: longer waves are gentler steps, which codes lose.
Chart wavelength_chart(int bits, int side, bool is_quick);

/// The same surface in finer texels.
Chart resolution_chart(bool is_quick);

}  // namespace relief

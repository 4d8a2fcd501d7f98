// SPDX-License-Identifier: Apache-2.0
/// \file
/// Loops that are compiled for several vector instruction sets, and the best set of this processor.
///
/// A loop over plain arrays is written once, as a RELIEF_INLINE function. Three functions that only
/// call it have the targets below, so that the compiler vectorizes the loop for each of them.
/// best_vector_target() tells which one to call. The author must make sure that all three give the
/// same results.
#pragma once

#include "relief/export.h"

#if defined(__x86_64__)
#define RELIEF_TARGET_256 [[gnu::target("avx2,fma,bmi,bmi2"), gnu::noinline]]
#define RELIEF_TARGET_512 \
    [[gnu::target("avx2,fma,avx512f,avx512dq,avx512bw,avx512vl"), gnu::noinline]]
#else
#define RELIEF_TARGET_256 [[gnu::noinline]]
#define RELIEF_TARGET_512 [[gnu::noinline]]
#endif
#define RELIEF_INLINE [[gnu::always_inline]] inline

namespace RELIEF_API relief {

/// Bits of a vector register.
enum class VectorTarget { any = 128, wide = 256, widest = 512 };

/// Returns the best target of this processor and operating system. The environment variable
/// RELIEF_VECTOR_BITS (128, 256) limits it, so that tests can compare targets.
VectorTarget best_vector_target();

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
/// \file
/// One loop, compiled for several sets of vector instructions, and the best that this processor
/// has.
///
/// A loop over plain arrays is written once, as a RELIEF_INLINE function. Three functions that only
/// call it, marked with the targets below, get it in three forms, as the compiler vectorises it for
/// each; `best_vector_target()` says which to call. Whoever does that answers for the results being
/// the same from all three. Tests: tests/mesh/geometry/normals/normals_test.cpp.
#pragma once

#if defined(__x86_64__)
#define RELIEF_TARGET_256 [[gnu::target("avx2,fma,bmi,bmi2"), gnu::noinline]]
#define RELIEF_TARGET_512 \
    [[gnu::target("avx2,fma,avx512f,avx512dq,avx512bw,avx512vl"), gnu::noinline]]
#else
#define RELIEF_TARGET_256 [[gnu::noinline]]
#define RELIEF_TARGET_512 [[gnu::noinline]]
#endif
#define RELIEF_INLINE [[gnu::always_inline]] inline

namespace relief {

/// Bits in a vector register.
enum class VectorTarget { any = 128, wide = 256, widest = 512 };

/// The widest that this processor and its system have. The environment variable RELIEF_VECTOR_BITS
/// (128, 256) narrows it, so that tests can compare.
VectorTarget best_vector_target();

}  // namespace relief

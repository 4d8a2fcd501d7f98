// SPDX-License-Identifier: Apache-2.0
#include "vector_targets.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace relief {
namespace {

VectorTarget of_processor() {
#if defined(__x86_64__)
    __builtin_cpu_init();
    const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    if (!wide) return VectorTarget::any;
    const bool widest = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
    return widest ? VectorTarget::widest : VectorTarget::wide;
#else
    return VectorTarget::any;
#endif
}

}  // namespace

VectorTarget best_vector_target() {
    static const VectorTarget processor = of_processor();
    const char* bits = std::getenv("RELIEF_VECTOR_BITS");
    if (bits == nullptr) return processor;
    const std::string_view wanted(bits);
    if (wanted == "128") return VectorTarget::any;
    if (wanted == "256") return std::min(processor, VectorTarget::wide);
    return processor;
}

}  // namespace relief

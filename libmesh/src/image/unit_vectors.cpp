// SPDX-License-Identifier: Apache-2.0
// Lengths and directions of vectors, in double precision. The operations and their order are those
// of make_unit() and store(), which the callers use for vectors that have no direction.
#include "image/unit_vectors.h"

#include <cmath>
#include <cstdint>

#include "portable_math.h"

namespace relief::detail {
namespace {

RELIEF_INLINE void lengths_loop(const VectorGroup& vectors, VectorNumbers& lengths) {
    for (std::size_t i = 0; i < vectors_per_group; ++i) {
        lengths[i] = std::sqrt(vectors.x[i] * vectors.x[i] + vectors.y[i] * vectors.y[i] +
                               vectors.z[i] * vectors.z[i]);
    }
}

RELIEF_INLINE bool make_units_loop(const VectorGroup& vectors, std::size_t count, float* normals) {
    struct alignas(64) Floats : std::array<float, vectors_per_group> {};
    Floats x, y, z;
    std::int64_t odd = 0;
    for (std::size_t i = 0; i < vectors_per_group; ++i) {
        const double squares =
            vectors.x[i] * vectors.x[i] + vectors.y[i] * vectors.y[i] + vectors.z[i] * vectors.z[i];
        const double length = std::sqrt(squares);
        // False for NaN.
        odd += squares > 0.0 ? 0 : 1;
        odd += squares < 1e300 ? 0 : 1;
        x[i] = static_cast<float>(vectors.x[i] / length + 0.0);
        y[i] = static_cast<float>(vectors.y[i] / length + 0.0);
        z[i] = static_cast<float>(vectors.z[i] / length + 0.0);
    }
    for (std::size_t i = 0; i < count; ++i) {
        normals[3 * i] = x[i];
        normals[3 * i + 1] = y[i];
        normals[3 * i + 2] = z[i];
    }
    return odd == 0;
}

RELIEF_TARGET_512 void lengths_512(const VectorGroup& vectors, VectorNumbers& lengths) {
    lengths_loop(vectors, lengths);
}
RELIEF_TARGET_256 void lengths_256(const VectorGroup& vectors, VectorNumbers& lengths) {
    lengths_loop(vectors, lengths);
}
[[gnu::noinline]] void lengths_any(const VectorGroup& vectors, VectorNumbers& lengths) {
    lengths_loop(vectors, lengths);
}

RELIEF_TARGET_512 bool make_units_512(const VectorGroup& vectors, std::size_t count,
                                      float* normals) {
    return make_units_loop(vectors, count, normals);
}
RELIEF_TARGET_256 bool make_units_256(const VectorGroup& vectors, std::size_t count,
                                      float* normals) {
    return make_units_loop(vectors, count, normals);
}
[[gnu::noinline]] bool make_units_any(const VectorGroup& vectors, std::size_t count,
                                      float* normals) {
    return make_units_loop(vectors, count, normals);
}

}  // namespace

UnitVectorFunctions unit_vector_functions() {
    switch (best_vector_target()) {
        case VectorTarget::widest:
            return {lengths_512, make_units_512};
        case VectorTarget::wide:
            return {lengths_256, make_units_256};
        case VectorTarget::any:
            break;
    }
    return {lengths_any, make_units_any};
}

}  // namespace relief::detail

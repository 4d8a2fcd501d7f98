// SPDX-License-Identifier: Apache-2.0
// Slopes to unit normals, float or coded. The square root and the division are IEEE's, so that
// every width of registers gives the same bits. Slopes must pass any_too_steep.
#include "image/bump/normal_loops.h"

#include <array>
#include <cmath>
#include <cstdint>

#include "image/bump/normal_store.h"
#include "image/bump/slope_loops.h"

namespace relief {
namespace {

template <typename Real>
RELIEF_INLINE bool steep_loop(const Real* __restrict right, const Real* __restrict up,
                              std::size_t count) {
    BitsOf<Real> found = 0;
    for (std::size_t i = 0; i < count; ++i)
        found |= is_too_steep(right[i] * right[i] + up[i] * up[i]);
    return found != 0;
}

/// What makes (-right, -up, 1) a unit vector.
template <typename Real>
RELIEF_INLINE Real inverse_length(Real right, Real up) {
    return 1 / std::sqrt(right * right + up * up + 1);
}

template <typename Real>
RELIEF_INLINE void normals_loop(const Real* __restrict right, const Real* __restrict up,
                                std::size_t count, float* __restrict normals) {
    for (std::size_t i = 0; i < count; ++i) {
        const Real scale = inverse_length(right[i], up[i]);
        // Subtracting from zero turns -0 into 0.
        normals[3 * i] = static_cast<float>(0 - right[i] * scale);
        normals[3 * i + 1] = static_cast<float>(0 - up[i] * scale);
        normals[3 * i + 2] = static_cast<float>(scale);
    }
}

/// One coordinate of a piece of a row.
template <typename Sample>
using Coordinate = std::array<Sample, columns_at_once>;

template <FlatCode flat, typename Sample, typename Real>
RELIEF_INLINE void coordinates_loop(const Real* __restrict right, const Real* __restrict up,
                                    std::size_t count, Real green, Sample* __restrict x,
                                    Sample* __restrict y, Sample* __restrict z) {
    for (std::size_t i = 0; i < count; ++i) {
        const Real scale = inverse_length(right[i], up[i]);
        x[i] = encoded<flat, Sample>(0 - right[i] * scale);
        y[i] = encoded<flat, Sample>(0 - green * up[i] * scale);
        z[i] = encoded<flat, Sample>(scale);
    }
}

template <FlatCode flat, typename Sample, typename Real>
RELIEF_INLINE void codes_of(const Real* right, const Real* up, std::size_t count, Real green,
                            Sample* codes) {
    alignas(64) Coordinate<Sample> x, y, z;
    coordinates_loop<flat>(right, up, count, green, x.data(), y.data(), z.data());
    interleave(x.data(), y.data(), z.data(), count, codes);
}

template <typename Real>
RELIEF_TARGET_512 bool steep_512(const Real* right, const Real* up, std::size_t count) {
    return steep_loop(right, up, count);
}
template <typename Real>
RELIEF_TARGET_256 bool steep_256(const Real* right, const Real* up, std::size_t count) {
    return steep_loop(right, up, count);
}
template <typename Real>
RELIEF_TARGET_512 void normals_512(const Real* right, const Real* up, std::size_t count,
                                   float* normals) {
    normals_loop(right, up, count, normals);
}
template <typename Real>
RELIEF_TARGET_256 void normals_256(const Real* right, const Real* up, std::size_t count,
                                   float* normals) {
    normals_loop(right, up, count, normals);
}
template <FlatCode flat, typename Sample, typename Real>
RELIEF_TARGET_512 void codes_512(const Real* right, const Real* up, std::size_t count, Real green,
                                 Sample* codes) {
    codes_of<flat>(right, up, count, green, codes);
}
template <FlatCode flat, typename Sample, typename Real>
RELIEF_TARGET_256 void codes_256(const Real* right, const Real* up, std::size_t count, Real green,
                                 Sample* codes) {
    codes_of<flat>(right, up, count, green, codes);
}
template <FlatCode flat, typename Sample, typename Real>
[[gnu::noinline]] void codes_any(const Real* right, const Real* up, std::size_t count, Real green,
                                 Sample* codes) {
    codes_of<flat>(right, up, count, green, codes);
}

template <FlatCode flat, typename Sample, typename Real>
void codes_with(VectorTarget target, const Real* right, const Real* up, std::size_t count,
                Real green, Sample* codes) {
    switch (target) {
        case VectorTarget::widest:
            return codes_512<flat>(right, up, count, green, codes);
        case VectorTarget::wide:
            return codes_256<flat>(right, up, count, green, codes);
        case VectorTarget::any:
            return codes_any<flat>(right, up, count, green, codes);
    }
}

}  // namespace

template <typename Real>
bool any_too_steep(VectorTarget target, const Real* right, const Real* up, std::size_t count) {
    switch (target) {
        case VectorTarget::widest:
            return steep_512(right, up, count);
        case VectorTarget::wide:
            return steep_256(right, up, count);
        case VectorTarget::any:
            break;
    }
    return steep_loop(right, up, count);
}

template <typename Real>
void store_normals(VectorTarget target, const Real* right, const Real* up, std::size_t count,
                   float* normals) {
    switch (target) {
        case VectorTarget::widest:
            return normals_512(right, up, count, normals);
        case VectorTarget::wide:
            return normals_256(right, up, count, normals);
        case VectorTarget::any:
            return normals_loop(right, up, count, normals);
    }
}

template <typename Sample, typename Real>
void store_codes(VectorTarget target, const Real* right, const Real* up, std::size_t count,
                 const NormalMapFormat& format, Sample* codes) {
    const Real green = format.green == Green::up ? 1 : -1;
    if (format.flat == FlatCode::half)
        codes_with<FlatCode::half>(target, right, up, count, green, codes);
    else
        codes_with<FlatCode::middle>(target, right, up, count, green, codes);
}

template <typename Sample, typename Real>
void store_dithered_codes(const Real* right, const Real* up, std::size_t count,
                          const NormalMapFormat& format, std::size_t first,
                          const DitherRow& thresholds, Sample* codes) {
    const NormalCoding<Sample> coding{format.flat};
    const double green = format.green == Green::up ? 1 : -1;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = right[i];
        const double y = up[i];
        const double scale = inverse_length(x, y);
        codes[3 * i] = coding.dithered(-x * scale, thresholds.at(first + i, 0));
        codes[3 * i + 1] = coding.dithered(-y * green * scale, thresholds.at(first + i, 1));
        codes[3 * i + 2] = coding.dithered(scale, thresholds.at(first + i, 2));
    }
}

#define RELIEF_INSTANTIATE(Real)                                                              \
    template bool any_too_steep(VectorTarget, const Real*, const Real*, std::size_t);         \
    template void store_normals(VectorTarget, const Real*, const Real*, std::size_t, float*); \
    template void store_codes(VectorTarget, const Real*, const Real*, std::size_t,            \
                              const NormalMapFormat&, std::uint8_t*);                         \
    template void store_codes(VectorTarget, const Real*, const Real*, std::size_t,            \
                              const NormalMapFormat&, std::uint16_t*);                        \
    template void store_codes(VectorTarget, const Real*, const Real*, std::size_t,            \
                              const NormalMapFormat&, float*);                                \
    template void store_dithered_codes(const Real*, const Real*, std::size_t,                 \
                                       const NormalMapFormat&, std::size_t, const DitherRow&, \
                                       std::uint8_t*);                                        \
    template void store_dithered_codes(const Real*, const Real*, std::size_t,                 \
                                       const NormalMapFormat&, std::size_t, const DitherRow&, \
                                       std::uint16_t*);
RELIEF_INSTANTIATE(float)
RELIEF_INSTANTIATE(double)
#undef RELIEF_INSTANTIATE

}  // namespace relief

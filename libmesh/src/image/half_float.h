// SPDX-License-Identifier: Apache-2.0
/// \file
/// Floats of 16 bits: a sign, an exponent of 5 bits, and a mantissa of 10 bits.
#pragma once

#include <cstdint>
#include <cstring>

namespace relief::detail {

inline constexpr float largest_half = 65504.0F;

/// Rounds to the nearest half float, ties to even; NaN stays NaN. \param is_clamped  becomes true
/// if the value is finite and beyond the range
inline std::uint16_t half_from_float(float value, bool& is_clamped) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    const auto sign = static_cast<std::uint16_t>(bits >> 16U & 0x8000U);
    bits &= 0x7FFFFFFFU;
    if (bits > 0x7F800000U) return static_cast<std::uint16_t>(sign | 0x7E00U);
    if (bits == 0x7F800000U) return static_cast<std::uint16_t>(sign | 0x7C00U);
    constexpr std::uint32_t first_beyond = 0x477FF000U;  // 65520 would round to 65536.
    if (bits >= first_beyond) {
        is_clamped = true;
        return static_cast<std::uint16_t>(sign | 0x7BFFU);
    }
    const std::uint32_t exponent = bits >> 23U;
    std::uint32_t mantissa = bits & 0x7FFFFFU;
    std::uint32_t dropped = 13;
    std::uint32_t result = 0;
    if (exponent >= 113) {
        result = (exponent - 112) << 10U;
    } else {
        if (exponent < 102) return sign;
        mantissa |= 0x800000U;
        dropped = 126 - exponent;
    }
    const std::uint32_t rest = mantissa & ((1U << dropped) - 1U);
    const std::uint32_t middle = 1U << (dropped - 1U);
    result += mantissa >> dropped;
    if (rest > middle || (rest == middle && (result & 1U) == 1)) ++result;
    return static_cast<std::uint16_t>(sign | result);
}

/// Returns the value of a half float. NaN stays NaN.
inline float float_from_half(std::uint16_t half) {
    const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000U) << 16U;
    const std::uint32_t exponent = half >> 10U & 31U;
    const std::uint32_t mantissa = half & 0x3FFU;
    if (exponent == 0) {
        const float size = static_cast<float>(mantissa) / 16777216.0F;
        return sign != 0 ? -size : size;
    }
    std::uint32_t bits = sign | mantissa << 13U;
    bits |= (exponent == 31 ? 255U : exponent + 112U) << 23U;
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

}  // namespace relief::detail

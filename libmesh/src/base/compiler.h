// SPDX-License-Identifier: Apache-2.0
/// \file
/// Extensions of C++20 that relief uses: vectors of numbers and integers of 128 bits. GCC and Clang
/// have both for every system; on Windows these are MinGW-w64 and clang-cl.
#pragma once

#if !defined(__GNUC__) && !defined(__clang__)
#error "relief needs GCC or Clang; on Windows MinGW-w64 or clang-cl"
#endif

namespace relief::detail {

/// Numbers in a vector register, with arithmetic by component. The compiler splits those that are
/// larger than the processor's registers.
template <typename Number, int bytes>
using Vector [[gnu::vector_size(bytes)]] = Number;

__extension__ using Integer128 = __int128;

}  // namespace relief::detail

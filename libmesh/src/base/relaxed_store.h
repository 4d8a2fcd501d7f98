// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stores to elements of arrays that several threads set to the same value.
#pragma once

#include <type_traits>

namespace relief::detail {

/// Stores a value atomically, without an order. libc++ has no std::atomic_ref before version 19.
template <typename Number>
void relaxed_store(Number& to, std::type_identity_t<Number> value) {
    __atomic_store_n(&to, value, __ATOMIC_RELAXED);
}

}  // namespace relief::detail

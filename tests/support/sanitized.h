// SPDX-License-Identifier: Apache-2.0
/// \file
/// States whether the tests run under a sanitizer. They take 5 to 50 times as long there, so cases
/// that try many inputs of one kind try fewer.
#pragma once

namespace relief::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

}  // namespace relief::test
